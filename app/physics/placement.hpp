// placement.hpp: finds a level surface in view on which an object can stand.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PlacementConfig {
  double cell_m = 0.02;           ///< cell size of the height map made from the view, 0.005 to 0.1
  double max_tilt_deg = 15.0;     ///< of the surface from horizontal
  double flatness_m = 0.015;      ///< max deviation of heights under the footprint from a plane
  double min_seen = 0.9;          ///< min measured fraction of the footprint
  double room_to_spare_m = 0.03;  ///< free and level margin around the footprint
  double min_range_m = 0.4;       ///< depth along the camera's axis
  double max_range_m = 4.0;
  /// Max height below the camera of a table; lower surfaces count as floor.
  double table_below_camera_m = 1.05;
};
/// Throws Error such as "placement.cell_m = 0: must be in 0.005..0.1".
void require_valid(const PlacementConfig& config);

inline constexpr double kMostFootprint_m = 1.0;

/// Finds the best place for an object of the given footprint: level, flat, free of obstacles, near the
/// picture's centre, preferably a table, with room to spare.
///
/// @param depth_m         live or expected depth, of the camera's size
/// @param T_world_camera  world with +z up
/// @param footprint_radius_m  > 0, at most kMostFootprint_m
/// @return the surface point below the object's centre, in the world; nothing if there is none, or if an
///         argument is invalid
/// Takes some 10 ms: call it when an object is dropped, not in each frame.
std::optional<Eigen::Vector3d> find_support(const DepthImage& depth_m, const Intrinsics& camera,
                                            const Eigen::Isometry3d& T_world_camera,
                                            double footprint_radius_m, const PlacementConfig& config = {});

}  // namespace roomradar
