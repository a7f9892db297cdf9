// run_facts.hpp: a session through the frames of a scene, and objects that are dropped on what it hides.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "app/evaluation/trade/picture_judge.hpp"
#include "app/evaluation/trade/run_scene.hpp"
#include "app/quality/quality.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

struct RunSetting {
  RunQuality quality;
  int objects = 1;
};

/// What a session's frames came to. The first few are not counted: caches and drivers settle in them.
struct RunFacts {
  std::string renderer;
  StageTimes times;
  double frame_ms = 0.0;   ///< mean of all frames: where they take turns, no one of them is usual
  double cpu_ms = 0.0;     ///< of all threads, a frame
  double moved_ms = 0.0;   ///< physics, mean of the frames in which some object had its turn; NaN: none
  double memory_mb = 0.0;  ///< that the process held more at its peak
  double located = 0.0;    ///< part of the frames
  /// Means over the located frames; NaN where there are none.
  double dynamic_triangles = 0.0, static_triangles = 0.0;
  double pose_error_m = 0.0;            ///< RMS, of the camera's position
  double object_age_ms = 0.0;           ///< how long ago what is shown of the objects was so, after a frame
  std::vector<JudgedPicture> pictures;  ///< one a true view of the scene
};

/// Objects of this mesh are dropped every 25 frames, one after the other, at the scene's places or on
/// whatever surface is in view.
RunFacts run_session(const RunScene& scene, const RunSetting& setting, const Mesh& object);

/// What became of the scene's scenarios, and of balls before what moved in them; NaN where it has none.
struct ContactFacts {
  double error_median_m = std::numeric_limits<double>::quiet_NaN();  ///< of those that something stopped
  double error_p95_m = error_median_m;
  double passed = error_median_m;       ///< part that fell through
  double false_stops = error_median_m;  ///< part that stopped where nothing is
  DynamicTouchFacts moved;
};
ContactFacts touch_true_surfaces(const RunScene& scene, const RunQuality& quality);

}  // namespace roomradar
