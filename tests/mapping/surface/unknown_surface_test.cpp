// unknown_surface_test.cpp: which unknown space counts, the position of its surface, and that no path leads
// past the surface.
#include "mapping/surface/unknown/unknown_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::unknown_surface_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kVoxel_m = 0.02;
constexpr float kFree = -1.0F, kOccupied = 1.0F;
const Mesh kNoSurface;

// Adds leaves of one voxel; the octree merges them into larger ones if possible.
void fill(StaticMap& map, const Vector3i& low, const Vector3i& high, float log_odds) {
  for (int z = low.z(); z < high.z(); ++z)
    for (int y = low.y(); y < high.y(); ++y)
      for (int x = low.x(); x < high.x(); ++x) map.add_evidence(MapLeaf{{x, y, z}, 1, log_odds});
}

// Free in [low, high), except for an unknown hole in [hole_low, hole_high).
StaticMap free_with_hole(const Vector3i& low, const Vector3i& high, const Vector3i& hole_low,
                         const Vector3i& hole_high) {
  StaticMap map(kVoxel_m);
  for (int z = low.z(); z < high.z(); ++z)
    for (int y = low.y(); y < high.y(); ++y)
      for (int x = low.x(); x < high.x(); ++x) {
        const Eigen::Array3i p(x, y, z);
        if ((p >= hole_low.array()).all() && (p < hole_high.array()).all()) continue;
        map.add_evidence(MapLeaf{p.matrix(), 1, kFree});
      }
  return map;
}

Vector3d corner_of(const Mesh& mesh, const Triangle& triangle, int i) {
  return mesh.origin + mesh.vertices[triangle[static_cast<std::size_t>(i)]].cast<double>();
}

Vector3d area_of(const Mesh& mesh, const Triangle& triangle) {
  const Vector3d a = corner_of(mesh, triangle, 0);
  return 0.5 * (corner_of(mesh, triangle, 1) - a).cross(corner_of(mesh, triangle, 2) - a);
}

double area_of(const Mesh& mesh) {
  double sum_m2 = 0.0;
  for (const Triangle& triangle : mesh.triangles) sum_m2 += area_of(mesh, triangle).norm();
  return sum_m2;
}

// Volume enclosed by a closed mesh, negative if its triangles face inwards.
double volume_of(const Mesh& mesh) {
  double sum_m3 = 0.0;
  for (const Triangle& triangle : mesh.triangles)
    sum_m3 += corner_of(mesh, triangle, 0).dot(area_of(mesh, triangle)) / 3.0;
  return sum_m3;
}

bool crosses(const Mesh& mesh, const Vector3d& from, const Vector3d& to) {
  for (const Triangle& triangle : mesh.triangles) {
    const Vector3d a = corner_of(mesh, triangle, 0), b = corner_of(mesh, triangle, 1),
                   c = corner_of(mesh, triangle, 2);
    const auto volume = [](const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s) {
      return (q - p).cross(r - p).dot(s - p);
    };
    const double from_side = volume(a, b, c, from), to_side = volume(a, b, c, to);
    if ((from_side > 0.0) == (to_side > 0.0)) continue;
    const double ab = volume(from, to, a, b), bc = volume(from, to, b, c), ca = volume(from, to, c, a);
    if ((ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0)) return true;
  }
  return false;
}

TEST(UnknownSurface, AMapWithoutFreeSpaceHasNone) {
  StaticMap map(kVoxel_m);
  EXPECT_TRUE(unknown_surface(map, kNoSurface).mesh_world.triangles.empty());
  EXPECT_FALSE(is_unknown(unknown_surface(map, kNoSurface), Vector3d::Zero()));
  fill(map, {0, 0, 0}, {8, 8, 8}, kOccupied);
  EXPECT_TRUE(unknown_surface(map, kNoSurface).mesh_world.triangles.empty());
}

TEST(UnknownSurface, OneFreeVoxelIsNoPlaceToComeFrom) {
  StaticMap map(kVoxel_m);
  fill(map, {4, 4, 4}, {5, 5, 5}, kFree);
  EXPECT_TRUE(unknown_surface(map, kNoSurface).mesh_world.triangles.empty());
}

TEST(UnknownSurface, AFreeBoxIsClosedByItsSixSides) {
  StaticMap map(kVoxel_m);
  fill(map, {-4, 2, 0}, {8, 10, 6}, kFree);  // aligned with the lattice of cubes
  const UnknownSurface surface = unknown_surface(map, kNoSurface);
  EXPECT_EQ(surface.mesh_world.triangles.size(), 12U);
  EXPECT_EQ(surface.mesh_world.vertices.size(), 8U);
  EXPECT_NEAR(area_of(surface.mesh_world), 2.0 * (12 * 8 + 12 * 6 + 8 * 6) * kVoxel_m * kVoxel_m, 1e-6);
  EXPECT_NEAR(volume_of(surface.mesh_world), -12 * 8 * 6 * std::pow(kVoxel_m, 3), 1e-7);  // faces inwards
  EXPECT_FALSE(is_unknown(surface, Vector3d(-4, 2, 0) * kVoxel_m + Vector3d::Constant(0.001)));
  EXPECT_TRUE(is_unknown(surface, Vector3d(-4, 2, 0) * kVoxel_m - Vector3d::Constant(0.001)));
  EXPECT_TRUE(is_unknown(surface, Vector3d(100.0, 0.0, 0.0)));
  EXPECT_TRUE(is_unknown(surface, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(UnknownSurface, OffTheLatticeItStandsLessThanACubeBehindTheBorder) {
  StaticMap map(kVoxel_m);
  fill(map, {1, 1, 1}, {13, 13, 13}, kFree);
  const UnknownSurface surface = unknown_surface(map, kNoSurface);
  EXPECT_EQ(surface.mesh_world.triangles.size(), 12U);
  EXPECT_NEAR(volume_of(surface.mesh_world), -std::pow(14 * kVoxel_m, 3), 1e-6);  // from 0 to 14
}

TEST(UnknownSurface, AMapThatIsFreeAsFarAsItReachesEndsThere) {
  StaticMap map(kVoxel_m);
  map.add_evidence(MapLeaf{Vector3i::Constant(-32768), 65536, kFree});
  const UnknownSurface surface = unknown_surface(map, kNoSurface);
  EXPECT_EQ(surface.mesh_world.triangles.size(), 12U);
  EXPECT_LT(surface.memory_bytes, 400U << 20U);
  EXPECT_FALSE(is_unknown(surface, Vector3d(600.0, -600.0, 0.0)));
  EXPECT_TRUE(is_unknown(surface, Vector3d(700.0, 0.0, 0.0)));
}

TEST(UnknownSurface, SpecksAndSheetsInFreeSpaceDoNotCount) {
  const Vector3i low = Vector3i::Zero(), high = Vector3i::Constant(16);
  const double shell_m2 = 6 * 16 * 16 * kVoxel_m * kVoxel_m;
  const auto area_with_hole = [&](const Vector3i& hole_low, const Vector3i& hole_size) {
    const StaticMap map = free_with_hole(low, high, hole_low, hole_low + hole_size);
    const UnknownSurfaceConfig config{.pocket_voxels = 0};
    return area_of(unknown_surface(map, kNoSurface, config).mesh_world) - shell_m2;
  };
  EXPECT_NEAR(area_with_hole({6, 6, 6}, {1, 1, 1}), 0.0, 1e-6);  // one voxel
  EXPECT_NEAR(area_with_hole({6, 6, 6}, {2, 2, 2}), 0.0, 1e-6);
  EXPECT_NEAR(area_with_hole({4, 4, 6}, {8, 8, 2}), 0.0, 1e-6);   // a sheet
  EXPECT_NEAR(area_with_hole({2, 6, 6}, {12, 2, 2}), 0.0, 1e-6);  // a needle
  const double face_m2 = kVoxel_m * kVoxel_m;
  EXPECT_NEAR(area_with_hole({6, 6, 6}, {4, 4, 4}), 6 * 4 * 4 * face_m2, 1e-6);
  EXPECT_NEAR(area_with_hole({4, 4, 6}, {8, 8, 4}), 2 * (8 * 8 + 8 * 4 + 8 * 4) * face_m2, 1e-6);
}

TEST(UnknownSurface, APocketThatHangsInFreeSpaceCountsFromSoManyVoxelsOn) {
  const Vector3i low = Vector3i::Zero(), high = Vector3i::Constant(24), at = Vector3i::Constant(6);
  const double face_m2 = kVoxel_m * kVoxel_m, shell_m2 = 6 * 24 * 24 * face_m2;
  const auto hole_area_m2 = [&](const StaticMap& map) {
    return area_of(unknown_surface(map, kNoSurface).mesh_world) - shell_m2;
  };
  // 512 voxels
  EXPECT_NEAR(hole_area_m2(free_with_hole(low, high, at, at + Vector3i::Constant(8))), 0.0, 1e-6);
  StaticMap large = free_with_hole(low, high, at, at + Vector3i::Constant(10));  // 1000 voxels
  EXPECT_NEAR(hole_area_m2(large), 6 * 10 * 10 * face_m2, 1e-6);
  // Occupied space within two steps makes a small pocket count; occupied space farther away does not.
  StaticMap held = free_with_hole(low, high, at, at + Vector3i::Constant(4));
  held.add_evidence(MapLeaf{{13, 8, 8}, 1, 3.0F});
  EXPECT_NEAR(hole_area_m2(held), 0.0, 1e-6);
  held.add_evidence(MapLeaf{{11, 8, 8}, 1, 3.0F});
  EXPECT_NEAR(hole_area_m2(held), 6 * 4 * 4 * face_m2, 1e-6);
}

TEST(UnknownSurface, AThinSlitInTheUnknownIsLinedToItsEnd) {
  StaticMap map(kVoxel_m);
  fill(map, {0, 0, 0}, {16, 16, 16}, kFree);
  fill(map, {16, 6, 6}, {36, 8, 8}, kFree);  // two voxels wide: too thin for paths to start in it
  const double face_m2 = kVoxel_m * kVoxel_m;
  EXPECT_NEAR(area_of(unknown_surface(map, kNoSurface).mesh_world), (6 * 16 * 16 + 4 * 2 * 20) * face_m2,
              1e-6);
}

// A sheet in the plane z = height_m, from low to high along x and y.
Mesh sheet(double low_m, double high_m, double height_m) {
  const auto at = [&](double x, double y) { return Vector3d(x, y, height_m).cast<float>().eval(); };
  Mesh mesh;
  mesh.vertices = {at(low_m, low_m), at(high_m, low_m), at(high_m, high_m), at(low_m, high_m)};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(UnknownSurface, WhatTheStaticSurfaceHidesNeedsNone) {
  StaticMap map(kVoxel_m);
  fill(map, {0, 0, 0}, {16, 16, 8}, kFree);
  const double floor_m2 = 16 * 16 * kVoxel_m * kVoxel_m;
  const double all_m2 = area_of(unknown_surface(map, kNoSurface).mesh_world);
  const Mesh floor = sheet(-0.5, 1.0, 0.0);
  EXPECT_NEAR(area_of(unknown_surface(map, floor).mesh_world), all_m2 - floor_m2, 1e-6);
  // The same with occupied voxels below it.
  fill(map, {0, 0, -2}, {16, 16, 0}, kOccupied);
  EXPECT_NEAR(area_of(unknown_surface(map, floor).mesh_world), all_m2 - floor_m2, 1e-6);
}

TEST(UnknownSurface, BehindAHoleInTheStaticSurfaceItGoesOnPastTheRim) {
  StaticMap map(kVoxel_m);
  fill(map, {0, 0, 0}, {16, 16, 8}, kFree);
  fill(map, {0, 0, -2}, {16, 16, 0}, kOccupied);
  const Mesh half_floor = sheet(-0.5, 8 * kVoxel_m, 0.0);  // its rim is at voxel 8 along x and y
  const UnknownSurface surface = unknown_surface(map, half_floor);
  Eigen::AlignedBox3d below;
  for (const Triangle& triangle : surface.mesh_world.triangles)
    for (int i = 0; i < 3; ++i)
      if (corner_of(surface.mesh_world, triangle, i).z() < -1.5 * kVoxel_m)
        below.extend(corner_of(surface.mesh_world, triangle, i));
  ASSERT_FALSE(below.isEmpty());
  EXPECT_NEAR(below.max().x(), 16 * kVoxel_m, 1e-6);
  const Vector3d covered(5 * kVoxel_m, 5 * kVoxel_m, 0.0), open(10 * kVoxel_m, 10 * kVoxel_m, 0.0);
  const Vector3d down(0.0, 0.0, -4 * kVoxel_m), up(0.0, 0.0, 2 * kVoxel_m);
  EXPECT_TRUE(crosses(surface.mesh_world, open + up, open + down));
  EXPECT_FALSE(crosses(surface.mesh_world, Vector3d(covered - Vector3d(4, 4, 0) * kVoxel_m) + up,
                       Vector3d(covered - Vector3d(4, 4, 0) * kVoxel_m) + down));
  // A path that slants in under the rim: two voxels behind the rim the surface still blocks it.
  const Vector3d slanted_from(9.5 * kVoxel_m, 9.5 * kVoxel_m, up.z());
  EXPECT_TRUE(
      crosses(surface.mesh_world, slanted_from, slanted_from + Vector3d(-0.6, -0.6, -1.0) * 6.0 * kVoxel_m));
}

// The definition, voxel by voxel, for maps of leaves of several sizes.
TEST(UnknownSurface, AgreesWithItsDefinitionOnRandomLeaves) {
  std::mt19937 random(7);
  for (int round = 0; round < 6; ++round) {
    constexpr int kSize = 32;
    StaticMap map(kVoxel_m);
    for (int i = 0; i < 240; ++i) {
      const int edge = 1 << (random() % 4);
      const auto place = [&] {
        return static_cast<int>(random() % (kSize / static_cast<unsigned>(edge))) * edge;
      };
      const Vector3i low =
          Vector3i(place(), place(), place()) + Vector3i(kSize * static_cast<int>(random() % 4), 0, 0);
      map.add_evidence(MapLeaf{low, edge, random() % 4 == 0 ? kOccupied : kFree});
    }
    const UnknownSurfaceConfig config{
        .least_voxels = 2 + round % 2, .cube_voxels = 1 + round % 3, .rim_voxels = 6, .pocket_voxels = 0};
    const auto state = [&](const Vector3i& p) {
      return map.occupancy_at((p.cast<double>() + Vector3d::Constant(0.5)) * kVoxel_m);
    };
    const auto all_in_cube = [](const Vector3i& low, int edge, const auto& holds) {
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x)
            if (!holds(Vector3i(low + Vector3i(x, y, z)))) return false;
      return true;
    };
    const auto is_opened = [&](const Vector3i& p, int edge, const auto& holds) {
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x)
            if (all_in_cube(p - Vector3i(x, y, z), edge, holds)) return true;
      return false;
    };
    const auto counts = [&](const Vector3i& p) {
      const int edge = config.cube_voxels;
      const Vector3i low = p.unaryExpr([&](int v) { return (v + 64 * edge) / edge * edge - 64 * edge; });
      return all_in_cube(low, edge, [&](const Vector3i& q) {
        return is_opened(q, config.least_voxels,
                         [&](const Vector3i& r) { return state(r) == Occupancy::kUnknown; });
      });
    };
    const UnknownSurface surface = unknown_surface(map, kNoSurface, config);
    for (int i = 0; i < 4000; ++i) {
      const auto place = [&] { return static_cast<int>(random() % (kSize + 8)) - 4; };
      const Vector3i p =
          Vector3i(place(), place(), place()) + Vector3i(kSize * static_cast<int>(random() % 4), 0, 0);
      ASSERT_EQ(is_unknown(surface, (p.cast<double>() + Vector3d::Constant(0.5)) * kVoxel_m), counts(p))
          << p.transpose() << " in round " << round;
    }
    // Each triangle has unknown space that counts behind it, and none in front of it.
    for (const Triangle& triangle : surface.mesh_world.triangles) {
      const Vector3d middle =
          (corner_of(surface.mesh_world, triangle, 0) + corner_of(surface.mesh_world, triangle, 1) +
           corner_of(surface.mesh_world, triangle, 2)) /
          3.0;
      const Vector3d normal = area_of(surface.mesh_world, triangle).normalized();
      EXPECT_TRUE(is_unknown(surface, middle - 0.3 * kVoxel_m * normal));
      EXPECT_FALSE(is_unknown(surface, middle + 0.3 * kVoxel_m * normal));
    }
  }
}

// The room from inside, 4 x 3.2 x 2.4 m, and a cupboard in it that hides a part of it.
constexpr Intrinsics kCamera{160, 120, 140.0, 140.0, 79.5, 59.5};
const Eigen::AlignedBox3d kRoom(Vector3d(-2.0, -1.6, 0.0), Vector3d(2.0, 1.6, 2.4));
const Eigen::AlignedBox3d kCupboard(Vector3d(-0.4, 0.5, 0.0), Vector3d(0.5, 0.9, 1.3));

test::Scene room() {
  return [](const Vector3d& from, const Vector3d& direction) {
    const Eigen::Array3d low = (kRoom.min() - from).array() / direction.array();
    const Eigen::Array3d high = (kRoom.max() - from).array() / direction.array();
    return low.max(high).minCoeff();
  };
}

StaticMap scan(const test::Scene& scene, const std::vector<Eigen::Isometry3d>& views) {
  StaticMap map(kVoxel_m);
  for (int repeat = 0; repeat < 3; ++repeat)
    for (const Eigen::Isometry3d& T : views)
      EXPECT_EQ(map.fuse(test::exact_frame(scene, kCamera, T), T), FuseStatus::kFused);
  return map;
}

TEST(UnknownSurface, OfOneViewIsThePyramidThatItSaw) {
  // A view straight at the wall x = 2 m, 3 m away. The view covers 3.429 x 2.571 m of the wall's plane; the
  // room ends within that. The camera is midway between floor and ceiling, and the room cuts all four sides
  // of the view's pyramid.
  const Vector3d eye(-1.0, 0.0, 1.2);
  const Eigen::AlignedBox3d far_room(Vector3d(-9, -9, -9), Vector3d(2, 9, 9));
  const auto wall = [&](const Vector3d& from, const Vector3d& direction) {
    return direction.x() > 0.0 ? (far_room.max().x() - from.x()) / direction.x() : test::kNoHit;
  };
  const auto map = scan(wall, {test::looking_at(eye, Vector3d(2.0, 0.0, 1.2))});
  const UnknownSurface surface = unknown_surface(map, extract_surface(map));
  // Stairs instead of slanted sides have the sides' areas along each axis: 3 m deep, on average half as wide
  // as at the wall; without the contribution of the wall's own rim.
  const double width_m = 3.0 * 160 / 140, height_m = 3.0 * 120 / 140;
  Vector3d along_m2 = Vector3d::Zero();
  for (const Triangle& triangle : surface.mesh_world.triangles)
    along_m2 += area_of(surface.mesh_world, triangle).cwiseAbs();
  EXPECT_NEAR(along_m2.z(), 2.0 * 0.5 * width_m * 3.0, 0.05 * width_m * 3.0);    // above and below
  EXPECT_NEAR(along_m2.y(), 2.0 * 0.5 * height_m * 3.0, 0.05 * height_m * 3.0);  // left and right
  // All four, seen along x. The mesh of the wall ends at the centres of the outermost coarse cells.
  EXPECT_NEAR(along_m2.x(), width_m * height_m, 0.07 * width_m * height_m);
  EXPECT_LT(surface.mesh_world.triangles.size(), 20000U);
}

TEST(UnknownSurface, NoStraightWayLeadsFromFreeToUnknownSpacePastBothSurfaces) {
  const test::Scene scene = test::nearest_of(room(), test::box(kCupboard));
  const auto map = scan(scene, {test::looking_at({-1.2, -1.2, 1.5}, {0.6, 0.8, 0.6}),
                                test::looking_at({1.4, -1.1, 1.2}, {-0.8, 0.6, 0.7}),
                                test::looking_at({0.0, -1.3, 1.9}, {0.2, 0.5, 0.0})});
  const Mesh seen = extract_surface(map);
  const UnknownSurface surface = unknown_surface(map, seen);
  const UnknownSurfaceConfig config;
  ASSERT_TRUE(is_unknown(surface, kCupboard.center()));
  ASSERT_TRUE(is_unknown(surface, Vector3d(0.05, 1.2, 0.5)));  // behind the cupboard
  std::mt19937 random(3);
  const auto point = [&] {
    const auto part = [&] { return std::generate_canonical<double, 32>(random); };
    return Vector3d(kRoom.min() + Vector3d(part(), part(), part()).cwiseProduct(kRoom.sizes()));
  };
  const auto is_place_to_come_from = [&](const Vector3d& p) {
    for (int i = 0; i < 27; ++i) {
      const Vector3d step(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      if (map.occupancy_at(p + config.least_voxels / 2 * kVoxel_m * step) != Occupancy::kFree) return false;
    }
    return true;
  };
  int ways = 0, by_unknown = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vector3d from = point();
    // Half of the paths are short: most short ones cross near a rim.
    const Vector3d to = i % 2 == 0 ? point() : Vector3d(from + 0.15 * (point() - kRoom.center()));
    if (!is_place_to_come_from(from) || !is_unknown(surface, to)) continue;
    ++ways;
    const bool frontier = crosses(surface.mesh_world, from, to);
    by_unknown += frontier ? 1 : 0;
    EXPECT_TRUE(frontier || crosses(seen, from, to)) << from.transpose() << " to " << to.transpose();
  }
  EXPECT_GT(ways, 150);
  EXPECT_GT(by_unknown, 50);
}

TEST(UnknownSurface, OfTheKitchenLeavesFreeWhatACameraSawThrough) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  StaticMap map(kVoxel_m);
  Frame frame;
  std::vector<std::pair<Vector3d, Vector3d>> rays;  // from the camera to 8 cm in front of the measured point
  for (std::int64_t i = 0; i < 400; i += 10) {
    ASSERT_TRUE(source->seek(i));
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
    const Eigen::Isometry3d& T = *frame.T_world_camera;
    ASSERT_EQ(map.fuse(frame, T), FuseStatus::kFused);
    for (int y = 20; y < frame.depth_m.height; y += 80)
      for (int x = 20; x < frame.depth_m.width; x += 80) {
        const double depth_m = static_cast<double>(frame.depth_m.at(x, y));
        if (depth_m > 0.5 && depth_m < 4.0)
          rays.emplace_back(T.translation(), T * back_project(frame.depth_camera, x, y, depth_m - 0.08));
      }
  }
  const UnknownSurface surface = unknown_surface(map, extract_surface(map));
  ASSERT_GT(surface.mesh_world.triangles.size(), 1000U);
  EXPECT_LT(surface.mesh_world.triangles.size(), 60000U);
  ASSERT_GT(rays.size(), 1000U);
  std::size_t asked = 0, unknown = 0;
  for (const auto& [from, to] : rays)
    for (double part = 0.1; part <= 1.0; part += 0.05, ++asked)
      unknown += is_unknown(surface, from + part * (to - from)) ? 1 : 0;
  // A voxel is free if the camera sees through its centre; rays that graze a depth discontinuity cross some
  // that are not.
  EXPECT_LT(unknown, asked / 1000) << "of " << asked;
  EXPECT_TRUE(is_unknown(surface, rays.front().second + 3.0 * (rays.front().second - rays.front().first)));
}

TEST(UnknownSurface, ConfigsOutOfTheirRulesAreRefused) {
  EXPECT_THROW(require_valid(UnknownSurfaceConfig{.least_voxels = 0}), Error);
  EXPECT_THROW(require_valid(UnknownSurfaceConfig{.cube_voxels = 17}), Error);
  EXPECT_THROW(require_valid(UnknownSurfaceConfig{.rim_voxels = -1}), Error);
  EXPECT_THROW(require_valid(UnknownSurfaceConfig{.pocket_voxels = -1}), Error);
  EXPECT_THROW(require_valid(UnknownSurfaceConfig{.cube_voxels = 3}), Error);  // cubes beyond rim_voxels
  EXPECT_NO_THROW(require_valid(UnknownSurfaceConfig{}));
}

}  // namespace
}  // namespace roomradar::unknown_surface_test
