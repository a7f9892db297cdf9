// map_pairs_test.cpp: registration, merging and comparison of two maps of painted rooms.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/map/registration.hpp"
#include "mapping/map/surface_points.hpp"
#include "mapping/map/tsdf_interpolation.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::map_pairs_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using test::Scene;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 80.0, 60.0};
constexpr double kVoxel_m = 0.02;

/// Floor, two walls in a corner, and a chest; the corner is at x = 2, y = 2.
Scene room() {
  return test::nearest_of(
      test::nearest_of(test::plane(Vector3d::UnitZ(), 0.0), test::plane(Vector3d::UnitY(), 2.0)),
      test::nearest_of(test::plane(Vector3d::UnitX(), 2.0),
                       test::box({Vector3d(0.9, 1.2, 0.0), Vector3d(1.5, 1.6, 0.5)})));
}
Scene with(const Scene& scene, const Eigen::AlignedBox3d& thing) {
  return test::nearest_of(scene, test::box(thing));
}
const Eigen::AlignedBox3d kThing(Vector3d(0.2, 1.0, 0.0), Vector3d(0.5, 1.25, 0.3));

/// A map as a prescan makes it, in its own world frame.
/// @param grey_of  grey level of a world point
template <typename Grey>
SavedMap scan_painted(const Grey& grey_of, const Scene& scene, double from_m, double to_m,
                      const Isometry3d& T_own_world, unsigned seed, double voxel_m = kVoxel_m) {
  SavedMap map;
  map.octree = StaticMap(voxel_m);
  for (int i = 0; i < 16; ++i) {
    const double along = from_m + (to_m - from_m) * i / 15.0;
    const Isometry3d T_world_camera =
        test::looking_at(Vector3d(along, -0.6 + 0.2 * std::sin(i), 1.4), Vector3d(along + 0.4, 1.7, 0.5));
    Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
    test::paint_with(grey_of, frame, T_world_camera);
    if (seed > 0) test::add_depth_noise(frame, seed + static_cast<unsigned>(i));
    frame.index = i;
    const Isometry3d T_own_camera = T_own_world * T_world_camera;
    EXPECT_EQ(map.octree.load().fuse(frame, T_own_camera), FuseStatus::kFused);
    if (i % 2 == 0) map.keyframe_database.load().keyframes.push_back(make_map_keyframe(frame, T_own_camera));
    map.trajectory.push_back({i, i / 30.0, T_own_camera});
  }
  map.mesh = extract_surface(map.octree.load());
  map.info.source = "painted";
  map.info.frames_read = map.info.frames_fused = 16;
  return map;
}

SavedMap scan(const Scene& scene, double from_m, double to_m, const Isometry3d& T_own_world, unsigned seed,
              double voxel_m = kVoxel_m) {
  return scan_painted(test::cube_grey, scene, from_m, to_m, T_own_world, seed, voxel_m);
}

Isometry3d turned(double angle_rad, const Vector3d& shift_m) {
  Isometry3d T = Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle_rad, Vector3d(0.1, 0.2, 1.0).normalized()).matrix();
  T.translation() = shift_m;
  return T;
}

class MapPairs : public ::testing::Test {
 protected:
  inline static const Isometry3d kT_b_world = turned(0.7, {1.3, -0.4, 0.2});
  inline static const Isometry3d kT_a_b = kT_b_world.inverse();  // a's world is the room's
  static const SavedMap& a() {
    static const SavedMap map = scan(room(), -0.6, 0.8, Isometry3d::Identity(), 1);
    return map;
  }
  static const SavedMap& b() {
    static const SavedMap map = scan(room(), 0.2, 1.2, kT_b_world, 1000);
    return map;
  }
  /// Greatest distance between the two transforms' images of a point within 2 m of the origin.
  static double gap_m(const Isometry3d& T, const Isometry3d& U) {
    double worst_m = 0.0;
    for (const Vector3d& p : {Vector3d(2, 2, 0), Vector3d(-1, 2, 1), Vector3d(1, 0, 1.4)})
      worst_m = std::max(worst_m, (T * p - U * p).norm());
    return worst_m;
  }
};

TEST_F(MapPairs, AreRegisteredWithinAFifthOfAVoxel) {
  const Registration found = register_maps(a(), b());
  ASSERT_TRUE(found) << describe(found);
  EXPECT_LT(gap_m(found.T_a_b * kT_b_world, Isometry3d::Identity()), 0.2 * kVoxel_m) << describe(found);
  EXPECT_LT(found.residual_m, 0.25 * kVoxel_m);
  EXPECT_GT(found.agreement, 0.95);
  EXPECT_GT(found.overlap, 0.3);
  const Registration again = register_maps(a(), b());
  EXPECT_EQ(again.T_a_b.matrix(), found.T_a_b.matrix());
}

TEST_F(MapPairs, ASmallPartOfALargeMapIsRegistered) {
  SavedMap hall = scan(room(), -0.6, 0.8, Isometry3d::Identity(), 1);
  const auto first = static_cast<std::uint32_t>(hall.mesh.vertices.size());
  for (const Eigen::Vector3f& corner :
       {Eigen::Vector3f(0, 30, 0), Eigen::Vector3f(60, 30, 0), Eigen::Vector3f(0, 90, 0)})
    hall.mesh.vertices.push_back(corner);
  hall.mesh.triangles.push_back({first, first + 1, first + 2});  // where b observed nothing
  const Registration found = register_maps(hall, b());
  ASSERT_TRUE(found) << describe(found);
  EXPECT_LT(gap_m(found.T_a_b * kT_b_world, Isometry3d::Identity()), 0.2 * kVoxel_m) << describe(found);
}

TEST_F(MapPairs, ALargeMapIsRegisteredInASmallPartOfIt) {
  SavedMap hall = scan(room(), 0.2, 1.2, kT_b_world, 1000);
  const auto first = static_cast<std::uint32_t>(hall.mesh.vertices.size());
  for (const Eigen::Vector3f& corner :
       {Eigen::Vector3f(0, 30, 0), Eigen::Vector3f(60, 30, 0), Eigen::Vector3f(0, 90, 0)})
    hall.mesh.vertices.push_back(corner);
  hall.mesh.triangles.push_back({first, first + 1, first + 2});  // where a observed nothing
  const Registration found = register_maps(a(), hall);
  ASSERT_TRUE(found) << describe(found);
  EXPECT_LT(gap_m(found.T_a_b * kT_b_world, Isometry3d::Identity()), 0.2 * kVoxel_m) << describe(found);
}

TEST_F(MapPairs, AnotherRoomIsRefused) {
  // The same camera path, but other walls with other paint.
  const Scene other = test::nearest_of(test::plane(Vector3d(0.3, 1.0, 0.0).normalized(), 1.6),
                                       test::plane(Vector3d::UnitZ(), -0.3));
  const Registration found = register_maps(a(), scan(other, -0.6, 0.8, Isometry3d::Identity(), 7));
  EXPECT_FALSE(found) << describe(found);
}

/// The room with a painted table; everything else has hardly any contrast, so only the table has features.
SavedMap scan_with_table(const Vector3d& shift_m, const Isometry3d& T_own_world, unsigned seed) {
  const Eigen::AlignedBox3d table(Vector3d(-0.2, 0.9, 0.0) + shift_m, Vector3d(0.7, 1.5, 0.8) + shift_m);
  Eigen::AlignedBox3d painted = table;
  painted.min() -= Vector3d::Constant(0.01);
  painted.max() += Vector3d::Constant(0.01);
  const auto grey_of = [=](const Vector3d& p_world) {
    const bool is_table = painted.contains(p_world) && p_world.z() > 0.02;
    return is_table ? 1.0 * test::cube_grey(p_world - shift_m) : 110.0 + 0.15 * test::cube_grey(p_world);
  };
  return scan_painted(grey_of, with(room(), table), -0.6, 0.8, T_own_world, seed);
}

TEST_F(MapPairs, ATableThatWasMovedDoesNotMoveTheRoom) {
  Isometry3d T_b_world = Isometry3d::Identity();
  T_b_world.linear() = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).matrix();
  T_b_world.translation() = Vector3d(1.3, -0.4, 0.0);
  const SavedMap before = scan_with_table(Vector3d::Zero(), Isometry3d::Identity(), 1);
  const SavedMap after = scan_with_table({-0.3, -0.25, 0.0}, T_b_world, 1000);
  const Registration found = register_maps(before, after);
  ASSERT_TRUE(found) << describe(found);
  EXPECT_LT(gap_m(found.T_a_b * T_b_world, Isometry3d::Identity()), 0.5 * kVoxel_m) << describe(found);
}

TEST_F(MapPairs, ALookAlikeIsRefused) {
  // The painted wall and the floor are the same, but the room differs: its side wall is a metre further in,
  // and boxes occupy space that is free in a.
  const Scene look_alike =
      with(with(test::nearest_of(test::plane(Vector3d::UnitY(), 2.0), test::plane(Vector3d::UnitX(), 1.0)),
                {Vector3d(-0.8, 0.6, -0.5), Vector3d(-0.1, 1.4, 0.7)}),
           {Vector3d(0.2, 0.5, -0.5), Vector3d(0.9, 1.3, 0.6)});
  const Registration found = register_maps(a(), scan(look_alike, -0.6, 0.8, Isometry3d::Identity(), 7));
  EXPECT_FALSE(found) << describe(found);
}

TEST_F(MapPairs, WithoutColourNothingIsRecognised) {
  SavedMap blind = scan(room(), -0.6, 0.8, Isometry3d::Identity(), 3);
  for (MapKeyframe& place : blind.keyframe_database.load().keyframes) {
    place.points_camera.clear();
    place.descriptors.clear();
  }
  EXPECT_EQ(register_maps(a(), blind).status, RegistrationStatus::kNoFeatures);
  EXPECT_EQ(register_maps(a(), SavedMap{}).status, RegistrationStatus::kNoOverlap);
}

TEST_F(MapPairs, MergedWithAFinerMapItSaysTheFinerResolution) {
  SavedMap coarse;
  coarse.octree = StaticMap(2.0 * kVoxel_m);
  coarse.info.settings["resolution_m"] = std::to_string(coarse.octree.load().resolution_m());
  SavedMap fine = scan(room(), -0.6, 0.8, Isometry3d::Identity(), 1);
  fine.info.settings["resolution_m"] = std::to_string(fine.octree.load().resolution_m());
  const SavedMap merged = merge_maps(std::move(coarse), fine, Isometry3d::Identity());
  EXPECT_EQ(merged.octree.load().resolution_m(), fine.octree.load().resolution_m());
  EXPECT_EQ(merged.info.settings.at("resolution_m"), fine.info.settings.at("resolution_m"));
}

TEST_F(MapPairs, WhatLiesPastTheReachOfTheFinerCellsIsRefusedInWords) {
  SavedMap far, fine;
  far.info.source = "corridor";
  far.octree = StaticMap(0.01);
  far.octree.load().add_evidence(MapLeaf{{7'000, 0, 0}, 8, -1.0F});
  fine.octree = StaticMap(0.002);
  fine.octree.load().add_evidence(MapLeaf{{0, 0, 0}, 8, -1.0F});
  const std::string fault =
      test::error_of([&] { (void)merge_maps(std::move(far), fine, Isometry3d::Identity()); });
  EXPECT_NE(fault.find("the map of corridor: reaches 70.1 m"), std::string::npos) << fault;
  EXPECT_NE(fault.find("a map reaches 65.5 m"), std::string::npos) << fault;
}

TEST_F(MapPairs, MergedItsSurfaceIsAsCloseAsTheFirstOnes) {
  const auto triangles = [](const char* deviation_m) {
    SavedMap first = scan(room(), -0.6, 0.8, Isometry3d::Identity(), 1);
    if (*deviation_m != 0) first.info.settings[kDeviationSetting] = deviation_m;
    return merge_maps(std::move(first), b(), kT_a_b).mesh.triangles.size();
  };
  const std::size_t defaults = triangles("");
  EXPECT_EQ(triangles("0.002"), defaults);
  EXPECT_LT(triangles("0.02"), defaults * 3 / 4);
  for (const char* impossible : {"", "-1", "nan", "inf", "2 mm", "1e99"}) {
    MapInfo info;
    info.settings[kDeviationSetting] = impossible;
    EXPECT_THROW((void)surface_config_of(info), Error) << impossible;
  }
}

TEST_F(MapPairs, MergedKnowWhatEitherKnewAndTheSurfaceFits) {
  const SavedMap merged = merge_maps(scan(room(), -0.6, 0.8, Isometry3d::Identity(), 1), b(), kT_a_b);
  EXPECT_EQ(merged.keyframe_database.load().keyframes.size(),
            a().keyframe_database.load().keyframes.size() + b().keyframe_database.load().keyframes.size());
  ASSERT_EQ(merged.trajectory.size(), 32U);
  for (std::size_t i = 1; i < merged.trajectory.size(); ++i)
    EXPECT_GT(merged.trajectory[i].stamp_s, merged.trajectory[i - 1].stamp_s);
  EXPECT_EQ(merged.info.frames_fused, 32);

  std::size_t off = 0, only_b = 0, lost = 0;
  for (const Eigen::Vector3f& vertex : merged.mesh.vertices) {
    const Vector3d p = merged.mesh.origin + vertex.cast<double>();
    const double to_walls_m = std::min({std::abs(p.z()), std::abs(p.y() - 2.0), std::abs(p.x() - 2.0)});
    const Eigen::AlignedBox3d chest(Vector3d(0.9, 1.2, 0.0), Vector3d(1.5, 1.6, 0.5));
    const double to_chest_m = chest.contains(p)
                                  ? std::min((p - chest.min()).minCoeff(), (chest.max() - p).minCoeff())
                                  : chest.exteriorDistance(p);
    if (std::min(to_walls_m, to_chest_m) > kVoxel_m) ++off;
  }
  EXPECT_LT(off, merged.mesh.vertices.size() / 50);
  // Every point of either surface is on the merged surface.
  for (const Vector3d& p_b : sample_surface(b().mesh, 2000)) {
    const Vector3d p = kT_a_b * p_b;
    const auto at = distance_at(merged.octree.load(), p);
    if (!at || std::abs(at->distance_m) > kVoxel_m) ++lost;
    if (!a().octree.load().sample_at(p)) ++only_b;
  }
  EXPECT_GT(only_b, 100U);
  EXPECT_LT(lost, 60U);  // 3 %: at rims, where not all eight samples are known
}

TEST_F(MapPairs, InOneWorldAddingIsExact) {
  StaticMap sum(kVoxel_m);
  add_map(a().octree.load(), Isometry3d::Identity(), sum);
  EXPECT_EQ(sum.counts().occupied_leaves, a().octree.load().counts().occupied_leaves);
  EXPECT_EQ(sum.counts().free_leaves, a().octree.load().counts().free_leaves);
  EXPECT_EQ(sum.counts().memory_bytes, a().octree.load().counts().memory_bytes) << "coarse cells stay coarse";
  sum.visit_samples([](const SurfaceSample& sample) {
    const auto before =
        a().octree.load().sample_at((sample.voxel.cast<double>() + Vector3d::Constant(0.5)) * kVoxel_m);
    ASSERT_TRUE(before);
    EXPECT_NEAR(before->distance_m, sample.distance_m, 1e-5F);
  });
}

TEST_F(MapPairs, AFinerGridTakesEachVoxelOnce) {
  // A free cube and an occupied voxel, rotated, resampled at half the voxel size: each voxel has the state at
  // its centre.
  StaticMap from(0.04), into(0.02);
  from.add_evidence(MapLeaf{{8, 8, 8}, 8, -1.0F});
  from.add_evidence(MapLeaf{{20, 8, 8}, 1, 2.0F});
  const Isometry3d T = turned(0.5, {0.013, 0.2, -0.1});
  add_map(from, T, into);
  int wrong = 0, known = 0;
  for (int z = -40; z < 80; ++z)
    for (int y = -40; y < 80; ++y)
      for (int x = -40; x < 100; ++x) {
        const Vector3d p = (Vector3d(x, y, z) + Vector3d::Constant(0.5)) * 0.02;
        const Occupancy expected = from.occupancy_at(T.inverse() * p);
        if (into.occupancy_at(p) != expected) ++wrong;
        if (expected != Occupancy::kUnknown) ++known;
      }
  EXPECT_GT(known, 4000);
  EXPECT_EQ(wrong, 0);
}

TEST_F(MapPairs, AFinerGridTakesTheWholeOfEachSample) {
  // A tilted plane resampled into voxels of a half, a third and a quarter of the edge: no holes.
  constexpr double kCoarse_m = 0.04;
  const Vector3d normal = Vector3d(0.2, 0.3, 1.0).normalized();
  StaticMap from(kCoarse_m);
  for (int y = -12; y < 12; ++y)
    for (int x = -12; x < 12; ++x)
      for (int z = -12; z < 12; ++z) {
        const Vector3d p = (Vector3d(x, y, z) + Vector3d::Constant(0.5)) * kCoarse_m;
        const double distance_m = normal.dot(p);
        if (std::abs(distance_m) > 3.0 * kCoarse_m) continue;
        SurfaceSample sample;
        sample.voxel = {x, y, z};
        sample.distance_m = static_cast<float>(distance_m);
        sample.weight = 4.0F;
        sample.occupancy = Occupancy::kFree;
        from.add_evidence(MapLeaf{sample.voxel, 1, -1.0F});
        from.add_evidence(sample);
      }
  for (const int parts : {2, 3, 4}) {
    StaticMap into(kCoarse_m / parts);
    add_map(from, Isometry3d::Identity(), into);
    int missing = 0, wrong = 0, all = 0;
    for (double y = -0.3; y < 0.3; y += 0.01)
      for (double x = -0.3; x < 0.3; x += 0.01) {
        const Vector3d p(x, y, -(normal.x() * x + normal.y() * y) / normal.z());
        const auto at = into.sample_at(p);
        ++all;
        missing += at ? 0 : 1;
        wrong += at && std::abs(at->distance_m) > kCoarse_m / parts ? 1 : 0;
      }
    EXPECT_EQ(missing, 0) << parts << " of " << all;
    EXPECT_EQ(wrong, 0) << parts;
  }
}

TEST_F(MapPairs, CellsThatDifferByMoreThanFourTimesAreNotJoined) {
  SavedMap coarse, fine;
  coarse.octree = StaticMap(0.05);
  fine.octree = StaticMap(0.01);
  const std::string fault =
      test::error_of([&] { (void)merge_maps(std::move(coarse), fine, Isometry3d::Identity()); });
  EXPECT_NE(fault.find("are 0.01 m and of the other 0.05 m"), std::string::npos) << fault;
}

TEST_F(MapPairs, TwoScansOfOneRoomDoNotDiffer) {
  EXPECT_TRUE(diff_maps(a().octree.load(), b().octree.load(), kT_a_b).empty());
  EXPECT_TRUE(diff_maps(a().octree.load(), a().octree.load(), Isometry3d::Identity()).empty());
}

TEST_F(MapPairs, AThingThatAppearsIsMeasuredAndVanishesTheOtherWayRound) {
  const SavedMap after = scan(with(room(), kThing), -0.6, 0.8, kT_b_world, 50);
  const std::vector<Change> appeared = diff_maps(a().octree.load(), after.octree.load(), kT_a_b);
  ASSERT_EQ(appeared.size(), 1U);
  EXPECT_EQ(appeared[0].kind, ChangeKind::kAppeared);
  // Its front and top are observed; the space behind them is no longer free.
  EXPECT_LT((appeared[0].box_world.center() - kThing.center()).norm(), 0.05);
  EXPECT_LT((appeared[0].box_world.sizes() - kThing.sizes()).cwiseAbs().maxCoeff(), 0.08);
  EXPECT_NEAR(appeared[0].volume_m3, kThing.volume(), 0.4 * kThing.volume());
  const std::vector<Change> vanished = diff_maps(after.octree.load(), a().octree.load(), kT_b_world);
  ASSERT_EQ(vanished.size(), 1U);
  EXPECT_EQ(vanished[0].kind, ChangeKind::kVanished);
  EXPECT_LT((kT_a_b * vanished[0].position_world - appeared[0].position_world).norm(), 0.02);
}

/// Free space and in it a wall at y = 0, 0.5 m wide and high.
/// @param surface_voxel  the wall's surface at (x, z), voxels along -y
StaticMap wall_at(const std::function<int(int, int)>& surface_voxel) {
  StaticMap map(kVoxel_m);
  for (int z = 0; z < 25; ++z)
    for (int x = 0; x < 25; ++x) {
      const int surface = -surface_voxel(x, z);
      for (int y = -20; y < surface; ++y) map.add_evidence(MapLeaf{{x, y, z}, 1, -1.0F});
      map.add_evidence(MapLeaf{{x, surface, z}, 1, 2.0F});
      SurfaceSample sample;
      sample.voxel = {x, surface, z};
      sample.weight = 1.0F;
      map.add_evidence(sample);
    }
  return map;
}

TEST_F(MapPairs, SingleVoxelsThatStandOutFromANoisyWallAreNoChange) {
  const StaticMap even = wall_at([](int, int) { return 0; });
  // as a wall that was measured from 5 m: every twelfth voxel is 10 cm in front, the others 0 to 6 cm
  const auto rough = [](int x, int z) {
    return std::array{0, 0, 1, 1, 2, 2, 3, 3, 1, 2, 0, 5}.at((7 * x + 5 * z) % 12);
  };
  const Isometry3d same = Isometry3d::Identity();
  EXPECT_TRUE(diff_maps(even, wall_at(rough), same).empty());
  EXPECT_TRUE(diff_maps(wall_at(rough), even, same).empty());
  // a box of 16 x 16 x 16 cm on the wall
  const auto is_box = [](int x, int z) { return x / 8 == 1 && z / 8 == 1; };
  EXPECT_EQ(diff_maps(even, wall_at([&](int x, int z) { return is_box(x, z) ? 8 : 0; }), same).size(), 1U);
  const auto rough_with_box = [&](int x, int z) { return is_box(x, z) ? 8 : rough(x, z); };
  const std::vector<Change> found = diff_maps(even, wall_at(rough_with_box), same);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(found[0].box_world.sizes().maxCoeff(), 0.4) << "with the wall around it, which is 0.5 m wide";
}

TEST_F(MapPairs, AWallThatTheOtherScanOnlyJustPassedIsNoChange) {
  const StaticMap wall = wall_at([](int, int) { return 0; });
  const auto free_to = [](int end_voxel) {
    StaticMap map(kVoxel_m);
    for (int z = 0; z < 25; ++z)
      for (int y = -20; y < end_voxel; ++y)
        for (int x = 0; x < 25; ++x) map.add_evidence(MapLeaf{{x, y, z}, 1, -1.0F});
    return map;
  };
  // Rays that end elsewhere freed the wall's voxels and 8 cm behind them; what comes then is unknown.
  EXPECT_TRUE(diff_maps(free_to(5), wall, Isometry3d::Identity()).empty());
  EXPECT_EQ(diff_maps(free_to(20), wall, Isometry3d::Identity()).size(), 1U);
}

TEST_F(MapPairs, WhatOneMapHasNotSeenHasNotChanged) {
  // The object is where a has no observations.
  const Eigen::AlignedBox3d far_off(Vector3d(0.2, -1.6, 0.0), Vector3d(0.6, -1.2, 0.4));
  const SavedMap after = scan(with(room(), far_off), -0.6, 0.8, Isometry3d::Identity(), 60);
  EXPECT_TRUE(diff_maps(a().octree.load(), after.octree.load(), Isometry3d::Identity()).empty());
}

TEST_F(MapPairs, PosesThatAreOffAreNoChange) {
  const Isometry3d T_off(Eigen::Translation3d(0.02, -0.10, 0.01));
  DiffConfig doubting, trusting;
  doubting.max_pose_error_m = 0.11;
  EXPECT_TRUE(diff_maps(a().octree.load(), b().octree.load(), T_off * kT_a_b, doubting).empty());
  trusting.max_pose_error_m = 0.0;
  EXPECT_FALSE(diff_maps(a().octree.load(), b().octree.load(), T_off * kT_a_b, trusting).empty());
}

TEST(MapDiff, OfASolidCubeTheSkinHasChanged) {
  constexpr int kEdge = 16;
  StaticMap before(0.02), after(0.02);
  before.add_evidence(MapLeaf{{-64, -64, -64}, 64, -2.0F});
  before.add_evidence(MapLeaf{{-64, -64, 0}, 64, -2.0F});
  after.add_evidence(MapLeaf{{-48, -48, -16}, kEdge, 3.0F});
  const std::vector<Change> changes = diff_maps(before, after, Isometry3d::Identity());
  ASSERT_EQ(changes.size(), 1U);
  constexpr int kInside = kEdge - 2;
  EXPECT_EQ(changes[0].surface_world.size(), kEdge * kEdge * kEdge - kInside * kInside * kInside);
  EXPECT_NEAR(changes[0].box_world.sizes().minCoeff(), kEdge * 0.02, 1e-9);
}

TEST(SampleSurface, SpreadsPointsByArea) {
  Mesh mesh;
  mesh.origin = Vector3d(10, 0, 0);
  mesh.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const std::vector<Vector3d> points = sample_surface(mesh, 400);
  ASSERT_EQ(points.size(), 400U);
  EXPECT_EQ(std::count_if(points.begin(), points.end(), [](const Vector3d& p) { return p.z() < 1.0; }), 300);
  for (const Vector3d& p : points) EXPECT_TRUE(p.x() >= 10.0 && p.y() >= 0.0 && p.x() <= 13.0);
  EXPECT_TRUE(sample_surface(Mesh{}, 10).empty());
}

}  // namespace
}  // namespace roomradar::map_pairs_test
