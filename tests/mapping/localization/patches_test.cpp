// patches_test.cpp: patches match from other viewpoints, and yield the camera's pose.
#include "mapping/localization/patches.hpp"

#include <gtest/gtest.h>

#include "mapping/localization/patch_matching.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::patches_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};

Frame painted(const Eigen::Isometry3d& T_world_camera) {
  Frame frame = test::exact_frame(test::corner_with_ball(), kCamera, T_world_camera);
  test::paint(frame, T_world_camera);
  test::add_depth_noise(frame, 7);
  return frame;
}

KeyframeDatabase place_at(const Eigen::Isometry3d& T_world_camera) {
  return {{make_map_keyframe(painted(T_world_camera), T_world_camera)}, {}};
}

const Eigen::Isometry3d kEye = test::looking_at({-0.2, -0.3, 1.2}, {0.0, 2.0, 0.6});
/// 0.9 m to the side and nearer, and rolled.
const Eigen::Isometry3d kAside =
    test::looking_at({0.6, 0.2, 1.0}, {-0.2, 2.2, 0.5}, Eigen::Vector3d(0.5, 0.0, 0.8));

TEST(Patches, LieOnTheSurfaceAndFaceTheViewer) {
  const std::vector<SurfacePatch> patches = describe_patches(painted(kEye), 300);
  ASSERT_GT(patches.size(), 100U);
  ASSERT_LE(patches.size(), 300U);
  for (const SurfacePatch& patch : patches) {
    const Eigen::Vector3d ray = kEye.linear() * (patch.point / patch.point.z()).cast<double>();
    EXPECT_NEAR(static_cast<double>(patch.point.z()), test::corner_with_ball()(kEye.translation(), ray), 0.1);
    EXPECT_LT(patch.normal.dot(patch.point), 0.0F);
    EXPECT_NEAR(patch.normal.norm(), 1.0F, 1e-4F);
    EXPECT_NEAR(patch.along.norm(), 1.0F, 1e-4F);
    EXPECT_NEAR(patch.along.dot(patch.normal), 0.0F, 1e-4F);
  }
}

TEST(Patches, OfOneViewSayWhereAViewFromAsideStands) {
  const PatchIndex known = build_patch_index(place_at(kEye));
  const auto candidates = propose_poses(describe_patches(painted(kAside), 400), known, 4, 6);
  ASSERT_FALSE(candidates.empty());
  const Eigen::Isometry3d error = kAside.inverse() * candidates.front().T_world_camera;
  EXPECT_LT(error.translation().norm(), 0.03);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.03);
}

TEST(Patches, OfAnotherRoomAreNotFound) {
  const auto other = [](const Eigen::Vector3d& p) {
    return test::cube_grey(p + Eigen::Vector3d(31.0, 17.0, 5.0));
  };
  Frame frame = test::exact_frame(test::corner_with_ball(), kCamera, kAside);
  test::paint_with(other, frame, kAside);
  EXPECT_TRUE(propose_poses(describe_patches(frame, 400), build_patch_index(place_at(kEye)), 4, 6).empty());
}

TEST(Patches, SpeakForTheTruePoseAndAgainstOthers) {
  const PatchIndex known = build_patch_index(place_at(kEye));
  const std::vector<SurfacePatch> seen = describe_patches(painted(kAside), 400);
  const PatchAgreement right = match_patches_at(seen, known, kAside);
  EXPECT_GT(right.alike.size(), 30U);
  EXPECT_GT(right.alike_part(), 0.35);
  for (const PointPair& pair : right.alike) EXPECT_LT((kAside * pair.b - pair.a).norm(), 0.03);
  Eigen::Isometry3d along_the_wall = kAside;
  along_the_wall.pretranslate(Eigen::Vector3d(0.12, 0.0, 0.0));
  const PatchAgreement wrong = match_patches_at(seen, known, along_the_wall);
  EXPECT_GT(wrong.compared, 30);
  EXPECT_LT(wrong.alike_part(), 0.1);
  EXPECT_EQ(match_patches_at({}, known, kAside).compared, 0);
  EXPECT_EQ(match_patches_at(seen, {}, kAside).alike_part(), 0.0);
}

TEST(Patches, NeedColourAndDepth) {
  Frame blind = painted(kEye);
  blind.colour = {};
  EXPECT_TRUE(describe_patches(blind, 300).empty());
  Frame dark = painted(kEye);
  dark.depth_m.resize(kCamera.width_px, kCamera.height_px);
  EXPECT_TRUE(describe_patches(dark, 300).empty());
  EXPECT_TRUE(describe_patches(painted(kEye), 0).empty());
  EXPECT_TRUE(propose_poses({}, build_patch_index({}), 4, 6).empty());
  EXPECT_TRUE(build_patch_index({}).empty());
}

}  // namespace
}  // namespace roomradar::patches_test
