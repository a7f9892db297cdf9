// foreground_history.cpp: carries the marked blocks of one frame over to the next.
#include "dynamic/foreground/foreground_history.hpp"

#include <algorithm>

namespace roomradar {
namespace {

struct Either {
  std::uint8_t operator()(std::uint8_t a, std::uint8_t b) const { return static_cast<std::uint8_t>(a | b); }
};

}  // namespace

void warp_history(const ForegroundHistory& memory, const DepthImage& depth_m, const Intrinsics& camera,
                  const Eigen::Isometry3d& T_world_camera, std::vector<std::uint8_t>& before) {
  const BlockGrid grid{blocks_along(depth_m.width), blocks_along(depth_m.height)};
  before.assign(grid.size(), 0);
  if (memory.is_empty || !(memory.camera == camera)) return;

  // A point on the ray (u, v, 1) at depth z was at z (R (u, v, 1)) + t in the previous camera's frame.
  const Eigen::Isometry3f T_before_now = (memory.T_world_camera.inverse() * T_world_camera).cast<float>();
  const Eigen::Matrix3f R = T_before_now.linear();
  const Eigen::Vector3f t = T_before_now.translation();
  const auto fx = static_cast<float>(camera.fx_px), fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px), cy = static_cast<float>(camera.cy_px);
  for (int row = 0; row < grid.rows; ++row) {
    const int y = std::min(row * kBlock_px + kBlock_px / 2, depth_m.height - 1);
    const float* depth = depth_m.row(y);
    const float v = (static_cast<float>(y) - cy) / fy;
    for (int column = 0; column < grid.columns; ++column) {
      const int x = std::min(column * kBlock_px + kBlock_px / 2, depth_m.width - 1);
      const float z = depth[x];
      if (!(z > 0.0F)) continue;
      const Eigen::Vector3f ray((static_cast<float>(x) - cx) / fx, v, 1.0F);
      const Eigen::Vector3f p = R * ray * z + t;
      if (!(p.z() > 0.05F)) continue;
      const float u_px = p.x() / p.z() * fx + cx + 0.5F;
      const float v_px = p.y() / p.z() * fy + cy + 0.5F;
      if (!(u_px >= 0.0F && v_px >= 0.0F && u_px < static_cast<float>(camera.width_px) &&
            v_px < static_cast<float>(camera.height_px)))
        continue;
      before[grid.at(column, row)] =
          memory
              .blocks[memory.grid.at(static_cast<int>(u_px) / kBlock_px, static_cast<int>(v_px) / kBlock_px)];
    }
  }
}

void store_history(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                   ForegroundHistory& memory) {
  memory.camera = camera;
  memory.T_world_camera = T_world_camera;
  memory.is_empty =
      std::all_of(memory.blocks.begin(), memory.blocks.end(), [](auto bits) { return bits == 0; });
  if (!memory.is_empty) spread(memory.grid, memory.blocks, 1, Either{}, memory.along_rows, memory.blocks);
}

}  // namespace roomradar
