// run_facts.hpp: measures a session on a scene's frames, and objects dropped onto the scene's hidden
// surfaces.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/trial.hpp"
#include "app/evaluation/trade/picture_judge.hpp"
#include "app/evaluation/trade/trade_frames.hpp"
#include "app/quality/quality.hpp"
#include "app/session/frame_scene.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A ball that moves straight towards a scenario's occluder. The occluder is a dynamic object that was absent
/// from the prescan.
struct DynamicTouch {
  std::size_t scenario = 0;                               ///< index in the scenarios
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();  ///< centre of the ball
  /// Unit direction of flight, away from the camera.
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitX();
  double true_travel_m = 0.0;
};

/// Radius of the balls.
inline constexpr double kTouchRadius_m = 0.04;
inline constexpr double kTouchLimit_m = 0.5;  ///< max distance of flight

/// Errors of the radar's distances to contact; NaN if there are no balls.
struct DynamicTouchFacts {
  /// Median of |found distance - true distance| over balls that the radar stopped at most kTooFar_m (2 cm)
  /// beyond the true contact.
  double error_median_m = std::numeric_limits<double>::quiet_NaN();
  double error_p95_m = error_median_m;
  double missed = error_median_m;  ///< fraction of balls that the radar stopped later or not at all
};
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

struct RunSetting {
  RunQuality quality;
  int objects = 1;
};

/// Measurements of a session. Excludes the first 10 frames, in which caches and drivers warm up.
struct RunFacts {
  std::string renderer;
  StageTimes times;
  /// Mean over frames. The median would be misleading if work alternates between frames.
  double frame_ms = 0.0;
  double cpu_ms = 0.0;     ///< mean CPU time of all threads per frame
  double moved_ms = 0.0;   ///< mean physics time over frames that advance objects; NaN: no such frame
  double memory_mb = 0.0;  ///< peak growth of the process's memory
  double located = 0.0;    ///< fraction of frames that were localised
  /// Means over the localised frames; NaN if there are none.
  double dynamic_triangles = 0.0, static_triangles = 0.0;
  double pose_error_m = 0.0;            ///< RMS error of the camera's position
  double object_age_ms = 0.0;           ///< mean age of the displayed object poses at the frame's time
  std::vector<JudgedPicture> pictures;  ///< one per RunScene::true_views
};

/// Runs a session with objects of mesh `object`. Each object is dropped every 25 frames, at the scene's drop
/// positions or above a surface in view. Drops are staggered among the objects.
RunFacts run_session(const RunScene& scene, const RunSetting& setting, const Mesh& object);

/// Results of the scene's scenarios and touches; NaN without scenarios or touches.
struct ContactFacts {
  /// Median of |travelled distance - true distance| over the objects that stopped.
  double error_median_m = std::numeric_limits<double>::quiet_NaN();
  double error_p95_m = error_median_m;
  double passed = error_median_m;       ///< fraction of objects that passed through a surface
  double false_stops = error_median_m;  ///< fraction of objects that stopped short of the true contact
  /// Contacts with dynamic objects.
  DynamicTouchFacts moved;
};
/// Runs the scene's scenarios and touches with the surfaces of a quality, and compares them with the exact
/// solids.
ContactFacts touch_true_surfaces(const RunScene& scene, const RunQuality& quality);

}  // namespace roomradar
