// Hidden-surface scenarios: the truth is exact, the surface hidden now but seen before, the judge fair.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/sim/counter_random.hpp"
#include "app/sim/kinect_depth.hpp"
#include "app/sim/scenarios.hpp"
#include "app/sim/swept_travel.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d at(double x, double y, double z) {
  Isometry3d T = Isometry3d::Identity();
  T.translation() = Vector3d(x, y, z);
  return T;
}

TEST(SimSweep, TravelHasItsClosedForm) {
  Room room;
  room.solids = {box({0, 0, -0.5}, {4, 4, 1}), sphere({1, 0, 0.3}, 0.2)};
  room.tree = SolidTree(room.solids);
  const Vector3d down = -Vector3d::UnitZ();
  EXPECT_NEAR(swept_travel(room, sphere({0, 0, 0}, 0.1), at(0, 0, 1), down, 2.0).travel_m, 0.9, 1e-6);
  // A ball of 0.1 m onto a ball of 0.2 m, 0.18 m aside: centres 0.3 m apart when they touch, 0.24 m in
  // height.
  EXPECT_NEAR(swept_travel(room, sphere({0, 0, 0}, 0.1), at(1.18, 0, 1), down, 2.0).travel_m,
              1.0 - 0.3 - 0.24, 1e-6);
  EXPECT_NEAR(swept_travel(room, box({0, 0, 0}, {0.2, 0.2, 0.2}), at(0, 0, 1), down, 2.0).travel_m, 0.9,
              1e-6);
  Isometry3d on_edge = at(0, 0, 1);
  on_edge.rotate(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vector3d::UnitX()));
  EXPECT_NEAR(swept_travel(room, box({0, 0, 0}, {0.2, 0.2, 0.2}), on_edge, down, 2.0).travel_m,
              1.0 - 0.1 * std::sqrt(2.0), 1e-6);
  const SweptTravel free = swept_travel(room, sphere({0, 0, 0}, 0.1), at(0, 0, 1), Vector3d::UnitZ(), 2.0);
  EXPECT_FALSE(free.touches);
  EXPECT_EQ(free.travel_m, 2.0);
  EXPECT_NEAR(swept_travel(room, capsule({-0.2, 0, 0}, {0.2, 0, 0}, 0.05), at(0, 0, 1), down, 2.0).travel_m,
              0.95, 1e-6);
}

TEST(SimScenario, HoldsWhatItPromises) {
  std::set<Occluder> kinds;
  int drops = 0, pushes = 0;
  for (const std::string& name : room_names()) {
    const ScenarioRoom room = make_scenario_room(name);
    for (std::int64_t number = 0; number < 16; ++number) {
      const Scenario s = make_scenario(room, 7, number);
      SCOPED_TRACE(name + " " + std::to_string(number) + " " + std::string(to_string(s.occluder)));
      kinds.insert(s.occluder);
      (s.direction_world.z() < -0.99 ? drops : pushes)++;
      EXPECT_NEAR(s.direction_world.norm(), 1.0, 1e-9);
      EXPECT_GT(s.true_travel_m, 0.05);
      EXPECT_NEAR(s.limit_m, s.true_travel_m + 0.4, 1e-9);

      // The mesh's vertices, an independent sampling of the object, agree with the truth.
      double nearest_at_start_m = 1.0, nearest_at_contact_m = 1.0, longest_m = 0.0;
      for (const Eigen::Vector3f& vertex : s.object_mesh.vertices) {
        const Vector3d p_world = s.T_world_object * (s.object_mesh.origin + vertex.cast<double>());
        nearest_at_start_m = std::min(nearest_at_start_m, signed_distance_m(room.room, p_world));
        nearest_at_contact_m =
            std::min(nearest_at_contact_m,
                     signed_distance_m(room.room, p_world + s.true_travel_m * s.direction_world));
        longest_m = std::max(longest_m, 2.0 * vertex.norm());
      }
      EXPECT_GT(nearest_at_start_m, 0.02);
      EXPECT_GT(nearest_at_contact_m, -0.0005);
      EXPECT_NEAR(signed_distance_m(room.room, s.contact_world), 0.0, 1e-5);
      EXPECT_GE(longest_m, 0.038);
      EXPECT_LE(longest_m, 0.30 * std::sqrt(3.0) + 1e-6);

      // Seen from where the camera stands, something nearer covers the contact.
      Frame frame;
      render_scenario(s, room.room, 0.0, frame);
      const Vector3d contact_camera = s.T_world_camera.inverse() * s.contact_world;
      const Eigen::Vector2d uv = project(s.depth_camera, contact_camera);
      ASSERT_TRUE(frame.depth_m.contains(static_cast<int>(std::lround(uv.x())),
                                         static_cast<int>(std::lround(uv.y()))));
      EXPECT_LT(
          frame.depth_m.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y()))),
          contact_camera.z());

      // The prescan's frames have the contact in view, with nothing between.
      int views = 0;
      for (const Isometry3d& T_world_camera : room.T_world_prescan) {
        const Vector3d p_camera = T_world_camera.inverse() * s.contact_world;
        if (p_camera.z() < 0.4) continue;
        const Eigen::Vector2d pixel = project(room.prescan.depth_camera, p_camera);
        if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > 639 || pixel.y() > 479) continue;
        const auto hit =
            cast_ray(room.room, T_world_camera.translation(), s.contact_world - T_world_camera.translation());
        views += hit && std::abs(hit->range_m - 1.0) < 0.08;
      }
      EXPECT_GE(views, 3);
      EXPECT_EQ(s.occluder_solids.empty(), s.occluder == Occluder::kFurniture);
      EXPECT_EQ(s.occluder_solids.size(), s.occluder_materials.size());
    }
  }
  EXPECT_EQ(kinds.size(), 4U);
  EXPECT_GT(drops, 15);
  EXPECT_GT(pushes, 15);
}

TEST(SimScenario, IsTheSameForTheSameNumberWhateverElseWasMade) {
  const ScenarioRoom room = make_scenario_room("table");
  const Scenario once = make_scenario(room, 3, 5);
  make_scenario(room, 3, 2);
  const Scenario again = make_scenario(room, 3, 5);
  EXPECT_EQ(once.T_world_object.matrix(), again.T_world_object.matrix());
  EXPECT_EQ(once.T_world_camera.matrix(), again.T_world_camera.matrix());
  EXPECT_EQ(once.true_travel_m, again.true_travel_m);
  EXPECT_NE(once.true_travel_m, make_scenario(room, 4, 5).true_travel_m);
  EXPECT_NE(once.true_travel_m, make_scenario(room, 3, 6).true_travel_m);
}

TEST(SimScenario, JudgeDrawsItsLines) {
  Scenario scenario;
  scenario.true_travel_m = 0.3;
  EXPECT_EQ(judge(scenario, 0.3).outcome, Outcome::kStoppedRight);
  EXPECT_EQ(judge(scenario, 0.319).outcome, Outcome::kStoppedRight);
  EXPECT_EQ(judge(scenario, 0.321).outcome, Outcome::kPassedThrough);
  EXPECT_EQ(judge(scenario, 0.271).outcome, Outcome::kStoppedRight);
  EXPECT_EQ(judge(scenario, 0.269).outcome, Outcome::kStoppedFalse);
  EXPECT_NEAR(judge(scenario, 0.35).error_m, 0.05, 1e-12);
}

TEST(SimScenario, AnUnknownRoomIsRefused) { EXPECT_THROW(make_scenario_room("cellar"), Error); }

}  // namespace
}  // namespace roomradar
