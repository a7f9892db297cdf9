// projection.cpp: pinhole intrinsics to clip space, boxes to pixels.
#include "radar/gl/projection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace roomradar {

PixelRect clamped(const PixelRect& rect, int width_px, int height_px) {
  // 64 bits, as a caller's rectangle may exceed the range of int.
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

PixelRect united(const PixelRect& a, const PixelRect& b) {
  if (a.width <= 0 || a.height <= 0) return b;
  if (b.width <= 0 || b.height <= 0) return a;
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

PixelRect pixels_of(const Eigen::AlignedBox3d& box, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_camera_box, double near_m) {
  if (box.isEmpty()) return {};
  Eigen::AlignedBox2d seen_px;
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p_camera =
        T_camera_box * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    if (p_camera.z() > near_m) {
      seen_px.extend(project(camera, p_camera));
    } else {
      ++behind;
    }
  }
  if (behind == 8) return {};
  if (behind > 0) return {0, 0, camera.width_px, camera.height_px};
  // Pixels whose centres may be covered, plus one for the renderer's vertex snapping.
  const auto whole_px = [](double at_px, double limit_px) {
    return static_cast<int>(std::clamp(at_px, -1.0, limit_px + 1.0));
  };
  const int x0 = whole_px(std::floor(seen_px.min().x()), camera.width_px);
  const int y0 = whole_px(std::floor(seen_px.min().y()), camera.height_px);
  const int x1 = whole_px(std::ceil(seen_px.max().x()), camera.width_px);
  const int y1 = whole_px(std::ceil(seen_px.max().y()), camera.height_px);
  return clamped({x0, y0, x1 - x0 + 1, y1 - y0 + 1}, camera.width_px, camera.height_px);
}

Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m, const PixelRect& rect) {
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  // Viewport coordinate v = u + 0.5 - rect.x for image coordinate u; x_clip / w = 2 v / width - 1; w is z.
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
