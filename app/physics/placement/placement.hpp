// placement.hpp: search for a level surface in view on which an object can stand.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct PlacementConfig {
  double cell_m = 0.02;       ///< cell size of the height map computed from the depth image, 0.005 to 0.1
  double max_tilt_deg = 8.0;  ///< max angle between the surface and the horizontal
  double flatness_m = 0.015;  ///< max deviation of measured heights under the footprint from the fitted plane
  /// Min fraction of the footprint's cells that must be measured. Within 6 cm of its centre, all cells must
  /// be measured.
  double min_seen = 0.9;
  double room_to_spare_m = 0.05;  ///< width of the measured, level margin around the footprint
  double min_range_m = 0.4;       ///< min depth of the surface along the camera's axis
  double max_range_m = 4.0;       ///< max depth of the surface along the camera's axis
  double max_away_m = 0.25;       ///< max distance of the returned point from SupportQuery::near_world
};
/// Throws Error such as "placement.cell_m = 0: must be in 0.005..0.1".
void require_valid(const PlacementConfig& config);

/// Max radius of a footprint, m. The footprint is the circle that the object covers seen from above.
inline constexpr double kMostFootprint_m = 1.0;

struct SupportQuery {
  double footprint_radius_m = 0.0;  ///< > 0, at most kMostFootprint_m
  /// Candidates are tried in order of distance from this point. Unset: in order of distance from the image
  /// centre.
  std::optional<Eigen::Vector3d> near_world{};
  /// Called with a point on a level, large enough surface. Returns false if the object does not fit there.
  /// Null: accepts every point.
  std::function<bool(const Eigen::Vector3d& point_world)> is_free{};
};

enum class SupportStatus {
  kInvalidInput,
  kFound,
  kNothingMeasured,  ///< no depth within range
  kNotLevel,         ///< no level surface, not even one as small as the margin
  kTooSmall,         ///< level surfaces exist, but none as large as footprint plus margin
  kTooFar,           ///< large enough surfaces exist, but none near near_world or within the image
  kBlocked,          ///< is_free() rejected all candidates tried
};

struct [[nodiscard]] Support {
  SupportStatus status = SupportStatus::kInvalidInput;
  /// If kFound: surface point below the object's centre.
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();

  explicit operator bool() const { return status == SupportStatus::kFound; }
};

/// Returns the surface point nearest to near_world, or to the image centre, on which an object can stand.
/// Footprint and margin around the point must be measured, level and flat. is_free() must return true. Calls
/// is_free() for at most 48 candidates. Skips candidates within 6 cm or 3/4 of the footprint's radius,
/// whichever is larger, of a rejected one.
///
/// @param depth_m         live depth, or depth rendered from the map. Must have the size of `camera`
/// @param T_world_camera  world with +z up
/// Throws Error if `config` is invalid.
/// Takes about 10 ms: too slow for a call in each frame.
Support find_support(const DepthImage& depth_m, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const SupportQuery& query,
                     const PlacementConfig& config = {});

}  // namespace roomradar
