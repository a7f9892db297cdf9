// dynamic_touch.hpp: measures contact errors of balls thrown at visible dynamic objects, against exact
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

/// One ball in front of a scenario's occluder, which was absent from the prescan.
struct DynamicTouch {
  std::size_t scenario = 0;                                    ///< index among the given scenarios
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();       ///< centre of the ball
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitX();  ///< unit, away from the camera
  double true_travel_m = 0.0;
};

inline constexpr double kTouchRadius_m = 0.04;
inline constexpr double kTouchLimit_m = 0.5;  ///< max distance that a ball flies

/// Draws up to 4 balls for each scenario with an occluder that was absent from the prescan. Each ball flies
/// through a pixel that shows the occluder at 0.8 to 3.5 m, and touches it well before the room.
std::vector<DynamicTouch> draw_dynamic_touches(
    const std::vector<std::unique_ptr<PreparedScenario>>& scenarios, const Room& room);

/// The radar's errors; NaN if there are no touches.
struct DynamicTouchFacts {
  double error_median_m = std::numeric_limits<double>::quiet_NaN();  ///< over balls that were stopped
  double error_p95_m = error_median_m;
  double missed = error_median_m;  ///< fraction of balls that were not stopped
};
/// Measures the touches with the radar.
/// @param touches  in the order of their scenarios
/// @param how      with kMap; fine_mesh applies around the true contacts
DynamicTouchFacts judge_dynamic_touches(const std::vector<DynamicTouch>& touches,
                                        const std::vector<std::unique_ptr<PreparedScenario>>& scenarios,
                                        FrameScene& scene, const TrialSurfaces& how, CyberRadar& radar);

}  // namespace roomradar
