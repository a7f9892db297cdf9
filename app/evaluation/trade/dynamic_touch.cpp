// dynamic_touch.cpp: draws balls at pixels that show dynamic objects, and moves them along the pixels' rays.
#include "app/evaluation/trade/dynamic_touch.hpp"

#include <cmath>

#include "app/evaluation/fallthrough/totals.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/solids/swept_travel.hpp"
#include "app/sim/solids/view_caster.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

constexpr int kTouchesEach = 4, kDraws = 60;
constexpr double kNearest_m = 0.8, kFarthest_m = 3.5;
constexpr double kBefore_m = 0.25;  // distance of the ball's start from the surface
constexpr double kAlone_m = 0.05;   // the room must be at least this much farther than the occluder

Solid ball() { return sphere(Eigen::Vector3d::Zero(), kTouchRadius_m); }

/// Returns the ball's distance to contact with the solids; infinite if it touches none.
double travel_to(std::span<const Solid> solids, const DynamicTouch& touch) {
  const std::vector<Solid> parts{ball()};
  const Eigen::Isometry3d T_world_ball(Eigen::Translation3d(touch.start_world));
  const SweptTravel swept = swept_travel(solids, parts, T_world_ball, touch.direction_world, kTouchLimit_m);
  return swept.touches ? swept.contact_distance_m : std::numeric_limits<double>::infinity();
}

void draw_touches_of(const Scenario& scenario, std::size_t number, const Room& room,
                     std::vector<DynamicTouch>& touches) {
  const std::vector<Solid> moved = occluder_at(scenario, 0);
  std::vector<Solid> solids = room.solids;
  solids.insert(solids.end(), moved.begin(), moved.end());
  const Intrinsics& camera = scenario.depth_camera;
  ViewCaster view;
  view.prepare(solids, camera, scenario.T_world_camera);
  CounterRandom random(scenario.seed, static_cast<std::uint64_t>(scenario.number));
  int found = 0;
  for (int draw = 0; draw < kDraws && found < kTouchesEach; ++draw) {
    const double u = random.uniform(0.0, camera.width_px), v = random.uniform(0.0, camera.height_px);
    const PixelHit hit = view.cast(u, v);
    if (hit.solid < static_cast<int>(room.solids.size())) continue;
    if (hit.depth_m < kNearest_m || hit.depth_m > kFarthest_m) continue;
    const Eigen::Vector3d p_camera = back_project(camera, u, v, hit.depth_m);
    DynamicTouch touch{.scenario = number};
    touch.direction_world = (scenario.T_world_camera.linear() * p_camera).normalized();
    touch.start_world = scenario.T_world_camera * p_camera - kBefore_m * touch.direction_world;
    touch.true_travel_m = travel_to(moved, touch);
    if (!std::isfinite(touch.true_travel_m) || touch.true_travel_m == 0.0) continue;
    if (travel_to(room.solids, touch) < touch.true_travel_m + kAlone_m) continue;
    touches.push_back(touch);
    ++found;
  }
}

}  // namespace

std::vector<DynamicTouch> draw_dynamic_touches(
    const std::vector<std::unique_ptr<PreparedScenario>>& scenarios, const Room& room) {
  std::vector<DynamicTouch> touches;
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    if (!scenarios[i]->scenario.occluder_solids.empty())
      draw_touches_of(scenarios[i]->scenario, i, room, touches);
  return touches;
}

DynamicTouchFacts judge_dynamic_touches(const std::vector<DynamicTouch>& touches,
                                        const std::vector<std::unique_ptr<PreparedScenario>>& scenarios,
                                        FrameScene& scene, const TrialSurfaces& how, Radar& radar) {
  if (touches.empty()) return {};
  constexpr double kAbout_m = 0.02;  // as in Session
  Mesh ball_mesh;
  append_mesh(ball(), {}, kMeshDeviation_m, ball_mesh);
  TriangleTree tree;
  tree.build_by_place(ball_mesh);
  std::vector<double> errors_m;
  int missed = 0;
  for (std::size_t first = 0; first < touches.size();) {
    std::size_t end = first;
    std::vector<FineRegion> fine;
    for (; end < touches.size() && touches[end].scenario == touches[first].scenario; ++end)
      fine.push_back({touches[end].start_world + touches[end].true_travel_m * touches[end].direction_world,
                      kTouchRadius_m + kAbout_m});
    (void)show_frame(*scenarios[touches[first].scenario], 0, how, fine, scene);
    const std::vector<SceneTree> surfaces = scene.surfaces();
    for (; first < end; ++first) {
      const DynamicTouch& touch = touches[first];
      const Eigen::Isometry3d T_world_ball(Eigen::Translation3d(touch.start_world));
      const Contact contact =
          radar.query({{&tree, T_world_ball}, touch.direction_world, kTouchLimit_m}, {surfaces, {}});
      const double past_m = contact.contact_distance_m - touch.true_travel_m;
      if (contact && past_m <= kTooFar_m)  // otherwise it passed through
        errors_m.push_back(std::abs(past_m));
      else
        ++missed;
    }
  }
  return {percentile(errors_m, 0.5), percentile(errors_m, 0.95),
          static_cast<double>(missed) / static_cast<double>(touches.size())};
}

}  // namespace roomradar
