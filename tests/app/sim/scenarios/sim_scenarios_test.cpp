// sim_scenarios_test.cpp: hidden-surface scenarios: exact truth, surfaces that are hidden now but were seen
// before, fair scoring.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/sim/scenarios/scenarios.hpp"
#include "app/sim/sensor/kinect_depth.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "app/sim/solids/swept_travel.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::sim_scenarios_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d at(double x, double y, double z) {
  Isometry3d T = Isometry3d::Identity();
  T.translation() = Vector3d(x, y, z);
  return T;
}

double contact_distance_m(const Room& room, const Solid& object, const Isometry3d& T_world_object,
                          const Vector3d& direction, double limit_m) {
  return swept_travel(room.solids, {&object, 1}, T_world_object, direction, limit_m).contact_distance_m;
}

TEST(SimSweep, TravelHasItsClosedForm) {
  Room room;
  room.solids = {box({0, 0, -0.5}, {4, 4, 1}), sphere({1, 0, 0.3}, 0.2)};
  const Vector3d down = -Vector3d::UnitZ();
  EXPECT_NEAR(contact_distance_m(room, sphere({0, 0, 0}, 0.1), at(0, 0, 1), down, 2.0), 0.9, 1e-7);
  // A ball of 0.1 m radius onto a ball of 0.2 m, offset by 0.18 m: at contact the centres are 0.3 m apart,
  // 0.24 m in height.
  EXPECT_NEAR(contact_distance_m(room, sphere({0, 0, 0}, 0.1), at(1.18, 0, 1), down, 2.0), 1.0 - 0.3 - 0.24,
              1e-7);
  EXPECT_NEAR(contact_distance_m(room, box({0, 0, 0}, {0.2, 0.2, 0.2}), at(0, 0, 1), down, 2.0), 0.9, 1e-7);
  Isometry3d on_edge = at(0, 0, 1);
  on_edge.rotate(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vector3d::UnitX()));
  EXPECT_NEAR(contact_distance_m(room, box({0, 0, 0}, {0.2, 0.2, 0.2}), on_edge, down, 2.0),
              1.0 - 0.1 * std::sqrt(2.0), 1e-7);
  EXPECT_NEAR(contact_distance_m(room, capsule({-0.2, 0, 0}, {0.2, 0, 0}, 0.05), at(0, 0, 1), down, 2.0),
              0.95, 1e-7);
  const Solid ball = sphere({0, 0, 0}, 0.1);
  const SweptTravel free = swept_travel(room.solids, {&ball, 1}, at(0, 0, 1), Vector3d::UnitZ(), 2.0);
  EXPECT_FALSE(free.touches);
  EXPECT_EQ(free.contact_distance_m, 2.0);
  const SweptTravel inside = swept_travel(room.solids, {&ball, 1}, at(0, 0, -0.5), down, 2.0);
  EXPECT_TRUE(inside.touches);
  EXPECT_EQ(inside.contact_distance_m, 0.0);
}

TEST(SimSweep, CrossedEdgesMeetWhereTheyCross) {
  // Two bars, each standing on an edge, one across the other: the lower one's ridge is at 0.1 sqrt(2).
  Solid lower = box({0, 0, 0}, {2.0, 0.2, 0.2}), upper = box({0, 0, 0}, {0.2, 2.0, 0.2});
  lower.T_world_solid.rotate(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vector3d::UnitX()));
  upper.T_world_solid.rotate(Eigen::AngleAxisd(0.25 * 3.14159265358979, Vector3d::UnitY()));
  const SweptTravel swept =
      swept_travel({&lower, 1}, {&upper, 1}, at(0.013, 0.027, 1), -Vector3d::UnitZ(), 2.0);
  ASSERT_TRUE(swept.touches);
  EXPECT_NEAR(swept.contact_distance_m, 1.0 - 0.2 * std::sqrt(2.0), 1e-7);
  EXPECT_LT((swept.point_world - Vector3d(0.013, 0, 0.1 * std::sqrt(2.0))).norm(), 1e-6);
}

/// Sphere tracing of the object's mesh, sampled at points `spacing_m` apart, through the room's exact
/// distance field. Slow; the result is too long by the effect of the gaps between the points.
double traced_travel_m(const Room& room, const Mesh& object, const Isometry3d& T_world_object,
                       const Vector3d& direction_world, double limit_m, double spacing_m) {
  double least_m = limit_m;
  const auto trace = [&](const Vector3d& p_object) {
    const Vector3d start_world = T_world_object * p_object;
    for (double contact_distance_m = 0.0; contact_distance_m < least_m;) {
      const double clear_m = signed_distance_m(room, start_world + contact_distance_m * direction_world);
      if (clear_m < 1e-6) {
        least_m = contact_distance_m;
        return;
      }
      contact_distance_m += std::max(clear_m, 1e-6);
    }
  };
  for (const Triangle& t : object.triangles) {
    const Vector3d a = object.vertices[t[0]].cast<double>(), b = object.vertices[t[1]].cast<double>(),
                   c = object.vertices[t[2]].cast<double>();
    const double longest_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest_m / spacing_m)));
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) trace(a + (b - a) * i / parts + (c - a) * j / parts);
  }
  return least_m;
}

TEST(SimSweep, EveryShapeTravelsAsFarAsItsTracedMesh) {
  const ScenarioRoom room = make_scenario_room("table");
  std::set<ObjectShape> shapes;
  for (std::int64_t number = 0; number < 27; ++number) {
    const Scenario s = make_scenario(room, 11, number);
    if (!shapes.insert(s.object.shape).second) continue;
    constexpr double kSpacing_m = 0.004;
    const double traced_m =
        traced_travel_m(room.room, s.object_mesh, s.T_world_object, s.direction_world, s.limit_m, kSpacing_m);
    // The mesh is up to 0.5 mm inside the solids; a corner of the room can reach between its points.
    EXPECT_GT(traced_m, s.true_travel_m - 1e-5) << to_string(s.object.shape);
    EXPECT_LT(traced_m, s.true_travel_m + 0.003) << to_string(s.object.shape);
  }
  EXPECT_EQ(shapes.size(), 9U);
}

TEST(SimDistance, IsWhatTheSlowestWaySays) {
  // Distance of a cylinder and a rotated box, against the box's exact distance from points all over the
  // cylinder.
  Solid can = cylinder({0, 0, 0}, 0.1, 0.3);
  Solid crate = rounded_box({0.5, 0.2, 0.3}, {0.3, 0.2, 0.4}, 0.03, 0.7);
  CounterRandom random(3, 5);
  for (int turn = 0; turn < 20; ++turn) {
    can.T_world_solid.rotate(Eigen::AngleAxisd(random.uniform(0.0, 6.0), Vector3d(1, 2, 3).normalized()));
    crate.T_world_solid.rotate(Eigen::AngleAxisd(random.uniform(0.0, 6.0), Vector3d(3, -1, 2).normalized()));
    double least_m = 1e9;
    const auto look = [&](double radius_m, double angle, double z) {
      const Vector3d p_can(radius_m * std::cos(angle), radius_m * std::sin(angle), z);
      least_m = std::min(least_m, signed_distance_m(crate, can.T_world_solid * p_can));
    };
    for (int i = 0; i < 720; ++i)
      for (int j = 0; j <= 60; ++j) {
        const double angle = i * 3.14159265358979 / 360.0;
        look(0.1, angle, 0.15 - 0.005 * j);
        look(0.1 * j / 60.0, angle, 0.15);
        look(0.1 * j / 60.0, angle, -0.15);
      }
    const Separation apart = separation(can, crate);
    EXPECT_LE(apart.distance_m, least_m + 1e-9);
    EXPECT_NEAR(apart.distance_m, least_m, 2e-4);  // the nearest point is between two samples of the cylinder
    EXPECT_NEAR(signed_distance_m(crate, apart.point_b_world), 0.0, 1e-7);
    EXPECT_NEAR(signed_distance_m(can, apart.point_b_world), apart.distance_m, 1e-7);
  }
  EXPECT_EQ(separation(can, can).distance_m, 0.0);
  EXPECT_NEAR(separation(sphere({0, 0, 1}, 0.1), sphere({0, 0, 0}, 0.2)).distance_m, 0.7, 1e-12);
}

TEST(SimScenario, HoldsWhatItPromises) {
  std::set<Occluder> kinds;
  std::set<ObjectShape> shapes;
  int drops = 0, pushes = 0, moving = 0;
  double fastest_m_s = 0.0;
  for (const std::string& name : room_names()) {
    const ScenarioRoom room = make_scenario_room(name);
    for (std::int64_t number = 0; number < 18; ++number) {
      const Scenario s = make_scenario(room, 7, number);
      SCOPED_TRACE(name + " " + std::to_string(number) + " " + std::string(to_string(s.occluder)) + " " +
                   std::string(to_string(s.object.shape)));
      kinds.insert(s.occluder);
      shapes.insert(s.object.shape);
      moving += !s.occluder_velocity_world.isZero();
      fastest_m_s = std::max(fastest_m_s, s.speed_m_s);
      (s.direction_world.z() < -0.99 ? drops : pushes)++;
      EXPECT_NEAR(s.direction_world.norm(), 1.0, 1e-9);
      EXPECT_GT(s.true_travel_m, 0.05);
      EXPECT_NEAR(s.limit_m, s.true_travel_m + 0.4, 1e-9);
      EXPECT_LE(step_m(s), 10.0 / 30.0 + 1e-9);

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
      EXPECT_GT(nearest_at_start_m, 0.0199);
      EXPECT_GT(nearest_at_contact_m, -0.0005);
      EXPECT_NEAR(signed_distance_m(room.room, s.contact_world), 0.0, 1e-5);
      EXPECT_GE(longest_m, 0.038);
      EXPECT_LE(longest_m, 2.0 * s.object.reach_m + 1e-6);

      // In the contact frame the camera sees something nearer than the contact.
      Frame frame;
      render_scenario(s, room.room, contact_frame(s), 0.0, frame);
      const Vector3d contact_camera = s.T_world_camera.inverse() * s.contact_world;
      const Eigen::Vector2d uv = project(s.depth_camera, contact_camera);
      ASSERT_TRUE(frame.depth_m.contains(static_cast<int>(std::lround(uv.x())),
                                         static_cast<int>(std::lround(uv.y()))));
      EXPECT_LT(
          frame.depth_m.at(static_cast<int>(std::lround(uv.x())), static_cast<int>(std::lround(uv.y()))),
          contact_camera.z());
      const Isometry3d T_camera_believed = s.T_world_camera.inverse() * s.T_world_believed;
      EXPECT_LT(T_camera_believed.translation().norm(), 0.01);
      EXPECT_LT(Eigen::AngleAxisd(T_camera_believed.linear()).angle(), 0.011);

      // Only the true surface is in the way: the occluder stays 4 cm away from the object in each frame.
      for (int i = 0; i <= contact_frame(s); ++i) {
        const std::vector<Solid> occluder = occluder_at(s, i);
        for (const double part : {0.0, 0.5, 1.0}) {
          const double travelled_m = std::min(s.true_travel_m, (i + part) * step_m(s));
          const Isometry3d T_world_object =
              Eigen::Translation3d(travelled_m * s.direction_world) * s.T_world_object;
          EXPECT_GE(clearance_m(occluder, s.object.parts, T_world_object, 1.0), 0.0399);
        }
      }

      // Frames of the prescan show the contact without occlusion.
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
  EXPECT_EQ(shapes.size(), 9U);
  EXPECT_GT(drops, 15);
  EXPECT_GT(pushes, 15);
  EXPECT_GE(moving, 3);
  EXPECT_GT(fastest_m_s, 5.0);
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
}  // namespace roomradar::sim_scenarios_test
