#include "app/run/frame_stream.hpp"

#include <gtest/gtest.h>

namespace roomradar::test {
namespace frame_stream_test {
namespace {

/// Adds a strip of `triangles` triangles that begins at `from`.
void add_strip(Mesh& mesh, const Eigen::Vector3f& from, std::uint32_t triangles) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < triangles + 2; ++i)
    mesh.vertices.push_back(from + Eigen::Vector3f(static_cast<float>(i / 2), static_cast<float>(i % 2), 0));
  for (std::uint32_t i = 0; i < triangles; ++i)
    mesh.triangles.push_back({first + i, first + i + 1, first + i + 2});
}

TEST(ComponentBoxes, AnEmptyMeshHasNone) { EXPECT_TRUE(component_boxes({}, 1).empty()); }

TEST(ComponentBoxes, BoxesAreInTheWorldLargestFirstWithoutSpecks) {
  Mesh mesh;
  mesh.origin = {100.0, 200.0, 300.0};
  mesh.vertices.emplace_back(50.0F, 50.0F, 50.0F);  // used by no triangle
  add_strip(mesh, {10, 0, 0}, 4);
  add_strip(mesh, {0, 0, 5}, 9);
  add_strip(mesh, {-10, 0, 0}, 1);
  const std::vector<Eigen::AlignedBox3d> boxes = component_boxes(mesh, 2);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].min(), Eigen::Vector3d(100, 200, 305));
  EXPECT_EQ(boxes[0].max(), Eigen::Vector3d(105, 201, 305));
  EXPECT_EQ(boxes[1].min(), Eigen::Vector3d(110, 200, 300));
  EXPECT_EQ(boxes[1].max(), Eigen::Vector3d(112, 201, 300));
}

TEST(RunsOf, RunsGoOnAcrossRowsAndCoverAllSetPixels) {
  MaskImage mask(4, 3);
  EXPECT_TRUE(runs_of(mask).empty());
  EXPECT_TRUE(runs_of({}).empty());
  for (const std::size_t pixel : {0U, 3U, 4U, 5U, 11U}) mask.pixels[pixel] = 255;
  EXPECT_EQ(runs_of(mask), (std::vector<std::uint32_t>{0, 1, 3, 3, 11, 1}));
  mask.resize(4, 3, 255);
  EXPECT_EQ(runs_of(mask), (std::vector<std::uint32_t>{0, 12}));
}

}  // namespace
}  // namespace frame_stream_test
}  // namespace roomradar::test
