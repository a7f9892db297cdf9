// change_tracker_config.hpp: thresholds at which a change of the room counts as lasting.
#pragma once
#include <cstddef>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {

/// One "sigma" is the combined standard deviation of sensor noise at the point's depth and pose error
/// (pose_sigma_m, pose_sigma_per_m).
struct ChangeTrackerConfig {
  DepthNoise noise = {};            ///< of the sensor
  float spacing_m = 0.02F;          ///< distance between the points that represent a surface
  float agree_sigmas = 2.5F;        ///< max displacement, in sigmas, of a surface that counts as unmoved
  float pose_sigma_m = 0.003F;      ///< apparent displacement of static surfaces by pose error
  float pose_sigma_per_m = 0.001F;  ///< growth of pose_sigma_m per metre of depth
  /// Max distance at which a surface in front of a point counts as the point's own surface after a motion.
  /// Such a surface contradicts the point. A surface farther in front only occludes the point.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the grid cells; cells that touch form one object
  int min_cells = 8;     ///< objects with fewer cells are ignored
  /// Min fraction of an object's cells with a point that was confirmed for long enough. Rejects objects with
  /// a still middle and a moving contour, such as a swaying hand.
  float min_steady_fraction = 0.75F;
  /// Min fraction of a removed object's cells that have at least 7 neighbours. A pose error also makes
  /// surface at an edge of the map look removed, but only in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< min fraction of an object's points confirmed by the last frame
  /// Min fraction of an added object's points that were seen in front of a surface of the map. Where the map
  /// knows nothing, what stands there may always have stood there.
  float min_known_fraction = 0.5F;
  float forget_after_s = 60.0F;    ///< max ChangePoint::unseen_s; points above it are dropped
  std::size_t max_points = 20000;  ///< max number of points over all objects
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

}  // namespace roomradar
