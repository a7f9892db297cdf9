// projection.cpp: pinhole intrinsics to clip space.
#include "radar/projection.hpp"

#include <algorithm>
#include <cstdint>

namespace roomradar {

PixelRect clamped(const PixelRect& rect, int width_px, int height_px) {
  // In 64 bits: a rectangle from elsewhere may reach past what int holds.
  const auto cut = [](std::int64_t first, std::int64_t count, std::int64_t limit, int& out_first,
                      int& out_count) {
    const std::int64_t begin = std::clamp<std::int64_t>(first, 0, limit);
    const std::int64_t end = std::clamp<std::int64_t>(first + std::max<std::int64_t>(count, 0), begin, limit);
    out_first = static_cast<int>(begin);
    out_count = static_cast<int>(end - begin);
  };
  PixelRect inside;
  cut(rect.x, rect.width, width_px, inside.x, inside.width);
  cut(rect.y, rect.height, height_px, inside.y, inside.height);
  return inside;
}

Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m, const PixelRect& rect) {
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  // Image coordinate u is viewport coordinate u + 0.5 - rect.x; x_clip / w = 2 * that / width - 1, with w =
  // z.
  clip(0, 0) = 2.0 * camera.fx_px / rect.width;
  clip(0, 2) = 2.0 * (camera.cx_px + 0.5 - rect.x) / rect.width - 1.0;
  clip(1, 1) = 2.0 * camera.fy_px / rect.height;
  clip(1, 2) = 2.0 * (camera.cy_px + 0.5 - rect.y) / rect.height - 1.0;
  clip(2, 3) = near_m;  // z_clip / w = near / z
  clip(3, 2) = 1.0;
  return clip;
}

Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m) {
  return clip_from_camera(camera, near_m, {0, 0, camera.width_px, camera.height_px});
}

}  // namespace roomradar
