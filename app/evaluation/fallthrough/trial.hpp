// trial.hpp: one object on its way through one scenario under one policy.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/evaluation/fallthrough/policies.hpp"
#include "app/sim/scenarios/scenarios.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// The frames of a scenario, each rendered when it is first asked for; where nothing moves all are the first.
class ScenarioFrames {
 public:
  ScenarioFrames(const Scenario& scenario, const Room& room) : scenario_(scenario), room_(room) {}
  const Frame& at(int number);

 private:
  const Scenario& scenario_;
  const Room& room_;
  std::map<int, Frame> frames_;
};

/// A scenario made ready: its frames so far, and its object for the radar.
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
  double frame_ms = 0.0;  ///< surfaces of the first frame, and one question to the radar (mean of all)
};

/// What happens in one frame of a trial.
struct TrialStep {
  int frame = 0;
  std::span<const SceneTree> surfaces;  ///< that can be touched
  double from_m = 0.0, to_m = 0.0;      ///< how far the object has come when the frame begins and ends
  bool is_last = false;
};
using WatchTrial = std::function<void(const TrialStep& step)>;

/// How the surfaces of a trial are made.
struct TrialSurfaces {
  SurfacePolicy policy = SurfacePolicy::kMap;  ///< of the scene
  int depth_stride = 1;                        ///< 1, 2 or 4: depth images are reduced by this first
  bool fine_mesh = false;                      ///< about the object every pixel that moved is a vertex
};

/// Makes the scene's surfaces those of one frame of the scenario, as tracking believes that it was taken
/// from; frame 0 as if the camera had stood so before. Gives what that took, ms.
double show_frame(PreparedScenario& prepared, int number, const TrialSurfaces& how,
                  std::span<const FineRegion> about_objects, FrameScene& scene);

/// Frame by frame: the policy's surfaces from what the camera shows, and the object as far as the radar lets
/// it, until something stops it or it has passed the scenario's limit. The camera's pose is what tracking
/// believes.
Trial run_trial(PreparedScenario& prepared, FrameScene& scene, const TrialSurfaces& surfaces,
                CyberRadar& radar, const WatchTrial& watch = {});
/// The same with the room's scene of one of kFallthroughPolicies.
Trial run_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, CyberRadar& radar,
                const WatchTrial& watch = {});

}  // namespace roomradar
