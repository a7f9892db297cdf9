// view.cpp: fits planes to the neighbourhoods of eight pixels at a time, and collects points.
#include "mapping/alignment/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {
namespace {

// Lateral noise of a Kinect v1: 0.8 pixels at a focal length of 585 pixels. Source: Nguyen et al. 2012,
// section 3.
constexpr float kLateralSigma_rad = 0.8F / 585.0F;

// Systematic depth error of a Kinect, from inexact calibration of lens and baseline; averaging does not
// reduce it. Chosen on the kitchen recording: 3 and 4 mm give an ATE of 22.3 and 21.9 mm, and an RPE over 30
// frames of 17.0 and 16.7 mm.
constexpr float kDistortion_m = 0.004F;

// Smaller intensity gradients (grey levels per pixel) are noise of the colour camera.
constexpr float kMinGradient = 3.0F;

constexpr int kLanes = 8;

/// Planes at eight pixels side by side, as inverse depth by column and row.
template <typename Float8>
struct Planes8 {
  Float8 value, slope_u, slope_v;  ///< 1/m at the pixel, and per pixel
  typename Float8::Mask are_found;
};

/// Reads `count` values; the others are 0.
template <typename Float8>
Float8 load_row(const float* from, int count) {
  if (count == kLanes) return Float8::load(from);
  std::array<float, kLanes> lanes{};
  std::copy_n(from, count, lanes.begin());
  return Float8::load(lanes);
}

/// Fits planes to the samples on the surfaces of `count` pixels from (x, y) on. Each has (2 kHalf + 1)^2
/// samples, `step` apart. None is found where there are too few samples, or if they are not coplanar within
/// the noise.
template <int kHalf, typename Float8>
Planes8<Float8> fit_planes(const Image<float>& inverse_depth, const DepthNoise& noise, int x, int y, int step,
                           int count) {
  const Float8 zero = 0.0F, one = 1.0F;
  const Float8 q0 = load_row<Float8>(inverse_depth.row(y) + x, count);
  const Float8 gate = Float8(kSameSurface) * q0;
  // Sums over the samples, relative to the centre: n, u, v, uu, uv, vv, q, uq, vq, qq.
  Float8 n = zero, su = zero, sv = zero, suu = zero, suv = zero, svv = zero, sq = zero, suq = zero,
         svq = zero, sqq = zero;
  for (int j = -kHalf; j <= kHalf; ++j) {
    const float* row = inverse_depth.row(y + j * step) + x;
    const auto v = static_cast<float>(j);
    Float8 row_n = zero, row_u = zero, row_q = zero;
    for (int i = -kHalf; i <= kHalf; ++i) {
      const auto u = static_cast<float>(i);
      const Float8 q = load_row<Float8>(row + i * step, count) - q0;
      const auto is_same = abs(q) < gate;
      const Float8 w = select(is_same, one, zero), wq = select(is_same, q, zero);
      row_n = row_n + w;
      row_u = row_u + w * u;
      suu = suu + w * (u * u);
      row_q = row_q + wq;
      suq = suq + wq * u;
      sqq = sqq + wq * q;
    }
    n = n + row_n, sv = sv + row_n * v, svv = svv + row_n * (v * v);
    su = su + row_u, suv = suv + row_u * v;
    sq = sq + row_q, svq = svq + row_q * v;
  }
  constexpr int kSamples = (2 * kHalf + 1) * (2 * kHalf + 1);
  const Float8 inverse_n = one / max(n, one);
  const Float8 cuu = suu - su * su * inverse_n, cuv = suv - su * sv * inverse_n,
               cvv = svv - sv * sv * inverse_n;
  const Float8 cuq = suq - su * sq * inverse_n, cvq = svq - sv * sq * inverse_n,
               cqq = sqq - sq * sq * inverse_n;
  const Float8 determinant = cuu * cvv - cuv * cuv;
  // With all samples, the determinant is the square of one direction's sum of squares. Near 0, the samples
  // are almost collinear.
  constexpr float kSquares = kHalf == 1 ? 6.0F : 50.0F;
  static_assert(kHalf == 1 || kHalf == 2);
  const auto are_enough =
      (zero < q0) & (Float8(0.4F * kSamples) <= n) & (Float8(0.012F * kSquares * kSquares) <= determinant);
  const Float8 divisor = select(are_enough, determinant, one);
  const Float8 a = (cuq * cvv - cvq * cuv) / divisor, b = (cvq * cuu - cuq * cuv) / divisor;
  const Float8 residual = max(cqq - a * cuq - b * cvq, zero) * inverse_n;
  const Float8 allowed = Float8(3.0F) * depth_sigmas_m(noise, one / select(are_enough, q0, one)) * q0 * q0;
  const Float8 value = q0 + (sq - a * su - b * sv) * inverse_n;
  const Float8 inverse_step = 1.0F / static_cast<float>(step);
  return {value, a * inverse_step, b * inverse_step,
          are_enough & (residual <= allowed * allowed) & (zero < value)};
}

void fill_gradient(const Image<float>& intensity, int x, int y, TargetPixel& pixel) {
  const float left = intensity.at(x - 1, y), right = intensity.at(x + 1, y);
  const float up = intensity.at(x, y - 1), down = intensity.at(x, y + 1);
  if (pixel.intensity < 0.0F || left < 0.0F || right < 0.0F || up < 0.0F || down < 0.0F) return;
  const float gu = 0.5F * (right - left), gv = 0.5F * (down - up);
  if (gu * gu + gv * gv < kMinGradient * kMinGradient) return;
  pixel.gradient_u = gu, pixel.gradient_v = gv;
}

template <int kHalf, typename Float8>
void make_reference_level(const ViewPyramid::Level& level, const DepthNoise& noise, int step,
                          TargetLevel& out) {
  const TargetPixel none{Eigen::Vector3f::Zero(), 0.0F, 0.0F, -1.0F, 0.0F, 0.0F};
  const Intrinsics& camera = level.camera;
  out.camera = camera;
  out.pixels.resize(camera.width_px, camera.height_px, none);
  const Float8 fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  const Float8 zero = 0.0F, one = 1.0F;
  const Float8 lane = Float8::load(std::array<float, kLanes>{0, 1, 2, 3, 4, 5, 6, 7});
  const int border = kHalf * step;
  for (int y = border; y < camera.height_px - border; ++y) {
    for (int x = border; x < camera.width_px - border; x += kLanes) {
      const int count = std::min(kLanes, camera.width_px - border - x);
      const auto [q, a, b, are_found] =
          fit_planes<kHalf, Float8>(level.inverse_depth_per_m, noise, x, y, step, count);
      const unsigned found = are_found.bits();
      if (found == 0) continue;
      // On a plane 1/z = n . ray / offset, so the gradient of 1/z gives n / offset.
      const Float8 du = lane + (static_cast<float>(x) - cx);
      const Float8 nx = a * fx, ny = b * fy, nz = q - a * du - b * (static_cast<float>(y) - cy);
      const Float8 distance_m = one / sqrt(select(are_found, nx * nx + ny * ny + nz * nz, one));
      const Float8 z_m = one / select(are_found, q, one);
      // Of the angle between normal and ray, times the ray's length at z = 1.
      const Float8 cosine = distance_m * q;
      const Float8 along_m = cosine * depth_sigmas_m(noise, z_m);
      const Float8 across_m = Float8(kLateralSigma_rad) * z_m * sqrt(max(one - cosine * cosine, zero));
      const Float8 inverse_sigma_per_m =
          one / sqrt(along_m * along_m + across_m * across_m + kDistortion_m * kDistortion_m);
      std::array<std::array<float, kLanes>, 5> columns{};
      const Float8 back_m = zero - distance_m;
      (back_m * nx).store(columns[0]);
      (back_m * ny).store(columns[1]);
      (back_m * nz).store(columns[2]);
      back_m.store(columns[3]);
      inverse_sigma_per_m.store(columns[4]);
      for (int i = 0; i < count; ++i) {
        if ((found >> static_cast<unsigned>(i) & 1U) == 0) continue;
        const auto k = static_cast<std::size_t>(i);
        TargetPixel& pixel = out.pixels.at(x + i, y);
        pixel.normal = {columns[0][k], columns[1][k], columns[2][k]};
        pixel.offset_m = columns[3][k];
        pixel.inverse_sigma_per_m = columns[4][k];
        if (level.intensity.empty()) continue;
        pixel.intensity = level.intensity.at(x + i, y);
        fill_gradient(level.intensity, x + i, y, pixel);
      }
    }
  }
}

template <typename Float8>
void make_levels(const ViewPyramid& pyramid, const ViewConfig& config, TargetView& reference) {
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
    const int reach_px = config.normal_reach_px >> i;
    if (config.noisy) {
      make_reference_level<2, Float8>(pyramid.levels[i], pyramid.noise, std::max(1, reach_px / 2),
                                      reference.levels[i]);
    } else {
      make_reference_level<1, Float8>(pyramid.levels[i], pyramid.noise, 1, reference.levels[i]);
    }
  }
}

}  // namespace

void make_target_view(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                      const ViewConfig& config, TargetView& reference, Arithmetic arithmetic) {
  reference.T_world_view = T_world_view;
  reference.levels.resize(pyramid.levels.size());
  if (arithmetic == Arithmetic::kFastest)
    make_levels<Float8>(pyramid, config, reference);
  else
    make_levels<PortableFloat8>(pyramid, config, reference);
}

void make_source_points(const ViewPyramid& pyramid, SourcePoints& live, const MaskImage& ignore,
                        int finest_step_px) {
  live.levels.resize(pyramid.levels.size());
  live.cameras.resize(pyramid.levels.size());
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
    const ViewPyramid::Level& level = pyramid.levels[i];
    live.cameras[i] = level.camera;
    const int step = i == 0 ? std::max(finest_step_px, 1) : 1;
    const double mask_scale =
        ignore.empty() ? 0.0 : static_cast<double>(ignore.width) / level.camera.width_px;
    std::vector<SourcePoint>& points = live.levels[i];
    points.clear();
    points.reserve(level.inverse_depth_per_m.pixels.size() / static_cast<std::size_t>(step * step));
    for (int y = step / 2; y < level.camera.height_px; y += step) {
      for (int x = step / 2; x < level.camera.width_px; x += step) {
        const float q = level.inverse_depth_per_m.at(x, y);
        if (q <= 0.0F) continue;
        if (!ignore.empty()) {
          const int u = std::min(static_cast<int>((x + 0.5) * mask_scale), ignore.width - 1);
          const int v = std::min(static_cast<int>((y + 0.5) * mask_scale), ignore.height - 1);
          if (ignore.at(u, v) != 0) continue;
        }
        points.push_back({back_project(level.camera, x, y, 1.0 / q).cast<float>(),
                          level.intensity.empty() ? -1.0F : level.intensity.at(x, y)});
      }
    }
  }
}

}  // namespace roomradar
