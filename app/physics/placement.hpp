// placement.hpp: find a level surface in view on which an object can stand.
#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PlacementConfig {
  double cell_m = 0.02;           ///< of the height grid that the view is turned into, 0.005 to 0.1
  double max_tilt_deg = 15.0;     ///< of the surface against level
  double flatness_m = 0.015;      ///< heights under the footprint keep this near to a plane
  double min_seen = 0.9;          ///< part of the footprint that must have been measured
  double room_to_spare_m = 0.03;  ///< free and level all round the footprint
  double min_range_m = 0.4;       ///< from the camera, along its axis
  double max_range_m = 4.0;
  /// Surfaces down to this below the camera are tables, lower ones the floor.
  double table_below_camera_m = 1.05;
};
/// Throws Error "placement.cell_m = 0: must be in 0.005..0.1" and the like.
void require_valid(const PlacementConfig& config);

inline constexpr double kMostFootprint_m = 1.0;

/// The best place for an object of the given footprint: level, flat, clear of what stands about, near the
/// middle of the picture, rather a table than the floor, with room to spare. Nothing if there is none.
///
/// @param depth_m         live or expected depth, of the camera's size
/// @param T_world_camera  world with +z up
/// @param footprint_radius_m  > 0, at most kMostFootprint_m; else nothing is found
/// @return the point of the surface under the object's middle, in the world
/// Nothing is found either where the sizes disagree. Takes some 10 ms: for when an object is dropped, not for
/// each frame.
std::optional<Eigen::Vector3d> find_support(const DepthImage& depth_m, const Intrinsics& camera,
                                            const Eigen::Isometry3d& T_world_camera,
                                            double footprint_radius_m, const PlacementConfig& config = {});

}  // namespace roomradar
