// object_levels_test.cpp: coarser meshes lie where they say, are lit as the full one, and are drawn where no
// pixel tells.
#include "app/object_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/virtual_object.hpp"
#include "mapping/triangle_distance.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar {
namespace {

/// The farthest that some of one mesh's vertices and triangle centres lie from the other's triangles.
float farthest_m(const Mesh& from, const Mesh& to, std::size_t every) {
  float farthest2 = 0.0F;
  for (std::size_t i = 0; i < from.triangles.size(); i += every) {
    const Triangle& t = from.triangles[i];
    const Eigen::Vector3f &a = from.vertices[t[0]], &b = from.vertices[t[1]], &c = from.vertices[t[2]];
    for (const Eigen::Vector3f& p : {a, Eigen::Vector3f((a + b + c) / 3.0F)}) {
      float nearest2 = 1e9F;
      for (const Triangle& other : to.triangles)
        nearest2 =
            std::min(nearest2, squared_distance_to_triangle(p, to.vertices[other[0]], to.vertices[other[1]],
                                                            to.vertices[other[2]]));
      farthest2 = std::max(farthest2, nearest2);
    }
  }
  return std::sqrt(farthest2);
}

/// A cube of 2 x 2 x 2 dm whose faces have n x n cells each; corners of faces are shared.
Mesh fine_cube(int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Eigen::Vector3f p;
          p[axis] = 0.1F * side;
          p[(axis + 1) % 3] = -0.1F + 0.2F * static_cast<float>(i) / static_cast<float>(n);
          p[(axis + 2) % 3] = -0.1F + 0.2F * static_cast<float>(j) / static_cast<float>(n);
          mesh.vertices.push_back(p);
        }
      }
      const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (n + 1) + i); };
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          Triangle one{at(i, j), at(i + 1, j), at(i + 1, j + 1)};
          Triangle other{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side < 0.0F) std::swap(one[1], one[2]), std::swap(other[1], other[2]);
          mesh.triangles.push_back(one);
          mesh.triangles.push_back(other);
        }
      }
    }
  }
  return mesh;
}

TEST(ObjectLevels, EachHasFewerTrianglesAndLiesWhereItSays) {
  const Mesh full = shapes::torus(120, 50, 0.08F, 0.035F, 0.01F);
  const std::vector<ObjectLevel> levels = object_levels(full);
  ASSERT_GE(levels.size(), 3U);
  std::size_t triangles = full.triangles.size();
  float deviation_m = 0.0F;
  for (const ObjectLevel& level : levels) {
    EXPECT_LT(level.mesh.triangles.size(), triangles);
    EXPECT_GT(level.deviation_m, deviation_m);
    triangles = level.mesh.triangles.size();
    deviation_m = level.deviation_m;
    EXPECT_LE(farthest_m(level.mesh, full, triangles / 60 + 1), 1.05F * deviation_m);
    EXPECT_LE(farthest_m(full, level.mesh, full.triangles.size() / 60), 1.05F * deviation_m);
    ASSERT_EQ(level.mesh.normals.size(), level.mesh.vertices.size());
  }
  EXPECT_LT(triangles, 300U);
}

TEST(ObjectLevels, AFinelyMeshedCubeKeepsItsEdgesSharp) {
  const std::vector<ObjectLevel> levels = object_levels(fine_cube(30));
  ASSERT_FALSE(levels.empty());
  const Mesh& mesh = levels.back().mesh;
  EXPECT_LT(mesh.triangles.size(), 2500U);
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f face = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                     .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                     .normalized();
    for (const std::uint32_t vertex : t) EXPECT_GT(mesh.normals[vertex].dot(face), 0.9F);
  }
}

TEST(ObjectLevels, AMeshOfFewTrianglesHasNone) {
  EXPECT_TRUE(object_levels(shapes::torus(30, 16, 0.08F, 0.035F, 0.01F)).empty());
  EXPECT_TRUE(object_levels({}).empty());
}

TEST(ObjectLevels, TheDrawnMeshIsCoarserTheFartherTheObjectAndNeverOffByMoreThanHalfAPixel) {
  GlContext context;
  const Mesh torus = shapes::torus(120, 50, 0.08F, 0.035F, 0.01F);
  VirtualObject object("torus", std::make_shared<const ObjectModel>(context, object_parts("torus", torus)));
  const Intrinsics camera{640, 480, 585.0, 585.0, 320.0, 240.0};
  const double radius_m = 0.5 * object.model->shape.drawn.bounds().sizes().norm();
  std::size_t before = object.model->shape.drawn.triangle_count() + 1;
  for (const double z_m : {0.1, 0.5, 1.0, 2.0, 4.0, 9.0}) {
    object.body.T_world_object.translation() = Eigen::Vector3d(0.1, 0.0, z_m);
    const GpuMesh& mesh = drawn_mesh(object, camera, Eigen::Isometry3d::Identity());
    EXPECT_LE(mesh.triangle_count(), before) << z_m;
    before = mesh.triangle_count();
    for (const DrawnLevel& level : object.model->levels) {
      const double half_pixel_m = 0.5 * (z_m - radius_m) / camera.fx_px;
      if (&mesh == level.mesh.get()) {
        EXPECT_LE(static_cast<double>(level.deviation_m), half_pixel_m) << z_m;
      }
    }
    if (z_m < radius_m) {
      EXPECT_EQ(&mesh, &object.model->shape.drawn);
    }
  }
  EXPECT_LT(before, 1000U);
}

}  // namespace
}  // namespace roomradar
