// radar_bench_cull.hpp: triangles of a depth frame in an object's path, for libraries that need triangles.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "radar_bench_poses.hpp"
#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

/// Volume that the object may touch on its path: its outline across the direction, from its rear to
/// distance_m ahead of its front. The volume's frame has its z axis along the direction and the object's
/// origin.
struct SweptVolume {
  Eigen::Isometry3d T_volume_world;
  Eigen::AlignedBox3f box;
};

SweptVolume swept_volume(const std::vector<Eigen::Vector3f>& sensor_vertices, const Pose& pose,
                         double distance_m);

struct CulledScene {
  std::vector<std::array<float, 4>> vertices;  ///< in the volume's frame; the fourth component is padding
  std::vector<std::uint8_t> is_outside;        ///< per vertex: a bit per side of the box that it is beyond
  std::vector<Triangle> triangles;             ///< not wholly beyond one side
};

/// Back-projects only the image rectangle that the volume projects to. Allocates nothing once `result` has
/// the capacity.
void cull(const FrameScene& frame, const SweptVolume& volume, CulledScene& result);

}  // namespace roomradar::bench
