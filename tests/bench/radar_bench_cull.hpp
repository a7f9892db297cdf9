// radar_bench_cull.hpp: what a depth frame holds in the way of an object, for libraries that take triangles.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "radar_bench_poses.hpp"
#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

/// What the object can meet on its way: its outline across the direction, from its rear to distance_m before
/// its front. The volume's frame has its z along the direction; its origin is the object's.
struct SweptVolume {
  Eigen::Isometry3d T_volume_world;
  Eigen::AlignedBox3f box;
};

SweptVolume swept_volume(const std::vector<Eigen::Vector3f>& sensor_vertices, const Pose& pose,
                         double distance_m);

struct CulledScene {
  std::vector<std::array<float, 4>> vertices;  ///< in the volume's frame; the fourth is padding
  std::vector<std::uint8_t> is_outside;        ///< one a vertex: a bit a side of the box that it lies beyond
  std::vector<Triangle> triangles;             ///< not wholly beyond one side
};

/// Back-projects only the image rectangle that the volume projects to. Allocates nothing once the result has
/// held as much.
void cull(const FrameScene& frame, const SweptVolume& volume, CulledScene& result);

}  // namespace roomradar::bench
