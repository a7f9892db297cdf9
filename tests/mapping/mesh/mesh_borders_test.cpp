// mesh_borders_test.cpp: position, size and side of a mesh's borders.
#include "mapping/mesh/mesh_borders.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace roomradar::mesh_borders_test {
namespace {

// A sheet of 10 x 10 squares of 0.1 m in the plane z = 0, facing +z, without the squares for which missing()
// returns true.
Mesh sheet(const std::function<bool(int x, int y)>& missing) {
  Mesh mesh;
  mesh.origin = {5.0, -3.0, 2.0};
  for (int y = 0; y <= 10; ++y)
    for (int x = 0; x <= 10; ++x)
      mesh.vertices.emplace_back(0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), 0.0F);
  const auto vertex = [](int x, int y) { return static_cast<std::uint32_t>(11 * y + x); };
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) {
      if (missing(x, y)) continue;
      mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
      mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  return mesh;
}

TEST(MeshBorders, ASheetHasARimAndItsHoleIsAHole) {
  const std::vector<BorderLoop> loops =
      border_loops(sheet([](int x, int y) { return x >= 3 && x < 7 && y >= 4 && y < 6; }));
  ASSERT_EQ(loops.size(), 2U);
  const BorderLoop& rim = loops[0];
  EXPECT_TRUE(rim.encloses_surface);
  EXPECT_EQ(rim.vertices.size(), 40U);
  EXPECT_NEAR(rim.length_m, 4.0, 1e-5);
  EXPECT_NEAR(rim.area_m2, 1.0, 1e-5);
  const BorderLoop& hole = loops[1];
  EXPECT_FALSE(hole.encloses_surface);
  EXPECT_NEAR(hole.length_m, 1.2, 1e-5);
  EXPECT_NEAR(hole.area_m2, 0.08, 1e-5);
  EXPECT_NEAR(hole.size_m, 0.4, 1e-5);
  EXPECT_LT((hole.centre_world - Eigen::Vector3d(5.5, -2.5, 2.0)).norm(), 1e-5);
  EXPECT_LT((hole.outward_world - Eigen::Vector3d::UnitZ()).norm(), 1e-5);
}

TEST(MeshBorders, HolesThatTouchAtACornerAreTwo) {
  const std::vector<BorderLoop> loops =
      border_loops(sheet([](int x, int y) { return (x == 4 && y == 4) || (x == 5 && y == 5); }));
  ASSERT_EQ(loops.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(loops[i].vertices.size(), 4U);
    EXPECT_FALSE(loops[i].encloses_surface);
  }
}

TEST(MeshBorders, AClosedSurfaceAndNoSurfaceHaveNone) {
  Mesh tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_TRUE(border_loops(tetrahedron).empty());
  EXPECT_TRUE(border_loops(Mesh{}).empty());
}

TEST(MeshBorders, ATriangleTwiceOverEndsTheWalk) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 2}};
  EXPECT_EQ(border_loops(mesh).size(), 1U);
  mesh.triangles[1] = {0, 2, 1};
  EXPECT_TRUE(border_loops(mesh).empty());
}

}  // namespace
}  // namespace roomradar::mesh_borders_test
