// level_surfaces_test.cpp: floor and table top of a small room, from its mesh and from keyframes' depth.
#include "mapping/map/level_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roomradar::level_surfaces_test {
namespace {

using Eigen::Vector3d;

/// Adds a grid of size x size cells of 10 cm at a height, facing up (or down).
void add_level(Mesh& mesh, const Vector3d& corner, int size, bool faces_up = true) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto row = static_cast<std::uint32_t>(size + 1);
  for (int y = 0; y <= size; ++y)
    for (int x = 0; x <= size; ++x)
      mesh.vertices.push_back((corner + Vector3d(0.1 * x, 0.1 * y, 0.0) - mesh.origin).cast<float>());
  for (std::uint32_t y = 0; y + 1 < row; ++y)
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t a = first + y * row + x, b = a + 1, c = a + row, d = c + 1;
      if (faces_up) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, d, b});
        mesh.triangles.push_back({a, c, d});
      }
    }
}

TEST(LevelSurfaces, AreListedBySizeAndTheLowestLargeOneIsTheFloor) {
  Mesh mesh;
  mesh.origin = Vector3d(5.0, 0.0, 1.0);
  add_level(mesh, Vector3d(0.0, 0.0, -0.02), 20);       // floor, 4 m2
  add_level(mesh, Vector3d(0.5, 0.5, 0.74), 9);         // table, 0.81 m2
  add_level(mesh, Vector3d(0.5, 0.5, 0.70), 9, false);  // its underside
  add_level(mesh, Vector3d(3.0, 0.0, -0.5), 3);         // a step below, 0.09 m2: too small for a floor
  add_level(mesh, Vector3d(3.0, 3.0, 1.0), 1);          // 0.01 m2: left out
  const std::vector<LevelSurface> surfaces = level_surfaces(mesh);
  ASSERT_EQ(surfaces.size(), 3U);
  EXPECT_NEAR(surfaces[0].area_m2, 4.0, 1e-4);
  EXPECT_NEAR(surfaces[0].height_m, -0.02, 1e-6);
  EXPECT_NEAR(surfaces[1].height_m, 0.74, 1e-6);
  EXPECT_LT((surfaces[1].middle_world - Vector3d(0.95, 0.95, 0.74)).norm(), 0.06);
  EXPECT_EQ(floor_among(surfaces, mesh), (std::vector<bool>{true, false, false}));
  EXPECT_TRUE(level_surfaces(Mesh{}).empty());
  EXPECT_TRUE(floor_among({}, Mesh{}).empty());
}

TEST(LevelSurfaces, PiecesOfTheFloorAreFloorAndATableAloneIsNot) {
  Mesh mesh;
  add_level(mesh, Vector3d(0.0, 0.0, 0.01), 20);  // 4 m2
  add_level(mesh, Vector3d(3.0, 0.0, 0.0), 10);   // 1 m2, on the other side of a table
  add_level(mesh, Vector3d(5.0, 0.0, 0.0), 3);    // 0.09 m2
  add_level(mesh, Vector3d(7.0, 0.0, 0.05), 10);  // a step
  const std::vector<LevelSurface> pieces = level_surfaces(mesh);
  ASSERT_EQ(pieces.size(), 4U);
  const std::vector<bool> is_floor = floor_among(pieces, mesh);
  for (std::size_t i = 0; i < pieces.size(); ++i) EXPECT_EQ(is_floor[i], pieces[i].height_m < 0.03) << i;

  // The sides of something below the only level surface.
  Mesh table;
  add_level(table, Vector3d(0.0, 0.0, 0.7), 10);
  EXPECT_EQ(floor_among(level_surfaces(table), table), std::vector<bool>{true});
  add_level(table, Vector3d(0.0, 0.0, 0.0), 2, false);
  EXPECT_EQ(floor_among(level_surfaces(table), table), std::vector<bool>{false});
}

TEST(LevelSurfaces, ASlopeIsNoneAndConnectedLevelsAreSplitByHeight) {
  Mesh mesh;
  add_level(mesh, Vector3d::Zero(), 10);
  for (Eigen::Vector3f& v : mesh.vertices) v.z() = 0.3F * v.x();  // 17 degrees
  EXPECT_TRUE(level_surfaces(mesh).empty());
}

/// A keyframe 1.5 m above the floor, looking down by 45 degrees onto floor and a table of 0.75 m height.
MapKeyframe keyframe_over(double floor_m, double table_half_m) {
  MapKeyframe keyframe;
  keyframe.preview_camera = {160, 120, 146.0, 146.0, 79.5, 59.5};
  keyframe.preview_depth_mm = Image<std::uint16_t>(160, 120, std::uint16_t{0});
  Eigen::Matrix3d R;
  const double s = std::sqrt(0.5);
  R.col(0) = Vector3d(1.0, 0.0, 0.0);
  R.col(1) = Vector3d(0.0, -s, -s);
  R.col(2) = Vector3d(0.0, s, -s);
  keyframe.T_world_camera.linear() = R;
  keyframe.T_world_camera.translation() = Vector3d(0.0, 0.0, floor_m + 1.5);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const Vector3d ray = R * back_project(keyframe.preview_camera, x, y, 1.0);
      if (ray.z() > -0.2) continue;
      double depth_m = -1.5 / ray.z();
      const double table_depth_m = -0.75 / ray.z();
      const Vector3d on_table = table_depth_m * ray;
      if (std::abs(on_table.x()) < table_half_m && std::abs(on_table.y() - 0.9) < table_half_m)
        depth_m = table_depth_m;
      keyframe.preview_depth_mm.at(x, y) = static_cast<std::uint16_t>(std::lround(1000.0 * depth_m));
    }
  return keyframe;
}

TEST(FloorHeight, IsThatOfTheLowestLevelSurfaceEvenIfATableIsLarger) {
  KeyframeDatabase database;
  EXPECT_EQ(floor_height_m(database, Vector3d::UnitZ()), std::nullopt);
  database.keyframes.push_back(keyframe_over(-0.83, 0.5));
  const auto floor = floor_height_m(database, Vector3d::UnitZ());
  ASSERT_TRUE(floor);
  EXPECT_NEAR(*floor, -0.83, 0.006);
  // Only the table is seen: it is the lowest level surface.
  KeyframeDatabase table_only;
  table_only.keyframes.push_back(keyframe_over(-0.83, 5.0));
  EXPECT_NEAR(floor_height_m(table_only, Vector3d::UnitZ()).value_or(9.0), -0.08, 0.006);
  // Nothing is level.
  EXPECT_EQ(floor_height_m(database, Vector3d::UnitX()), std::nullopt);
}

TEST(FloorHeight, APlaceCountsOnceHoweverOftenItWasSeen) {
  KeyframeDatabase database;
  database.keyframes.push_back(keyframe_over(-0.83, 0.5));
  for (int i = 0; i < 50; ++i)
    database.keyframes.push_back(keyframe_over(-0.83, 5.0));  // the table fills them
  EXPECT_NEAR(floor_height_m(database, Vector3d::UnitZ()).value_or(9.0), -0.83, 0.006);
}

}  // namespace
}  // namespace roomradar::level_surfaces_test
