// trial.hpp: moves the object of one scenario with one policy.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/evaluation/fallthrough/policies.hpp"
#include "app/sim/scenarios/scenarios.hpp"
#include "radar/exact/radar.hpp"

namespace roomradar {

/// Frames of a scenario, rendered on first use. If the occluder does not move, all frames are frame 0.
class ScenarioFrames {
 public:
  ScenarioFrames(const Scenario& scenario, const Room& room) : scenario_(scenario), room_(room) {}
  const Frame& at(int number);

 private:
  const Scenario& scenario_;
  const Room& room_;
  std::map<int, Frame> frames_;
};

/// A scenario, the triangle tree of its object, and its rendered frames.
struct PreparedScenario {
  Scenario scenario;
  TriangleTree object;
  ScenarioFrames frames;

  PreparedScenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number);
  PreparedScenario(const PreparedScenario&) = delete;
  PreparedScenario& operator=(const PreparedScenario&) = delete;
};

struct Trial {
  double travelled_m = 0.0;
  Verdict verdict;
  SurfaceKind rested_on = SurfaceKind::kNothing;
  double frame_ms = 0.0;  ///< time to create the first frame's surfaces, plus the mean time of a radar query
};

/// One frame of a trial.
struct TrialStep {
  int frame = 0;
  std::span<const SceneTree> surfaces;  ///< all surfaces that can be touched
  double from_m = 0.0, to_m = 0.0;      ///< distance travelled at the frame's start and end
  bool is_last = false;
};
using WatchTrial = std::function<void(const TrialStep& step)>;

/// Settings for the surfaces of a trial.
struct TrialSurfaces {
  SurfacePolicy policy = SurfacePolicy::kMap;  ///< policy of the scene
  int depth_stride = 1;                        ///< factor by which depth images are reduced: 1, 2 or 4
  bool fine_mesh = false;                      ///< true: each dynamic pixel near the object is a vertex
};

/// Sets the scene's surfaces to those of one frame of the scenario, with the camera at T_world_believed.
/// Returns the run time, ms. For kMap and frame 0, first runs the foreground detection once more, untimed: it
/// replaces the labels of the previous scenario, which the timed detection would otherwise use.
double show_frame(PreparedScenario& prepared, int number, const TrialSurfaces& how,
                  std::span<const FineRegion> about_objects, FrameScene& scene);

/// Runs the scenario frame by frame. Creates the policy's surfaces from each camera frame, with the camera at
/// Scenario::T_world_believed, and moves the object as far as the radar permits. Ends when the object stops
/// or has travelled Scenario::limit_m.
Trial run_trial(PreparedScenario& prepared, FrameScene& scene, const TrialSurfaces& surfaces, Radar& radar,
                const WatchTrial& watch = {});
/// Runs the scenario in the room's scene for kFallthroughPolicies[policy].
Trial run_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, Radar& radar,
                const WatchTrial& watch = {});

}  // namespace roomradar
