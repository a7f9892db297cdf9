// surface_update_test.cpp: a box is cut out of a mesh and extracted again: nothing is lost outside, no gap at
// its sides.
#include "mapping/surface/surface_update.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::surface_update_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 290.0, 290.0, 79.5, 59.5};  // sees 0.8 m of the floor

double area_m2(const Mesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles)
    area += 0.5 * static_cast<double>((mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                          .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                          .norm());
  return area;
}

// A floor with a box on it, seen from above by a camera that circles it.
test::Scene floor_with_box() {
  return test::nearest_of(test::plane({0, 0, 1}, 0.0),
                          test::box(AlignedBox3d(Vector3d(-0.15, -0.1, 0.0), Vector3d(0.15, 0.1, 0.2))));
}
StaticMap map_of(const test::Scene& scene) {
  StaticMap map(0.02);
  for (int i = 0; i < 8; ++i) {
    const double a = 0.785 * i;
    const Eigen::Isometry3d pose =
        test::looking_at({1.1 * std::cos(a), 1.1 * std::sin(a), 1.0}, {0.0, 0.0, 0.05});
    EXPECT_EQ(map.fuse(test::exact_frame(scene, kCamera, pose, Rgb{90, 120, 200}), pose), FuseStatus::kFused);
  }
  return map;
}

// Greatest distance from one mesh to the other, or infinity beyond 5 cm.
float farthest_m(const Mesh& from, const Mesh& to) {
  Mesh moved = from;
  for (Eigen::Vector3f& v : moved.vertices) v += (from.origin - to.origin).cast<float>();
  moved.origin = to.origin;
  const MeshDistanceQuery near(to, 0.05F);
  std::vector<FarPoint> beyond;
  const float within_m = greatest_distance_m(moved, near, 0.01F, 0.05F, beyond);
  return beyond.empty() ? within_m : std::numeric_limits<float>::infinity();
}

TEST(OutsideOf, CutsTrianglesAtTheSidesAndKeepsTheRest) {
  Mesh floor;
  floor.origin = {10.0, 20.0, 30.0};
  floor.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  floor.normals.assign(4, Eigen::Vector3f::UnitZ());
  floor.colours = {{0, 0, 0}, {200, 0, 0}, {200, 0, 0}, {0, 0, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  const AlignedBox3d box(Vector3d(9.5, 19.0, 29.9), Vector3d(10.5, 21.0, 30.1));
  const Mesh left = clip_outside(floor, box);
  EXPECT_NEAR(area_m2(left), 16.0 - 2.0, 1e-5);
  ASSERT_EQ(left.normals.size(), left.vertices.size());
  ASSERT_EQ(left.colours.size(), left.vertices.size());
  for (std::size_t v = 0; v < left.vertices.size(); ++v) {
    const Vector3d inward =
        (left.vertices[v].cast<double>() + left.origin - box.center()).cwiseAbs() - 0.5 * box.sizes();
    EXPECT_GT(inward.maxCoeff(), -1e-6) << "a vertex is left inside";
    EXPECT_NEAR(left.colours[v].r, 50.0F * (left.vertices[v].x() + 2.0F), 1.0) << "colours go along";
  }
}

TEST(OutsideOf, LeavesAMeshThatTheBoxMissesAndTakesOneThatItHolds) {
  Mesh floor;
  floor.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(clip_outside(floor, AlignedBox3d(Vector3d(-1, -1, 0.5), Vector3d(1, 1, 1))).triangles.size(), 2U);
  EXPECT_EQ(clip_outside(floor, AlignedBox3d()).triangles.size(), 2U);
  EXPECT_TRUE(clip_outside(floor, AlignedBox3d(Vector3d(-3, -3, -1), Vector3d(3, 3, 1))).triangles.empty());
  EXPECT_TRUE(clip_outside(Mesh{}, AlignedBox3d(Vector3d(-3, -3, -1), Vector3d(3, 3, 1))).triangles.empty());
}

TEST(RenewSurface, OfAMapThatDidNotChangeIsTheSameSurface) {
  const StaticMap map = map_of(floor_with_box());
  const Mesh before = extract_surface(map);
  // Boxes whose sides cut flat parts, the box, or run along the floor.
  for (const AlignedBox3d& box : {AlignedBox3d(Vector3d(-0.3, -0.25, -0.1), Vector3d(0.25, 0.3, 0.4)),
                                  AlignedBox3d(Vector3d(-0.05, -0.5, 0.0), Vector3d(0.5, 0.02, 0.11))}) {
    Mesh after = before;
    update_surface(map, box, {}, after);
    // Each is within 2 mm of the full surface.
    EXPECT_LE(farthest_m(after, before), 0.0041F);
    EXPECT_LE(farthest_m(before, after), 0.0041F);
    EXPECT_EQ(after.normals.size(), after.vertices.size());
    EXPECT_EQ(after.colours.size(), after.vertices.size());
  }
}

TEST(RenewSurface, TakesWhatIsNewInTheBoxAndNothingElse) {
  const StaticMap empty_floor = map_of(test::plane({0, 0, 1}, 0.0));
  const StaticMap with_box = map_of(floor_with_box());
  Mesh mesh = extract_surface(empty_floor);
  const AlignedBox3d box(Vector3d(-0.25, -0.2, -0.1), Vector3d(0.25, 0.2, 0.3));
  update_surface(with_box, box, {}, mesh);
  const Mesh all_new = extract_surface(with_box);
  Mesh top;
  top.vertices = {{-0.1F, -0.05F, 0.2F}, {0.1F, -0.05F, 0.2F}, {0.0F, 0.05F, 0.2F}};
  top.triangles = {{0, 1, 2}};
  EXPECT_LT(farthest_m(top, mesh), 0.01F);
  EXPECT_LE(farthest_m(all_new, mesh), 0.02F);
  EXPECT_GT(farthest_m(top, extract_surface(empty_floor)), 0.05F);
}

TEST(RenewSurface, OfAnEmptyBoxOrAnEmptyMeshIsNoFault) {
  const StaticMap map = map_of(floor_with_box());
  Mesh mesh = extract_surface(map);
  const std::size_t triangles = mesh.triangles.size();
  update_surface(map, AlignedBox3d(), {}, mesh);
  EXPECT_EQ(mesh.triangles.size(), triangles);
  Mesh none;
  update_surface(map, AlignedBox3d(Vector3d(-0.3, -0.3, -0.1), Vector3d(0.3, 0.3, 0.3)), {}, none);
  EXPECT_FALSE(none.triangles.empty());
  update_surface(StaticMap(0.02), AlignedBox3d(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)), {}, mesh);
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(SamplesInABox, AreThoseWhoseVoxelsHaveTheirCentresInIt) {
  const StaticMap map = map_of(floor_with_box());
  const AlignedBox3d box(Vector3d(-0.111, -0.25, -0.02), Vector3d(0.2, 0.133, 0.215));
  std::vector<VoxelIndex> expected, found;
  map.visit_samples([&](const SurfaceSample& sample) {
    if (box.contains((sample.voxel.cast<double>().array() + 0.5).matrix() * 0.02))
      expected.push_back(sample.voxel);
  });
  map.visit_samples(box, [&](const SurfaceSample& sample) { found.push_back(sample.voxel); });
  EXPECT_EQ(found, expected);
  EXPECT_GT(found.size(), 100U);
  std::size_t none = 0;
  map.visit_samples(AlignedBox3d(), [&](const SurfaceSample&) { ++none; });
  map.visit_samples(AlignedBox3d(Vector3d(1e9, 1e9, 1e9), Vector3d(2e9, 2e9, 2e9)),
                    [&](const SurfaceSample&) { ++none; });
  EXPECT_EQ(none, 0U);
}

}  // namespace
}  // namespace roomradar::surface_update_test
