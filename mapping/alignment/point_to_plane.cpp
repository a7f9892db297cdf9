// point_to_plane.cpp: projective association, and sums in float over blocks of points.
#include "mapping/alignment/point_to_plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

/// Normal equations of residuals r = r0 + J twist, J = (m, p x m), packed: 21 entries of J'wJ, 6 of J'wr.
struct Normals {
  std::array<float, 27> sums{};

  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& m, float residual, float weight) {
    const Eigen::Vector3f c = p.cross(m);
    const std::array<float, 6> J{m.x(), m.y(), m.z(), c.x(), c.y(), c.z()};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const float wj = weight * J[i];
      for (std::size_t j = i; j < 6; ++j) sums[k++] += wj * J[j];
      sums[21 + i] += wj * residual;
    }
  }
};

/// Adds one block of points, summed in float, to the double-precision sum.
void add(const Normals& block, NormalEquations& sum) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) sum.H(i, j) += static_cast<double>(block.sums[k++]);
    sum.g(i) += static_cast<double>(block.sums[21 + static_cast<std::size_t>(i)]);
  }
}

}  // namespace

// One function: the sums of a block stay in registers.
void match_points(const std::vector<SourcePoint>& points, const TargetLevel& reference,
                  const Eigen::Isometry3d& T_view_camera, const MatchLimits& limits, const Exposure& exposure,
                  const RowMotion& motion, PointMatches& pass) {
  constexpr std::size_t kBlock = 512;  // float sums over this many points keep five digits
  const Eigen::Matrix3f R = T_view_camera.linear().cast<float>();
  const Eigen::Matrix3f R_transposed = R.transpose();
  const Eigen::Vector3f t = T_view_camera.translation().cast<float>();
  const auto fx = static_cast<float>(reference.camera.fx_px), fy = static_cast<float>(reference.camera.fy_px);
  const auto cx = static_cast<float>(reference.camera.cx_px), cy = static_cast<float>(reference.camera.cy_px);
  const auto end_u = static_cast<float>(reference.camera.width_px) - 0.5F;
  const auto end_v = static_cast<float>(reference.camera.height_px) - 0.5F;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, points.size());
    Normals depth, colour;
    float weights = 0.0F, squares = 0.0F;
    float n = 0.0F, sl = 0.0F, sr = 0.0F, sll = 0.0F, srr = 0.0F;
    for (std::size_t i = begin; i < end; ++i) {
      const SourcePoint& point = points[i];
      const Eigen::Vector3f p_camera = motion.at_middle(point.p_camera);
      const Eigen::Vector3f p = R * p_camera + t;
      if (p.z() < 0.1F) continue;
      const float inverse_z = 1.0F / p.z();
      const float u = fx * p.x() * inverse_z + cx, v = fy * p.y() * inverse_z + cy;
      if (!(u > -0.5F && v > -0.5F && u < end_u && v < end_v)) continue;
      const int x = static_cast<int>(u + 0.5F), y = static_cast<int>(v + 0.5F);
      const TargetPixel& pixel = reference.pixels.at(x, y);
      if (pixel.inverse_sigma_per_m <= 0.0F) continue;
      ++pass.met;
      const float r_m = pixel.normal.dot(p) - pixel.offset_m;
      if (std::abs(r_m) > limits.gate_m) continue;
      const float r = r_m * pixel.inverse_sigma_per_m;
      const float w = robust_weight(r * limits.inverse_soft);
      if (std::abs(r) < 4.0F) {  // difference of two measurements: 3 sqrt(2) standard deviations
        ++pass.inliers;
        squares += r_m * r_m;
      }
      const Eigen::Vector3f m = pixel.inverse_sigma_per_m * (R_transposed * pixel.normal);
      depth.add(p_camera, m, r, w);
      weights += w * pixel.inverse_sigma_per_m * pixel.inverse_sigma_per_m;

      if (limits.inverse_intensity_sigma <= 0.0F || point.intensity < 0.0F || pixel.intensity < 0.0F)
        continue;
      n += w, sl += w * point.intensity, sr += w * pixel.intensity;
      sll += w * point.intensity * point.intensity, srr += w * pixel.intensity * pixel.intensity;
      const float gu = pixel.gradient_u * fx * inverse_z, gv = pixel.gradient_v * fy * inverse_z;
      if (!exposure.known || (gu == 0.0F && gv == 0.0F)) continue;
      const float expected = pixel.intensity + pixel.gradient_u * (u - static_cast<float>(x)) +
                             pixel.gradient_v * (v - static_cast<float>(y));
      const float rc =
          (expected - exposure.gain * point.intensity - exposure.offset) * limits.inverse_intensity_sigma;
      const Eigen::Vector3f h(gu, gv, -(gu * p.x() + gv * p.y()) * inverse_z);
      colour.add(p_camera, limits.inverse_intensity_sigma * (R_transposed * h), rc,
                 w * robust_weight(rc * limits.inverse_soft));
    }
    add(depth, pass.depth);
    add(colour, pass.colour);
    pass.depth.weight += static_cast<double>(weights);
    pass.squares += static_cast<double>(squares);
    pass.n += static_cast<double>(n), pass.live += static_cast<double>(sl);
    pass.reference += static_cast<double>(sr);
    pass.live_live += static_cast<double>(sll), pass.reference_reference += static_cast<double>(srr);
  }
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
