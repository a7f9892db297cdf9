// physics_with_radar_test.cpp: the teapot among meshes, moved with the real radar, checked against
// exact_travel.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "app/objects/teapot.hpp"
#include "app/physics/depenetration.hpp"
#include "app/physics/physics.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::physics_with_radar_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kTableTop_m = 0.7;

/// A level sheet of 1 cm triangles over [-half, half]^2 about (x, y), facing up, rough by uniform noise.
Mesh sheet(double half_m, double height_m, double noise_m = 0.0) {
  Mesh mesh;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-noise_m, noise_m);
  const int steps = static_cast<int>(half_m / 0.005);
  const auto n = static_cast<std::uint32_t>(steps + 1);
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i)
      mesh.vertices.emplace_back(static_cast<float>(-half_m + 0.01 * i),
                                 static_cast<float>(-half_m + 0.01 * j),
                                 static_cast<float>(height_m + noise(random)));
  for (std::uint32_t j = 0; j + 1 < n; ++j) {
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = j * n + i;
      mesh.triangles.push_back({a, a + 1, a + n});
      mesh.triangles.push_back({a + 1, a + n + 1, a + n});
    }
  }
  return mesh;
}

/// An upright sheet at x_m that faces +x, like the camera's mesh of a hand's visible side.
Mesh palm(double x_m) {
  Mesh mesh = sheet(0.06, 0.0);
  for (Eigen::Vector3f& v : mesh.vertices) v = {static_cast<float>(x_m) + v.z(), v.x(), v.y() + 0.78F};
  return mesh;
}

class PhysicsWithRadar : public ::testing::Test {
 protected:
  PhysicsWithRadar() {
    teapot_.build_by_place(teapot_mesh_);
    body_.mass = mass_properties(teapot_mesh_, teapot_.is_closed());
    body_.T_world_object.translation() = Vec3(0, 0, kTableTop_m + 0.3);
  }
  void set_table(const Mesh& mesh) {
    table_mesh_ = mesh;
    table_.build_by_place(mesh);
  }
  StepReport step() {
    const std::vector<SceneTree> scene = {{{&table_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic},
                                          {{&hand_, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic}};
    const RadarScene radar_scene{scene, {}};
    const PushDirections push =
        depenetration_directions({&hand_mesh_}, body_.T_world_object * Vec3(0, 0, 0.07), 0.25);
    return advance(body_, kFrame_s, make_collision_queries(radar_, teapot_, radar_scene), {}, push.span());
  }
  void set_hand(const Mesh& mesh) {
    hand_mesh_ = mesh;
    hand_.build_in_order(mesh);
  }
  /// Gap between the teapot and the table along gravity; negative: depth of the overlap.
  [[nodiscard]] double exact_gap_m() const {
    Eigen::Isometry3d raised = body_.T_world_object;
    raised.translation().z() += 0.05;
    const std::optional<double> contact_distance_m =
        exact_travel(teapot_mesh_, raised, -Vec3::UnitZ(), 0.5, table_mesh_, Eigen::Isometry3d::Identity());
    return contact_distance_m ? *contact_distance_m - 0.05 : 1.0;
  }

  CyberRadar radar_;
  Mesh teapot_mesh_ = utah_teapot(8, 0.15);
  TriangleTree teapot_, table_, hand_;
  Mesh table_mesh_, hand_mesh_;
  Body body_;
};

TEST_F(PhysicsWithRadar, TheTeapotRestsOnTheTableWithinAFewMillimetres) {
  set_table(sheet(0.4, kTableTop_m));
  for (int i = 0; i < 45; ++i) EXPECT_EQ(step().status, StepStatus::kMoved);
  EXPECT_TRUE(body_.asleep);
  EXPECT_GE(exact_gap_m(), 0.0);
  EXPECT_LE(exact_gap_m(), 0.002);  // a margin of 1 mm
  const Vec3 before = body_.T_world_object.translation();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(step().queries, 1);
  EXPECT_EQ(body_.T_world_object.translation(), before);
}

TEST_F(PhysicsWithRadar, ARoughTableHoldsItWithoutCreeping) {
  set_table(sheet(0.4, kTableTop_m, 0.004));
  double deepest_m = 0.0;
  for (int i = 0; i < 60; ++i) {
    (void)step();
    deepest_m = std::max(deepest_m, -exact_gap_m());
  }
  EXPECT_TRUE(body_.asleep);
  EXPECT_LT(deepest_m, 0.004);  // the requirement is 10 mm
  EXPECT_LT(body_.T_world_object.translation().head<2>().norm(), 0.03);
}

TEST_F(PhysicsWithRadar, ThrownItSlidesAndStops) {
  set_table(sheet(0.8, kTableTop_m));
  body_.T_world_object.translation() = Vec3(-0.5, 0, kTableTop_m + 0.05);
  body_.velocity_world_mps = {1.5, 0, 0};
  double deepest_m = 0.0;
  for (int i = 0; i < 60; ++i) {
    (void)step();
    deepest_m = std::max(deepest_m, -exact_gap_m());
  }
  EXPECT_TRUE(body_.asleep);
  EXPECT_GT(body_.T_world_object.translation().x(), -0.4);
  EXPECT_LT(body_.T_world_object.translation().x(), 0.2);
  EXPECT_LT(deepest_m, 0.002);
}

TEST_F(PhysicsWithRadar, APalmPushesItAlongTheTable) {
  set_table(sheet(0.8, kTableTop_m));
  body_.T_world_object.translation() = Vec3(0, 0, kTableTop_m + 0.003);
  body_.asleep = true;
  double palm_x_m = -0.25;  // the handle ends at -0.15
  double deepest_m = 0.0;
  for (int i = 0; i < 60; ++i) {
    palm_x_m += 0.01;  // 0.3 m/s
    set_hand(palm(palm_x_m));
    (void)step();
    deepest_m = std::max(deepest_m, -exact_gap_m());
  }
  EXPECT_NEAR(body_.T_world_object.translation().x(), 0.35 + 0.15, 0.03);
  EXPECT_LT(deepest_m, 0.003);
  EXPECT_LT(exact_gap_m(), 0.01);
}

TEST_F(PhysicsWithRadar, AHandLiftsItFromBelowAndLetsItFall) {
  set_table(sheet(0.4, kTableTop_m));
  body_.T_world_object.translation() = Vec3(0, 0, kTableTop_m + 0.1);
  double hand_z_m = kTableTop_m + 0.05;
  for (int i = 0; i < 60; ++i) {
    hand_z_m += 0.005;
    set_hand(sheet(0.06, hand_z_m));
    (void)step();
  }
  EXPECT_NEAR(body_.T_world_object.translation().z(), hand_z_m, 0.01);
  set_hand({});
  for (int i = 0; i < 120; ++i) (void)step();  // a pot wobbles for a while
  EXPECT_TRUE(body_.asleep);
  EXPECT_NEAR(exact_gap_m(), 0.002, 0.002);
}

}  // namespace
}  // namespace roomradar::physics_with_radar_test
