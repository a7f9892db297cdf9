// radar_allocation_test.cpp: after its first queries a radar allocates no more memory.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "radar/exact/cyber_radar.hpp"
#include "radar/exact/scene_boxes.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/allocation_count.hpp"

namespace roomradar::radar_allocation_test {
namespace {

TEST(RadarAllocation, AQueryTakesNothingFromTheHeapAfterTheFirstOnesOfItsSize) {
  DepthImage depth_m(320, 240);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x)
      depth_m.at(x, y) = 1.4F + 0.05F * std::sin(0.2F * static_cast<float>(x + y));
  }
  SceneDepth depth;
  depth.depth_m = &depth_m;
  depth.camera = {320, 240, 260.0, 260.0, 159.5, 119.5};
  depth.T_world_camera =
      Eigen::Translation3d(0.0, 0.0, 1.3) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());  // looks down
  const JudgedMesh ground(shapes::bumpy_ground(60)), ball(shapes::ball(0.1F, 12, 16));
  std::vector<SceneTree> trees = {{{&ground.tree, ground.T_world_mesh}, SurfaceKind::kStatic}};
  std::mt19937 random(8);
  for (int i = 0; i < 40; ++i) {
    trees.push_back({{&ball.tree, Eigen::Isometry3d(Eigen::Translation3d(shapes::random_point(random)))},
                     SurfaceKind::kObject});
  }
  SceneBoxes boxes;
  const std::vector<JudgedMesh> objects = {JudgedMesh(shapes::box({0.2F, 0.1F, 0.2F})),
                                           JudgedMesh(shapes::torus(60, 40, 0.12F, 0.05F, 0.02F))};
  for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled}) {
    CyberRadar radar({.mode = mode});
    int contacts = 0, overlaps = 0, free = 0;
    // Poses that are free, sunk or among the scene's objects; with and without margin; new and repeated
    // queries.
    const auto ask_all = [&] {
      boxes.build(std::span<const SceneTree>(trees));
      const RadarScene scene{.trees = trees, .depths = {&depth, 1}, .boxes = &boxes};
      std::mt19937 pose_random(9);
      for (int i = 0; i < 200; ++i) {
        Eigen::Isometry3d T(shapes::random_rotation(pose_random));
        T.pretranslate(0.5 * shapes::random_point(pose_random) + Eigen::Vector3d(0.0, 0.0, 0.4));
        const Eigen::Vector3d direction = shapes::random_point(pose_random);
        for (int kept = 0; kept < 4; ++kept) {
          const Contact contact = radar.query({.object = {&objects[static_cast<std::size_t>(i % 2)].tree, T},
                                               .direction_world = direction,
                                               .distance_m = 0.5,
                                               .margin_m = i % 5 == 0 ? 0.01 : 0.0},
                                              scene);
          contacts += contact.status == ContactStatus::kContact ? 1 : 0;
          overlaps += contact.status == ContactStatus::kOverlap ? 1 : 0;
          free += contact.status == ContactStatus::kNoTarget ? 1 : 0;
        }
      }
    };
    ask_all();
    const std::size_t before = test::allocations;
    ask_all();
    EXPECT_EQ(test::allocations - before, 0U) << to_string(mode);
    EXPECT_GT(contacts, 100);
    EXPECT_GT(overlaps, 100);
    EXPECT_GT(free, 20);
  }
}

TEST(RadarAllocation, QueriesThatAreCutShortTakeNoMoreFromTheHeapEachTime) {
  // A ball, sunk in ground of 2 mm cells, moves out of it towards a wall that it hits from behind.
  const JudgedMesh ground([] {
    Mesh mesh = shapes::bumpy_ground(500);
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= 0.5F;
    return mesh;
  }());
  const JudgedMesh ball(shapes::ball(0.1F, 40, 60)), wall(shapes::floor(1.0F, 0.25F));
  const SceneTree trees[] = {{{&ground.tree, ground.T_world_mesh}, SurfaceKind::kStatic},
                             {{&wall.tree, wall.T_world_mesh}, SurfaceKind::kDynamic}};
  CyberRadar radar;
  const auto ask_all = [&] {
    int cut_short = 0;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Isometry3d T(Eigen::Translation3d(0.01 * i - 0.1, 0.05 - 0.005 * i, 0.02));
      const Contact got = radar.query(
          {.object = {&ball.tree, T}, .direction_world = Eigen::Vector3d::UnitZ(), .distance_m = 0.3},
          {.trees = trees, .depths = {}});
      cut_short += got.lower_m == 0.0 ? 1 : 0;
    }
    return cut_short;
  };
  EXPECT_GT(ask_all(), 5);
  const std::size_t before = test::allocations;
  for (int again = 0; again < 3; ++again) ask_all();
  EXPECT_EQ(test::allocations - before, 0U);
}

}  // namespace
}  // namespace roomradar::radar_allocation_test
