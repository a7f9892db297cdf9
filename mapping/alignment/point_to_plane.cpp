// point_to_plane.cpp: projective association of eight points at a time, and sums in float over blocks of
// points.
#include "mapping/alignment/point_to_plane.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace roomradar {
namespace {

constexpr std::size_t kLanes = 8;

/// Eight numbers of one kind for each coordinate.
template <typename Float8>
struct Vector8 {
  Float8 x, y, z;

  [[nodiscard]] Float8 dot(const Vector8& b) const { return x * b.x + y * b.y + z * b.z; }
  [[nodiscard]] Vector8 cross(const Vector8& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
  friend Vector8 operator+(const Vector8& a, const Vector8& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector8 operator*(const Float8& s, const Vector8& a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <typename Float8>
Vector8<Float8> all_lanes(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

/// A rotation, in all lanes.
template <typename Float8>
struct Rotation8 {
  Vector8<Float8> row0, row1, row2;

  explicit Rotation8(const Eigen::Matrix3f& R)
      : row0(all_lanes<Float8>(R.row(0))),
        row1(all_lanes<Float8>(R.row(1))),
        row2(all_lanes<Float8>(R.row(2))) {}
  Vector8<Float8> operator*(const Vector8<Float8>& p) const {
    return {row0.dot(p), row1.dot(p), row2.dot(p)};
  }
};

template <typename Float8>
double sum_of_lanes(const Float8& value) {
  std::array<float, kLanes> lanes{};
  value.store(lanes);
  double sum = 0.0;
  for (const float lane : lanes) sum += static_cast<double>(lane);
  return sum;
}

/// Normal equations of residuals r = r0 + J twist, J = (m, p x m), packed: 21 entries of J'wJ, 6 of J'wr.
template <typename Float8>
struct Normals {
  std::array<Float8, 27> sums;

  Normals() { sums.fill(0.0F); }
  void add(const Vector8<Float8>& p, const Vector8<Float8>& m, const Float8& residual, const Float8& weight) {
    const Vector8<Float8> c = p.cross(m);
    const std::array<Float8, 6> J{m.x, m.y, m.z, c.x, c.y, c.z};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const Float8 wj = weight * J[i];
      for (std::size_t j = i; j < 6; ++j, ++k) sums[k] = sums[k] + wj * J[j];
      sums[21 + i] = sums[21 + i] + wj * residual;
    }
  }
  /// Adds the sums of all lanes.
  void add_to(NormalEquations& sum) const {
    std::size_t k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) sum.H(i, j) += sum_of_lanes(sums[k++]);
      sum.g(i) += sum_of_lanes(sums[21 + static_cast<std::size_t>(i)]);
    }
  }
};

/// Sums over the points of one block, per lane.
template <typename Float8>
struct BlockSums {
  Normals<Float8> depth, colour;
  Float8 weight = 0.0F, squares = 0.0F;
  Float8 n = 0.0F, live = 0.0F, reference = 0.0F, live_live = 0.0F, reference_reference = 0.0F;

  void add_to(PointMatches& pass) const {
    depth.add_to(pass.depth);
    colour.add_to(pass.colour);
    pass.depth.weight += sum_of_lanes(weight);
    pass.squares += sum_of_lanes(squares);
    pass.n += sum_of_lanes(n), pass.live += sum_of_lanes(live), pass.reference += sum_of_lanes(reference);
    pass.live_live += sum_of_lanes(live_live);
    pass.reference_reference += sum_of_lanes(reference_reference);
  }
};

/// Matches eight points at a time with the pixels of a target level.
template <typename Float8>
class Matcher {
 public:
  Matcher(const TargetLevel& reference, const Eigen::Isometry3d& T_view_camera, const MatchLimits& limits,
          const Exposure& exposure, const RowMotion& motion)
      : reference_(reference),
        limits_(limits),
        exposure_(exposure),
        motion_(motion),
        R_(T_view_camera.linear().cast<float>()),
        R_transposed_(T_view_camera.linear().transpose().cast<float>()),
        t_(all_lanes<Float8>(T_view_camera.translation().cast<float>())),
        fx_(static_cast<float>(reference.camera.fx_px)),
        fy_(static_cast<float>(reference.camera.fy_px)),
        cx_(static_cast<float>(reference.camera.cx_px)),
        cy_(static_cast<float>(reference.camera.cy_px)),
        end_u_(static_cast<float>(reference.camera.width_px) - 0.5F),
        end_v_(static_cast<float>(reference.camera.height_px) - 0.5F) {}

  /// Adds the residuals of points[0 .. count - 1], count <= 8.
  void add(const SourcePoint* points, std::size_t count, BlockSums<Float8>& sums, PointMatches& pass) const {
    static_assert(sizeof(SourcePoint) == 4 * sizeof(float) && sizeof(TargetPixel) == 8 * sizeof(float));
    const Float8 zero = 0.0F;
    std::array<const float*, kLanes> rows{};
    for (std::size_t i = 0; i < kLanes; ++i) rows[i] = points[std::min(i, count - 1)].p_camera.data();
    const std::array<Float8, 4> point = Float8::template columns<4>(rows);
    const Float8& live = point[3];
    const Vector8<Float8> p_camera = at_middle({point[0], point[1], point[2]});
    const Vector8<Float8> p = R_ * p_camera + t_;
    const Mask in_front = Mask::of_bits((1U << count) - 1U) & (Float8(0.1F) <= p.z);
    const Float8 inverse_z = Float8(1.0F) / select(in_front, p.z, 1.0F);
    const Float8 u = fx_ * p.x * inverse_z + cx_, v = fy_ * p.y * inverse_z + cy_;
    const Mask inside = in_front & (Float8(-0.5F) < u) & (Float8(-0.5F) < v) & (u < end_u_) & (v < end_v_);
    if (inside.bits() == 0) return;
    const Float8 x = floor(select(inside, u, 0.0F) + 0.5F), y = floor(select(inside, v, 0.0F) + 0.5F);
    std::array<int, kLanes> columns{}, image_rows{};
    x.store_truncated(columns);
    y.store_truncated(image_rows);
    for (std::size_t i = 0; i < kLanes; ++i)
      rows[i] = reference_.pixels.at(columns[i], image_rows[i]).normal.data();
    const auto [nx, ny, nz, offset_m, inverse_sigma_per_m, intensity, gradient_u, gradient_v] =
        Float8::template columns<8>(rows);
    const Mask met = inside & (zero < inverse_sigma_per_m);
    pass.met += static_cast<std::size_t>(std::popcount(met.bits()));
    const Vector8<Float8> normal{nx, ny, nz};
    const Float8 r_m = normal.dot(p) - offset_m;
    const Mask matched = met & (abs(r_m) <= Float8(limits_.gate_m));
    if (matched.bits() == 0) return;
    const Float8 r = select(matched, r_m * inverse_sigma_per_m, 0.0F);
    const Float8 w = select(matched, robust_weight(r * limits_.inverse_soft), 0.0F);
    // The residual is the difference of two measurements: 2.8 of its standard deviations.
    const Mask inliers = matched & (abs(r) < Float8(4.0F));
    pass.inliers += static_cast<std::size_t>(std::popcount(inliers.bits()));
    sums.squares = sums.squares + select(inliers, r_m * r_m, 0.0F);
    sums.depth.add(p_camera, inverse_sigma_per_m * (R_transposed_ * normal), r, w);
    sums.weight = sums.weight + w * inverse_sigma_per_m * inverse_sigma_per_m;

    if (limits_.inverse_intensity_sigma <= 0.0F) return;
    const Mask both = matched & (zero <= live) & (zero <= intensity);
    if (both.bits() == 0) return;
    const Float8 wi = select(both, w, 0.0F);
    sums.n = sums.n + wi;
    sums.live = sums.live + wi * live;
    sums.reference = sums.reference + wi * intensity;
    sums.live_live = sums.live_live + wi * live * live;
    sums.reference_reference = sums.reference_reference + wi * intensity * intensity;
    if (!exposure_.known) return;
    const Float8 gu = gradient_u * fx_ * inverse_z, gv = gradient_v * fy_ * inverse_z;
    const Float8 expected = intensity + gradient_u * (u - x) + gradient_v * (v - y);
    const Float8 rc = select(both,
                             (expected - Float8(exposure_.gain) * live - Float8(exposure_.offset)) *
                                 Float8(limits_.inverse_intensity_sigma),
                             0.0F);
    const Vector8<Float8> h{gu, gv, zero - (gu * p.x + gv * p.y) * inverse_z};
    sums.colour.add(p_camera, Float8(limits_.inverse_intensity_sigma) * (R_transposed_ * h), rc,
                    wi * robust_weight(rc * limits_.inverse_soft));
  }

 private:
  using Mask = typename Float8::Mask;
  const TargetLevel& reference_;
  const MatchLimits& limits_;
  const Exposure& exposure_;
  const RowMotion& motion_;
  Rotation8<Float8> R_, R_transposed_;
  Vector8<Float8> t_;
  Float8 fx_, fy_, cx_, cy_, end_u_, end_v_;

  /// As RowMotion::at_middle().
  Vector8<Float8> at_middle(const Vector8<Float8>& p) const {
    if (motion_.row_s == 0.0F) return p;
    const Float8 t_s =
        Float8(motion_.row_s) * (Float8(motion_.fy_px) * p.y / p.z + Float8(motion_.above_middle_px));
    return p +
           t_s * (all_lanes<Float8>(motion_.linear_mps) + all_lanes<Float8>(motion_.angular_radps).cross(p));
  }
};

template <typename Float8>
void match(const std::vector<SourcePoint>& points, const Matcher<Float8>& matcher, PointMatches& pass) {
  constexpr std::size_t kBlock = 1024;  // float sums over 128 points per lane keep six digits
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, points.size());
    BlockSums<Float8> sums;
    for (std::size_t i = begin; i < end; i += kLanes)
      matcher.add(points.data() + i, std::min(kLanes, end - i), sums, pass);
    sums.add_to(pass);
  }
}

}  // namespace

void match_points(const MovingPoints& live, const TargetLevel& reference, const ViewRelation& relation,
                  const MatchLimits& limits, PointMatches& pass, Arithmetic arithmetic) {
  const auto& [T_view_camera, exposure] = relation;
  if (arithmetic == Arithmetic::kFastest)
    match(live.points, Matcher<Float8>(reference, T_view_camera, limits, exposure, live.motion), pass);
  else
    match(live.points, Matcher<PortableFloat8>(reference, T_view_camera, limits, exposure, live.motion),
          pass);
}

Exposure match_exposure(const PointMatches& pass) {
  if (pass.n < 50.0) return {};
  const double live_mean = pass.live / pass.n, reference_mean = pass.reference / pass.n;
  const double live_variance = pass.live_live / pass.n - live_mean * live_mean;
  const double reference_variance = pass.reference_reference / pass.n - reference_mean * reference_mean;
  Exposure exposure;
  const double ratio = std::max(reference_variance, 1.0) / std::max(live_variance, 1.0);
  exposure.gain = static_cast<float>(std::clamp(std::sqrt(ratio), 0.5, 2.0));
  exposure.offset = static_cast<float>(reference_mean - static_cast<double>(exposure.gain) * live_mean);
  exposure.known = true;
  return exposure;
}

}  // namespace roomradar
