// held_out_test.cpp: a flat wall measured at known distances in front of and behind its mesh.
#include "app/evaluation/held_out.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/prescan.hpp"

namespace roomradar::held_out_test {
namespace {

constexpr Intrinsics kCamera{64, 48, 58.5, 58.5, 31.5, 23.5};

/// Frames of constant depth.
class FlatSource final : public FrameSource {
 public:
  explicit FlatSource(std::vector<float> depths_m) : depths_m_(std::move(depths_m)) {}
  ReadResult next(Frame& frame) override {
    if (position_ == depths_m_.size()) return {ReadStatus::kEnd, {}};
    frame.index = static_cast<std::int64_t>(position_);
    frame.depth_camera = kCamera;
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, depths_m_[position_++]);
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    position_ = 0;
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override {
    return static_cast<std::int64_t>(depths_m_.size());
  }
  [[nodiscard]] std::string name() const override { return "flat"; }

 private:
  std::vector<float> depths_m_;
  std::size_t position_ = 0;
};

/// A wall across the view at z = 2 m, from x = left_m to the right.
Mesh wall(float left_m) {
  Mesh mesh;
  mesh.origin = {0.0, 0.0, 2.0};
  mesh.vertices = {{left_m, -9.0F, 0.0F}, {9.0F, -9.0F, 0.0F}, {9.0F, 9.0F, 0.0F}, {left_m, 9.0F, 0.0F}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

std::vector<TimedPose> asleep(std::int64_t frames) {
  std::vector<TimedPose> poses;
  for (std::int64_t i = 0; i < frames; ++i) poses.push_back({i, 0.0, Eigen::Isometry3d::Identity()});
  return poses;
}

TEST(HeldOut, EveryNthFromTheMiddleOfTheFirstN) {
  EXPECT_TRUE(is_held_out(5, 10));
  EXPECT_TRUE(is_held_out(295, 10));
  EXPECT_FALSE(is_held_out(0, 10));
  EXPECT_FALSE(is_held_out(5, 0));
  EXPECT_FALSE(is_held_out(5, -10));
}

TEST(HeldOut, OnlyTheHeldOutFramesAreCompared) {
  // Frames 1 and 3 (N = 2) measure the wall 10 mm too far; the mesh is in front of it. The others are far
  // off.
  FlatSource source({0.5F, 2.01F, 0.5F, 2.01F});
  const HeldOutScore score = score_held_out(source, wall(-9.0F), asleep(4), 2);
  EXPECT_EQ(score.frames, 2);
  EXPECT_EQ(score.pixels, 2 * 16 * 12);
  EXPECT_DOUBLE_EQ(score.cover, 1.0);
  EXPECT_NEAR(score.median_m, 0.010, 5e-5);
  EXPECT_NEAR(score.bias_m, -0.010, 5e-5);
  EXPECT_DOUBLE_EQ(score.outliers, 0.0);
}

TEST(HeldOut, HalfAWallCoversHalfOfThePixels) {
  FlatSource source({1.7F, 1.7F});  // 0.3 m in front of the mesh: covered, and outliers
  const HeldOutScore score = score_held_out(source, wall(0.0F), asleep(2), 2);
  EXPECT_DOUBLE_EQ(score.cover, 0.5);
  EXPECT_NEAR(score.bias_m, 0.3, 5e-5);
  EXPECT_DOUBLE_EQ(score.outliers, 1.0);
}

TEST(HeldOut, NothingIsClaimedWhereNothingCanBeCompared) {
  FlatSource far({4.5F, 4.5F});  // beyond the range compared
  EXPECT_EQ(score_held_out(far, wall(-9.0F), asleep(2), 2).pixels, 0);
  FlatSource one({2.0F});
  const HeldOutScore without_pose = score_held_out(one, wall(-9.0F), {}, 2);
  EXPECT_EQ(without_pose.frames, 0);
  EXPECT_DOUBLE_EQ(without_pose.cover, 0.0);
}

}  // namespace
}  // namespace roomradar::held_out_test
