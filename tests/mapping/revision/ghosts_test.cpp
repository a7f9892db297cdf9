// ghosts_test.cpp: objects that moved away are removed from the map, static ones stay.
#include "mapping/revision/ghosts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "mapping/revision/ghost_removal.hpp"
#include "mapping/revision/ghost_zone.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::ghosts_test {
namespace {

using test::exact_frame;
using test::looking_at;
using test::Scene;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
constexpr double kResolution_m = 0.02;

// A recording in memory.
class FrameList final : public FrameSource {
 public:
  explicit FrameList(std::vector<Frame> frames, bool can_seek = true)
      : frames_(std::move(frames)), can_seek_(can_seek) {}
  ReadResult next(Frame& frame) override {
    if (position_ >= frames_.size()) return {ReadStatus::kEnd, {}};
    frame = frames_[position_++];
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    position_ = 0;
    return true;
  }
  bool seek(std::int64_t index) override {
    if (!can_seek_) return false;
    position_ = static_cast<std::size_t>(index);
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(frames_.size());
  }
  [[nodiscard]] std::string name() const override { return "frames in memory"; }
  [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }

 private:
  std::vector<Frame> frames_;
  bool can_seek_;
  std::size_t position_ = 0;
};

struct Scan {
  StaticMap map{kResolution_m};
  std::int64_t ghosts = 0;
};

// Fuses all frames at their own poses, disturbed by up to pose_noise_m, and removes ghosts.
Scan scan(FrameList source, double pose_noise_m = 0.0) {
  Scan scan;
  std::vector<FusedFrame> fused;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-pose_noise_m, pose_noise_m);
  for (const Frame& frame : source.frames()) {
    Eigen::Isometry3d T_world_camera = *frame.T_world_camera;
    if (pose_noise_m > 0.0)
      T_world_camera.translation() += Eigen::Vector3d(off(random), off(random), off(random));
    if (scan.map.fuse(frame, T_world_camera) != FuseStatus::kFused) continue;
    const auto position = static_cast<std::int64_t>(fused.size());
    fused.push_back({position, frame.index, frame.depth_camera, T_world_camera});
  }
  StageTimes times;
  GhostRevision revision = remove_ghosts(source, fused, {}, scan.map, times);
  refuse_surroundings(source, fused, revision, scan.map, times);
  scan.ghosts = revision.voxels();
  return scan;
}

/// Fuses all frames at their own poses.
std::vector<FusedFrame> fuse_all(const std::vector<Frame>& frames, StaticMap& map) {
  std::vector<FusedFrame> fused;
  for (const Frame& frame : frames) {
    EXPECT_EQ(map.fuse(frame, *frame.T_world_camera), FuseStatus::kFused);
    fused.push_back({frame.index, frame.index, frame.depth_camera, *frame.T_world_camera});
  }
  return fused;
}

// `count` frames from a camera that sways slightly in front of the wall; scene_at(i) is the scene of frame i.
template <typename SceneAt>
std::vector<Frame> record(int count, const SceneAt& scene_at, unsigned noise_seed = 1) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d eye(0.15 * std::sin(0.3 * i), 0.0, 0.05 * std::cos(0.3 * i));
    Frame frame = exact_frame(scene_at(i), kCamera, looking_at(eye, {0.0, 2.0, 0.0}));
    frame.index = i;
    test::add_depth_noise(frame, noise_seed + static_cast<unsigned>(i));
    frames.push_back(std::move(frame));
  }
  return frames;
}

Scene wall() { return test::plane(Eigen::Vector3d::UnitY(), 2.0); }
Scene before_wall(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return test::nearest_of(wall(), test::box({low, high}));
}

// Returns the vertices of the surface, in the world frame.
std::vector<Eigen::Vector3d> surface_of(const StaticMap& map) {
  const Mesh mesh = extract_surface(map, {.min_component_area_m2 = 0.0F, .max_deviation_m = 0.0F});
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3f& v : mesh.vertices) vertices.emplace_back(mesh.origin + v.cast<double>());
  return vertices;
}

std::int64_t count_before_wall(const std::vector<Eigen::Vector3d>& vertices, double margin_m) {
  return std::count_if(vertices.begin(), vertices.end(),
                       [=](const auto& v) { return v.y() < 2.0 - margin_m; });
}

std::int64_t occupied_before_wall(const StaticMap& map, double margin_m) {
  std::int64_t count = 0;
  map.visit_samples([&](const SurfaceSample& sample) {
    const double y = (sample.voxel.y() + 0.5) * kResolution_m;
    count += sample.occupancy == Occupancy::kOccupied && y < 2.0 - margin_m;
  });
  return count;
}

TEST(Ghosts, ABoxThatWasThereForHalfOfTheFramesVanishesAndTheWallBehindIsThere) {
  // 20 cm wide, its face 9 cm in front of the wall, at 2 m: beyond the margin, but its rear voxels touch the
  // wall's.
  const auto frames = record(40, [](int i) {
    return i < 20 ? before_wall({-0.1, 1.91, -0.1}, {0.1, 2.1, 0.1}) : wall();
  });
  const Scan scanned = scan(FrameList(frames));
  const auto vertices = surface_of(scanned.map);
  EXPECT_EQ(count_before_wall(vertices, 0.02), 0);
  EXPECT_EQ(occupied_before_wall(scanned.map, 0.03), 0);
  // The wall that the box hid: one vertex per voxel, at most 1 cm off.
  const auto behind = std::count_if(vertices.begin(), vertices.end(), [](const auto& v) {
    return std::abs(v.x()) < 0.08 && std::abs(v.z()) < 0.08 && std::abs(v.y() - 2.0) < 0.01;
  });
  EXPECT_GE(behind, 49);
}

TEST(Ghosts, ABoxInCoarseCellsVanishesAsAWhole) {
  const Scene far_wall = test::plane(Eigen::Vector3d::UnitY(), 4.5);
  const Scene with_box = test::nearest_of(
      far_wall, test::box({Eigen::Vector3d(-0.3, 3.5, -0.3), Eigen::Vector3d(0.3, 3.8, 0.3)}));
  const std::vector<Frame> frames = record(40, [&](int i) { return i < 20 ? far_wall : with_box; });
  StaticMap map(kResolution_m);
  const std::vector<FusedFrame> fused = fuse_all(frames, map);
  const Eigen::AlignedBox3d round_box(Eigen::Vector3d(-0.5, 3.3, -0.5), Eigen::Vector3d(0.5, 4.0, 0.5));
  int coarse = 0, fine = 0;
  map.visit_cells(round_box, [&](const SurfaceSample&, int edge) { ++(edge > 1 ? coarse : fine); });
  ASSERT_GT(coarse, 500);
  ASSERT_EQ(fine, 0);
  FrameList source(frames);
  StageTimes times;
  GhostRevision revision = remove_ghosts(source, fused, {}, map, times);
  EXPECT_GT(revision.voxels(), 8 * 300);
  refuse_surroundings(source, fused, revision, map, times);
  int left = 0;
  map.visit_cells(round_box, [&](const SurfaceSample&, int) { ++left; });
  EXPECT_LE(left, 2);  // of samples beside the box's edges
  int wall = 0;
  map.visit_cells(
      {Eigen::Vector3d(-0.3, 4.3, -0.3), Eigen::Vector3d(0.3, 4.7, 0.3)},
      [&](const SurfaceSample& sample, int) { wall += sample.occupancy == Occupancy::kOccupied; });
  EXPECT_GT(wall, 100);
}

TEST(Ghosts, WhatCameLaterAndStayedForHalfOfTheFramesVanishesToo) {
  const auto frames = record(40, [](int i) {
    return i >= 20 ? before_wall({-0.1, 1.6, -0.1}, {0.1, 1.8, 0.1}) : wall();
  });
  const Scan scanned = scan(FrameList(frames));
  EXPECT_EQ(count_before_wall(surface_of(scanned.map), 0.03), 0);
  EXPECT_EQ(scanned.map.occupancy_at({0.0, 1.61, 0.0}), Occupancy::kFree);
}

// A box in the last frames. In most earlier frames something nearer hides the space of the box's left part
// and behind it.
std::vector<Frame> record_box_half_hidden_before(int frames_with_box, std::initializer_list<int> unhidden) {
  const Scene box = before_wall({-0.08, 1.6, -0.4}, {0.5, 1.8, 0.4});
  const Scene hider = test::nearest_of(
      wall(), test::box({Eigen::Vector3d(-0.6, 0.9, -0.6), Eigen::Vector3d(0.06, 1.0, 0.6)}));
  return record(40, [&, frames_with_box](int i) {
    if (i >= 40 - frames_with_box) return box;
    return std::find(unhidden.begin(), unhidden.end(), i) != unhidden.end() ? wall() : hider;
  });
}
std::int64_t occupied_of_its_left_face(const StaticMap& map) {
  std::int64_t count = 0;
  for (double x = -0.07; x < -0.04; x += kResolution_m)
    for (double z = -0.15; z < 0.15; z += kResolution_m)
      count += map.occupancy_at({x, 1.61, z}) == Occupancy::kOccupied;
  return count;
}

TEST(Ghosts, WhatHangsTogetherWithAGhostGoesOnLessEvidence) {
  // Two frames see through the left part: too few on their own.
  const Scan scanned = scan(FrameList(record_box_half_hidden_before(10, {10, 20})));
  EXPECT_EQ(occupied_of_its_left_face(scanned.map), 0);
}

TEST(Ghosts, WhatHangsTogetherWithAGhostAndWasHardlySeenGoes) {
  EXPECT_EQ(occupied_of_its_left_face(scan(FrameList(record_box_half_hidden_before(3, {}))).map), 0);
}

TEST(Ghosts, WhatHangsTogetherWithAGhostAndWasOftenSeenStays) {
  EXPECT_GE(occupied_of_its_left_face(scan(FrameList(record_box_half_hidden_before(12, {}))).map), 10);
}

TEST(Ghosts, OccupiedVoxelsWithoutASampleGoWithWhatTheyTouch) {
  GhostVotes::Verdicts verdicts;
  verdicts.absent = {{0, 0, 0}};
  verdicts.still = {{5, 0, 0}};
  verdicts.unseen = {{0, 5, 0}};
  const GhostZone zone(verdicts, kResolution_m);
  const auto fate_at = [&](const VoxelIndex& voxel, float weight) {
    SurfaceSample sample;
    sample.voxel = voxel;
    sample.occupancy = Occupancy::kOccupied;
    sample.weight = weight;
    return zone.fate_of(sample);
  };
  EXPECT_EQ(fate_at({1, 1, 0}, 0.0F), SampleAction::kUnknown);
  EXPECT_EQ(fate_at({1, 1, 0}, 1.0F), SampleAction::kEraseSample);  // cleared, to be measured again
  EXPECT_EQ(fate_at({3, 0, 0}, 0.0F), SampleAction::kEraseSample);  // near static surface
  EXPECT_EQ(fate_at({0, 3, 0}, 0.0F),
            SampleAction::kKeep);  // near surface that no frame of this scan observed
  EXPECT_EQ(fate_at({0, 5, 0}, 1.0F), SampleAction::kKeep);
  EXPECT_EQ(fate_at({40, 0, 0}, 0.0F), SampleAction::kKeep);
}

TEST(Ghosts, TheZoneReachesTwoVoxelsAcrossTheBordersOfBricks) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> at(-20, 20);
  const auto voxels = [&](int count) {
    std::vector<VoxelIndex> made;
    while (count-- > 0) made.emplace_back(at(random), at(random), at(random));
    return made;
  };
  const GhostVotes::Verdicts verdicts{voxels(40), voxels(20), voxels(60), voxels(60)};
  const GhostZone zone(verdicts, kResolution_m);
  const auto is_near = [](const VoxelIndex& voxel, const std::vector<VoxelIndex>& set, int most) {
    return std::any_of(set.begin(), set.end(), [&](const VoxelIndex& other) {
      return (other - voxel).cwiseAbs().maxCoeff() <= most;
    });
  };
  int unknown = 0;
  for (int z = -24; z <= 24; ++z)
    for (int y = -24; y <= 24; ++y)
      for (int x = -24; x <= 24; ++x) {
        SurfaceSample sample;  // occupied, but not measured
        sample.voxel = {x, y, z};
        sample.occupancy = Occupancy::kOccupied;
        const bool near_removed =
            is_near(sample.voxel, verdicts.ghosts, 2) || is_near(sample.voxel, verdicts.absent, 2);
        const bool near_kept =
            is_near(sample.voxel, verdicts.still, 2) || is_near(sample.voxel, verdicts.unseen, 2);
        const bool becomes_unknown =
            !is_near(sample.voxel, verdicts.ghosts, 0) &&
            (is_near(sample.voxel, verdicts.absent, 0) || (near_removed && !near_kept));
        ASSERT_EQ(zone.fate_of(sample) == SampleAction::kUnknown, becomes_unknown)
            << x << " " << y << " " << z;
        unknown += becomes_unknown;
      }
  EXPECT_GT(unknown, 500);
}

// The map contains an earlier scan; the image border of this scan's frames cuts the surface that they see
// through.
TEST(Ghosts, SurfaceOfAnEarlierScanThatNoFrameMeasuresAnewStays) {
  Scan scanned;
  const Scene with_box = before_wall({-0.25, 1.85, -0.3}, {0.25, 2.0, 0.3});
  fuse_all(record(20, [&](int) { return with_box; }), scanned.map);
  const auto wall_beside = [&scanned] {
    const auto vertices = surface_of(scanned.map);
    return std::count_if(vertices.begin(), vertices.end(), [](const Eigen::Vector3d& v) {
      return v.x() > 0.29 && v.x() < 0.35 && std::abs(v.z()) < 0.2 && std::abs(v.y() - 2.0) < 0.03;
    });
  };
  const std::int64_t before = wall_beside();
  ASSERT_GT(before, 30);

  std::vector<Frame> frames;
  for (int i = 0; i < 20; ++i) {  // the right border of the image is the plane x = 0.27 m
    frames.push_back(exact_frame(wall(), kCamera, looking_at({0.27, 0.0, 0.0}, {0.27 - 1.1, 2.0, 0.0})));
    frames.back().index = i;
    test::add_depth_noise(frames.back(), 100U + static_cast<unsigned>(i));
  }
  const std::vector<FusedFrame> fused = fuse_all(frames, scanned.map);
  FrameList source(frames);
  StageTimes times;
  GhostRevision revision = remove_ghosts(source, fused, {}, scanned.map, times);
  refuse_surroundings(source, fused, revision, scanned.map, times);
  EXPECT_GT(revision.voxels(), 100);  // the box
  EXPECT_GE(wall_beside(), before);
}

TEST(Ghosts, NoDepthBesideSomethingNearerMayBeItsShadow) {
  const Frame frame = exact_frame(wall(), kCamera, looking_at({0, 0, 0}, {0, 2, 0}));
  AbsenceVoter looks;
  looks.begin(frame, Eigen::Isometry3d::Identity());
  AbsenceVotes votes;
  looks.unmeasured(frame, {80, 60, 0.3F, /*beside_nearer=*/true}, {0.0F, 0.0F, 2.0F}, false, votes);
  EXPECT_EQ(votes.unmeasured, 0);
  looks.unmeasured(frame, {80, 60, 0.3F, /*beside_nearer=*/false}, {0.0F, 0.0F, 2.0F}, false, votes);
  EXPECT_EQ(votes.unmeasured, 1);
}

TEST(Ghosts, AThinPoleStaysThoughThePosesAreACentimetreOff) {
  // 4 cm wide, 3 pixels at this camera.
  const auto frames = record(40, [](int) { return before_wall({-0.02, 1.5, -1.0}, {0.02, 1.54, 1.0}); });
  const Scan scanned = scan(FrameList(frames), 0.01);
  std::int64_t occupied = 0;
  scanned.map.visit_samples([&](const SurfaceSample& sample) {
    occupied += sample.occupancy == Occupancy::kOccupied && sample.voxel.y() * kResolution_m < 1.6;
  });
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_GE(occupied, 50);  // 1.2 m of it are in view: 60 voxels
}

// 8 cm wide: smaller than what errors of tracking leave at edges.
TEST(Ghosts, ASmallThingGoesIfMoreFramesSeeThroughItThanMeasureIt) {
  const auto ghosts_of = [](int frames_with_box) {
    return scan(FrameList(record(40,
                                 [=](int i) {
                                   return i >= 40 - frames_with_box
                                              ? before_wall({-0.04, 1.2, -0.04}, {0.04, 1.28, 0.04})
                                              : wall();
                                 })))
        .ghosts;
  };
  EXPECT_GT(ghosts_of(12), 10);
  EXPECT_EQ(ghosts_of(30), 0);
}

// The centre of a coarse voxel is farther in front of the wall than noise or pose error explains.
TEST(Ghosts, AWallIsNoneHoweverCoarseTheCells) {
  const auto frames = record(20, [](int) { return wall(); });
  FrameList source(frames);
  for (const double resolution_m : {0.03, 0.05, 0.07, 0.1, 0.15, 0.2}) {
    StaticMap map(resolution_m);
    const std::vector<FusedFrame> fused = fuse_all(frames, map);
    StageTimes times;
    EXPECT_EQ(remove_ghosts(source, fused, {}, map, times).voxels(), 0) << resolution_m;
  }
}

TEST(Ghosts, WhatIsNeverSeenThroughIsLeftAsItIs) {
  const auto frames = record(12, [](int) { return before_wall({-0.1, 1.6, -0.1}, {0.1, 1.8, 0.1}); });
  const Scan scanned = scan(FrameList(frames));
  EXPECT_EQ(scanned.ghosts, 0);
  StaticMap fused_only(kResolution_m);
  for (const Frame& frame : frames)
    ASSERT_EQ(fused_only.fuse(frame, *frame.T_world_camera), FuseStatus::kFused);
  std::vector<SurfaceSample> expected, found;
  fused_only.visit_samples([&](const SurfaceSample& sample) { expected.push_back(sample); });
  scanned.map.visit_samples([&](const SurfaceSample& sample) { found.push_back(sample); });
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].voxel, expected[i].voxel);
    ASSERT_EQ(found[i].distance_m, expected[i].distance_m);
  }
}

// A shelf below, and a slab of 40 cm above it without any depth behind. Frame i has depth of the slab if
// is_measured(i, eye), and its colour if is_there(i); the background has another colour.
template <typename IsThere, typename IsMeasured>
std::vector<Frame> record_slab(const IsThere& is_there, const IsMeasured& is_measured) {
  constexpr Rgb kSlab{180, 60, 50}, kBehind{90, 90, 100};
  const Scene slab = test::box({Eigen::Vector3d(-0.2, 1.6, -0.2), Eigen::Vector3d(0.2, 1.8, 0.2)});
  const Scene shelf = test::box({Eigen::Vector3d(-2.0, 1.2, -0.6), Eigen::Vector3d(2.0, 2.4, -0.5)});
  std::vector<Frame> frames;
  for (int i = 0; i < 45; ++i) {
    const Eigen::Vector3d eye(0.15 * std::sin(0.3 * i), 0.0, 0.05 * std::cos(0.3 * i));
    const Eigen::Isometry3d T_world_camera = looking_at(eye, {0.0, 2.0, 0.0});
    Frame frame = exact_frame(is_measured(i, eye) ? test::nearest_of(shelf, slab) : shelf, kCamera,
                              T_world_camera, kBehind);
    for (int y = 0; y < kCamera.height_px && is_there(i); ++y)
      for (int x = 0; x < kCamera.width_px; ++x)
        if (std::isfinite(slab(eye, T_world_camera.linear() * back_project(kCamera, x, y, 1.0))))
          frame.colour.at(x, y) = kSlab;
    frame.index = i;
    test::add_depth_noise(frame, 1 + static_cast<unsigned>(i));
    frames.push_back(std::move(frame));
  }
  return frames;
}
const Eigen::Vector3d kInSlabsFace(0.01, 1.61, 0.01), kInShelf(0.01, 1.81, -0.51);

TEST(Ghosts, WhatWasThereForAThirdOfTheFramesIsUnknownThoughNothingIsMeasuredBehind) {
  const auto is_there = [](int i, const auto&...) { return i >= 15 && i < 30; };
  const Scan scanned = scan(FrameList(record_slab(is_there, is_there)));
  EXPECT_GE(scanned.ghosts, 400);  // its face alone has 20 x 20 voxels
  std::int64_t left = 0;
  scanned.map.visit_samples([&](const SurfaceSample& sample) {
    left += sample.occupancy == Occupancy::kOccupied && sample.voxel.z() * kResolution_m > -0.4;
  });
  EXPECT_EQ(left, 0);
  EXPECT_EQ(scanned.map.occupancy_at(kInSlabsFace), Occupancy::kUnknown);
  EXPECT_EQ(scanned.map.occupancy_at(kInShelf), Occupancy::kOccupied);
}

TEST(Ghosts, ADarkPanelThatIsMeasuredFromSomeSidesOnlyStays) {
  const auto frames =
      record_slab([](int) { return true; }, [](int, const Eigen::Vector3d& eye) { return eye.x() < -0.09; });
  const Scan scanned = scan(FrameList(frames));  // measured in less than a third of the frames
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_EQ(scanned.map.occupancy_at(kInSlabsFace), Occupancy::kOccupied);
}

TEST(Ghosts, AGlossyWallOfWhichEachFrameMeasuresOtherPartsStaysAsAWhole) {
  // A wall of 1.8 m that has no depth in a third of the image's columns, other ones in each frame. In the
  // middle, 40 cm of it are measured, and have their colour, in a third of the frames only, like an object
  // that was there for that time.
  const Scene glossy = test::box({Eigen::Vector3d(-0.9, 1.6, -0.2), Eigen::Vector3d(0.9, 1.8, 0.2)});
  std::vector<Frame> frames;
  for (int i = 0; i < 45; ++i) {
    const Eigen::Vector3d eye(0.15 * std::sin(0.3 * i), 0.0, 0.05 * std::cos(0.3 * i));
    Frame frame = exact_frame(glossy, kCamera, looking_at(eye, {0.0, 2.0, 0.0}), Rgb{180, 60, 50});
    for (int y = 0; y < kCamera.height_px; ++y)
      for (int x = 0; x < kCamera.width_px; ++x) {
        float& depth_m = frame.depth_m.at(x, y);
        const Eigen::Vector3d p_world =
            *frame.T_world_camera * back_project(kCamera, x, y, static_cast<double>(depth_m));
        const bool changes = depth_m > 0.0F && std::abs(p_world.x()) < 0.2;
        if (changes && (i < 15 || i >= 30)) {
          frame.colour.at(x, y) = Rgb{90, 90, 100};
          depth_m = 0.0F;
        }
        if (!changes && (x / 20 + i) % 3 == 0) depth_m = 0.0F;
      }
    frame.index = i;
    test::add_depth_noise(frame, 1 + static_cast<unsigned>(i));
    frames.push_back(std::move(frame));
  }
  const Scan scanned = scan(FrameList(frames));
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_EQ(scanned.map.occupancy_at({0.5, 1.61, 0.01}), Occupancy::kOccupied);
}

TEST(Ghosts, WhatIsHiddenBySomethingTooNearToBeMeasuredStays) {
  // A slab, and in front of its left half a post that has depth only from a distance. Later the camera sways
  // close behind the post. The slab's left half is then sometimes measured, sometimes hidden by colour
  // without depth.
  const Scene slab = test::box({Eigen::Vector3d(-0.4, 1.6, -0.2), Eigen::Vector3d(0.6, 1.8, 0.2)});
  const Scene post = test::box({Eigen::Vector3d(-0.5, 0.35, -1.0), Eigen::Vector3d(0.0, 0.4, 1.0)});
  std::vector<Frame> frames;
  for (int i = 0; i < 60; ++i) {
    const bool is_close = i >= 15;
    const Eigen::Vector3d eye(is_close ? 0.08 * std::sin(0.3 * i) - 0.03 : 0.0, is_close ? 0.0 : -0.8, 0.0);
    const Eigen::Isometry3d T_world_camera = looking_at(eye, {eye.x(), 2.0, 0.0});
    Frame frame = exact_frame(test::nearest_of(slab, post), kCamera, T_world_camera, Rgb{180, 60, 50});
    for (std::size_t n = 0; n < frame.depth_m.pixels.size(); ++n)
      if (frame.depth_m.pixels[n] > 0.0F && frame.depth_m.pixels[n] < 0.6F) {
        frame.depth_m.pixels[n] = 0.0F;
        frame.colour.pixels[n] = Rgb{20, 160, 40};
      }
    frame.index = i;
    test::add_depth_noise(frame, 1 + static_cast<unsigned>(i));
    frames.push_back(std::move(frame));
  }
  const Scan scanned = scan(FrameList(frames));
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_EQ(scanned.map.occupancy_at({-0.11, 1.61, 0.01}), Occupancy::kOccupied);
}

TEST(Ghosts, WhatStandsThereForMoreThanHalfOfTheFramesBeforeNothingMeasuredStays) {
  const auto is_there = [](int i, const auto&...) { return i < 25; };
  const Scan scanned = scan(FrameList(record_slab(is_there, is_there)));
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_EQ(scanned.map.occupancy_at(kInSlabsFace), Occupancy::kOccupied);
}

TEST(Ghosts, FramesWithoutDepthBehindAGhostAreNoEvidenceWithoutColour) {
  const Scene with_box = before_wall({-0.1, 1.6, -0.1}, {0.1, 1.8, 0.1});
  auto frames = record(40, [&](int i) { return i < 20 ? with_box : wall(); });
  // At the box's former position and around it, the later frames have no depth.
  for (int i = 20; i < 40; ++i)
    for (int y = 30; y < 90; ++y)
      for (int x = 40; x < 120; ++x) frames[static_cast<std::size_t>(i)].depth_m.at(x, y) = 0.0F;
  const Scan scanned = scan(FrameList(frames));
  EXPECT_EQ(scanned.ghosts, 0);
  EXPECT_EQ(scanned.map.occupancy_at({0.0, 1.61, 0.0}), Occupancy::kOccupied);
}

TEST(Ghosts, TheSameFramesGiveTheSameMapWhetherTheSourceCanSeekOrNot) {
  const auto frames = record(30, [](int i) {
    return i >= 15 ? before_wall({-0.2, 1.6, -0.2}, {0.2, 1.8, 0.2}) : wall();
  });
  const Scan a = scan(FrameList(frames, true));
  const Scan b = scan(FrameList(frames, false));
  EXPECT_GT(a.ghosts, 50);
  EXPECT_EQ(a.ghosts, b.ghosts);
  std::vector<SurfaceSample> samples_a, samples_b;
  a.map.visit_samples([&](const SurfaceSample& sample) { samples_a.push_back(sample); });
  b.map.visit_samples([&](const SurfaceSample& sample) { samples_b.push_back(sample); });
  ASSERT_EQ(samples_a.size(), samples_b.size());
  for (std::size_t i = 0; i < samples_a.size(); ++i) {
    ASSERT_EQ(samples_a[i].voxel, samples_b[i].voxel);
    ASSERT_EQ(samples_a[i].distance_m, samples_b[i].distance_m);
    ASSERT_EQ(samples_a[i].weight, samples_b[i].weight);
  }
}

TEST(Ghosts, ASecondLookThatIsCutOffGoesOnToTheSameMap) {
  FrameList source(record(30, [](int i) {
    return i >= 15 ? before_wall({-0.2, 1.6, -0.2}, {0.2, 1.8, 0.2}) : wall();
  }));
  StaticMap map(kResolution_m);
  const std::vector<FusedFrame> fused = fuse_all(source.frames(), map);
  StageTimes times;
  GhostRevision revision = remove_ghosts(source, fused, {}, map, times);
  ASSERT_GT(revision.voxels(), 0);
  const test::TemporaryFolder folder;
  GhostRevision kept;
  refuse_surroundings(source, fused, revision, map, times, [&](const std::string&) {
    if (revision.next != 11) return;
    kept = revision;
    map.write_ot(folder.path() / "octree.ot");
  });
  ASSERT_EQ(kept.next, 11U);
  StaticMap resumed = StaticMap::read_ot(folder.path() / "octree.ot");
  refuse_surroundings(source, fused, kept, resumed, times);
  std::vector<SurfaceSample> expected;
  map.visit_samples([&](const SurfaceSample& sample) { expected.push_back(sample); });
  std::size_t next = 0;
  resumed.visit_samples([&](const SurfaceSample& sample) {
    ASSERT_LT(next, expected.size());
    ASSERT_EQ(sample.voxel, expected[next].voxel);
    ASSERT_EQ(sample.distance_m, expected[next++].distance_m);
  });
  EXPECT_EQ(next, expected.size());
}

TEST(Ghosts, FramesThatDoNotFitTheirCameraSayNothing) {
  // Something stands before the wall in the last frames. The others see through where it is.
  const Scene with_box = before_wall({-0.3, 1.2, -0.3}, {0.3, 1.4, 0.3});
  StaticMap map(kResolution_m);
  const auto frames = record(24, [&](int i) { return i < 14 ? wall() : with_box; });
  for (const Frame& frame : frames) ASSERT_EQ(map.fuse(frame, *frame.T_world_camera), FuseStatus::kFused);
  GhostVotes votes(map);
  for (const Frame& frame : frames) votes.look(frame, *frame.T_world_camera);
  const auto ghosts = votes.verdicts().ghosts.size();
  EXPECT_GT(ghosts, 100U);
  Frame wrong = frames[20];  // would say that the box is there
  wrong.depth_camera.width_px = 80;
  for (int i = 0; i < 500; ++i) votes.look(wrong, *wrong.T_world_camera);
  votes.look(Frame{}, Eigen::Isometry3d::Identity());
  EXPECT_EQ(votes.verdicts().ghosts.size(), ghosts);
  for (int i = 0; i < 500; ++i) votes.look(frames[20], *frames[20].T_world_camera);
  EXPECT_LT(votes.verdicts().ghosts.size(), ghosts) << "the right ones count";
}

TEST(Ghosts, WhatStaysIsListedNearWhatGoesAlone) {
  const Scene beside_it = before_wall({0.3, 1.2, -0.3}, {0.6, 1.4, 0.3});
  const Scene with_box = test::nearest_of(beside_it, before_wall({-0.3, 1.2, -0.3}, {0.3, 1.4, 0.3}));
  StaticMap map(kResolution_m);
  const auto frames = record(24, [&](int i) { return i < 14 ? beside_it : with_box; });
  for (const Frame& frame : frames) ASSERT_EQ(map.fuse(frame, *frame.T_world_camera), FuseStatus::kFused);
  GhostVotes votes(map);
  for (const Frame& frame : frames) votes.look(frame, *frame.T_world_camera);
  const GhostVotes::Verdicts verdicts = votes.verdicts();
  const GhostZone zone(verdicts, kResolution_m);
  std::size_t beside = 0;
  map.visit_samples([&](const SurfaceSample& sample) {
    if (sample.occupancy == Occupancy::kOccupied && zone.reaches(sample.voxel)) ++beside;
  });
  ASSERT_GT(beside, verdicts.ghosts.size() + 100U);
  EXPECT_GT(verdicts.ghosts.size(), 100U);
  for (const VoxelIndex& voxel : verdicts.still) EXPECT_TRUE(zone.reaches(voxel));
  // All of the occupied surface that the zone reaches is a ghost, absent, still or unseen.
  EXPECT_GE(verdicts.ghosts.size() + verdicts.absent.size() + verdicts.still.size() + verdicts.unseen.size(),
            beside);
  StaticMap still_map(kResolution_m);
  const auto of_wall = record(8, [](int) { return wall(); });
  for (const Frame& frame : of_wall)
    ASSERT_EQ(still_map.fuse(frame, *frame.T_world_camera), FuseStatus::kFused);
  GhostVotes nothing_goes(still_map);
  for (const Frame& frame : of_wall) nothing_goes.look(frame, *frame.T_world_camera);
  EXPECT_TRUE(nothing_goes.verdicts().still.empty());
}

TEST(Ghosts, AnEmptyMapHasNone) {
  const StaticMap map(kResolution_m);
  GhostVotes votes(map);
  votes.look(record(1, [](int) { return wall(); })[0], Eigen::Isometry3d::Identity());
  EXPECT_TRUE(votes.verdicts().ghosts.empty());
}

TEST(Ghosts, ConfigsOutOfTheirRulesAreRefused) {
  EXPECT_THROW(require_valid(GhostConfig{.margin_m = 0.0F}), Error);
  EXPECT_THROW(require_valid(GhostConfig{.window_radius_m = -1.0F}), Error);
  EXPECT_THROW(require_valid(GhostConfig{.min_through = 0}), Error);
  EXPECT_THROW(require_valid(GhostConfig{.min_through_share = std::nanf("")}), Error);
  EXPECT_THROW(require_valid(GhostConfig{.max_looks = 0}), Error);
  EXPECT_NO_THROW(require_valid(GhostConfig{}));
}

TEST(DepthWindows, AgreeWithLookingAtEachPixel) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> depth(0.5F, 5.0F);
  for (const auto& [width, height] : {std::pair{97, 71}, {40, 200}, {5, 3}, {1, 1}}) {
    DepthImage depth_m(width, height);
    for (float& d : depth_m.pixels) d = random() % 3 == 0 ? 0.0F : depth(random);
    DepthWindows windows;
    build_windows(depth_m, windows);
    for (int i = 0; i < 2000; ++i) {
      const int x = static_cast<int>(random() % static_cast<unsigned>(width));
      const int y = static_cast<int>(random() % static_cast<unsigned>(height));
      const int radius = static_cast<int>(random() % (kMaxWindowRadius_px + 1));
      float nearest = std::numeric_limits<float>::infinity();
      int measured = 0;
      for (int v = y - radius; v <= y + radius; ++v)
        for (int u = x - radius; u <= x + radius; ++u)
          if (depth_m.contains(u, v) && depth_m.at(u, v) > 0.0F) {
            nearest = std::min(nearest, depth_m.at(u, v));
            ++measured;
          }
      const WindowDepth window = window_depth(windows, x, y, radius);
      const bool inside = x >= radius && y >= radius && x + radius < width && y + radius < height;
      if (inside) {
        EXPECT_EQ(window.nearest_m, nearest);
      }
      EXPECT_LE(window.nearest_m, nearest);  // at the border the window may include more pixels, never fewer
      const auto pixels = static_cast<float>((2 * radius + 1) * (2 * radius + 1));
      EXPECT_FLOAT_EQ(window.measured_share, static_cast<float>(measured) / pixels);
    }
  }
}

}  // namespace
}  // namespace roomradar::ghosts_test
