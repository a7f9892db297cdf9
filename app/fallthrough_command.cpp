// fallthrough_command.cpp: roomradar fallthrough: the same hidden-surface scenarios under each policy.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>

#include "app/commands.hpp"
#include "app/live_scene.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/sim/scenarios.hpp"
#include "app/sim/simulated_source.hpp"
#include "radar/cyber_radar.hpp"

namespace roomradar {
namespace {

constexpr double kResolution_m = 0.01;
constexpr double kFrameTime_s = 1.0 / 30.0;
// Every second frame of the walk round the room: 3 cm or 3 degrees apart.
constexpr int kPrescanEvery = 2;

constexpr std::array<SurfacePolicy, 3> kPolicies = {SurfacePolicy::kHoles, SurfacePolicy::kSkirt,
                                                    SurfacePolicy::kMap};

struct PolicyTotals {
  int passed = 0;
  int false_stops = 0;
  std::vector<double> contact_errors_m;  ///< of those that stopped, how far from the truth
  std::vector<double> frame_ms;
};

/// A simulated room with its prescanned map on the renderer.
struct MappedRoom {
  ScenarioRoom simulated;
  PrescanResult scanned;
  Shape mesh;

  MappedRoom(GlContext& context, const std::string& name, StageTimes& times)
      : simulated(make_scenario_room(name)), mesh(context) {
    SimOptions walk = simulated.prescan;
    walk.frames = (walk.frames + kPrescanEvery - 1) / kPrescanEvery;
    walk.rate_hz /= kPrescanEvery;
    SimulatedSource source(walk);
    PrescanConfig config;
    config.resolution_m = kResolution_m;
    config.poses = PoseOrigin::kRecorded;
    Progress progress("prescan of room " + name, 2 * walk.frames);  // read twice
    scanned = prescan(source, config, times,
                      [&](const std::string& stage, const std::string& /*note*/) { progress.step(stage); });
    mesh.set(scanned.map.mesh, MeshUsage::kStatic);
  }
};

/// Moves the scenario's object frame by frame until the radar stops it; how far it came.
double travelled_m(const Scenario& scenario, const Eigen::Isometry3d& T_map_world, const TriangleTree& object,
                   const std::vector<SceneTree>& scene, CyberRadar& radar, double& query_ms) {
  const Eigen::Vector3d direction_map = T_map_world.linear() * scenario.direction_world;
  const double step_m = scenario.speed_m_s * kFrameTime_s;
  double done_m = 0.0;
  int queries = 0;
  query_ms = 0.0;
  while (done_m < scenario.limit_m) {
    const double next_m = std::min(step_m, scenario.limit_m - done_m);
    Eigen::Isometry3d T_map_object = T_map_world * scenario.T_world_object;
    T_map_object.pretranslate(done_m * direction_map);
    const auto start = std::chrono::steady_clock::now();
    const Contact contact = radar.query({{&object, T_map_object}, direction_map, next_m}, {scene, {}});
    query_ms += ms_since(start);
    ++queries;
    if (contact) {
      done_m += std::max(0.0, contact.travel_m);
      break;
    }
    done_m += next_m;
  }
  query_ms /= queries;
  return done_m;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

int run(const FallthroughCommand& command) {
  Report report;
  report.command = "fallthrough";
  report.source = "simulated rooms";
  report.settings = {
      {"scenarios", command.scenarios}, {"seed", command.seed}, {"resolution_m", kResolution_m}};

  require_writable(command.report);
  GlContext context;
  report.renderer = context.renderer();
  CyberRadar radar;
  std::map<std::string, std::unique_ptr<MappedRoom>> rooms;
  for (const std::string& name : room_names())
    rooms.emplace(name, std::make_unique<MappedRoom>(context, name, report.times));

  std::array<PolicyTotals, kPolicies.size()> totals;
  nlohmann::json failures = nlohmann::json::array();
  {
    Progress progress("scenarios", command.scenarios);
    Frame frame;
    for (int number = 0; number < command.scenarios; ++number) {
      const std::string& name = room_names()[static_cast<std::size_t>(number) % room_names().size()];
      const MappedRoom& room = *rooms.at(name);
      const Scenario scenario = make_scenario(room.simulated, command.seed, number);
      render_scenario(scenario, room.simulated.room, /*noise_scale=*/1.0, frame);
      const Eigen::Isometry3d& T_map_world = room.scanned.map.info.T_world_recorded;
      const Eigen::Isometry3d T_map_camera = T_map_world * scenario.T_world_camera;
      TriangleTree object;
      object.build_by_place(scenario.object_mesh);

      for (std::size_t i = 0; i < kPolicies.size(); ++i) {
        LiveScene scene(context, room.mesh, {.surfaces = kPolicies[i]});
        const auto start = std::chrono::steady_clock::now();
        if (kPolicies[i] == SurfacePolicy::kMap) {
          scene.render_expected(frame.depth_camera, T_map_camera);
          scene.find_moved(frame);
        }
        scene.mesh_moved(frame, T_map_camera);
        const double scene_ms = ms_since(start);
        double query_ms = 0.0;
        const double came_m = travelled_m(scenario, T_map_world, object, scene.surfaces(), radar, query_ms);
        const Verdict verdict = judge(scenario, came_m);
        totals[i].frame_ms.push_back(scene_ms + query_ms);
        if (came_m < scenario.limit_m) totals[i].contact_errors_m.push_back(std::abs(verdict.error_m));
        if (verdict.outcome == Outcome::kPassedThrough) ++totals[i].passed;
        if (verdict.outcome == Outcome::kStoppedFalse) ++totals[i].false_stops;
        if (verdict.outcome != Outcome::kStoppedRight)
          failures.push_back(
              {{"scenario", number},
               {"room", name},
               {"occluder", to_string(scenario.occluder)},
               {"surfaces", to_string(kPolicies[i])},
               {"outcome", verdict.outcome == Outcome::kPassedThrough ? "passed" : "false stop"},
               {"error_m", verdict.error_m}});
      }
      progress.step(name);
    }
  }

  std::printf("%d scenarios, seed %llu, %s\n", command.scenarios,
              static_cast<unsigned long long>(command.seed), context.renderer().c_str());
  std::printf("%-8s %8s %12s %22s %16s\n", "surfaces", "passed", "false stops", "contact error, median",
              "frame, median");
  for (std::size_t i = 0; i < kPolicies.size(); ++i) {
    const PolicyTotals& t = totals[i];
    const std::string name(to_string(kPolicies[i]));
    std::printf("%-8s %8d %12d %19.1f mm %13.1f ms\n", name.c_str(), t.passed, t.false_stops,
                1e3 * median(t.contact_errors_m), median(t.frame_ms));
    report.results["policies"][name] = {{"passed", t.passed},
                                        {"false_stops", t.false_stops},
                                        {"contact_error_median_m", median(t.contact_errors_m)},
                                        {"frame_median_ms", median(t.frame_ms)}};
  }
  report.results["scenarios"] = command.scenarios;
  report.results["failures"] = failures;
  write_report(report, command.report);
  return 0;
}

}  // namespace roomradar
