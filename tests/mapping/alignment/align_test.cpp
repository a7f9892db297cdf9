// align_test.cpp: pose of a frame relative to views with known poses.
#include "mapping/alignment/align.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <span>

#include "mapping/alignment/point_to_plane.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::align_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};

test::Scene corner_with_ball() {
  using namespace test;
  return nearest_of(nearest_of(plane({0, 0, 1}, 0.0), plane({0, 1, 0}, 3.0)),
                    nearest_of(plane({1, 0, 0}, -1.5), sphere({0.2, 2.0, 0.4}, 0.4)));
}

Eigen::Isometry3d eye() { return test::looking_at({0.6, 0.2, 1.3}, {0.0, 2.2, 0.5}); }

Eigen::Isometry3d moved(double x_m, double y_m, double z_m, double rx, double ry, double rz) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << x_m, y_m, z_m, rx, ry, rz;
  return retract(twist);
}

TargetView reference_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  ViewPyramid pyramid;
  TargetView reference;
  make_pyramid(frame, {}, pyramid);
  make_target_view(pyramid, T_world_camera, {}, reference);
  return reference;
}

SourcePoints live_of(const Frame& frame, const MaskImage& ignore = {}) {
  ViewPyramid pyramid;
  SourcePoints live;
  make_pyramid(frame, {}, pyramid);
  make_source_points(pyramid, live, ignore);
  return live;
}

double translation_error_m(const Tracking& tracking, const Eigen::Isometry3d& truth) {
  return (tracking.T_world_camera.translation() - truth.translation()).norm();
}

double rotation_error_rad(const Tracking& tracking, const Eigen::Isometry3d& truth) {
  return Eigen::AngleAxisd(truth.linear().transpose() * tracking.T_world_camera.linear()).angle();
}

// A target view's planes are fitted across creases between surfaces as far as the noise allows. Even exact
// depth therefore leaves an error of this size.
constexpr double kFit_m = 0.003, kFit_rad = 0.0015;

const Eigen::Isometry3d kStep = moved(0.03, -0.02, 0.025, 0.02, -0.03, 0.015);

TEST(Twist, LogIsTheInverseOfExp) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << 1.0, -2.0, 0.5, 0.3, -0.8, 0.1;
  EXPECT_TRUE(local(retract(twist)).isApprox(twist, 1e-12));
  EXPECT_TRUE(local(Eigen::Isometry3d::Identity()).isZero(1e-15));
}

TEST(MakeReference, PlainAndFastestArithmeticMakeTheSameViewBitForBit) {
  for (const Intrinsics& camera : {kCamera, Intrinsics{163, 121, 146.0, 146.0, 81.0, 60.0}}) {
    Frame frame = test::exact_frame(corner_with_ball(), camera, eye());
    test::paint(frame, eye());
    test::add_depth_noise(frame, 7);
    ViewPyramid pyramid;
    make_pyramid(frame, {}, pyramid);
    for (const bool is_noisy : {true, false}) {
      ViewConfig config;
      config.noisy = is_noisy;
      TargetView fastest, plain;
      make_target_view(pyramid, eye(), config, fastest, Arithmetic::kFastest);
      make_target_view(pyramid, eye(), config, plain, Arithmetic::kPortable);
      ASSERT_EQ(fastest.levels.size(), plain.levels.size());
      for (std::size_t level = 0; level < plain.levels.size(); ++level) {
        std::size_t planes = 0;
        const auto& pixels = fastest.levels[level].pixels.pixels;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
          const TargetPixel &a = pixels[i], &b = plain.levels[level].pixels.pixels[i];
          planes += a.inverse_sigma_per_m > 0.0F ? 1 : 0;
          ASSERT_EQ(a.normal, b.normal);
          ASSERT_EQ(a.offset_m, b.offset_m);
          ASSERT_EQ(a.inverse_sigma_per_m, b.inverse_sigma_per_m);
          ASSERT_EQ(a.intensity, b.intensity);
          ASSERT_EQ(a.gradient_u, b.gradient_u);
          ASSERT_EQ(a.gradient_v, b.gradient_v);
        }
        EXPECT_GT(planes, pixels.size() / 3);
      }
    }
  }
}

struct MatchCase {
  TargetView reference;
  std::vector<SourcePoint> points;
};
MatchCase match_case() {
  Frame before = test::exact_frame(corner_with_ball(), kCamera, eye());
  Frame frame = test::exact_frame(corner_with_ball(), kCamera, eye() * kStep);
  test::paint(before, eye());
  test::paint(frame, eye() * kStep);
  return {reference_of(before, eye()), live_of(frame).levels[0]};
}

void match(const MatchCase& of, std::span<const SourcePoint> points, const RowMotion& motion,
           PointMatches& pass, Arithmetic arithmetic = Arithmetic::kFastest) {
  match_points({{points.begin(), points.end()}, motion}, of.reference.levels[0], {kStep, {1.1F, -3.0F, true}},
               {0.1F, 0.5F, 0.2F}, pass, arithmetic);
}

TEST(MatchPoints, CountsEachPointOnce) {
  const MatchCase of = match_case();
  const std::span<const SourcePoint> points = of.points;
  PointMatches whole;
  match(of, points, {}, whole);
  EXPECT_GT(whole.inliers, 1000U);
  for (const std::size_t at : {1U, 7U, 8U, 1029U}) {
    PointMatches parts;
    match(of, points.first(at), {}, parts);
    match(of, points.subspan(at), {}, parts);
    EXPECT_EQ(parts.met, whole.met);
    EXPECT_EQ(parts.inliers, whole.inliers);
    EXPECT_NEAR(parts.depth.weight, whole.depth.weight, 1e-5 * whole.depth.weight);
    EXPECT_NEAR(parts.n, whole.n, 1e-5 * whole.n);
    EXPECT_TRUE(parts.colour.H.isApprox(whole.colour.H, 1e-5));
  }
}

TEST(MatchPoints, PlainAndFastestArithmeticGiveTheSameSumsBitForBit) {
  RowMotion moving;
  moving.linear_mps = {0.1F, 0.2F, -0.3F};
  moving.angular_radps = {0.5F, -0.2F, 0.1F};
  moving.row_s = 1e-4F;
  moving.fy_px = 292.5F;
  const MatchCase of = match_case();
  for (const RowMotion& motion : {RowMotion(), moving})
    for (const std::size_t leave_out : {0U, 1U, 5U}) {
      const auto points = std::span(of.points).first(of.points.size() - leave_out);
      PointMatches fastest, plain;
      match(of, points, motion, fastest, Arithmetic::kFastest);
      match(of, points, motion, plain, Arithmetic::kPortable);
      EXPECT_GT(fastest.inliers, 1000U);
      EXPECT_GT(fastest.colour.H(0, 0), 0.0);
      EXPECT_EQ(fastest.depth.H, plain.depth.H);
      EXPECT_EQ(fastest.depth.g, plain.depth.g);
      EXPECT_EQ(fastest.depth.weight, plain.depth.weight);
      EXPECT_EQ(fastest.colour.H, plain.colour.H);
      EXPECT_EQ(fastest.colour.g, plain.colour.g);
      EXPECT_EQ(fastest.met, plain.met);
      EXPECT_EQ(fastest.inliers, plain.inliers);
      EXPECT_EQ(fastest.squares, plain.squares);
      EXPECT_EQ(fastest.n, plain.n);
      EXPECT_EQ(fastest.live_live, plain.live_live);
    }
}

TEST(MakeReference, PlanesLieOnTheSurface) {
  const Eigen::Isometry3d T = eye();
  const TargetView reference = reference_of(test::exact_frame(test::plane({0, 0, 1}, 0.0), kCamera, T), T);
  const Eigen::Vector3d up_camera = T.linear().transpose() * Eigen::Vector3d::UnitZ();
  for (const TargetLevel& level : reference.levels) {
    int planes = 0;
    for (const TargetPixel& pixel : level.pixels.pixels) {
      if (pixel.inverse_sigma_per_m <= 0.0F) continue;
      ++planes;
      ASSERT_GT(pixel.normal.cast<double>().dot(up_camera), 0.9999);  // 0.8 degrees
      ASSERT_NEAR(pixel.offset_m, -1.3, 0.003);                       // the camera is 1.3 m above the floor
    }
    EXPECT_GT(planes, level.camera.width_px * level.camera.height_px / 3);
  }
}

TEST(Align, FindsAKnownMotion) {
  const Eigen::Isometry3d T = eye(), truth = T * kStep;
  const TargetView reference = reference_of(test::exact_frame(corner_with_ball(), kCamera, T), T);
  const Tracking tracking =
      align(live_of(test::exact_frame(corner_with_ball(), kCamera, truth)), reference, T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), kFit_m);
  EXPECT_LT(rotation_error_rad(tracking, truth), kFit_rad);
  EXPECT_EQ(tracking.unconstrained_dofs, 0);
  EXPECT_GT(tracking.inlier_fraction, 0.9);
}

TEST(Align, FollowsARenderedViewWithoutColour) {
  const Eigen::Isometry3d T = eye(), truth = T * kStep;
  const ViewConfig rendered{.noisy = false};
  ViewPyramid pyramid;
  TargetView reference;
  make_pyramid(test::exact_frame(corner_with_ball(), kCamera, T).depth_m, kCamera, rendered, pyramid);
  make_target_view(pyramid, T, rendered, reference);
  Frame now = test::exact_frame(corner_with_ball(), kCamera, truth);
  test::add_depth_noise(now, 4);
  const Tracking tracking = align(live_of(now), reference, T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), kFit_m);
  EXPECT_LT(rotation_error_rad(tracking, truth), kFit_rad);
}

TEST(Align, StandsTheNoiseOfAKinect) {
  const Eigen::Isometry3d T = eye(), truth = T * kStep;
  Frame before = test::exact_frame(corner_with_ball(), kCamera, T);
  Frame now = test::exact_frame(corner_with_ball(), kCamera, truth);
  test::add_depth_noise(before, 1);
  test::add_depth_noise(now, 2);
  const Tracking tracking = align(live_of(now), reference_of(before, T), T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), 0.003);
  EXPECT_LT(rotation_error_rad(tracking, truth), 0.002);
}

TEST(Align, WhatHasMovedDoesNotPull) {
  const Eigen::Isometry3d T = eye(), truth = T * kStep;
  const TargetView reference = reference_of(test::exact_frame(corner_with_ball(), kCamera, T), T);
  const test::Scene with_person = test::nearest_of(
      corner_with_ball(),
      test::box(Eigen::AlignedBox3d(Eigen::Vector3d(-0.6, 1.2, 0.0), Eigen::Vector3d(0.0, 1.5, 1.4))));
  const Frame now = test::exact_frame(with_person, kCamera, truth);
  const Tracking tracking = align(live_of(now), reference, T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), 0.003);
  EXPECT_LT(tracking.inlier_fraction, 0.95);  // the person was seen, and not taken for the room
}

TEST(Align, IgnoredPixelsAreLeftOut) {
  const Frame frame = test::exact_frame(corner_with_ball(), kCamera, eye());
  MaskImage left(kCamera.width_px, kCamera.height_px, 0);
  for (int y = 0; y < left.height; ++y) std::fill_n(left.row(y), left.width / 2, std::uint8_t{255});
  const SourcePoints live = live_of(frame, left);
  ASSERT_FALSE(live.levels.front().empty());
  for (const SourcePoint& point : live.levels.front()) EXPECT_GT(point.p_camera.x(), 0.0F);
}

TEST(Align, OneWallFixesDistanceAndTiltAndHoldsTheRest) {
  const test::Scene wall = test::plane({0, 1, 0}, 2.0);
  const Eigen::Isometry3d T = test::looking_at({0, 0, 1}, {0, 2, 1});
  // 2 cm nearer and tilted, and 3 cm along the wall, which is unobservable.
  const Eigen::Isometry3d truth = T * moved(0.03, 0, 0.02, 0.01, 0.02, 0);
  const TargetView reference = reference_of(test::exact_frame(wall, kCamera, T), T);
  const Tracking tracking = align(live_of(test::exact_frame(wall, kCamera, truth)), reference, T);
  EXPECT_EQ(tracking.status, TrackStatus::kDegenerate);
  EXPECT_EQ(tracking.unconstrained_dofs,
            3);  // two translations along the wall, the rotation about its normal
  EXPECT_FALSE(tracking);
  const Eigen::Vector3d position = tracking.T_world_camera.translation();
  EXPECT_NEAR(position.y(), truth.translation().y(), 0.001);
  // Kept from the guess, up to the effect of the rotation about the wall's mean distance.
  EXPECT_NEAR(position.x(), T.translation().x(), 0.004);
  EXPECT_NEAR(tracking.T_world_camera.linear().col(2).dot(truth.linear().col(2)), 1.0, 1e-6);
}

TEST(Align, ColourFixesWhatOneWallDoesNot) {
  const test::Scene wall = test::plane({0, 1, 0}, 2.0);
  const Eigen::Isometry3d T = test::looking_at({0, 0, 1}, {0, 2, 1});
  const Eigen::Isometry3d truth = T * moved(0.02, -0.01, 0.01, 0.005, 0.005, 0.01);
  Frame before = test::exact_frame(wall, kCamera, T), now = test::exact_frame(wall, kCamera, truth);
  test::paint(before, T);
  test::paint(now, truth, 0.8, 15.0);  // the exposure has changed, too
  const Tracking tracking = align(live_of(now), reference_of(before, T), T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), 0.003);
  EXPECT_LT(rotation_error_rad(tracking, truth), 0.002);
}

TEST(Align, IdenticalFramesDoNotMove) {
  const Eigen::Isometry3d T = eye();
  Frame frame = test::exact_frame(corner_with_ball(), kCamera, T);
  test::add_depth_noise(frame, 3);
  const Tracking tracking = align(live_of(frame), reference_of(frame, T), T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, T), kFit_m);
  EXPECT_LT(rotation_error_rad(tracking, T), kFit_rad);
}

TEST(Align, SeveralReferencesAreMetAtOnce) {
  const Eigen::Isometry3d T = eye(), other = T * moved(-0.08, 0.02, 0, 0, -0.05, 0), truth = T * kStep;
  const TargetView a = reference_of(test::exact_frame(corner_with_ball(), kCamera, T), T);
  const TargetView b = reference_of(test::exact_frame(corner_with_ball(), kCamera, other), other);
  const std::array<PosedReference, 2> both{PosedReference{&a, T}, PosedReference{&b, other}};
  const SourcePoints live = live_of(test::exact_frame(corner_with_ball(), kCamera, truth));
  const Tracking tracking = align(live, both, T);
  EXPECT_EQ(tracking.status, TrackStatus::kTracked);
  EXPECT_LT(translation_error_m(tracking, truth), kFit_m);
  EXPECT_EQ(align(live, std::span<const PosedReference>(), T).status, TrackStatus::kTooFewPoints);
}

TEST(Align, A300MetreOffsetChangesNothing) {
  const Eigen::Isometry3d T = eye();
  Eigen::Isometry3d far_away = Eigen::Isometry3d::Identity();
  far_away.translation() = Eigen::Vector3d(300, -300, 300);
  const Frame before = test::exact_frame(corner_with_ball(), kCamera, T);
  const SourcePoints live = live_of(test::exact_frame(corner_with_ball(), kCamera, T * kStep));
  const Tracking here = align(live, reference_of(before, T), T);
  const Tracking there = align(live, reference_of(before, far_away * T), far_away * T);
  EXPECT_EQ(there.status, TrackStatus::kTracked);
  EXPECT_TRUE((far_away.inverse() * there.T_world_camera).isApprox(here.T_world_camera, 1e-6));
}

/// Expects the initial guess back for images with no or too little information.
void expect_guess_kept(const DepthImage& depth_m, TrackStatus expected) {
  const Eigen::Isometry3d T = eye();
  Frame now = test::exact_frame(corner_with_ball(), kCamera, T);
  const TargetView reference = reference_of(now, T);
  now.depth_m = depth_m;
  const Tracking tracking = align(live_of(now), reference, T);
  EXPECT_EQ(tracking.status, expected) << to_string(tracking.status);
  EXPECT_TRUE(tracking.T_world_camera.isApprox(T));
  EXPECT_TRUE(tracking.information.allFinite());
}

TEST(Align, NoDepthKeepsTheGuess) {
  expect_guess_kept(DepthImage(kCamera.width_px, kCamera.height_px), TrackStatus::kTooFewPoints);
}

TEST(Align, OnePixelKeepsTheGuess) {
  DepthImage depth_m(kCamera.width_px, kCamera.height_px);
  depth_m.at(160, 120) = 2.0F;
  expect_guess_kept(depth_m, TrackStatus::kTooFewPoints);
}

TEST(Align, AnotherRoomIsNotTaken) {
  expect_guess_kept(DepthImage(kCamera.width_px, kCamera.height_px, 0.6F), TrackStatus::kDiverged);
}

TEST(Align, ConstantDepthIsAWallSquareToTheCamera) {
  Frame frame;
  frame.depth_camera = kCamera;
  frame.depth_m.resize(kCamera.width_px, kCamera.height_px, 2.0F);
  const Eigen::Isometry3d T = eye();
  const Tracking tracking = align(live_of(frame), reference_of(frame, T), T);
  EXPECT_EQ(tracking.status, TrackStatus::kDegenerate);
  EXPECT_EQ(tracking.unconstrained_dofs, 3);
  EXPECT_LT(translation_error_m(tracking, T), 1e-4);
}

TEST(Align, AGuessThatIsNoNumberIsRefused) {
  const Frame frame = test::exact_frame(corner_with_ball(), kCamera, eye());
  Eigen::Isometry3d guess = eye();
  guess.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const Tracking tracking = align(live_of(frame), reference_of(frame, eye()), guess);
  EXPECT_EQ(tracking.status, TrackStatus::kDiverged);
  EXPECT_TRUE(tracking.T_world_camera.matrix().allFinite());
}

TEST(Align, AnEmptyReferenceIsNoReference) {
  const Frame frame = test::exact_frame(corner_with_ball(), kCamera, eye());
  Frame nothing = frame;
  nothing.depth_m.resize(kCamera.width_px, kCamera.height_px);
  EXPECT_EQ(align(live_of(frame), reference_of(nothing, eye()), eye()).status, TrackStatus::kTooFewPoints);
  EXPECT_EQ(align(live_of(frame), TargetView{}, eye()).status, TrackStatus::kTooFewPoints);
}

}  // namespace
}  // namespace roomradar::align_test
