// refuse_region_test.cpp: an object is added to a map, or removed from it, by frames that show it; nothing
// else changes.
#include "mapping/revision/refuse_region.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/depth_noise.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::refuse_region_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
const AlignedBox3d kCrate(Vector3d(-0.15, -0.1, 0.0), Vector3d(0.15, 0.1, 0.2));

test::Scene room() { return test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 1, 0}, 0.8)); }
test::Scene room_with_crate() { return test::nearest_of(room(), test::box(kCrate)); }

Frame seen(const test::Scene& scene, const Eigen::Isometry3d& T_world_camera, unsigned seed) {
  Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  for (float& z : frame.depth_m.pixels)
    if (z > 0.0F) z += noise(random) * depth_sigma_m(DepthNoise{}, z);
  return frame;
}
// Fuses views of the crate's front and of its two sides.
StaticMap map_of(const test::Scene& scene) {
  StaticMap map(0.02);
  for (unsigned i = 0; i < 24; ++i) {
    const Eigen::Isometry3d pose =
        test::looking_at({0.1 * (static_cast<double>(i) - 12.0), -0.9, 0.8}, {0.0, 0.1, 0.05});
    EXPECT_EQ(map.fuse(seen(scene, pose, i), pose), FuseStatus::kFused);
  }
  return map;
}
std::vector<RegionView> views_of(const test::Scene& live, const test::Scene& model) {
  std::vector<RegionView> views;
  for (unsigned i = 0; i < 12; ++i) {
    const Eigen::Isometry3d pose =
        test::looking_at({0.02 * (static_cast<double>(i) - 6.0), -1.0, 0.9}, {0.0, 0.1, 0.05});
    views.push_back({seen(live, pose, 100 + i), test::exact_frame(model, kCamera, pose).depth_m, pose});
  }
  return views;
}
// Points on the visible surface of the crate.
WorldRegion crate_region() {
  std::vector<Vector3d> points;
  for (double u = 0.0; u <= 1.0; u += 0.05)
    for (double v = 0.0; v <= 1.0; v += 0.05) {
      const Vector3d size = kCrate.sizes();
      points.push_back(kCrate.min() + Vector3d(u * size.x(), v * size.y(), size.z()));
      points.push_back(kCrate.min() + Vector3d(u * size.x(), 0.0, v * size.z()));
    }
  return WorldRegion(points, 0.03);
}

using Samples = std::map<std::tuple<int, int, int>, std::pair<float, float>>;
Samples samples_beyond(const StaticMap& map, const AlignedBox3d& box) {
  Samples samples;
  map.visit_samples([&](const SurfaceSample& s) {
    const Vector3d centre = (s.voxel.cast<double>().array() + 0.5).matrix() * map.resolution_m();
    if (!box.contains(centre)) samples[{s.voxel.x(), s.voxel.y(), s.voxel.z()}] = {s.distance_m, s.weight};
  });
  return samples;
}

// Counts the surface's vertices within 1.5 cm of the crate's top or front.
int on_crate(const StaticMap& map) {
  const Mesh mesh = extract_surface(map, {.max_deviation_m = 0.0F});
  int count = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Vector3d p = v.cast<double>() + mesh.origin;
    const bool on_top = std::abs(p.z() - 0.2) < 0.015 && std::abs(p.x()) < 0.14 && std::abs(p.y()) < 0.09;
    const bool in_front =
        std::abs(p.y() + 0.1) < 0.015 && std::abs(p.x()) < 0.14 && p.z() > 0.03 && p.z() < 0.19;
    count += on_top || in_front ? 1 : 0;
  }
  return count;
}

TEST(RenewRegion, PutsInWhatCame) {
  StaticMap map = map_of(room());
  ASSERT_EQ(on_crate(map), 0);
  const AlignedBox3d box = refuse_region(map, crate_region(), views_of(room_with_crate(), room()));
  EXPECT_TRUE(box.contains(kCrate.center()));
  EXPECT_GT(on_crate(map), 150) << "15 x 10 voxels of top and as many of front";
  EXPECT_EQ(map.occupancy_at({0.0, 0.0, 0.195}), Occupancy::kOccupied);
}

TEST(RenewRegion, CarvesWhatWentWithItsFarSide) {
  StaticMap map = map_of(room_with_crate());
  ASSERT_GT(on_crate(map), 150);
  refuse_region(map, crate_region(), views_of(room(), room_with_crate()));
  EXPECT_EQ(on_crate(map), 0);
  const Mesh mesh = extract_surface(map, {.max_deviation_m = 0.0F});
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Vector3d p = v.cast<double>() + mesh.origin;
    const bool on_table = p.y() > 0.5 || p.z() < 0.02;
    EXPECT_TRUE(on_table) << p.transpose() << ": something still stands there";
  }
  EXPECT_EQ(map.occupancy_at({0.0, 0.0, 0.1}), Occupancy::kFree) << "its inside was unknown";
  // The surface it stood on has come into view and is mapped.
  EXPECT_EQ(map.occupancy_at({0.0, 0.0, -0.001}), Occupancy::kOccupied);
}

TEST(RenewRegion, AThinThingOnTheTableTakesTheTablesPlace) {
  const AlignedBox3d book(Vector3d(-0.15, -0.1, 0.0), Vector3d(0.15, 0.1, 0.03));
  StaticMap map = map_of(room());
  std::vector<Vector3d> points;
  for (double u = 0.0; u <= 1.0; u += 0.05)
    for (double v = 0.0; v <= 1.0; v += 0.05) points.emplace_back(-0.15 + 0.3 * u, -0.1 + 0.2 * v, 0.03);
  refuse_region(map, WorldRegion(points, 0.03), views_of(test::nearest_of(room(), test::box(book)), room()));
  const Mesh mesh = extract_surface(map, {.max_deviation_m = 0.0F});
  int on_top = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Vector3d p = v.cast<double>() + mesh.origin;
    on_top += std::abs(p.z() - 0.03) < 0.008 && std::abs(p.x()) < 0.13 && std::abs(p.y()) < 0.08 ? 1 : 0;
  }
  EXPECT_GT(on_top, 60);
}

TEST(RenewRegion, ChangesNothingElsewhere) {
  StaticMap map = map_of(room_with_crate());
  const AlignedBox3d around(Vector3d(-1.5, -0.4, -0.12), Vector3d(1.5, 2.0, 0.6));
  const AlignedBox3d near_crate(kCrate.min() - Vector3d::Constant(0.12),
                                kCrate.max() + Vector3d::Constant(0.12));
  // Pixels beside the crate reach the table and the wall behind it; the map outside the region stays
  // unchanged.
  const Samples before = samples_beyond(map, around);
  const AlignedBox3d box = refuse_region(map, crate_region(), views_of(room(), room_with_crate()));
  EXPECT_EQ(samples_beyond(map, around), before);
  EXPECT_TRUE(around.contains(box)) << box.min().transpose() << " .. " << box.max().transpose();
  const Samples before_nothing = samples_beyond(map, near_crate);
  EXPECT_TRUE(refuse_region(map, WorldRegion({}, 0.03), views_of(room(), room())).isEmpty());
  EXPECT_TRUE(refuse_region(map, crate_region(), {}).isEmpty());
  EXPECT_EQ(samples_beyond(map, near_crate), before_nothing);
}

TEST(RenewRegion, AHandThatPassesBeforeWhatWentIsNotTakenIn) {
  StaticMap map = map_of(room_with_crate());
  std::vector<RegionView> views = views_of(room(), room_with_crate());
  for (std::size_t i = 0; i < 4; ++i)
    views[i].frame = seen(test::nearest_of(room(), test::sphere({0.0, -0.4, 0.45}, 0.12)),
                          views[i].T_world_camera, static_cast<unsigned>(200 + i));
  refuse_region(map, crate_region(), views);
  EXPECT_EQ(on_crate(map), 0);
  EXPECT_NE(map.occupancy_at({0.0, -0.47, 0.52}), Occupancy::kOccupied);
}

TEST(WorldRegion, HoldsWhatIsNearItsPoints) {
  const std::vector<Vector3d> points{{0.01, 0.01, 0.01}};
  const WorldRegion region(points, 0.03);
  EXPECT_TRUE(region.contains({0.01, 0.01, 0.01}));
  EXPECT_TRUE(region.contains({0.05, -0.02, 0.01}));
  EXPECT_FALSE(region.contains({0.07, 0.01, 0.01}));
  EXPECT_TRUE(WorldRegion({}, 0.03).box_world().isEmpty());
  EXPECT_FALSE(WorldRegion({}, 0.03).contains({0, 0, 0}));
}

}  // namespace
}  // namespace roomradar::refuse_region_test
