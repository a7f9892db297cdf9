// run_scene.hpp: a mapped room, or half a recording, with the frames of a run in it and what is true of them.
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

/// What a picture of a frame is judged by.
struct TrueView {
  std::size_t frame = 0;  ///< among the scene's
  DepthImage depth_m;     ///< exact
};

struct RunScene {
  std::string name;
  SavedMap map;
  std::vector<Frame> frames;           ///< their poses are true, in the recording's world
  std::vector<TrueView> true_views;    ///< of some frames; none of a recording
  std::unique_ptr<ScenarioRoom> room;  ///< null: a recording
  Mesh mesh_room;                      ///< the map's, in the room's own frame
  std::vector<std::unique_ptr<PreparedScenario>> scenarios;  ///< with all their frames; they refer to `room`
  std::vector<DynamicTouch> touches;
  std::vector<Eigen::Vector3d> drop_at_world;  ///< above what is looked at; empty: over what is in view
};

/// @param spec  of a room: "table", "random?seed=3"
std::unique_ptr<RunScene> run_scene_of_room(const std::string& spec, const TradeScale& scale);
/// Maps the first half of the frames that are taken of it; the others are the run's. Throws Error likewise
/// as frames_of_recording().
std::unique_ptr<RunScene> run_scene_of_recording(const std::string& folder, const TradeScale& scale);

}  // namespace roomradar
