// map_picture_test.cpp: the picture of a map shows all of the map, and every change.
#include "app/media/map_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace roomradar::map_picture_test {
namespace {

/// A level strip from one point to another, 0.2 m wide.
Mesh strip(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  const Eigen::Vector3f across = 0.1F * Eigen::Vector3f::UnitZ().cross(to - from).normalized();
  Mesh mesh;
  mesh.vertices = {from - across, to - across, to + across, from + across};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Change at(const Eigen::Vector3d& p_world, ChangeKind kind) {
  Change change;
  change.kind = kind;
  change.surface_world = {p_world};
  return change;
}

long count(const ColourImage& picture, Rgb colour) {
  return std::count(picture.pixels.begin(), picture.pixels.end(), colour);
}

constexpr Rgb kGreen{20, 160, 60}, kRed{210, 40, 40};

TEST(MapPicture, HasAllOfANarrowMapAndWhatChangedBesideIt) {
  const Eigen::Vector3f ahead(-0.5646F, 0.8253F, 0.0F);  // viewing direction of the picture
  for (const float length_m : {0.1F, 1.0F, 8.0F, 100.0F}) {
    const Mesh map = strip({0.0F, 0.0F, 0.0F}, length_m * ahead);
    const std::vector<Change> changes{at({0.0, 0.0, 0.0}, ChangeKind::kVanished),
                                      at((length_m * ahead).cast<double>(), ChangeKind::kAppeared),
                                      at({0.0, 0.0, 0.5}, ChangeKind::kAppeared)};  // above the map
    const ColourImage picture = draw_changes(map, changes, 300);
    EXPECT_EQ(picture.width, 300);
    EXPECT_LE(picture.height, 1200);
    EXPECT_EQ(count(picture, kRed), 9) << length_m;
    EXPECT_EQ(count(picture, kGreen), 18) << length_m;
  }
  EXPECT_TRUE(draw_changes({}, {}, 300).empty());
}

}  // namespace
}  // namespace roomradar::map_picture_test
