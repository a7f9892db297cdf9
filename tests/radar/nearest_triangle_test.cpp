// nearest_triangle_test.cpp: the triangle under a point, and the right one of two at an edge.
#include "radar/nearest_triangle.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/radar/shapes.hpp"

namespace roomradar {
namespace {

class NearestTriangleTest : public testing::Test {
 protected:
  GlContext context;
  GpuMesh gpu{context};
};

TEST_F(NearestTriangleTest, OfTwoAtAnEdgeTheOneThatOpposesTheMotion) {
  gpu.upload(shapes::box({0.2F, 0.2F, 0.2F}), MeshUsage::kStatic);
  const MeshInstance instance{&gpu, Eigen::Isometry3d::Identity()};
  const Eigen::Vector3d on_upper_edge(0.1, 0.03, 0.1);
  for (const Eigen::Vector3d& u :
       {Eigen::Vector3d(-0.1, 0, -1).normalized(), Eigen::Vector3d(-1, 0, -0.1).normalized()}) {
    const auto found = nearest_triangle(instance, on_upper_edge, u, 1e-3);
    ASSERT_TRUE(found);
    const Eigen::Vector3d expected = u.z() < -0.5 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    EXPECT_NEAR((found->normal_world - expected).norm(), 0.0, 1e-9);
  }
}

TEST_F(NearestTriangleTest, SameAsLookingAtDensePointsOfEveryTriangle) {
  const Mesh mesh = shapes::torus(20, 12, 0.3F, 0.1F, 0.02F);
  gpu.upload(mesh, MeshUsage::kStatic);
  std::mt19937 random(1);
  Eigen::Isometry3d T_world_mesh(shapes::random_rotation(random));
  T_world_mesh.pretranslate(Eigen::Vector3d(1e6, -1e6, 1e6));
  const MeshInstance instance{&gpu, T_world_mesh};
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p_mesh = 0.4 * shapes::random_point(random);
    double expected_m = std::numeric_limits<double>::infinity();
    constexpr int kSteps = 24;
    for (const Triangle& t : mesh.triangles) {
      for (int a = 0; a <= kSteps; ++a) {
        for (int b = 0; a + b <= kSteps; ++b) {
          const double wa = static_cast<double>(a) / kSteps, wb = static_cast<double>(b) / kSteps;
          const Eigen::Vector3d q = wa * mesh.vertices[t[0]].cast<double>() +
                                    wb * mesh.vertices[t[1]].cast<double>() +
                                    (1.0 - wa - wb) * mesh.vertices[t[2]].cast<double>();
          expected_m = std::min(expected_m, (q - p_mesh).norm());
        }
      }
    }
    const auto found = nearest_triangle(instance, T_world_mesh * p_mesh, Eigen::Vector3d::UnitX(), 1.0);
    ASSERT_TRUE(found);
    EXPECT_LE(found->distance_m, expected_m + 1e-6);
    EXPECT_GE(found->distance_m, expected_m - 4e-3);  // points 5 mm apart on triangles of 10 cm
    EXPECT_FALSE(
        nearest_triangle(instance, T_world_mesh * p_mesh, Eigen::Vector3d::UnitX(), 0.9 * found->distance_m));
  }
}

TEST_F(NearestTriangleTest, TrianglesWithoutAreaHaveNoNormalAndAreLeftOut) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 1}};
  gpu.upload(mesh, MeshUsage::kStatic);
  EXPECT_FALSE(
      nearest_triangle({&gpu, Eigen::Isometry3d::Identity()}, {0.5, 0, 0}, Eigen::Vector3d::UnitZ(), 1.0));
}

}  // namespace
}  // namespace roomradar
