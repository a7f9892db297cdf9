// radar_bench_poses.hpp: poses and directions of the moving objects.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "radar_bench_shapes.hpp"

namespace roomradar::bench {

struct Pose {
  Eigen::Isometry3d T_world_sensor;
  Eigen::Vector3d direction_world;  ///< unit
};

/// Poses about 15 to 40 cm in front of a surface, moving roughly away from the camera. No triangle of either
/// frame is within clear_m of the object's centre.
std::vector<Pose> free_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count);

/// The same positions with the same orientation and direction for all.
std::vector<Pose> steady_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count);

/// Poses whose bounding box contains the tip of a stick although the object touches no stick: the tip is in a
/// hollow of the object. Directions are random.
std::vector<Pose> hollow_poses(const Mesh& object, const Mesh& sticks,
                               const std::vector<Eigen::Vector3d>& tips_m, int count, unsigned seed);

}  // namespace roomradar::bench
