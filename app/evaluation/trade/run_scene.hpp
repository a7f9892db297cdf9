// run_scene.hpp: scene of a run, that is, a mapped room or recording with frames and ground truth.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/trial.hpp"
#include "app/evaluation/trade/dynamic_touch.hpp"
#include "app/evaluation/trade/trade_scale.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Ground truth for the picture of a frame.
struct TrueView {
  std::size_t frame = 0;  ///< index in RunScene::frames
  DepthImage depth_m;     ///< exact depth
};

struct RunScene {
  std::string name;
  SavedMap map;
  /// Frames with true poses, in the recording's world frame.
  std::vector<Frame> frames;
  /// Ground truth of some frames; empty for recordings.
  std::vector<TrueView> true_views;
  std::unique_ptr<ScenarioRoom> room;  ///< null for recordings
  Mesh mesh_room;                      ///< the map's mesh in the room's frame
  /// Scenarios with all frames rendered. The scenarios contain references to `room`.
  std::vector<std::unique_ptr<PreparedScenario>> scenarios;
  std::vector<DynamicTouch> touches;
  /// Positions at which objects are dropped; empty: objects are dropped above surfaces in view.
  std::vector<Eigen::Vector3d> drop_at_world;
};

/// @param spec  room as after `sim:`, such as "table" or "random?seed=3"
std::unique_ptr<RunScene> run_scene_of_room(const std::string& spec, const TradeScale& scale);
/// Reads the first scale.map_frames + scale.run_frames frames of the recording. The last scale.run_frames of
/// them, but at most half, are for the run. The others are mapped. Throws Error as frames_of_recording()
/// does.
std::unique_ptr<RunScene> run_scene_of_recording(const std::string& folder, const TradeScale& scale);

}  // namespace roomradar
