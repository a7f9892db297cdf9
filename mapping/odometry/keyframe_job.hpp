// keyframe_job.hpp: what a new keyframe is put through beside tracking: described, found alike, joined.
#pragma once
#include <optional>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct KeyframeJobConfig {
  JoinConfig join;
  PlaceConfig place;
  RelocaliseConfig relocalise;
};

/// A job owns all that it looks at but the places, which nobody may change while it runs.
struct KeyframeJob {
  Frame frame;                     ///< that became the newest keyframe
  KeyframeGraph graph;             ///< with the newest keyframe, not joined yet
  WarmKeyframes warm;              ///< among them the newest
  const Places* places = nullptr;  ///< one a keyframe but the newest
  const Places* known = nullptr;   ///< of a map made before; null: none
};

struct KeyframeJobResult {
  KeyframeGraph graph;  ///< joined and solved
  Place place;          ///< of the newest keyframe
  /// Where the newest keyframe is in the known places' world, if it was found there.
  std::optional<Eigen::Isometry3d> T_known_camera;
};

/// Joins the newest keyframe with those near it, and with those that look alike but are thought to be far
/// away: where the poses have drifted apart, appearance still knows the place. Then solves: for the poses
/// near the newest, or for all where one was joined that was thought to be far away.
KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config);

}  // namespace roomradar
