// unloaded_space.cpp: rays of pixels against boxes, by slabs.
#include "app/session/tiles/unloaded_space.hpp"

#include <algorithm>
#include <limits>

#include "radar/gl/projection.hpp"

namespace roomradar {

double ray_entry(const Eigen::AlignedBox3d& box_world, const Eigen::Vector3d& from_world,
                 const Eigen::Vector3d& ray_world) {
  double enters = 0.0, leaves = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box_world.min()[axis] - from_world[axis],
                 high = box_world.max()[axis] - from_world[axis];
    if (ray_world[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return std::numeric_limits<double>::infinity();
      continue;
    }
    const double a = low / ray_world[axis], b = high / ray_world[axis];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves ? enters : std::numeric_limits<double>::infinity();
}

void hide_behind(std::span<const Eigen::AlignedBox3d> boxes_world, const Intrinsics& camera,
                 const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m) {
  constexpr double kNear_m = 0.05;
  if (depth_m.pixels.empty()) return;
  const float farthest_m = *std::max_element(depth_m.pixels.begin(), depth_m.pixels.end());
  const Eigen::Vector3d from_world = T_world_camera.translation();
  for (const Eigen::AlignedBox3d& box : boxes_world) {
    // A distance is at least the depth of its point, so a box this far away hides nothing within the image.
    const double diagonal = back_project(camera, 0.0, 0.0, 1.0).norm() + 1.0;
    if (box.exteriorDistance(from_world) > diagonal * static_cast<double>(farthest_m)) continue;
    const PixelRect rect =
        clamped(pixels_of(box, camera, T_world_camera.inverse(), kNear_m), depth_m.width, depth_m.height);
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      float* row = depth_m.row(y);
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        if (row[x] == 0.0F) continue;
        const Eigen::Vector3d ray_world = T_world_camera.linear() * back_project(camera, x, y, 1.0);
        if (ray_entry(box, from_world, ray_world) < static_cast<double>(row[x])) row[x] = 0.0F;
      }
    }
  }
}

}  // namespace roomradar
