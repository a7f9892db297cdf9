// rolling_shutter.cpp: first-order motion of image points and of their inverse depths.
#include "mapping/alignment/rolling_shutter.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view_pyramid.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

/// Where the pixels of a row are in the skewed image, one entry per pixel. The loops over a row have no
/// branches, so that compilers vectorise them.
struct SkewedRow {
  std::vector<float> t_s;     ///< from the middle of the readout to the readout of the pixel
  std::vector<float> du, dv;  ///< of the pixel within its four neighbours, 0..1
  std::vector<int> upper;     ///< index of the upper left neighbour in the image
  std::vector<int> nearest;   ///< index of the nearest neighbour
  std::vector<int> inside;    ///< 0: outside the image, with index 0

  explicit SkewedRow(int width_px) {
    const auto width = static_cast<std::size_t>(width_px);
    for (std::vector<float>* floats : {&t_s, &du, &dv}) floats->resize(width);
    for (std::vector<int>* ints : {&upper, &nearest, &inside}) ints->resize(width);
  }
};

/// Motion of a pinhole camera's image points.
struct ImageMotion {
  Eigen::Vector3f v, w;  ///< of the camera, m/s and rad/s
  float fx, fy, cx, cy, row_s, above_middle_px;

  [[nodiscard]] float xn(int x) const { return (static_cast<float>(x) - cx) / fx; }
  [[nodiscard]] float yn(int y) const { return (static_cast<float>(y) - cy) / fy; }
  /// Per second, a point moves by -(v + w x p) in the camera's frame; all is divided by its depth.
  [[nodiscard]] float nearing(float xn, float yn, float inverse_depth_per_m) const {
    return v.z() * inverse_depth_per_m + w.x() * yn - w.y() * xn;
  }
};

void find_skewed(const ImageMotion& motion, const Image<float>& skewed, int y, SkewedRow& row) {
  const Eigen::Vector3f v = motion.v, w = motion.w;
  const float fx = motion.fx, fy = motion.fy, yn = motion.yn(y), row_s = motion.row_s;
  const float rows_s = row_s * (static_cast<float>(y) - motion.cy + motion.above_middle_px);
  const int width = skewed.width;
  const auto last_u = static_cast<float>(width - 1), last_v = static_cast<float>(skewed.height - 1);
  const float* const inverse_depth_per_m = skewed.row(y);
  float *const t_s = row.t_s.data(), *const du = row.du.data(), *const dv = row.dv.data();
  int *const upper = row.upper.data(), *const nearest = row.nearest.data(), *const inside = row.inside.data();
  for (int x = 0; x < width; ++x) {
    const float q = inverse_depth_per_m[x], xn = motion.xn(x);
    const float nearing = motion.nearing(xn, yn, q);
    const float u_speed = fx * (xn * nearing - v.x() * q - w.y() + w.z() * yn);
    const float v_speed = fy * (yn * nearing - v.y() * q - w.z() * xn + w.x());
    t_s[x] = rows_s / (1.0F - row_s * v_speed);
    const float u = static_cast<float>(x) + t_s[x] * u_speed;
    const float down = static_cast<float>(y) + t_s[x] * v_speed;
    const bool is_inside = (u >= 0.0F) & (down >= 0.0F) & (u < last_u) & (down < last_v);
    const float u_in = is_inside ? u : 0.0F, v_in = is_inside ? down : 0.0F;
    const int u0 = static_cast<int>(u_in), v0 = static_cast<int>(v_in);
    du[x] = u_in - static_cast<float>(u0);
    dv[x] = v_in - static_cast<float>(v0);
    upper[x] = v0 * width + u0;
    nearest[x] = upper[x] + (du[x] < 0.5F ? 0 : 1) + (dv[x] < 0.5F ? 0 : width);
    inside[x] = is_inside ? 1 : 0;
  }
}

/// Four neighbours of a pixel, and whether they are of one surface.
struct Neighbours {
  float a, b, c, d;

  /// @param upper  index of the upper left one
  Neighbours(const float* pixels, int upper, int width)
      : a(pixels[upper]), b(pixels[upper + 1]), c(pixels[upper + width]), d(pixels[upper + width + 1]) {}
  [[nodiscard]] float least() const { return std::min(std::min(a, b), std::min(c, d)); }
  [[nodiscard]] float most() const { return std::max(std::max(a, b), std::max(c, d)); }
  [[nodiscard]] bool are_one_surface() const { return least() > most() * (1.0F - kSameSurface); }
  [[nodiscard]] float between(float du, float dv) const {
    return (1.0F - dv) * ((1.0F - du) * a + du * b) + dv * ((1.0F - du) * c + du * d);
  }
};

void sample_depth(const ImageMotion& motion, const Image<float>& skewed, const SkewedRow& row, int y,
                  float* __restrict inverse_depth_per_m) {
  const float yn = motion.yn(y);
  const int width = skewed.width;
  const float* const from = skewed.pixels.data();
  const float *const t_s = row.t_s.data(), *const du = row.du.data(), *const dv = row.dv.data();
  const int *const upper = row.upper.data(), *const nearest = row.nearest.data(),
                   *const inside = row.inside.data();
  for (int x = 0; x < width; ++x) {
    const Neighbours round(from, upper[x], width);
    const float q = round.are_one_surface() ? round.between(du[x], dv[x]) : from[nearest[x]];
    const float moved = q * (1.0F - t_s[x] * motion.nearing(motion.xn(x), yn, q));
    inverse_depth_per_m[x] = (inside[x] != 0) & (q > 0.0F) & (moved > 0.0F) ? moved : 0.0F;
  }
}

void sample_intensity(const Image<float>& skewed, const Image<float>& skewed_intensity, const SkewedRow& row,
                      float* __restrict intensity) {
  const int width = skewed.width;
  const float *const from = skewed.pixels.data(), *const greys = skewed_intensity.pixels.data();
  const float *const du = row.du.data(), *const dv = row.dv.data();
  const int *const upper = row.upper.data(), *const nearest = row.nearest.data(),
                   *const inside = row.inside.data();
  for (int x = 0; x < width; ++x) {
    const Neighbours round(from, upper[x], width), grey(greys, upper[x], width);
    const bool one_surface = round.are_one_surface();
    const float q = one_surface ? round.between(du[x], dv[x]) : from[nearest[x]];
    const bool is_known = one_surface & (grey.least() >= 0.0F);
    const float seen = is_known ? grey.between(du[x], dv[x]) : greys[nearest[x]];
    intensity[x] = (inside[x] != 0) & (q > 0.0F) ? seen : -1.0F;
  }
}

}  // namespace

bool gives_velocity(double dt_s) {
  constexpr double kShortest_s = 1e-3, kLongest_s = 0.2;
  return dt_s >= kShortest_s && dt_s <= kLongest_s;
}

CameraVelocity velocity_of(const Eigen::Isometry3d& T_before_after, double dt_s) {
  if (!gives_velocity(dt_s)) return {};
  const Vector6d twist = local(T_before_after) / dt_s;
  if (!twist.allFinite()) return {};
  return {twist.head<3>(), twist.tail<3>()};
}

double image_speed_pxps(const CameraVelocity& velocity, const Intrinsics& camera) {
  return camera.fx_px * (velocity.angular_radps.norm() + velocity.linear_mps.norm());
}

RowMotion row_motion(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s) {
  return {velocity.linear_mps.cast<float>(), velocity.angular_radps.cast<float>(),
          static_cast<float>(readout_s / std::max(camera.height_px, 1)), static_cast<float>(camera.fy_px),
          static_cast<float>(camera.cy_px - 0.5 * (camera.height_px - 1))};
}

void deskew(const Intrinsics& camera, const CameraVelocity& velocity, double readout_s,
            Image<float>& inverse_depth_per_m, Image<float>& intensity) {
  const Image<float> skewed = inverse_depth_per_m, skewed_intensity = intensity;
  if (skewed.width < 2 || skewed.height < 2) {  // no pixel has four neighbours
    std::fill(inverse_depth_per_m.pixels.begin(), inverse_depth_per_m.pixels.end(), 0.0F);
    std::fill(intensity.pixels.begin(), intensity.pixels.end(), -1.0F);
    return;
  }
  const RowMotion rows = row_motion(camera, velocity, readout_s);
  const ImageMotion motion{rows.linear_mps,
                           rows.angular_radps,
                           static_cast<float>(camera.fx_px),
                           rows.fy_px,
                           static_cast<float>(camera.cx_px),
                           static_cast<float>(camera.cy_px),
                           rows.row_s,
                           rows.above_middle_px};
  SkewedRow row(skewed.width);
  for (int y = 0; y < skewed.height; ++y) {
    find_skewed(motion, skewed, y, row);
    sample_depth(motion, skewed, row, y, inverse_depth_per_m.row(y));
    if (!intensity.empty()) sample_intensity(skewed, skewed_intensity, row, intensity.row(y));
  }
}

}  // namespace roomradar
