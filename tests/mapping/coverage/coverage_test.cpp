// coverage_test.cpp: the picture marks unobserved space, and holes in the surface are listed with holes in
// space.
#include "mapping/coverage/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mapping/map/map_folder.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::coverage_test {
namespace {

using Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 100.0, 100.0, 79.5, 59.5};

// A wall seen `count` times by a camera in front of it that moves sideways.
SavedMap wall_seen(int count) {
  SavedMap map;
  map.octree = StaticMap(0.02);
  for (int i = 0; i < count; ++i) {
    const Eigen::Isometry3d T = test::looking_at({0.001 * i, 0.0, 1.0}, {0.001 * i, 2.0, 1.0});
    const Frame frame = test::exact_frame(test::plane(Vector3d::UnitY(), 2.0), kCamera, T);
    EXPECT_EQ(map.octree.load().fuse(frame, T), FuseStatus::kFused);
    map.trajectory.push_back({i, i / 30.0, T});
  }
  map.mesh = extract_surface(map.octree.load());
  return map;
}

int count_pixels(const ColourImage& picture, const auto& is) {
  return static_cast<int>(std::count_if(picture.pixels.begin(), picture.pixels.end(), is));
}
bool is_orange(Rgb c) { return c.r > 130 && c.r > c.g + 50 && c.g > c.b + 15; }
bool is_violet(Rgb c) { return c.r > c.g + 60 && c.b > c.g + 60; }

ColourImage picture_of(const SavedMap& map, const Frontier& frontier) {
  return draw_coverage(map.octree.load(), map.mesh, frontier, frontier.holes, map.trajectory);
}

TEST(CoveragePicture, SurfaceSeenOnceIsThinAndSurfaceSeenOftenIsNot) {
  const int thin = count_pixels(picture_of(wall_seen(1), {}), is_orange);
  const int well = count_pixels(picture_of(wall_seen(30), {}), is_orange);
  EXPECT_GT(thin, 50'000);  // the wall fills the side view
  EXPECT_LT(well, 3'000);   // the legend, and the wall's rim
}

TEST(CoveragePicture, HolesAreMarkedAtTheirPlace) {
  const SavedMap map = wall_seen(30);
  Frontier frontier{.cell_m = 0.1, .holes = {}, .cells = {}};
  const int before = count_pixels(picture_of(map, frontier), is_violet);
  frontier.holes.push_back({.kind = HoleKind::kUnknownSpace,
                            .position_world = {0.3, 1.9, 1.2},
                            .size_m = 0.2,
                            .area_m2 = 0.04,
                            .look_direction_world = Vector3d::UnitY(),
                            .viewpoint_world = std::nullopt});
  frontier.cells.push_back({{0.3, 1.9, 1.2}, 0});
  EXPECT_GT(count_pixels(picture_of(map, frontier), is_violet),
            before + 300);  // a badge and a cell, in two views
}

TEST(CoveragePicture, AMapWithoutSurfaceIsDrawnAllTheSame) {
  const ColourImage picture = draw_coverage(StaticMap(0.02), {}, {}, {}, {});
  EXPECT_GT(picture.width, 1000);
}

TEST(Coverage, AHoleInTheSurfaceWithSpaceSeenOnBothSidesIsASurfaceBorder) {
  // The wall's mesh without the triangles within 15 cm of a point; space is unchanged.
  SavedMap map = wall_seen(30);
  map.mesh = extract_surface(map.octree.load(), {.max_deviation_m = 0.0F});
  const Vector3d middle(0.2, 2.0, 1.1);
  std::erase_if(map.mesh.triangles, [&](const Triangle& t) {
    return (map.mesh.origin + map.mesh.vertices[t[0]].cast<double>() - middle).norm() < 0.15;
  });
  const std::vector<Hole> holes =
      find_holes(map.octree.load(), map.mesh, {.cell_m = 0.08, .holes = {}, .cells = {}});
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_EQ(holes[0].kind, HoleKind::kSurfaceBorder);
  EXPECT_LT((holes[0].position_world - middle).norm(), 0.03);
  EXPECT_NEAR(holes[0].size_m, 0.3, 0.06);
  EXPECT_NEAR(holes[0].area_m2, 0.0707, 0.02);  // area of the disc
  EXPECT_GT(holes[0].look_direction_world.y(), 0.95);
  ASSERT_TRUE(holes[0].viewpoint_world);
  EXPECT_NEAR(holes[0].viewpoint_world->y(), 0.8, 0.1);

  Frontier known{.cell_m = 0.08, .holes = {Hole{}}, .cells = {{middle, 0}}};
  const std::vector<Hole> once = find_holes(map.octree.load(), map.mesh, known);
  EXPECT_EQ(once.size(), 1U) << "the frontier's hole there is the same one";
}

TEST(Coverage, HolesAreSortedByAreaAndTheScansEndComesLast) {
  const SavedMap map = wall_seen(30);
  Frontier frontier{.cell_m = 0.08, .holes = {}, .cells = {}};
  for (const auto& [kind, area_m2] :
       {std::pair{HoleKind::kUnknownSpace, 0.1}, std::pair{HoleKind::kSurfaceBorder, 0.5},
        std::pair{HoleKind::kOuterBorder, 9.0}, std::pair{HoleKind::kUnknownSpace, 0.7}})
    frontier.holes.push_back({.kind = kind, .area_m2 = area_m2, .viewpoint_world = {}});
  std::vector<double> areas_m2;
  for (const Hole& hole : find_holes(map.octree.load(), Mesh{}, frontier)) areas_m2.push_back(hole.area_m2);
  EXPECT_EQ(areas_m2, (std::vector<double>{0.7, 0.5, 0.1, 9.0}));
}

TEST(Coverage, NoNumberOfAHolesDescriptionIsMinusZero) {
  const Hole hole{.position_world = {-0.001, 1.0, -0.004},
                  .look_direction_world = {-0.002, 1.0, 0.0},
                  .viewpoint_world = Vector3d(-0.003, 0.0, 0.0)};
  EXPECT_EQ(describe(hole).find("-0.00"), std::string::npos) << describe(hole);
}

TEST(Coverage, ASurveyHasTheFrontiersHolesAndAPicture) {
  const SavedMap scan = wall_seen(30);
  const Coverage coverage = survey_coverage(scan.octree.load(), scan.mesh, scan.trajectory);
  ASSERT_FALSE(coverage.holes.empty());  // the view of a single wall has an outer border
  EXPECT_TRUE(std::all_of(coverage.holes.begin(), coverage.holes.end(),
                          [](const Hole& hole) { return hole.kind == HoleKind::kOuterBorder; }));
  EXPECT_GT(coverage.picture_png.size(), 10'000U);
  EXPECT_NE(describe(coverage.holes[0]).find("outer border at ("), std::string::npos);
}

}  // namespace
}  // namespace roomradar::coverage_test
