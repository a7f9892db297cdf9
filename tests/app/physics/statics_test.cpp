// statics_test.cpp: stacks, arches and boards stand, tip and slide as statics says.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "mapping/types/system/counter_random.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/body_group.hpp"

namespace roomradar::statics_test {
namespace {

using Vec3 = Eigen::Vector3d;
using test::BodyGroup;

constexpr double kMargin_m = 0.001;

Mesh box(double x, double y, double z) { return shapes::box(Vec3(x, y, z).cast<float>()); }

BodyGroup on_floor(const std::vector<Mesh>& meshes) {
  BodyGroup group(meshes);
  group.add_surface(shapes::floor(4.0F, 0.0F));
  return group;
}

/// Expects that the group comes to rest within 4 s and then does not move for `seconds`.
void expect_to_stand(BodyGroup& group, double seconds, const std::string& what) {
  const std::vector<Body> put = group.bodies;
  group.run(4.0, {});
  EXPECT_TRUE(group.all_asleep()) << what;
  const std::vector<Body> slept = group.bodies;
  group.run(seconds, {});
  for (std::size_t i = 0; i < group.bodies.size(); ++i) {
    EXPECT_LT(strayed_m(group.bodies[i], slept[i].T_world_object), 0.5e-3) << what << " " << i;
    EXPECT_LT(strayed_m(group.bodies[i], put[i].T_world_object), 8e-3) << what << " " << i;
  }
  EXPECT_EQ(group.deepest_m, 0.0) << what;
}

TEST(Statics, APyramidOfFifteenStands) {
  BodyGroup group = on_floor(std::vector<Mesh>(15, box(0.1, 0.1, 0.1)));
  std::size_t body = 0;
  for (int row = 0; row < 5; ++row)
    for (int i = 0; i < 5 - row; ++i) group.put(body++, {0.11 * (i + 0.5 * row), 0.0, 0.051 + 0.101 * row});
  expect_to_stand(group, 60.0, "pyramid");
}

/// A wedge of an arch about the y axis, between two angles, with its vertices relative to the arch's centre.
Mesh wedge(double from_rad, double to_rad, double inner_m, double outer_m, double depth_m, double gap_m) {
  Mesh mesh;
  for (const double y : {-0.5 * depth_m, 0.5 * depth_m})
    for (const auto& [angle, shift] : {std::pair{from_rad, 0.5 * gap_m}, std::pair{to_rad, -0.5 * gap_m}})
      for (const double radius : {inner_m, outer_m})
        mesh.vertices.emplace_back(Vec3(radius * std::cos(angle) - shift * std::sin(angle), y,
                                        radius * std::sin(angle) + shift * std::cos(angle))
                                       .cast<float>());
  // 0 inner-from 1 outer-from 2 inner-to 3 outer-to at -y; 4..7 at +y
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(0, 1, 3, 2);  // -y
  quad(4, 6, 7, 5);  // +y
  quad(0, 4, 5, 1);  // from
  quad(2, 3, 7, 6);  // to
  quad(1, 5, 7, 3);  // outer
  quad(0, 2, 6, 4);  // inner
  return mesh;
}

TEST(Statics, AnArchOfSevenWedgesStands) {
  constexpr int kWedges = 7;
  std::vector<Mesh> wedges;
  for (int i = 0; i < kWedges; ++i)
    wedges.push_back(wedge(std::numbers::pi * i / kWedges, std::numbers::pi * (i + 1) / kWedges, 0.2, 0.3,
                           0.1, kMargin_m));
  BodyGroup group = on_floor(wedges);
  for (std::size_t i = 0; i < kWedges; ++i) group.put(i, {0.0, 0.0, 0.5 * kMargin_m});
  group.weigh();
  expect_to_stand(group, 60.0, "arch");
}

/// Number of random loads per test: 20 with ROOMRADAR_LONG_TESTS.
int trials() { return std::getenv("ROOMRADAR_LONG_TESTS") != nullptr ? 20 : 3; }

TEST(Statics, AnOverhangOfFourBoardsStandsUpToItsLimit) {
  for (int trial = 0; trial < trials(); ++trial) {
    // Equal boards first: the harmonic limit. Then boards of random masses.
    CounterRandom random(1, static_cast<std::uint64_t>(trial));
    std::vector<double> masses_kg(4, 1.0);
    for (double& mass_kg : masses_kg) mass_kg = trial == 0 ? 1.0 : random.uniform(0.5, 2.0);
    // A board of half length 0.2 m may reach beyond the one below until the centre of mass of all boards from
    // it on is above that one's end.
    double above_kg = 0.0, centre_m = 0.0;  // of the boards from i on; centre_m from the middle of board i
    std::vector<double> reach_m(5, 0.0);
    for (std::size_t i = 3; i > 0; --i) {
      centre_m = above_kg * (reach_m[i + 1] + centre_m) / (above_kg + masses_kg[i]);
      above_kg += masses_kg[i];
      reach_m[i] = 0.2 - centre_m;
    }
    for (const double factor : {0.95, 1.05}) {
      BodyGroup group = on_floor(std::vector<Mesh>(4, box(0.4, 0.2, 0.04)));
      group.mass_kg = masses_kg;
      double x = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i > 0) x += factor * reach_m[i];
        group.put(i, {x, 0.0, 0.021 + 0.041 * static_cast<double>(i)});
      }
      if (factor < 1.0) {
        expect_to_stand(group, 10.0, "overhang " + std::to_string(trial));
      } else {
        const Body put = group.bodies[3];
        group.run(4.0, {});
        EXPECT_GT(strayed_m(group.bodies[3], put.T_world_object), 0.02) << trial;
      }
    }
  }
}

TEST(Statics, ASeesawTipsToTheHeavierSide) {
  // A board over a ridge of 4 cm, loads at 0.3 m to either side: it stays as long as both lie within its top.
  const double arm_m = 0.3, half_ridge_m = 0.02;
  for (int trial = 0; trial < trials(); ++trial) {
    CounterRandom random(2, static_cast<std::uint64_t>(trial));
    const double board_kg = random.uniform(0.5, 2.0), lighter_kg = random.uniform(0.5, 2.0);
    const double side = trial % 2 == 0 ? 1.0 : -1.0;
    for (const double factor : {0.95, 1.05}) {
      BodyGroup group({box(0.8, 0.2, 0.02), box(0.06, 0.1, 0.06), box(0.06, 0.1, 0.06)});
      group.add_surface(shapes::floor(4.0F, 0.0F));
      Mesh ridge = shapes::box(Eigen::Vector3f(0.04F, 0.4F, 0.2F));
      ridge.origin.z() = 0.1;
      group.add_surface(ridge);
      // The heavier load tips it if m (arm - half) > half board + lighter (arm + half).
      const double limit_kg =
          (half_ridge_m * board_kg + lighter_kg * (arm_m + half_ridge_m)) / (arm_m - half_ridge_m);
      group.mass_kg = {board_kg, lighter_kg, factor * limit_kg};
      group.put(0, {0.0, 0.0, 0.211});
      group.put(1, {-side * arm_m, 0.0, 0.252});
      group.put(2, {side * arm_m, 0.0, 0.252});
      group.run(4.0, {});
      const bool has_tipped = group.bodies[0].T_world_object.linear()(2, 2) < 0.99;
      EXPECT_EQ(has_tipped, factor > 1.0) << factor << " " << trial;
      EXPECT_EQ(group.deepest_m, 0.0);
    }
  }
}

TEST(Statics, ABoxOverAnEdgeTipsPastItsMiddle) {
  for (int trial = 0; trial < trials(); ++trial) {
    CounterRandom random(3, static_cast<std::uint64_t>(trial));
    // A box with a load on its end: the common centre of mass is 5 % of the half length from the edge.
    const double length_m = random.uniform(0.15, 0.3), height_m = random.uniform(0.04, 0.12);
    const double load_kg = random.uniform(0.1, 2.0), load_x_m = random.uniform(-0.3, 0.3) * length_m;
    for (const double factor : {0.95, 1.05}) {
      BodyGroup group({box(length_m, 0.1, height_m), box(0.03, 0.08, 0.03)});
      Mesh step = shapes::box(Eigen::Vector3f(1.0F, 1.0F, 0.5F));
      step.origin = Vec3(-0.5, 0.0, 0.25);
      group.add_surface(step);
      group.add_surface(shapes::floor(4.0F, 0.0F));
      group.mass_kg = {1.0, load_kg};
      const double x = 0.5 * length_m * (factor - 1.0) - load_kg * load_x_m / (1.0 + load_kg);
      group.put(0, {x, 0.0, 0.501 + 0.5 * height_m});
      group.put(1, {x + load_x_m, 0.0, 0.502 + height_m + 0.015});
      group.run(4.0, {});
      EXPECT_EQ(group.bodies[0].T_world_object.translation().z() < 0.5, factor > 1.0)
          << factor << " " << trial;
      EXPECT_EQ(group.deepest_m, 0.0);
    }
  }
}

/// Returns a plane that falls towards +x at an angle.
Mesh slope(double angle_rad) {
  const auto at = [&](double x, double y) -> Eigen::Vector3f {
    return Vec3(x * std::cos(angle_rad), y, -x * std::sin(angle_rad)).cast<float>();
  };
  Mesh mesh;
  shapes::add_quad(mesh, at(-3, -3), at(3, -3), at(3, 3), at(-3, 3));
  return mesh;
}

TEST(Statics, ABoxSlidesDownASlopeSteeperThanItsOwnFriction) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const double friction : {0.1, 0.3, 0.8, 1.2}) {
    for (const double beyond_rad : {-kDegree, kDegree}) {
      const double angle_rad = std::atan(friction) + beyond_rad;
      BodyGroup group({box(0.2, 0.2, 0.05)});
      group.add_surface(slope(angle_rad));
      group.bodies[0].material.friction = friction;
      const Eigen::AngleAxisd tilt(angle_rad, Vec3::UnitY());
      group.bodies[0].T_world_object.linear() = tilt.toRotationMatrix();
      group.put(0, tilt * Vec3(0.0, 0.0, 0.026));
      const Body put = group.bodies[0];
      group.run(1.0, {});
      const double slid_m = strayed_m(group.bodies[0], put.T_world_object);
      const double expected_m =
          0.5 * 9.81 * (std::sin(angle_rad) - friction * std::cos(angle_rad));  // after 1 s, if it slides
      if (beyond_rad < 0.0)
        EXPECT_LT(slid_m, 0.002) << friction;
      else
        EXPECT_NEAR(slid_m, expected_m, 0.02 * expected_m + 0.002) << friction;
    }
  }
}

TEST(Statics, FrictionBetweenTwoBodiesIsTheGeometricMean) {
  for (const double factor : {0.95, 1.05}) {  // of the slope at which the upper one slides
    BodyGroup group({box(0.4, 0.4, 0.05), box(0.1, 0.1, 0.05)});
    group.add_surface(shapes::floor(4.0F, 0.0F));
    group.bodies[0].material.friction = 0.4;
    group.bodies[1].material.friction = 0.9;
    group.is_carried[0] = true;  // held at rest
    group.put(0, {0.0, 0.0, 0.026});
    group.put(1, {0.0, 0.0, 0.077});
    const double slope_rad = std::atan(factor * 0.6);
    PhysicsConfig config;
    config.gravity_world_mps2 = 9.81 * Vec3(std::sin(slope_rad), 0.0, -std::cos(slope_rad));
    const Body put = group.bodies[1];
    group.run(0.5, config);
    EXPECT_EQ(strayed_m(group.bodies[1], put.T_world_object) > 0.01, factor > 1.0) << factor;
  }
}

TEST(Statics, ABallBouncesByItsOwnRestitution) {
  for (const double restitution : {0.3, 0.5, 0.8}) {
    BodyGroup group({shapes::ball(0.03F, 16, 24)});
    group.add_surface(shapes::floor(4.0F, 0.0F));
    group.frame_s = 1e-3;
    group.bodies[0].material.restitution = restitution;
    group.put(0, {0.0, 0.0, 1.03});
    double lowest_m = 1.03, highest_m = 0.0;
    for (int i = 0; i < 1200; ++i) {
      group.step({});
      const double z = group.bodies[0].T_world_object.translation().z();
      if (group.bodies[0].velocity_world_mps.z() > 0.0) highest_m = std::max(highest_m, z);
      lowest_m = std::min(lowest_m, z);
    }
    const double expected_m = restitution * restitution * (1.03 - lowest_m);
    EXPECT_NEAR(highest_m - lowest_m, expected_m, 0.03 * expected_m) << restitution;
  }
}

/// A column of cubes of 10 cm, asleep, of which nothing but its own bodies can disturb any.
BodyGroup sleeping_column(std::size_t cubes) {
  BodyGroup group = on_floor(std::vector<Mesh>(cubes, box(0.1, 0.1, 0.1)));
  for (std::size_t i = 0; i < cubes; ++i) group.put(i, {0.0, 0.0, 0.051 + 0.101 * static_cast<double>(i)});
  group.run(4.0, {});
  EXPECT_TRUE(group.all_asleep());
  group.is_undisturbed.assign(cubes, true);
  return group;
}

TEST(Statics, AllThatStoodOnWhatIsTakenAwayWakesWithinTwoFramesAndFalls) {
  constexpr std::size_t kCubes = 6, kTaken = 2;
  for (const bool is_carried_off : {false, true}) {
    BodyGroup group = sleeping_column(kCubes);
    if (is_carried_off) {
      group.is_carried[kTaken] = true;
      group.bodies[kTaken].asleep = false;
      group.bodies[kTaken].velocity_world_mps = {6.0, 0.0, 0.0};  // out from under the others in a frame
    } else {
      group.is_present[kTaken] = false;
    }
    group.run(2.0 * group.frame_s, {});
    for (std::size_t i = kTaken + 1; i < kCubes; ++i)
      EXPECT_FALSE(group.bodies[i].asleep) << i << " " << is_carried_off;
    group.run(2.0, {});
    for (std::size_t i = kTaken + 1; i < kCubes; ++i)
      EXPECT_LT(group.bodies[i].T_world_object.translation().z(),
                0.051 + 0.101 * (static_cast<double>(i) - 0.5))
          << i << " " << is_carried_off;
    EXPECT_EQ(group.deepest_m, 0.0);
  }
}

TEST(Statics, AColumnWakesWhenTheSurfaceUnderItIsCarvedAway) {
  BodyGroup group = sleeping_column(5);
  group.remove_surfaces();
  group.add_surface(shapes::floor(4.0F, -0.5F));
  group.is_undisturbed.assign(5, false);  // as after a change of the map
  group.run(2.0 * group.frame_s, {});
  for (const Body& body : group.bodies) EXPECT_FALSE(body.asleep);
  group.run(2.0, {});
  EXPECT_NEAR(group.bodies[0].T_world_object.translation().z(), -0.449, 1e-3);
  EXPECT_EQ(group.deepest_m, 0.0);
}

TEST(Statics, ABoardThatLosesOneOfTwoSupportsTipsIfItsCentreIsNotOverTheOther) {
  // The support that stays ends at x = 0.
  for (const double centre_m : {-0.0105, 0.0105}) {  // 5 % of the board's half length to either side
    BodyGroup group = on_floor({box(0.42, 0.1, 0.02), box(0.1, 0.1, 0.1), box(0.1, 0.1, 0.1)});
    group.put(1, {-0.05, 0.0, 0.051});
    group.put(2, {0.1, 0.0, 0.051});
    group.put(0, {centre_m, 0.0, 0.112});
    group.run(2.0, {});
    ASSERT_TRUE(group.all_asleep());
    group.is_undisturbed.assign(3, true);
    group.is_present[2] = false;
    const double level = group.bodies[0].T_world_object.linear()(2, 2);
    EXPECT_GT(level, 1.0 - 1e-6);
    group.run(2.0 * group.frame_s, {});
    EXPECT_FALSE(group.bodies[0].asleep) << centre_m;
    group.run(1.5, {});
    EXPECT_EQ(group.bodies[0].T_world_object.linear()(2, 2) < 0.99, centre_m > 0.0) << centre_m;
    EXPECT_EQ(group.deepest_m, 0.0);
  }
}

TEST(Statics, WeightWakesWhatSleepsAndBearsThroughSeveralBodies) {
  // A column of three on the end of a board over an edge, put there one after the other: two are too light.
  BodyGroup group = on_floor({box(0.4, 0.2, 0.02), box(0.2, 0.2, 0.1), box(0.06, 0.06, 0.06),
                              box(0.06, 0.06, 0.06), box(0.06, 0.06, 0.06)});
  group.mass_kg = {1.0, 50.0, 0.16, 0.16, 0.16};  // board: 1 kg x 5 cm; load arm 12 cm: tips at 0.417 kg
  group.put(1, {-0.1, 0.0, 0.051});
  group.put(0, {-0.05, 0.0, 0.112});
  for (std::size_t i = 2; i < 5; ++i) group.put(i, {2.0 + static_cast<double>(i), 0.0, 0.031});
  for (std::size_t i = 2; i < 5; ++i) {
    group.put(i, {0.12, 0.0, 0.154 + 0.0612 * static_cast<double>(i - 2)});
    group.bodies[i].asleep = false;
    bool has_tipped = false;  // the column slides off the tipping board, which then falls back
    for (int frame = 0; frame < 90; ++frame) {
      group.step({});
      has_tipped |= group.bodies[0].T_world_object.linear()(2, 2) < 0.99;
    }
    EXPECT_EQ(has_tipped, i == 4) << i;
  }
  EXPECT_EQ(group.deepest_m, 0.0);
}

}  // namespace
}  // namespace roomradar::statics_test
