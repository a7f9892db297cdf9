// view.cpp: fits planes to the neighbourhoods of pixels, and collects points.
#include "mapping/alignment/view.hpp"

#include <algorithm>
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

/// Fits a plane to the samples on the pixel's surface among (2 kHalf + 1)^2 samples, `step` apart. Returns
/// false if there are too few, or if they are not coplanar within the noise.
template <int kHalf>
bool fit_plane(const Image<float>& inverse_depth, const DepthNoise& noise, int x, int y, int step,
               float& value, float& slope_u, float& slope_v) {
  const float q0 = inverse_depth.at(x, y);
  const float gate = kSameSurface * q0;
  // Sums over the samples, relative to the centre: n, u, v, uu, uv, vv, q, uq, vq, qq.
  float n = 0, su = 0, sv = 0, suu = 0, suv = 0, svv = 0, sq = 0, suq = 0, svq = 0, sqq = 0;
  for (int j = -kHalf; j <= kHalf; ++j) {
    const float* row = inverse_depth.row(y + j * step) + x;
    const auto v = static_cast<float>(j);
    for (int i = -kHalf; i <= kHalf; ++i) {
      const float q = row[i * step] - q0;
      const float w = std::abs(q) < gate ? 1.0F : 0.0F;
      const auto u = static_cast<float>(i);
      n += w, su += w * u, sv += w * v, suu += w * u * u, suv += w * u * v, svv += w * v * v;
      const float wq = w * q;
      sq += wq, suq += wq * u, svq += wq * v, sqq += wq * q;
    }
  }
  constexpr int kSamples = (2 * kHalf + 1) * (2 * kHalf + 1);
  if (n < 0.4F * kSamples) return false;
  const float inverse_n = 1.0F / n;
  const float cuu = suu - su * su * inverse_n, cuv = suv - su * sv * inverse_n,
              cvv = svv - sv * sv * inverse_n;
  const float cuq = suq - su * sq * inverse_n, cvq = svq - sv * sq * inverse_n,
              cqq = sqq - sq * sq * inverse_n;
  const float determinant = cuu * cvv - cuv * cuv;
  // With all samples, the determinant is the square of one direction's sum of squares. Near 0, the samples
  // are almost collinear.
  constexpr float kSquares = kHalf == 1 ? 6.0F : 50.0F;
  static_assert(kHalf == 1 || kHalf == 2);
  if (determinant < 0.012F * kSquares * kSquares) return false;
  const float a = (cuq * cvv - cvq * cuv) / determinant, b = (cvq * cuu - cuq * cuv) / determinant;
  const float residual = std::max(cqq - a * cuq - b * cvq, 0.0F) * inverse_n;
  const float allowed = 3.0F * depth_sigma_m(noise, 1.0F / q0) * q0 * q0;
  if (residual > allowed * allowed) return false;
  slope_u = a / static_cast<float>(step), slope_v = b / static_cast<float>(step);
  value = q0 + (sq - a * su - b * sv) * inverse_n;
  return value > 0.0F;
}

void fill_gradient(const Image<float>& intensity, int x, int y, TargetPixel& pixel) {
  const float left = intensity.at(x - 1, y), right = intensity.at(x + 1, y);
  const float up = intensity.at(x, y - 1), down = intensity.at(x, y + 1);
  if (pixel.intensity < 0.0F || left < 0.0F || right < 0.0F || up < 0.0F || down < 0.0F) return;
  const float gu = 0.5F * (right - left), gv = 0.5F * (down - up);
  if (gu * gu + gv * gv < kMinGradient * kMinGradient) return;
  pixel.gradient_u = gu, pixel.gradient_v = gv;
}

template <int kHalf>
void make_reference_level(const ViewPyramid::Level& level, const DepthNoise& noise, int step,
                          TargetLevel& out) {
  const TargetPixel none{Eigen::Vector3f::Zero(), 0.0F, 0.0F, -1.0F, 0.0F, 0.0F};
  const Intrinsics& camera = level.camera;
  out.camera = camera;
  out.pixels.resize(camera.width_px, camera.height_px, none);
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  const int border = kHalf * step;
  for (int y = border; y < camera.height_px - border; ++y) {
    for (int x = border; x < camera.width_px - border; ++x) {
      if (level.inverse_depth_per_m.at(x, y) <= 0.0F) continue;
      float q = 0, a = 0, b = 0;
      if (!fit_plane<kHalf>(level.inverse_depth_per_m, noise, x, y, step, q, a, b)) continue;
      // On a plane 1/z = n . ray / offset, so the gradient of 1/z gives n / offset.
      const float du = static_cast<float>(x) - cx, dv = static_cast<float>(y) - cy;
      const Eigen::Vector3f n(a * fx, b * fy, q - a * du - b * dv);
      const float distance_m = 1.0F / n.norm();
      TargetPixel& pixel = out.pixels.at(x, y);
      pixel.normal = -distance_m * n;
      pixel.offset_m = -distance_m;
      const float z_m = 1.0F / q;
      const float cosine = distance_m * q;  // of the angle between normal and ray, times the ray's length at
                                            // z = 1
      const float along_m = cosine * depth_sigma_m(noise, z_m);
      const float across_m = kLateralSigma_rad * z_m * std::sqrt(std::max(1.0F - cosine * cosine, 0.0F));
      pixel.inverse_sigma_per_m =
          1.0F / std::sqrt(along_m * along_m + across_m * across_m + kDistortion_m * kDistortion_m);
      if (level.intensity.empty()) continue;
      pixel.intensity = level.intensity.at(x, y);
      fill_gradient(level.intensity, x, y, pixel);
    }
  }
}

}  // namespace

void make_target_view(const ViewPyramid& pyramid, const Eigen::Isometry3d& T_world_view,
                      const ViewConfig& config, TargetView& reference) {
  reference.T_world_view = T_world_view;
  reference.levels.resize(pyramid.levels.size());
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
    const int reach_px = config.normal_reach_px >> i;
    if (config.noisy) {
      make_reference_level<2>(pyramid.levels[i], pyramid.noise, std::max(1, reach_px / 2),
                              reference.levels[i]);
    } else {
      make_reference_level<1>(pyramid.levels[i], pyramid.noise, 1, reference.levels[i]);
    }
  }
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
