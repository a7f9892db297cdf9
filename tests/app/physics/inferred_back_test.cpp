// inferred_back_test.cpp: a hand with an assumed back among virtual objects: it supports and pushes them, but
// does not throw them.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/physics/depenetration.hpp"
#include "app/physics/physics.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar::inferred_back_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kHand_m = 0.05;  // radius of a fist
constexpr double kCube_m = 0.04;  // half a side
constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 160.0, 120.0};

Mesh cube() {
  Mesh mesh;
  const auto h = static_cast<float>(kCube_m);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back((i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? h : -h);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh table(double height_m) {
  Mesh mesh;
  const auto z = static_cast<float>(height_m);
  mesh.vertices = {{-2, -2, z}, {2, -2, z}, {2, 2, z}, {-2, 2, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// A camera at the world's origin that looks along +y, and a fist in front of it.
class InferredBack : public ::testing::Test {
 protected:
  InferredBack() {
    T_world_camera_.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    cube_.build_by_place(cube());
    table_.build_by_place(table(-kCube_m - 0.001));
  }

  void see_hand(const Vec3& centre_world, double radius_m = kHand_m) {
    DepthImage depth_m(kCamera.width_px, kCamera.height_px);
    MaskImage mask(kCamera.width_px, kCamera.height_px, 0);
    const Vec3 centre = T_world_camera_.inverse() * centre_world;
    for (int y = 0; y < depth_m.height; ++y) {
      for (int x = 0; x < depth_m.width; ++x) {
        const Vec3 ray = back_project(kCamera, x, y, 1.0);
        const double b = ray.dot(centre), a = ray.squaredNorm();
        const double root = b * b - a * (centre.squaredNorm() - radius_m * radius_m);
        if (root <= 0.0) continue;
        depth_m.at(x, y) = static_cast<float>((b - std::sqrt(root)) / a);
        mask.at(x, y) = 255;
      }
    }
    const FineRegion near_body{body_.T_world_object.translation(), 2.0 * kCube_m};
    mesh_dynamic({{depth_m, kCamera, T_world_camera_}, mask, DepthImage(kCamera.width_px, kCamera.height_px)},
                 {&near_body, 1}, {}, scratch_, surface_);
    seen_.build_in_order(surface_.seen_world);
    inferred_.build_in_order(surface_.inferred_world);
  }

  [[nodiscard]] Contact ask(const Vec3& at, const Vec3& direction, double distance_m,
                            const std::vector<SceneTree>& scene) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = at;
    return radar_.query({{&cube_, T}, direction, distance_m}, {scene, {}});
  }
  [[nodiscard]] SceneTree seen() const {
    return {{&seen_, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic};
  }
  [[nodiscard]] SceneTree inferred() const {
    return {{&inferred_, Eigen::Isometry3d::Identity()}, SurfaceKind::kInferredBack};
  }

  StepReport step() {
    std::vector<SceneTree> scene = {{{&table_, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}, seen()};
    const PushDirections push = depenetration_directions({&surface_.seen_world, &surface_.inferred_world},
                                                         body_.T_world_object.translation(), 0.25);
    const std::vector<SceneTree> back = {inferred()};
    const RadarScene of_back{back, {}};
    const CollisionQueries back_probe = make_collision_queries(radar_, cube_, of_back);
    if (!is_engulfed(body_, kFrame_s, back_probe.travel, {}, push.span())) scene.push_back(inferred());
    const RadarScene of_all{scene, {}};
    return advance(body_, kFrame_s, make_collision_queries(radar_, cube_, of_all), {}, push.span());
  }

  CyberRadar radar_;
  Eigen::Isometry3d T_world_camera_ = Eigen::Isometry3d::Identity();
  DynamicSurfaceScratch scratch_;
  DynamicSurface surface_;
  TriangleTree cube_, table_, seen_, inferred_;
  Body body_;
};

TEST_F(InferredBack, WhatComesFromBehindStopsAtTheBack) {
  see_hand({0.0, 0.8, 0.0});
  const Contact contact = ask({0.0, 1.3, 0.0}, -Vec3::UnitY(), 1.0, {seen(), inferred()});
  ASSERT_EQ(contact.status, ContactStatus::kContact);
  EXPECT_EQ(contact.touched, SurfaceKind::kInferredBack);
  EXPECT_NEAR(contact.contact_distance_m, 1.3 - kCube_m - 0.8 - kHand_m, 0.02);
  EXPECT_GT(contact.normal_world.y(), 0.7) << "faces the object";
  // Without its back the object enters the hand.
  const Contact open = ask({0.0, 1.3, 0.0}, -Vec3::UnitY(), 1.0, {seen()});
  EXPECT_GT(open.contact_distance_m, contact.contact_distance_m + 0.9 * kHand_m);
}

TEST_F(InferredBack, EachSideSaysWhatItIs) {
  see_hand({0.0, 0.8, 0.0});
  const Contact front = ask({0.0, 0.5, 0.0}, Vec3::UnitY(), 1.0, {seen(), inferred()});
  EXPECT_EQ(front.touched, SurfaceKind::kDynamic);
  EXPECT_NEAR(front.contact_distance_m, 0.3 - kCube_m - kHand_m, 0.003);
  for (const double behind_m : {0.0, 0.02}) {  // beside the outline, where there is only the back
    const Contact side =
        ask({0.3, 0.8 + kCube_m + 0.005 + behind_m, 0.0}, -Vec3::UnitX(), 1.0, {seen(), inferred()});
    ASSERT_EQ(side.status, ContactStatus::kContact) << behind_m;
    EXPECT_EQ(side.touched, SurfaceKind::kInferredBack);
  }
}

TEST_F(InferredBack, WhatIsInsideLeavesAnyWayButThroughTheFront) {
  see_hand({0.0, 1.0, 0.0}, 0.2);  // a hull that appears around the cube
  const Vec3 at(0.0, 0.95, 0.0);
  for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(0, 1, 0.3), Vec3(0.3, 1, 0)}) {
    EXPECT_EQ(ask(at, direction, 1.0, {seen(), inferred()}).status, ContactStatus::kNoTarget);
  }
  // Also halfway out of it.
  EXPECT_EQ(ask({0.0, 1.15, 0.0}, Vec3::UnitY(), 1.0, {seen(), inferred()}).status, ContactStatus::kNoTarget);
}

TEST_F(InferredBack, AHandPushesFromAnySide) {
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
    const Vec3 start(0.0, 1.0, 0.0);
    body_ = Body{};
    body_.T_world_object.translation() = start;
    body_.asleep = true;
    double fastest_mps = 0.0;
    for (int frame = 0; frame < 18; ++frame) {  // 0.5 m/s, from 17 cm before to 13 cm past the cube
      see_hand(start + direction * (-0.17 + 0.5 * kFrame_s * frame));
      const Vec3 before = body_.T_world_object.translation();
      EXPECT_EQ(step().status, StepStatus::kMoved);
      fastest_mps = std::max(fastest_mps, (body_.T_world_object.translation() - before).norm() / kFrame_s);
    }
    const double went_m = (body_.T_world_object.translation() - start).dot(direction);
    EXPECT_GT(went_m, 0.113 + kHand_m) << direction.transpose() << ": the hand went through";
    EXPECT_LT(went_m, 0.113 + kHand_m + kCube_m + 0.05) << direction.transpose() << ": flung";
    EXPECT_LT(fastest_mps, 1.5) << direction.transpose();
    EXPECT_NEAR(body_.T_world_object.translation().z(), 0.0, 0.002);
  }
}

TEST_F(InferredBack, ABodyThatTheBackComesAboutStaysWhereItIs) {
  const Vec3 start(0.0, 1.02, 0.0);
  for (const double radius_m : {0.1, 0.07}) {
    body_ = Body{};
    body_.T_world_object.translation() = start;
    body_.asleep = true;
    for (int frame = 0; frame < 20; ++frame) {  // appears suddenly; the back extends 7 cm into the cube
      see_hand(start - Vec3(0.0, radius_m + kCube_m - 0.07, 0.0), radius_m);
      EXPECT_EQ(step().status, StepStatus::kMoved);
    }
    EXPECT_LT((body_.T_world_object.translation() - start).norm(), 0.001) << radius_m;
  }
  // A body wholly inside a hull falls out of it.
  body_ = Body{};
  body_.T_world_object.translation() = start + Vec3(0.0, 0.0, 0.06);
  see_hand(start + Vec3(0.0, 0.1, 0.15), 0.3);
  for (int frame = 0; frame < 30; ++frame) (void)step();
  EXPECT_NEAR(body_.T_world_object.translation().z(), 0.0, 0.003);
  EXPECT_LT((body_.T_world_object.translation() - start).norm(), 0.005);
}

}  // namespace
}  // namespace roomradar::inferred_back_test
