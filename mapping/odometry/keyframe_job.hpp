// keyframe_job.hpp: background processing of a new keyframe: features, place recognition, graph edges.
#pragma once
#include <optional>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct KeyframeJobConfig {
  ConnectConfig join;
  KeyframeDatabaseConfig place;
  RelocaliseConfig relocalise;
};

/// Input of run(). Owns its data, except for the two keyframe databases. Precondition: the databases do not
/// change while run() executes.
struct KeyframeJob {
  Frame frame;          ///< frame of the newest keyframe
  KeyframeGraph graph;  ///< includes the newest keyframe, which has no edges yet
  KeyframeCache cache;  ///< contains the newest keyframe
  const KeyframeDatabase* keyframe_database = nullptr;  ///< one entry per keyframe except the newest
  const KeyframeDatabase* known = nullptr;              ///< database of an earlier map; null: none
};

struct KeyframeJobResult {
  KeyframeGraph graph;  ///< input graph with the newest keyframe connected, and optimised poses
  MapKeyframe place;    ///< database entry of the newest keyframe
  /// Pose of the newest keyframe in the earlier map's world frame; unset if it was not localised there.
  std::optional<Eigen::Isometry3d> T_known_camera;
};

/// Connects the newest keyframe to keyframes near it. Also connects it to distant keyframes with similar
/// features, which may show the same part of the room if the poses have drifted. Then optimises the poses
/// near the newest keyframe, or all poses if a connection to a distant keyframe contradicts them.
KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config);

}  // namespace roomradar
