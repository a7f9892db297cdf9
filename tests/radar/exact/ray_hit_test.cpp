// ray_hit_test.cpp: rays against meshes.
#include "radar/exact/ray_hit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace roomradar::ray_hit_test {
namespace {

using Vec3 = Eigen::Vector3d;

/// Small triangles scattered about the origin, 2 m wide.
Mesh scattered_triangles(std::mt19937& random, int count) {
  std::uniform_real_distribution<float> place(-1.0F, 1.0F), corner(-0.1F, 0.1F);
  Mesh mesh;
  mesh.origin = {3.0, -2.0, 5.0};
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f middle(place(random), place(random), place(random));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(middle + Eigen::Vector3f(corner(random), corner(random), corner(random)));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Distance to the triangle's plane, if the signs of three determinants say that the hit is inside.
double distance_by_volumes(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 o = ray.origin_world, d = ray.direction_world;
  const double u = d.dot((b - o).cross(c - o)), v = d.dot((c - o).cross(a - o)),
               w = d.dot((a - o).cross(b - o));
  const bool is_inside = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
  const Vec3 normal = (b - a).cross(c - a);
  const double t = normal.dot(a - o) / normal.dot(d);
  return is_inside && t > 0.0 ? t : std::numeric_limits<double>::infinity();
}

TEST(MeshHit, IsTheNearestOfAllTriangles) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Mesh mesh = scattered_triangles(random, 3000);
  TriangleTree tree;
  tree.build_by_place(mesh);
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
  T_world_mesh.rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())).pretranslate(Vec3(-4, 1, 2));
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    Ray ray;
    ray.origin_world =
        T_world_mesh *
        (mesh.origin + 3.0 * Vec3(normal(random), normal(random), normal(random)).normalized());
    const Vec3 aim =
        T_world_mesh * (mesh.origin + 0.6 * Vec3(normal(random), normal(random), normal(random)));
    ray.direction_world = (aim - ray.origin_world).normalized();
    double nearest_m = 10.0;
    for (const Triangle& triangle : mesh.triangles) {
      const auto corner = [&](int k) -> Vec3 {
        return T_world_mesh *
               (mesh.origin + mesh.vertices[triangle[static_cast<std::size_t>(k)]].cast<double>());
      };
      nearest_m = std::min(nearest_m, distance_by_volumes(ray, corner(0), corner(1), corner(2)));
    }
    const auto hit = hit_mesh({&tree, T_world_mesh}, ray, 10.0);
    ASSERT_EQ(hit.has_value(), nearest_m < 10.0) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance_m, nearest_m, 1e-9);
    EXPECT_NEAR((hit->point_world - ray.origin_world).norm(), nearest_m, 1e-9);
    EXPECT_LT(hit->normal_world.dot(ray.direction_world), 0.0);
    EXPECT_FALSE(hit_mesh({&tree, T_world_mesh}, ray, nearest_m - 1e-6)) << "out of reach";
  }
  EXPECT_GT(hits, 100);
}

TEST(MeshHit, ARayThroughAPixelMeetsWhatIsProjectedThere) {
  const Intrinsics camera{640, 480, 525.0, 530.0, 319.5, 239.5};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.rotate(Eigen::AngleAxisd(2.0, Vec3(1, 0.2, 0).normalized())).pretranslate(Vec3(1, 2, 3));
  const Ray ray = ray_through(camera, T_world_camera, 100.0, 400.0);
  const Eigen::Vector2d pixel =
      project(camera, T_world_camera.inverse() * (ray.origin_world + 1.7 * ray.direction_world));
  EXPECT_NEAR(pixel.x(), 100.0, 1e-9);
  EXPECT_NEAR(pixel.y(), 400.0, 1e-9);
}

TEST(MeshHit, NoRaySlipsThroughBetweenTwoTriangles) {
  Mesh mesh;
  mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  TriangleTree tree;
  tree.build_by_place(mesh);
  for (int i = -99; i < 100; ++i) {
    const double at = 0.02 * i;  // on the diagonal that both triangles share
    const Vec3 from(0.3, -1.2, 1.7);
    EXPECT_TRUE(hit_mesh({&tree, Eigen::Isometry3d::Identity()},
                         {from, (Vec3(at, at, 0.0) - from).normalized()}, 10.0));
  }
}

TEST(MeshHit, NothingIsMetWhereNothingIsOrTheRayIsNone) {
  const Ray ray{{0, 0, 0}, {0, 0, 1}};
  EXPECT_FALSE(hit_mesh({}, ray, 10.0));
  TriangleTree tree;
  EXPECT_FALSE(hit_mesh({&tree, Eigen::Isometry3d::Identity()}, ray, 10.0));
  Mesh mesh;
  mesh.vertices = {{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
  mesh.triangles = {{0, 1, 2}};
  tree.build_by_place(mesh);
  const TreeInstance sheet{&tree, Eigen::Isometry3d::Identity()};
  EXPECT_TRUE(hit_mesh(sheet, ray, 10.0));
  EXPECT_FALSE(hit_mesh(sheet, {{0, 0, 3}, {0, 0, 1}}, 10.0)) << "behind";
  EXPECT_FALSE(hit_mesh(sheet, {{0, 0, 0}, {0, 0, 0}}, 10.0));
  EXPECT_FALSE(hit_mesh(sheet, {{0, std::nan(""), 0}, {0, 0, 1}}, 10.0));
  EXPECT_FALSE(hit_mesh(sheet, {{5, 0, 0}, {0, 0, 1}}, 10.0)) << "beside";
}

}  // namespace
}  // namespace roomradar::ray_hit_test
