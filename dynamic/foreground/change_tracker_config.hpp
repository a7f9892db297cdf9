// change_tracker_config.hpp: thresholds at which a change of the room counts as lasting.
#pragma once
#include <cstddef>

namespace roomradar {

/// "Sigmas" combine, as variances, sensor noise at the point's depth with pose and model error.
struct ChangeTrackerConfig {
  float spacing_m = 0.02F;          ///< distance between the points that represent a surface
  float agree_sigmas = 2.5F;        ///< a surface displaced by up to this has not moved
  float pose_sigma_m = 0.003F;      ///< apparent displacement of static surfaces between frames
  float pose_sigma_per_m = 0.001F;  ///< growth of pose_sigma_m per metre of depth
  /// A surface in front of a point, by more than agree_sigmas and less than this, contradicts the point: its
  /// own surface has moved. A surface farther in front occludes the point, which then does not change.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the cells; touching cells, corners included, form one object
  int min_cells = 8;     ///< objects with fewer cells are ignored
  /// Min fraction of an object's cells with a point that was confirmed for long enough. Rejects objects that
  /// are still in the middle and move at the rim, such as a swaying hand.
  float min_steady_fraction = 0.75F;
  /// Removed objects: min fraction of cells that are interior (at least 7 neighbours). A pose error makes a
  /// map edge look removed too, but only in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< min fraction of an object's points confirmed by the last frame
  float forget_after_s = 60.0F;    ///< points unseen for this long are dropped
  std::size_t max_points = 20000;  ///< limit over all objects; at the limit no point is added
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

}  // namespace roomradar
