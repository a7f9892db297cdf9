// dynamic_touch.hpp: measures contact errors between balls and visible dynamic objects, relative to exact
// solids.
#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "app/evaluation/fallthrough/trial.hpp"
#include "app/session/frame_scene.hpp"
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

/// Draws at random up to 4 balls for each scenario with an occluder that was absent from the prescan. Each
/// ball flies along the ray of a pixel that shows the occluder at 0.8 to 3.5 m, and would touch the occluder
/// at least 5 cm before the room.
std::vector<DynamicTouch> draw_dynamic_touches(
    const std::vector<std::unique_ptr<PreparedScenario>>& scenarios, const Room& room);

/// Errors of the radar's distances to contact; NaN if there are no balls.
struct DynamicTouchFacts {
  /// Median of |found distance - true distance| over balls that the radar stopped at most kTooFar_m (2 cm)
  /// beyond the true contact.
  double error_median_m = std::numeric_limits<double>::quiet_NaN();
  double error_p95_m = error_median_m;
  double missed = error_median_m;  ///< fraction of balls that the radar stopped later or not at all
};
/// Measures the contacts of all balls with the radar.
/// @param touches  balls, sorted by scenario
/// @param how      its policy must be kMap. With fine_mesh, the mesh is fine within 2 cm of the ball at each
///                 true contact
DynamicTouchFacts judge_dynamic_touches(const std::vector<DynamicTouch>& touches,
                                        const std::vector<std::unique_ptr<PreparedScenario>>& scenarios,
                                        FrameScene& scene, const TrialSurfaces& how, Radar& radar);

}  // namespace roomradar
