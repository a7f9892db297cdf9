// floor_plan_test.cpp: walls are dark, the floor is light, and all floors are to one scale.
#include "app/media/floor_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace roomradar::floor_plan_test {
namespace {

void add_rectangle(Mesh& mesh, const Eigen::Vector3f& corner, const Eigen::Vector3f& a,
                   const Eigen::Vector3f& b) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& v : {Eigen::Vector3f(corner), Eigen::Vector3f(corner + a),
                                   Eigen::Vector3f(corner + a + b), Eigen::Vector3f(corner + b)})
    mesh.vertices.push_back(v);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// A floor of 4 m x 2 m with a wall of 2.5 m along y = 2, and a lintel above 1.9 m along y = 0.
Mesh room() {
  Mesh mesh;
  add_rectangle(mesh, {0, 0, 0}, {4, 0, 0}, {0, 2, 0});
  add_rectangle(mesh, {0, 2, 0}, {4, 0, 0}, {0, 0, 2.5F});
  add_rectangle(mesh, {0, 0, 1.9F}, {4, 0, 0}, {0, 0, 0.6F});
  return mesh;
}

/// Returns the mean brightness of a square of pixels.
double brightness(const ColourImage& picture, int x, int y) {
  double sum = 0.0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum += picture.at(x + dx, y + dy).g / 9.0;
  return sum;
}

TEST(FloorPlan, WallsAreDarkAndTheFloorIsLight) {
  const std::array<double, 1> floors = {0.0};
  const ColourImage plan = draw_floor_plans(room(), floors);
  ASSERT_EQ(plan.width, 400 + 1 + 60);  // 100 pixels per m, and the margins
  constexpr int kLeft = 30, kTop = 30 + 40;
  const auto dark_row = [&](int y) { return plan.at(kLeft + 200, y).g < 80; };
  EXPECT_TRUE(dark_row(kTop));         // the wall at y = 2
  EXPECT_FALSE(dark_row(kTop + 200));  // the lintel is too high
  EXPECT_GT(brightness(plan, kLeft + 200, kTop + 100), 200.0);
  EXPECT_LT(brightness(plan, kLeft + 200, kTop + 100), 250.0);  // floor is not unknown
}

TEST(FloorPlan, FloorsAreSideBySideAndAHugeMeshStaysAPicture) {
  const std::array<double, 2> floors = {0.0, 3.0};
  const ColourImage both = draw_floor_plans(room(), floors, 1000);
  EXPECT_GT(both.width, 2 * 400);
  EXPECT_LE(both.width, 1000);
  Mesh far = room();
  add_rectangle(far, {-300, -300, 0}, {600, 0, 0}, {0, 600, 0});
  const ColourImage huge = draw_floor_plans(far, floors, 1000);
  EXPECT_LE(std::max(huge.width, huge.height), 1000);
  EXPECT_TRUE(draw_floor_plans({}, floors).empty());
  EXPECT_TRUE(draw_floor_plans(room(), {}).empty());
}

}  // namespace
}  // namespace roomradar::floor_plan_test
