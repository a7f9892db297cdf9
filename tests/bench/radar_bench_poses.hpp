// radar_bench_poses.hpp: where the moving objects stand and which way they go.
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

/// Poses about 15 to 40 cm before a surface, moving roughly away from the camera, with no triangle of either
/// frame within clear_m of the object's middle.
std::vector<Pose> free_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count);

/// The same places with one orientation and one direction for all.
std::vector<Pose> steady_poses(const FrameScene& coarse, const FrameScene& fine, double clear_m, int count);

/// Poses whose bounding box holds the tip of a stick while no surface of the object touches the sticks: what
/// is in the box stands in a hollow. Directions are random.
std::vector<Pose> hollow_poses(const Mesh& object, const Mesh& sticks,
                               const std::vector<Eigen::Vector3d>& tips_m, int count, unsigned seed);

}  // namespace roomradar::bench
