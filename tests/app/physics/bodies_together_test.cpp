// bodies_together_test.cpp: colliding bodies conserve momentum.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "app/objects/teapot.hpp"
#include "app/physics/physics.hpp"
#include "app/physics/rigid_motion.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::bodies_together_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;

PhysicsConfig weightless(double restitution) {
  PhysicsConfig config;
  config.gravity_world_mps2.setZero();
  config.restitution = restitution;
  config.friction = config.rolling = 0.0;
  return config;
}

/// Two bodies, and optionally a floor at height 0, advanced alternately.
class Pair {
 public:
  Pair(const Mesh& first, const Mesh& second) {
    const std::array meshes{&first, &second};
    for (std::size_t i = 0; i < 2; ++i) {
      trees_[i].build_by_place(*meshes[i]);
      bodies[i].mass = mass_properties(*meshes[i], trees_[i].is_closed());
    }
  }
  void put(const Vec3& first_world, const Vec3& second_world) {
    bodies[0].T_world_object.translation() = first_world;
    bodies[1].T_world_object.translation() = second_world;
  }
  void hold_second() { is_second_held_ = true; }
  void add_floor() { floor_.build_by_place(shapes::floor(4.0F, 0.0F)); }

  void step(const PhysicsConfig& config) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t j = 1 - i;
      const std::vector<SceneTree> scene{{{&floor_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic},
                                         {{&trees_[j], bodies[j].T_world_object}, SurfaceKind::kObject}};
      const std::array others{SceneBody{}, SceneBody{&bodies[j], mass_ratio[i]}};
      const RadarScene radar_scene{scene, {}};
      CollisionQueries probe = make_collision_queries(radar_, field_, trees_[i], radar_scene);
      probe.others = others;
      PhysicsConfig own = config;
      if (i == 1 && is_second_held_) own.gravity_world_mps2.setZero();
      const StepReport report = advance(bodies[i], kFrame_s, probe, own);
      deepest_m = std::max(deepest_m, report.deepest_overlap_m);
    }
  }
  void run(double seconds, const PhysicsConfig& config) {
    for (double t = 0.0; t < seconds - 1e-9; t += kFrame_s) step(config);
  }
  void weigh() {
    mass_ratio = {bodies[0].mass.mass_kg / bodies[1].mass.mass_kg,
                  bodies[1].mass.mass_kg / bodies[0].mass.mass_kg};
  }
  [[nodiscard]] Vec3 momentum() const {
    return bodies[0].mass.mass_kg * bodies[0].velocity_world_mps +
           bodies[1].mass.mass_kg * bodies[1].velocity_world_mps;
  }
  [[nodiscard]] Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    for (const Body& body : bodies)
      sum += body.mass.mass_kg * (inertia_world_m2(body) * body.angular_velocity_world_rad_s +
                                  centre_world(body).cross(body.velocity_world_mps));
    return sum;
  }

  std::array<Body, 2> bodies;
  std::array<double, 2> mass_ratio{1.0, 1.0};
  double deepest_m = 0.0;

 private:
  std::array<TriangleTree, 2> trees_;
  TriangleTree floor_;
  bool is_second_held_ = false;
  CyberRadar radar_;
  ProximityQuery field_;
};

Mesh box(double x, double y, double z) { return shapes::box(Vec3(x, y, z).cast<float>()); }

TEST(MassProperties, WeighASolidAsWaterAndAShellByItsArea) {
  EXPECT_NEAR(mass_properties(box(0.1, 0.2, 0.3), true).mass_kg, 6.0, 1e-6);
  EXPECT_NEAR(mass_properties(box(1, 1, 1), false).mass_kg, 30.0, 1e-5);
  EXPECT_GT(mass_properties({}, false).mass_kg, 0.0);
}

TEST(BodiesTogether, EqualOnesSwapTheirVelocitiesWhereAllComesBack) {
  Pair pair(box(0.1, 0.1, 0.1), box(0.1, 0.1, 0.1));
  pair.put({-0.3, 0, 1}, {0.3, 0, 1});
  pair.bodies[0].velocity_world_mps = {2, 0, 0};
  pair.bodies[1].asleep = true;
  pair.run(0.5, weightless(1.0));
  EXPECT_LT(pair.bodies[0].velocity_world_mps.norm(), 1e-6);
  EXPECT_LT((pair.bodies[1].velocity_world_mps - Vec3(2, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(pair.deepest_m, 0.0);
}

TEST(BodiesTogether, AHeavyOneCarriesALightOneAlongAndALightOneHardlyMovesAHeavyOne) {
  for (const bool is_heavy_first : {true, false}) {
    Pair pair(box(0.2, 0.2, 0.2), box(0.1, 0.1, 0.1));  // 8 kg and 1 kg
    pair.weigh();
    const std::size_t moving = is_heavy_first ? 0 : 1;
    pair.put({-0.5, 0, 1}, {0.3, 0, 1});
    pair.bodies[moving].velocity_world_mps = {is_heavy_first ? 1.8 : -1.8, 0, 0};
    const Vec3 before = pair.momentum();
    pair.run(1.0, weightless(0.0));
    const double together_mps = is_heavy_first ? 1.6 : -0.2;
    for (const Body& body : pair.bodies)
      EXPECT_NEAR(body.velocity_world_mps.x(), together_mps, 1e-3) << is_heavy_first;
    EXPECT_LT((pair.momentum() - before).norm(), 1e-6);
    EXPECT_EQ(pair.deepest_m, 0.0);
  }
}

TEST(BodiesTogether, KeepMomentumAndTheirTurningWhenTheyMeetOffCentre) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    Pair pair(box(0.2, 0.1, 0.1), box(0.1, 0.3, 0.1));
    pair.weigh();
    pair.put({-0.3, 0.1, 1}, {0.3, 0, 1});
    pair.bodies[0].velocity_world_mps = {3, 0, 0};
    pair.bodies[0].angular_velocity_world_rad_s = {0, 0, 2};
    const Vec3 before = pair.momentum(), turning_before = pair.angular_momentum();
    pair.run(0.4, weightless(restitution));
    EXPECT_LT((pair.momentum() - before).norm(), 1e-6);
    EXPECT_GT(pair.bodies[1].velocity_world_mps.x(), 0.3);
    EXPECT_GT(std::abs(pair.bodies[1].angular_velocity_world_rad_s.z()), 0.3);
    // The contact point is off by a margin on one of the bodies.
    EXPECT_LT((pair.angular_momentum() - turning_before).norm(), 0.02 * turning_before.norm());
    EXPECT_EQ(pair.deepest_m, 0.0);
  }
}

TEST(BodiesTogether, AThrownOneShovesARestingOneAlongTheFloorAndBothComeToRest) {
  Pair pair(box(0.1, 0.1, 0.1), box(0.1, 0.1, 0.1));
  pair.add_floor();
  pair.put({-0.4, 0, 0.06}, {0, 0, 0.0511});
  pair.run(1.0, {});
  ASSERT_TRUE(pair.bodies[1].asleep);
  const Vec3 stood = pair.bodies[1].T_world_object.translation();
  pair.bodies[0].velocity_world_mps = {3, 0, 0};
  pair.run(3.0, {});
  const Vec3 went = pair.bodies[1].T_world_object.translation() - stood;
  EXPECT_GT(went.x(), 0.05);
  EXPECT_LT(went.x(), 0.4);
  EXPECT_LT(std::abs(went.y()) + std::abs(went.z()), 0.01);
  for (const Body& body : pair.bodies) {
    EXPECT_TRUE(body.asleep);
    EXPECT_NEAR(body.T_world_object.translation().z(), 0.051, 1e-3);
  }
  EXPECT_LT(pair.deepest_m, 1e-3);
}

TEST(BodiesTogether, OneThatIsSetDownOnAnotherLetsItRest) {
  Pair pair(box(0.1, 0.1, 0.1), box(0.2, 0.2, 0.1));
  pair.add_floor();
  pair.put({0.02, 0, 0.152}, {0, 0, 0.051});
  pair.bodies[0].asleep = false;
  pair.run(2.0, {});
  const Eigen::Isometry3d stood = pair.bodies[1].T_world_object;
  EXPECT_TRUE(pair.bodies[0].asleep);
  EXPECT_TRUE(pair.bodies[1].asleep);
  pair.run(2.0, {});
  EXPECT_TRUE(pair.bodies[1].T_world_object.isApprox(stood, 0.0));
  EXPECT_EQ(pair.bodies[0].rests_on, SurfaceKind::kObject);
}

/// Puts a body of 10 cm on a board of 30 cm that a hand holds at 1 m.
void put_on_a_held_board(Pair& pair, const Vec3& at) {
  pair.mass_ratio = {0.0, 1e6};
  pair.put(at, {0, 0, 1});
  pair.run(1.5, {});
}

TEST(BodiesTogether, OneThatRestsIsCarriedAlongByWhatItRestsOn) {
  for (const double speed_mps : {0.01, 0.05, 0.3}) {
    const double seconds = speed_mps < 0.02 ? 10.0 : 1.0;
    Pair pair(box(0.1, 0.1, 0.1), box(0.3, 0.3, 0.1));
    pair.hold_second();
    put_on_a_held_board(pair, {0, 0, 1.102});
    ASSERT_TRUE(pair.bodies[0].asleep);
    pair.bodies[1].velocity_world_mps = {speed_mps, 0, 0};
    pair.run(seconds, {});
    EXPECT_NEAR(pair.bodies[0].T_world_object.translation().x(), speed_mps * seconds, 0.02);
    EXPECT_NEAR(pair.bodies[0].T_world_object.translation().z(), 1.101, 2e-3);
    pair.bodies[1].velocity_world_mps.setZero();
    pair.run(1.0, {});
    EXPECT_TRUE(pair.bodies[0].asleep);
  }
}

TEST(BodiesTogether, OneTipsWhoseSupportIsDrawnAwayFromUnderHalfOfIt) {
  for (const double beyond_m : {-0.015, 0.02}) {  // the board ends this far short of the body's centre
    Pair pair(box(0.1, 0.1, 0.1), box(0.3, 0.3, 0.1));
    pair.hold_second();
    put_on_a_held_board(pair, {0.1, 0, 1.102});
    ASSERT_TRUE(pair.bodies[0].asleep);
    pair.bodies[1].T_world_object.translation().x() = 0.1 - 0.15 - beyond_m;
    pair.run(1.0, {});
    if (beyond_m > 0.0) {
      EXPECT_LT(pair.bodies[0].T_world_object.translation().z(), 0.5);
    } else {
      EXPECT_TRUE(pair.bodies[0].asleep);
      EXPECT_NEAR(pair.bodies[0].T_world_object.translation().z(), 1.101, 2e-3);
    }
  }
}

TEST(BodiesTogether, OneInAHandGoesOnAndTakesTheOtherWithIt) {
  Pair pair(box(0.1, 0.1, 0.1), box(0.1, 0.1, 0.1));
  pair.mass_ratio = {1e6, 0.0};
  pair.put({-0.3, 0, 1}, {0, 0, 1});
  pair.bodies[0].velocity_world_mps = {0.5, 0, 0};
  pair.run(1.0, weightless(0.0));
  EXPECT_NEAR(pair.bodies[0].velocity_world_mps.x(), 0.5, 1e-3);
  EXPECT_NEAR(pair.bodies[1].velocity_world_mps.x(), 0.5, 1e-3);
  EXPECT_NEAR(pair.bodies[1].T_world_object.translation().x(), 0.3, 0.02);
}

TEST(BodiesTogether, OneStandsStillThatIsNotNamedAsABody) {
  Pair pair(box(0.1, 0.1, 0.1), box(0.1, 0.1, 0.1));
  pair.mass_ratio = {0.0, 0.0};
  pair.put({-0.3, 0, 1}, {0.3, 0, 1});
  pair.bodies[0].velocity_world_mps = {2, 0, 0};
  pair.run(0.5, weightless(0.0));
  EXPECT_TRUE(pair.bodies[1].velocity_world_mps.isZero());
  EXPECT_LT(pair.bodies[0].velocity_world_mps.norm(), 1e-6);
}

Eigen::Isometry3d pose(const Vec3& position, const Eigen::Quaterniond& turn) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = turn.normalized().toRotationMatrix();
  T.translation() = position;
  return T;
}

TEST(BodiesTogether, AHandThatReachesIntoOneDoesNotPushItIntoAnotherThatLiesInItsHollow) {
  const Mesh teapot = utah_teapot(10, 0.2 / 2.04), fist = box(0.06, 0.06, 0.06);
  TriangleTree teapot_tree, fist_tree;
  teapot_tree.build_by_place(teapot);
  fist_tree.build_by_place(fist);
  // One leans upside down on the other; they touch, but do not overlap.
  const Eigen::Isometry3d T_world_lies =
      pose({0.1470, -0.3587, 0.7609}, {0.98952, 0.00948, 0.13997, -0.03411});
  const Eigen::Isometry3d T_world_leans =
      pose({0.2384, -0.3216, 0.8928}, {0.10893, 0.92496, -0.26430, 0.25044});
  const Vec3 to_hand = Vec3(0.96, 0.27, 0.0).normalized(), across(-to_hand.y(), to_hand.x(), 0.0);
  const SceneTree lies{{&teapot_tree, T_world_lies}, SurfaceKind::kObject};
  CyberRadar radar;
  ProximityQuery field;
  std::vector<ClosestPoint> points;
  for (int place = 0; place < 36; ++place) {
    Eigen::Isometry3d T_world_fist = Eigen::Isometry3d::Identity();
    T_world_fist.translation() = T_world_leans.translation() + 0.03 * (place / 9) * to_hand +
                                 0.05 * (place % 3 - 1) * across + Vec3(0.0, 0.0, 0.05 * (place / 3 % 3 - 1));
    const std::vector<SceneTree> scene{{{&fist_tree, T_world_fist}, SurfaceKind::kDynamic}, lies};
    const RadarScene radar_scene{scene, {}};
    Body body;
    body.mass = mass_properties(teapot, false);
    body.T_world_object = T_world_leans;
    (void)advance(body, kFrame_s, make_collision_queries(radar, field, teapot_tree, radar_scene), {},
                  {&to_hand, 1});
    const SurfaceKindMask crossed =
        field.near({&teapot_tree, body.T_world_object}, {{&lies, 1}, {}}, 1e-6, 0, points);
    EXPECT_EQ(crossed, 0U) << place;
  }
}

}  // namespace
}  // namespace roomradar::bodies_together_test
