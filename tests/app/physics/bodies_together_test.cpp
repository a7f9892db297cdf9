// bodies_together_test.cpp: colliding bodies conserve momentum.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "app/objects/teapot.hpp"
#include "app/physics/physics.hpp"
#include "app/physics/rigid_motion.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/body_group.hpp"

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

/// Two bodies.
class Pair : public test::BodyGroup {
 public:
  Pair(const Mesh& first, const Mesh& second) : BodyGroup({first, second}) {}
  void put(const Vec3& first_world, const Vec3& second_world) {
    BodyGroup::put(0, first_world);
    BodyGroup::put(1, second_world);
  }
  void hold_second() { is_carried[1] = true; }
  void add_floor() { add_surface(shapes::floor(4.0F, 0.0F)); }
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

double energy_J(const Pair& pair) {
  double sum_J = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Body& body = pair.bodies[i];
    sum_J += pair.mass_kg[i] *
             energy({body.velocity_world_mps, body.angular_velocity_world_rad_s}, inertia_world_m2(body));
  }
  return sum_J;
}

TEST(BodiesTogether, RandomImpactsKeepMomentumAndNeverAddEnergy) {
  const std::array<Mesh, 4> shapes = {box(0.1, 0.1, 0.1), box(0.3, 0.1, 0.05), shapes::ball(0.06F, 10, 14),
                                      box(0.4, 0.02, 0.02)};
  CounterRandom random(3, 0);
  const auto vector = [&](double size) {
    return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    Pair pair(shapes[static_cast<std::size_t>(i) % 4], shapes[static_cast<std::size_t>(i) / 4 % 4]);
    pair.weigh();
    PhysicsConfig config = weightless(random.uniform(0.0, 1.0));
    config.friction = random.uniform(0.0, 1.0);
    pair.put({-0.4, 0.0, 0.0}, Vec3(0.4, 0.0, 0.0) + vector(0.05));
    for (std::size_t k = 0; k < 2; ++k) {
      Body& body = pair.bodies[k];
      body.T_world_object.rotate(Eigen::AngleAxisd(random.uniform(0.0, 3.0), vector(1.0).normalized()));
      body.velocity_world_mps = Vec3(k == 0 ? 3.0 : -1.0, 0.0, 0.0) + vector(0.2);
      body.angular_velocity_world_rad_s = vector(5.0);
    }
    const Vec3 momentum = pair.momentum();
    double energy = energy_J(pair);
    const double speed_before = pair.bodies[1].velocity_world_mps.x();
    for (int frame = 0; frame < 12; ++frame) {
      pair.step(config);
      EXPECT_LE(energy_J(pair) / energy - 1.0, 1e-9) << i << " frame " << frame;
      energy = energy_J(pair);
    }
    met += std::abs(pair.bodies[1].velocity_world_mps.x() - speed_before) > 1e-3;
    EXPECT_LT((pair.momentum() - momentum).norm(), 1e-9 * momentum.norm()) << i;
    EXPECT_EQ(pair.deepest_m, 0.0) << i;
  }
  EXPECT_GT(met, 150);
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
  pair.hold_second();
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
  pair.is_carried[0] = true;
  pair.put({-0.3, 0, 1}, {0, 0, 1});
  pair.bodies[0].velocity_world_mps = {0.5, 0, 0};
  pair.run(1.0, weightless(0.0));
  EXPECT_NEAR(pair.bodies[0].velocity_world_mps.x(), 0.5, 1e-3);
  EXPECT_NEAR(pair.bodies[1].velocity_world_mps.x(), 0.5, 1e-3);
  EXPECT_NEAR(pair.bodies[1].T_world_object.translation().x(), 0.3, 0.02);
}

TEST(BodiesTogether, OneStandsStillThatIsNotNamedAsABody) {
  const Mesh cube = box(0.1, 0.1, 0.1);
  TriangleTree tree;
  tree.build_by_place(cube);
  Body body;
  body.mass = mass_properties(cube, true);
  body.T_world_object.translation() = Vec3(-0.3, 0, 1);
  body.velocity_world_mps = {2, 0, 0};
  Eigen::Isometry3d T_world_other = Eigen::Isometry3d::Identity();
  T_world_other.translation() = Vec3(0.3, 0, 1);
  const std::vector<SceneTree> scene{{{&tree, T_world_other}, SurfaceKind::kObject}};
  const RadarScene radar_scene{scene, {}};
  CyberRadar radar;
  const CollisionQueries probe = make_collision_queries(radar, tree, radar_scene);
  for (int i = 0; i < 15; ++i) static_cast<void>(advance(body, kFrame_s, probe, weightless(0.0)));
  EXPECT_LT(body.velocity_world_mps.norm(), 1e-6);
}

/// A tower of n cubes of 10 cm, 1 mm apart.
test::BodyGroup tower(std::size_t n) {
  test::BodyGroup group(std::vector<Mesh>(n, box(0.1, 0.1, 0.1)));
  group.add_surface(shapes::floor(4.0F, 0.0F));
  for (std::size_t i = 0; i < n; ++i) group.put(i, {0.0, 0.0, 0.051 + 0.101 * static_cast<double>(i)});
  return group;
}

TEST(BodiesTogether, ATowerOfTenStands) {
  test::BodyGroup group = tower(10);
  group.run(3.0, {});
  for (const Body& body : group.bodies) EXPECT_TRUE(body.asleep);
  const std::vector<Body> slept = group.bodies;
  group.run(57.0, {});
  for (std::size_t i = 0; i < 10; ++i) {
    const Vec3 at = group.bodies[i].T_world_object.translation();
    EXPECT_LT((at - slept[i].T_world_object.translation()).norm(), 0.5e-3) << i;
    EXPECT_NEAR(at.head<2>().norm(), 0.0, 1e-3) << i;
    EXPECT_NEAR(at.z(), 0.051 + 0.101 * static_cast<double>(i), 2e-3) << i;
  }
  EXPECT_EQ(group.deepest_m, 0.0);
}

TEST(BodiesTogether, ALoadTipsTheBoardItIsPutOnOrNotAsStaticsSays) {
  // A board of 1 kg, 40 cm long, over an edge at x = 0 of a base 20 cm wide to the left of it: it stays with
  // a load at its right end as long as load x arm <= board x overlap.
  for (const double factor : {0.95, 1.05}) {
    for (const bool is_late : {false, true}) {  // put on the sleeping board, or there from the beginning
      test::BodyGroup group({box(0.4, 0.2, 0.02), box(0.2, 0.2, 0.1), box(0.02, 0.1, 0.1)});
      group.add_surface(shapes::floor(4.0F, 0.0F));
      const double board_x = -0.05, load_x = board_x + 0.18;
      group.mass_kg = {1.0, 50.0, factor * 0.05 / load_x};
      group.put(1, {-0.1, 0.0, 0.051});
      group.put(0, {board_x, 0.0, 0.112});
      group.put(2, {is_late ? 3.0 : load_x, 0.0, is_late ? 0.051 : 0.173});
      if (is_late) {
        group.run(2.0, {});
        ASSERT_TRUE(group.bodies[0].asleep);
        group.put(2, {load_x, 0.0, 0.1732});
        group.bodies[2].asleep = false;
      }
      // The load slides off the tipping board, which then falls back.
      bool has_tipped = false;
      for (int frame = 0; frame < 120; ++frame) {
        group.step({});
        has_tipped |= group.bodies[0].T_world_object.linear()(2, 2) < 0.99;
      }
      EXPECT_EQ(has_tipped, factor > 1.0) << factor << (is_late ? ", later" : "");
      EXPECT_EQ(group.deepest_m, 0.0);
    }
  }
}

TEST(BodiesTogether, AllAboveWakeAndFallWhenTheLowestGoes) {
  test::BodyGroup group = tower(5);
  group.run(3.0, {});
  for (const Body& body : group.bodies) ASSERT_TRUE(body.asleep);
  group.put(0, {3.0, 0.0, 0.051});
  group.step({});
  group.step({});
  for (std::size_t i = 1; i < 5; ++i) EXPECT_FALSE(group.bodies[i].asleep) << i;
  group.run(3.0, {});
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_NEAR(group.bodies[i].T_world_object.translation().z(), 0.051 + 0.101 * static_cast<double>(i - 1),
                3e-3);
  EXPECT_LT(group.deepest_m, 1e-3);
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
    (void)advance(body, kFrame_s, make_collision_queries(radar, teapot_tree, radar_scene), {}, {&to_hand, 1});
    const SurfaceKindMask crossed =
        near_features({&teapot_tree, body.T_world_object}, {{&lies, 1}, {}}, 1e-6, 0, points);
    EXPECT_EQ(crossed, 0U) << place;
  }
}

TEST(BodiesTogether, AHeapIsTheSameToTheBitOnOneThreadAndOnTwo) {
  const auto fall = [](bool is_one_thread) {
    std::vector<Mesh> meshes;
    for (int i = 0; i < 12; ++i) meshes.push_back(i % 3 == 0 ? utah_teapot(4, 0.06) : box(0.1, 0.08, 0.06));
    test::BodyGroup group(meshes);
    group.system.is_one_thread = is_one_thread;
    group.add_surface(shapes::floor(2.0F, 0.0F));
    for (int i = 0; i < 12; ++i)
      group.put(static_cast<std::size_t>(i), {0.13 * (i % 3), 0.05 * (i % 2), 0.1 + 0.11 * (i / 3)});
    group.run(1.5, {});
    std::vector<Eigen::Matrix4d> poses;
    for (const Body& body : group.bodies) poses.push_back(body.T_world_object.matrix());
    return std::pair(poses, group.system.worker != nullptr);
  };
  const auto [alone, alone_has_worker] = fall(true);
  const auto [shared, shared_has_worker] = fall(false);
  EXPECT_FALSE(alone_has_worker);
  EXPECT_TRUE(shared_has_worker);
  EXPECT_EQ(alone, shared);
}

}  // namespace
}  // namespace roomradar::bodies_together_test
