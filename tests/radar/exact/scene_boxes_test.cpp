// scene_boxes_test.cpp: of many trees only those near a query are tested, and the result is the same.
#include "radar/exact/scene_boxes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::scene_boxes_test {
namespace {

class SceneBoxesTest : public ::testing::Test {
 protected:
  std::mt19937 random{2};
  JudgedMesh ball{shapes::ball(0.1F, 12, 16)}, torus{shapes::torus(30, 20, 0.12F, 0.04F, 0.01F)};
  std::vector<SceneTree> crowd(int count) {
    std::vector<SceneTree> trees;
    for (int i = 0; i < count; ++i) {
      Eigen::Isometry3d T(shapes::random_rotation(random));
      T.pretranslate(2.0 * shapes::random_point(random) + Eigen::Vector3d(1e5, 0.0, -1e5));
      trees.push_back({{i % 2 == 0 ? &ball.tree : &torus.tree, T}, SurfaceKind::kObject});
    }
    return trees;
  }
};

TEST_F(SceneBoxesTest, EachIsSceneForTheOthersWithAndWithoutBoxes) {
  std::vector<SceneTree> trees = crowd(400);
  SceneBoxes boxes;
  boxes.build(std::span<const SceneTree>(trees));
  CyberRadar radar;
  int met = 0;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    RadarQuery query{.object = trees[i].instance,
                     .direction_world = shapes::random_point(random),
                     .distance_m = 1.0,
                     .own_tree = i};
    const Contact with = radar.query(query, {.trees = trees, .depths = {}, .boxes = &boxes});
    const Contact without = radar.query(query, {.trees = trees, .depths = {}});
    std::vector<SceneTree> others = trees;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    query.own_tree = RadarQuery::kNotInScene;
    const Contact among_others = radar.query(query, {.trees = others, .depths = {}});
    for (const Contact& other : {without, among_others}) {
      ASSERT_EQ(with.status, other.status) << i;
      ASSERT_EQ(with.contact_distance_m, other.contact_distance_m) << i;
      ASSERT_EQ(with.lower_m, other.lower_m) << i;
    }
    met += with ? 1 : 0;
  }
  EXPECT_GT(met, 50);
}

TEST_F(SceneBoxesTest, APoseThatIsNotFiniteIsRefusedAndNothingIsLeftOut) {
  std::vector<SceneTree> trees = crowd(10);
  trees.push_back({});
  SceneBoxes boxes;
  boxes.build(std::span<const SceneTree>(trees));
  EXPECT_TRUE(boxes.are_finite());
  trees[3].instance.T_world_mesh.translation().x() = std::numeric_limits<double>::quiet_NaN();
  boxes.build(std::span<const SceneTree>(trees));
  EXPECT_FALSE(boxes.are_finite());
  CyberRadar radar;
  const RadarQuery query{.object = {&ball.tree, Eigen::Isometry3d::Identity()},
                         .direction_world = Eigen::Vector3d::UnitX(),
                         .distance_m = 1.0};
  EXPECT_EQ(radar.query(query, {.trees = trees, .depths = {}, .boxes = &boxes}).status,
            ContactStatus::kInvalidInput);
}

TEST_F(SceneBoxesTest, OfNothingIsNothing) {
  SceneBoxes boxes;
  boxes.build(std::span<const SceneTree>());
  CyberRadar radar;
  const RadarQuery query{.object = {&ball.tree, Eigen::Isometry3d::Identity()},
                         .direction_world = Eigen::Vector3d::UnitX(),
                         .distance_m = 1.0};
  EXPECT_EQ(radar.query(query, {.trees = {}, .depths = {}, .boxes = &boxes}).status,
            ContactStatus::kNoTarget);
}

}  // namespace
}  // namespace roomradar::scene_boxes_test
