// moved_touch.hpp: balls that fly at what moved, where the camera sees it, against its exact solids.
#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "app/evaluation/fallthrough/trial.hpp"
#include "app/session/frame_scene.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// One ball before the thing that hides a scenario's surface: what was not there in the prescan.
struct DynamicTouch {
  std::size_t scenario = 0;                                    ///< among those given
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();       ///< the ball's middle
  Eigen::Vector3d direction_world = Eigen::Vector3d::UnitX();  ///< unit, away from the camera
  double true_travel_m = 0.0;
};

inline constexpr double kTouchRadius_m = 0.04;
inline constexpr double kTouchLimit_m = 0.5;  ///< how far a ball flies if nothing stops it

/// Up to a few for each scenario with such a thing, where that is 0.8 to 3.5 m away and the ball meets it
/// well before the room.
std::vector<DynamicTouch> draw_dynamic_touches(
    const std::vector<std::unique_ptr<PreparedScenario>>& scenarios, const Room& room);

/// What the radar says of them; NaN where there are none.
struct DynamicTouchFacts {
  double error_median_m = std::numeric_limits<double>::quiet_NaN();  ///< of those that something stopped
  double error_p95_m = error_median_m;
  double missed = error_median_m;  ///< part that nothing stopped
};
/// @param touches  in the order of their scenarios
/// @param how      of kMap; with fine_mesh about where the balls touch
DynamicTouchFacts judge_dynamic_touches(const std::vector<DynamicTouch>& touches,
                                        const std::vector<std::unique_ptr<PreparedScenario>>& scenarios,
                                        FrameScene& scene, const TrialSurfaces& how, CyberRadar& radar);

}  // namespace roomradar
