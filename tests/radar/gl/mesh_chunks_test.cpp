// mesh_chunks_test.cpp: no triangle is lost, boxes contain their triangles, nearby triangles stay together.
#include "radar/gl/mesh_chunks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/radar/shapes.hpp"

namespace roomradar::mesh_chunks_test {
namespace {

void expect_boxes_hold_their_triangles(const Mesh& mesh, const ChunkedTriangles& chunked) {
  std::size_t next = 0;
  for (const MeshChunk& chunk : chunked.chunks) {
    EXPECT_EQ(chunk.first_triangle, next) << "runs follow each other";
    next += chunk.triangle_count;
    for (std::size_t i = chunk.first_triangle; i < next; ++i) {
      for (const std::uint32_t vertex : chunked.triangles[i]) {
        EXPECT_TRUE(chunk.bounds_local.contains(mesh.vertices[vertex]));
      }
    }
    EXPECT_TRUE(chunked.bounds_local.contains(chunk.bounds_local));
  }
  EXPECT_EQ(next, chunked.triangles.size());
}

TEST(MeshChunks, EveryTriangleIsInOneRun) {
  const Mesh mesh = shapes::torus(60, 40, 1.0F, 0.3F, 0.05F);
  ChunkedTriangles by_key, in_order;
  chunk_by_place(mesh, 100, by_key);
  chunk_in_order(mesh, 100, in_order);
  EXPECT_EQ(in_order.triangles, mesh.triangles);
  std::vector<Triangle> sorted = by_key.triangles, expected = mesh.triangles;
  std::sort(sorted.begin(), sorted.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(sorted, expected);
  expect_boxes_hold_their_triangles(mesh, by_key);
  expect_boxes_hold_their_triangles(mesh, in_order);
}

TEST(MeshChunks, ByPlaceMakesSmallBoxesOfShuffledTriangles) {
  Mesh mesh = shapes::torus(100, 50, 1.0F, 0.3F, 0.0F);
  std::mt19937 random(5);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  ChunkedTriangles chunked;
  chunk_by_place(mesh, 100, chunked);
  std::vector<float> longest_m;
  for (const MeshChunk& chunk : chunked.chunks) longest_m.push_back(chunk.bounds_local.sizes().maxCoeff());
  std::sort(longest_m.begin(), longest_m.end());
  // 100 runs on a surface of 11.8 m^2: a compact run is 0.34 m wide. Morton order has jumps, hence the
  // median.
  EXPECT_LT(longest_m[longest_m.size() / 2], 0.7F);
}

TEST(MeshChunks, UnusableTrianglesAreDroppedAndCounted) {
  Mesh mesh = shapes::box({1.0F, 1.0F, 1.0F});
  mesh.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  mesh.vertices.emplace_back(0.0F, std::numeric_limits<float>::infinity(), 0.0F);
  mesh.triangles.push_back({0, 1, 24});
  mesh.triangles.push_back({0, 1, 25});
  mesh.triangles.push_back({0, 1, 26});  // index one past the last vertex
  mesh.triangles.push_back({0, 1, 0xFFFFFFFFU});
  ChunkedTriangles chunked;
  chunk_in_order(mesh, 8, chunked);
  EXPECT_EQ(chunked.dropped_triangles, 4U);
  EXPECT_EQ(chunked.triangles.size(), 12U);
  EXPECT_TRUE(chunked.bounds_local.isApprox(
      Eigen::AlignedBox3f(Eigen::Vector3f::Constant(-0.5F), Eigen::Vector3f::Constant(0.5F))));
}

TEST(MeshChunks, EmptyMeshHasNoRunsAndNoBounds) {
  ChunkedTriangles chunked;
  chunk_by_place({}, 100, chunked);
  EXPECT_TRUE(chunked.chunks.empty());
  EXPECT_TRUE(chunked.bounds_local.isEmpty());
}

TEST(MeshChunks, OnePointMeshIsFine) {  // no extent to scale Morton cells by
  Mesh mesh;
  mesh.vertices.assign(3, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  mesh.triangles.push_back({0, 1, 2});
  ChunkedTriangles chunked;
  chunk_by_place(mesh, 100, chunked);
  EXPECT_EQ(chunked.triangles.size(), 1U);
}

}  // namespace
}  // namespace roomradar::mesh_chunks_test
