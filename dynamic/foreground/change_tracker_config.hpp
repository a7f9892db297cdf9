// change_tracker_config.hpp: when a change of the room counts as lasting.
#pragma once
#include <cstddef>

namespace roomradar {

/// "Sigmas" combine sensor noise at that depth with pose and model error, added as variances.
struct ChangeTrackerConfig {
  float spacing_m = 0.02F;          ///< between the points that represent a surface
  float agree_sigmas = 2.5F;        ///< a surface within this distance of its former place has not moved
  float pose_sigma_m = 0.003F;      ///< apparent displacement of static surfaces between frames
  float pose_sigma_per_m = 0.001F;  ///< its growth per metre of depth
  /// A surface in front of a point by less than this is the point's own surface, moved. A surface in front by
  /// more is an occluder, and the point's state is unknown meanwhile.
  float own_reach_m = 0.1F;
  float link_m = 0.03F;  ///< edge of the cells; touching cells, corners included, form one object
  int min_cells = 8;     ///< objects with fewer cells are ignored
  /// An object settles as a whole: min fraction of its cells with a point that stayed. Rejects an object
  /// whose middle holds still while its rim moves, such as a swaying hand.
  float min_steady_fraction = 0.75F;
  /// kWent: min fraction of an object's cells that are interior, with neighbours all round. A map edge
  /// displaced by a pose error is seen through as well, but in a strip one or two cells wide.
  float min_core_fraction = 0.15F;
  float min_seen_fraction = 0.5F;  ///< min fraction of its points confirmed by this frame
  float forget_after_s = 60.0F;    ///< points unseen for this long are dropped
  std::size_t max_points = 20000;  ///< of all objects together; at this number no point is added
};
/// Throws Error naming the field, its value and the rule.
void require_valid(const ChangeTrackerConfig& config);

}  // namespace roomradar
