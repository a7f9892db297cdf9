// placement.hpp: finds a level surface in view on which an object can stand.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PlacementConfig {
  double cell_m = 0.02;           ///< cell size of the height map made from the view, 0.005 to 0.1
  double max_tilt_deg = 8.0;      ///< max angle between the surface and the horizontal
  double flatness_m = 0.015;      ///< max deviation of heights under the footprint from a plane
  double min_seen = 0.9;          ///< min measured fraction of the footprint; within 6 cm of its centre: 1
  double room_to_spare_m = 0.05;  ///< free and level margin around the footprint
  double min_range_m = 0.4;       ///< min depth of the surface along the camera's axis
  double max_range_m = 4.0;       ///< max depth of the surface along the camera's axis
  double max_away_m = 0.25;       ///< max distance of the place from SupportQuery::near_world
};
/// Throws Error such as "placement.cell_m = 0: must be in 0.005..0.1".
void require_valid(const PlacementConfig& config);

inline constexpr double kMostFootprint_m = 1.0;

struct SupportQuery {
  double footprint_radius_m = 0.0;  ///< > 0, at most kMostFootprint_m
  /// Searches for the place nearest to this point; unset: nearest to the picture's centre.
  std::optional<Eigen::Vector3d> near_world{};
  /// Callback for a place that is level and large enough: returns false if the object does not fit there.
  /// Null: every place is free.
  std::function<bool(const Eigen::Vector3d& point_world)> is_free{};
};

enum class SupportStatus {
  kInvalidInput,
  kFound,
  kNothingMeasured,  ///< no depth within range
  kNotLevel,         ///< no level surface, not even one as small as the margin
  kTooSmall,         ///< level surfaces, but none as large as footprint and margin
  kTooFar,           ///< places found, but none within max_away_m of near_world
  kBlocked,          ///< is_free rejected the places tried
};

struct [[nodiscard]] Support {
  SupportStatus status = SupportStatus::kInvalidInput;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();  ///< kFound: surface point below the object's centre

  explicit operator bool() const { return status == SupportStatus::kFound; }
};

/// Finds the place nearest to the picture's centre, or to a point, where an object can stand: footprint and
/// margin are on measured, level, flat surface, and is_free() returns true. Skips places within 6 cm, or 3/4
/// of the footprint's radius, of a place that is_free() rejected; tries at most 48.
///
/// @param depth_m         live or expected depth, of the camera's size
/// @param T_world_camera  world with +z up
/// Takes about 10 ms: call it when an object is dropped, not in each frame.
Support find_support(const DepthImage& depth_m, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const SupportQuery& query,
                     const PlacementConfig& config = {});

}  // namespace roomradar
