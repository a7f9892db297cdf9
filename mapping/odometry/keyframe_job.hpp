// keyframe_job.hpp: background processing of a new keyframe: description, place recognition, graph edges.
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

/// Input of run(). Owns its data except for the two keyframe databases, which must not change while it runs.
struct KeyframeJob {
  Frame frame;                                          ///< frame of the newest keyframe
  KeyframeGraph graph;                                  ///< includes the newest keyframe, not connected yet
  KeyframeCache prepare_keyframe;                       ///< includes the newest keyframe
  const KeyframeDatabase* keyframe_database = nullptr;  ///< one per keyframe except the newest
  const KeyframeDatabase* known = nullptr;              ///< database of an earlier map; null: none
};

struct KeyframeJobResult {
  KeyframeGraph graph;  ///< connected and optimised
  MapKeyframe place;    ///< database entry of the newest keyframe
  /// Pose of the newest keyframe in the earlier map's world, if it was localised there.
  std::optional<Eigen::Isometry3d> T_known_camera;
};

/// Connects the newest keyframe to those near it, and to distant ones that look alike: after drift,
/// appearance still recognises a place. Then optimises the poses near the newest keyframe, or all poses if a
/// distant keyframe was connected.
KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config);

}  // namespace roomradar
