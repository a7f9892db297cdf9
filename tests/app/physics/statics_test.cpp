// statics_test.cpp: stacks, arches and boards stand, tip and slide as statics says.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

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

TEST(Statics, AnOverhangOfFourBoardsStandsUpToTheHarmonicLimit) {
  // Each board of length 0.4 m may reach beyond the one below by 0.2/1, 0.2/2, 0.2/3 m from the top down.
  for (const double factor : {0.95, 1.05}) {
    BodyGroup group = on_floor(std::vector<Mesh>(4, box(0.4, 0.2, 0.04)));
    double x = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i > 0) x += factor * 0.2 / static_cast<double>(4 - i);
      group.put(i, {x, 0.0, 0.021 + 0.041 * static_cast<double>(i)});
    }
    if (factor < 1.0) {
      expect_to_stand(group, 10.0, "overhang");
    } else {
      const Body put = group.bodies[3];
      group.run(4.0, {});
      EXPECT_GT(strayed_m(group.bodies[3], put.T_world_object), 0.02);
    }
  }
}

TEST(Statics, ASeesawTipsToTheHeavierSide) {
  // A board over a ridge of 4 cm, loads at 0.3 m to either side: it stays as long as both lie within its top.
  const double arm_m = 0.3, half_ridge_m = 0.02, board_kg = 1.0;
  for (const double factor : {0.95, 1.05}) {
    for (const double side : {-1.0, 1.0}) {
      BodyGroup group({box(0.8, 0.2, 0.02), box(0.06, 0.1, 0.06), box(0.06, 0.1, 0.06)});
      group.add_surface(shapes::floor(4.0F, 0.0F));
      Mesh ridge = shapes::box(Eigen::Vector3f(0.04F, 0.4F, 0.2F));
      ridge.origin.z() = 0.1;
      group.add_surface(ridge);
      // The heavier load tips it if m (arm - half) > half board + 1 kg (arm + half).
      const double limit_kg = (half_ridge_m * board_kg + arm_m + half_ridge_m) / (arm_m - half_ridge_m);
      group.mass_kg = {board_kg, 1.0, factor * limit_kg};
      group.put(0, {0.0, 0.0, 0.211});
      group.put(1, {-side * arm_m, 0.0, 0.252});
      group.put(2, {side * arm_m, 0.0, 0.252});
      group.run(4.0, {});
      const bool has_tipped = group.bodies[0].T_world_object.linear()(2, 2) < 0.99;
      EXPECT_EQ(has_tipped, factor > 1.0) << factor << " " << side;
      EXPECT_EQ(group.deepest_m, 0.0);
    }
  }
}

TEST(Statics, ABoxOverAnEdgeTipsPastItsMiddle) {
  for (const double factor : {0.95, 1.05}) {
    BodyGroup group({box(0.2, 0.1, 0.1)});
    Mesh step = shapes::box(Eigen::Vector3f(1.0F, 1.0F, 0.5F));
    step.origin = Vec3(-0.5, 0.0, 0.25);
    group.add_surface(step);
    group.add_surface(shapes::floor(4.0F, 0.0F));
    group.put(0, {0.1 * (factor - 1.0), 0.0, 0.551});  // its middle 5 mm to either side of the edge
    group.run(4.0, {});
    EXPECT_EQ(group.bodies[0].T_world_object.translation().z() < 0.5, factor > 1.0) << factor;
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
