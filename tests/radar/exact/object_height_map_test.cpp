// object_height_map_test.cpp: M is never below the object, and its bounds for the scene's triangles are never
// too large.
#include "radar/exact/object_height_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "radar/geometry/frame_along.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::object_height_map_test {
namespace {

/// Unconnected triangles of all sizes, including needles.
Mesh splinters(int count, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f at = (0.2 * shapes::random_point(random)).cast<float>();
    const float size_m = 0.3F * std::pow(uniform(random), 4.0F), width = std::pow(uniform(random), 6.0F);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(at);
    mesh.vertices.push_back(at + size_m * shapes::random_point(random).cast<float>());
    mesh.vertices.push_back(at + size_m * width * shapes::random_point(random).cast<float>());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

class ObjectHeightMapTest : public ::testing::Test {
 protected:
  std::mt19937 random{5};
  TriangleTree tree;
  TurnedTree turned(const Mesh& mesh) {
    tree.build_by_place(mesh);
    TurnedTree object;
    object.tree = &tree;
    object.R_frame_mesh = frame_along(shapes::random_rotation(random) * Eigen::Vector3d::UnitZ());
    object.touching_m = 1e-6;
    return object;
  }
  std::vector<Mesh> meshes() {
    return {shapes::box({0.2F, 0.3F, 0.1F}), shapes::torus(40, 24, 0.2F, 0.06F, 0.02F),
            splinters(300, random)};
  }
};

TEST_F(ObjectHeightMapTest, IsNowhereLowerThanTheObject) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Mesh& mesh : meshes()) {
    for (const int resolution_px : {1, 7, 64, 500}) {
      const TurnedTree object = turned(mesh);
      ObjectHeightMap front;
      front.build(object, resolution_px);
      for (int i = 0; i < 3000; ++i) {
        const auto t = static_cast<std::uint32_t>(random() % tree.triangle_count());
        const FrameTriangle triangle = turned_corners(object, t);
        const double a = uniform(random), b = uniform(random) * (1.0 - a);
        const Eigen::Vector3d p = triangle.corners[0] + a * (triangle.corners[1] - triangle.corners[0]) +
                                  b * (triangle.corners[2] - triangle.corners[0]);
        const auto x = static_cast<float>(p.x()), y = static_cast<float>(p.y());
        ASSERT_GE(front.max_under(x, x, y, y), p.z() - 1e-9) << resolution_px << " px, triangle " << t;
        ASSERT_TRUE(front.bounds().contains(p));
      }
    }
  }
}

TEST_F(ObjectHeightMapTest, ATriangleIsNoNearerThanItsBoundAndThatIsFinerThanItsBoxs) {
  int finer = 0, met = 0;
  for (const Mesh& mesh : meshes()) {
    for (const int resolution_px : {1, 24, 256}) {
      const TurnedTree object = turned(mesh);
      ObjectHeightMap front;
      front.build(object, resolution_px);
      Mesh scene = splinters(200, random);
      // Some are larger than the object, some at the limits of float.
      for (std::size_t i = 0; i < 60; ++i) scene.vertices[i] *= i < 30 ? 40.0F : 4000.0F;
      for (const Triangle& corners : scene.triangles) {
        FrameTriangle s;
        for (std::size_t i = 0; i < 3; ++i) s.corners[i] = scene.vertices[corners[i]].cast<double>();
        set_normal(s);
        double truth_m = std::numeric_limits<double>::infinity();
        for (std::uint32_t t = 0; t < tree.triangle_count(); ++t) {
          TriangleGap gap;
          if (find_gap(turned_corners(object, t), s, gap)) truth_m = std::min(truth_m, gap.low_m);
        }
        const float bound_m = front.least_gap_under(s);
        ASSERT_LE(bound_m, truth_m) << resolution_px << " px";
        if (truth_m == std::numeric_limits<double>::infinity()) continue;
        ++met;
        const Eigen::Vector3f low = s.corners[0].cwiseMin(s.corners[1]).cwiseMin(s.corners[2]).cast<float>();
        const Eigen::Vector3f high = s.corners[0].cwiseMax(s.corners[1]).cwiseMax(s.corners[2]).cast<float>();
        finer += bound_m > low.z() - front.max_under(low.x(), high.x(), low.y(), high.y()) + 1e-3F ? 1 : 0;
      }
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(finer, met / 4);
}

TEST_F(ObjectHeightMapTest, AFlatTriangleOverABoxIsBoundedToAPixelsRounding) {
  TurnedTree object = turned(shapes::box({0.2F, 0.2F, 0.2F}));
  object.R_frame_mesh.setIdentity();
  ObjectHeightMap front;
  front.build(object, 64);
  FrameTriangle slope{{Eigen::Vector3d(-1, -1, 0.5), {1, -1, 0.5}, {0, 1, 0.9}},
                      {}};  // a slope of 0.2 m per metre
  set_normal(slope);
  const double truth_m = 0.5 + 0.2 * 0.9 - 0.1;  // above the box's edge at y = -0.1
  EXPECT_LE(front.least_gap_under(slope), truth_m);
  EXPECT_GT(front.least_gap_under(slope), truth_m - 2.0 * 0.2 * 0.2 / 64);
}

TEST_F(ObjectHeightMapTest, WhatIsBesideTheObjectCannotBeMet) {
  const TurnedTree object = turned(shapes::ball(0.1F, 10, 12));
  ObjectHeightMap front;
  front.build(object, 32);
  FrameTriangle beside{{Eigen::Vector3d(0.2, 0.0, 1.0), {0.4, 0.0, 1.0}, {0.3, 0.2, 1.0}}, {}};
  set_normal(beside);
  EXPECT_EQ(front.least_gap_under(beside), std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace roomradar::object_height_map_test
