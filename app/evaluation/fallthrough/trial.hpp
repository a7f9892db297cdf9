// trial.hpp: moves one object through one scenario under one policy.
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

/// Frames of a scenario, rendered on first use. If nothing moves, the first rendering serves for all frames.
class ScenarioFrames {
 public:
  ScenarioFrames(const Scenario& scenario, const Room& room) : scenario_(scenario), room_(room) {}
  const Frame& at(int number);

 private:
  const Scenario& scenario_;
  const Room& room_;
  std::map<int, Frame> frames_;
};

/// A scenario with its object's tree and the frames rendered so far.
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
  double frame_ms = 0.0;  ///< time for the first frame's surfaces plus the mean time of a radar query
};

/// One frame of a trial.
struct TrialStep {
  int frame = 0;
  std::span<const SceneTree> surfaces;  ///< all that can be touched
  double from_m = 0.0, to_m = 0.0;      ///< distance travelled at the frame's start and end
  bool is_last = false;
};
using WatchTrial = std::function<void(const TrialStep& step)>;

/// Settings for making the surfaces of a trial.
struct TrialSurfaces {
  SurfacePolicy policy = SurfacePolicy::kMap;  ///< policy of the scene
  int depth_stride = 1;                        ///< 1, 2 or 4: factor by which depth images are reduced first
  bool fine_mesh = false;                      ///< near the object, every dynamic pixel is a vertex
};

/// Sets the scene's surfaces to those of one frame of the scenario, at the simulated tracker's inexact pose.
/// Frame 0 is processed twice, so the foreground has a history. Returns the time taken, ms.
double show_frame(PreparedScenario& prepared, int number, const TrialSurfaces& how,
                  std::span<const FineRegion> about_objects, FrameScene& scene);

/// Runs the scenario frame by frame: makes the policy's surfaces from the camera's frame and moves the object
/// as far as the radar allows. Ends when the object is stopped or passes the scenario's limit. Uses the
/// simulated tracker's inexact camera pose.
Trial run_trial(PreparedScenario& prepared, FrameScene& scene, const TrialSurfaces& surfaces,
                CyberRadar& radar, const WatchTrial& watch = {});
/// Runs the scenario in the room's scene of kFallthroughPolicies[policy].
Trial run_trial(PreparedScenario& prepared, MappedRoom& room, std::size_t policy, CyberRadar& radar,
                const WatchTrial& watch = {});

}  // namespace roomradar
