// free_pose_test.cpp: ways of a box out of floors and corners.
#include "app/physics/placement/free_pose.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "radar/geometry/triangle_tree.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::free_pose_test {
namespace {

using Vec3 = Eigen::Vector3d;

/// A box of 10 cm, and surfaces of the room.
struct Scene {
  TriangleTree box_tree;
  std::vector<TriangleTree> trees;
  std::vector<SceneTree> surfaces;
  CyberRadar radar;

  explicit Scene(const std::vector<Mesh>& meshes, SurfaceKind kind = SurfaceKind::kStatic) {
    box_tree.build_by_place(shapes::box(Eigen::Vector3f::Constant(0.1F)));
    trees.resize(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      trees[i].build_by_place(meshes[i]);
      surfaces.push_back({{&trees[i], Eigen::Isometry3d::Identity()}, kind});
    }
  }
  TreeInstance at(const Vec3& middle) const {
    TreeInstance box{&box_tree, Eigen::Isometry3d::Identity()};
    box.T_world_mesh.translation() = middle;
    return box;
  }
  std::optional<FreePose> leave(const Vec3& middle, double max_m,
                                const std::function<bool(const Eigen::Isometry3d&)>& is_allowed = {}) {
    return nearest_free_pose(at(middle), surfaces, 0.001, max_m, is_allowed, radar);
  }
};

/// Wall in the plane x = 0, facing +x.
Mesh wall() {
  Mesh mesh;
  shapes::add_quad(mesh, {0, -2, -2}, {0, 2, -2}, {0, 2, 2}, {0, -2, 2});
  return mesh;
}

TEST(FreePose, ABoxInTheFloorRisesAndDoesNotFallThrough) {
  Scene scene({shapes::floor(2.0F, 0.0F)});
  // Its middle is below the floor: the shorter way would be down.
  for (const double middle_m : {0.04, 0.0, -0.02, -0.045}) {
    EXPECT_TRUE(is_crossed(scene.at({0, 0, middle_m}), scene.surfaces));
    const auto free = scene.leave({0, 0, middle_m}, 0.1);
    ASSERT_TRUE(free) << middle_m;
    EXPECT_NEAR(free->moved_m, 0.05 - middle_m, 0.0012 + 0.1 / 20 / 32);
    EXPECT_NEAR(free->T_world_object.translation().z(), 0.05, 0.0012 + 0.1 / 20 / 32);
    EXPECT_FALSE(is_crossed({&scene.box_tree, free->T_world_object}, scene.surfaces));
  }
}

TEST(FreePose, InACornerItLeavesBothSurfacesAtOnce) {
  Scene scene({shapes::floor(2.0F, 0.0F), wall()});
  const auto free = scene.leave({0.03, 0.5, 0.03}, 0.1);
  ASSERT_TRUE(free);
  EXPECT_GT(free->T_world_object.translation().x(), 0.05);
  EXPECT_GT(free->T_world_object.translation().z(), 0.05);
  EXPECT_LT(free->moved_m, 0.04);
}

TEST(FreePose, WithoutAWayInReachThereIsNone) {
  Scene scene({shapes::floor(2.0F, 0.0F)});
  EXPECT_FALSE(scene.leave({0, 0, 0.0}, 0.04));
  // A ceiling at 9 cm: no space for a box of 10 cm.
  Mesh ceiling = shapes::floor(2.0F, 0.09F);
  for (Triangle& triangle : ceiling.triangles) std::swap(triangle[1], triangle[2]);
  Scene slot({shapes::floor(2.0F, 0.0F), ceiling});
  EXPECT_FALSE(slot.leave({0, 0, 0.045}, 0.1));
}

TEST(FreePose, KeepsToAllowedPoses) {
  Scene scene({shapes::floor(2.0F, 0.0F)});
  const auto low = [](const Eigen::Isometry3d& T) { return T.translation().z() < 0.01; };
  EXPECT_FALSE(scene.leave({0, 0, 0.0}, 0.1, low));
  const auto left = [](const Eigen::Isometry3d& T) { return T.translation().x() < -0.01; };
  const auto free = scene.leave({0, 0, 0.02}, 0.1, left);
  ASSERT_TRUE(free);
  EXPECT_LT(free->T_world_object.translation().x(), -0.01);
}

TEST(FreePose, OneSidedSurfacesDoNotCross) {
  Scene scene({shapes::floor(2.0F, 0.0F)}, SurfaceKind::kUnknownFrontier);
  EXPECT_FALSE(is_crossed(scene.at({0, 0, 0.0}), scene.surfaces));
}

}  // namespace
}  // namespace roomradar::free_pose_test
