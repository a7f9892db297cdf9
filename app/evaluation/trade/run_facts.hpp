// run_facts.hpp: measures a session on a scene's frames, and objects dropped onto the scene's hidden
// surfaces.
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
