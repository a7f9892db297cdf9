// types_test.cpp: cameras, depth noise, stage times.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "mapping/types/validity.hpp"
#include "mapping/types/voxel_key.hpp"
#include "tests/support/allocation_count.hpp"

namespace roomradar::types_test {
namespace {

constexpr Intrinsics kKinect{640, 480, 585.0, 585.0, 320.0, 240.0};

TEST(Intrinsics, ProjectIsTheInverseOfBackProject) {
  for (const double depth_m : {0.4, 1.0, 8.0}) {
    const Eigen::Vector2d p_px = project(kKinect, back_project(kKinect, 17.25, 401.5, depth_m));
    EXPECT_NEAR(p_px.x(), 17.25, 1e-10);
    EXPECT_NEAR(p_px.y(), 401.5, 1e-10);
  }
}

TEST(Intrinsics, HalvingKeepsTheImageBordersInPlace) {
  // The left border of the image is at u = -0.5 in both; its ray must be the same.
  const Intrinsics half = scaled(kKinect, 0.5);
  EXPECT_EQ(half.width_px, 320);
  EXPECT_NEAR(back_project(kKinect, -0.5, -0.5, 2.0).x(), back_project(half, -0.5, -0.5, 2.0).x(), 1e-12);
  EXPECT_NEAR(back_project(kKinect, 639.5, 479.5, 2.0).y(), back_project(half, 319.5, 239.5, 2.0).y(), 1e-12);
}

TEST(Intrinsics, WhatCannotBeACameraIsNamed) {
  const auto message = [](Intrinsics camera) -> std::string {
    try {
      require_valid(camera, "cam.txt");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(kKinect), "accepted");
  Intrinsics bad = kKinect;
  bad.fx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(bad).find("cam.txt: fx_px"), std::string::npos) << message(bad);
  bad = kKinect;
  bad.width_px = 0;
  EXPECT_NE(message(bad).find("width_px"), std::string::npos);
  bad = kKinect;
  bad.cy_px = std::numeric_limits<double>::infinity();
  EXPECT_NE(message(bad).find("cy_px"), std::string::npos);
  EXPECT_FALSE(is_valid(bad));
  EXPECT_TRUE(is_valid(kKinect));
}

TEST(Intrinsics, ProjectionAsksNothingOfTheImagesSize) {
  Intrinsics camera = kKinect;
  camera.width_px = 0;
  camera.cx_px = -5e3;
  EXPECT_TRUE(can_project(camera));
  EXPECT_FALSE(is_valid(camera));
  camera.fy_px = 0.0;
  EXPECT_FALSE(can_project(camera));
}

TEST(Frame, ImagesThatDoNotFitTheirCamerasAreNamed) {
  Frame frame;
  EXPECT_NE(fault_of(frame), "");
  frame.depth_camera = kKinect;
  frame.depth_m.resize(640, 480, 1.0F);
  EXPECT_EQ(fault_of(frame), "");  // a frame without colour is valid
  frame.depth_m.resize(320, 240, 1.0F);
  EXPECT_EQ(fault_of(frame), "its depth image and its depth camera differ in size");
  frame.depth_m.resize(640, 480, 1.0F);
  frame.depth_m.pixels.pop_back();
  EXPECT_NE(depth_fault_of(frame), "");
  frame.depth_m.resize(640, 480, 1.0F);
  frame.colour.resize(320, 240);
  EXPECT_EQ(fault_of(frame), "its colour camera is invalid");
  frame.colour_camera = kKinect;
  EXPECT_EQ(fault_of(frame), "its colour image and its colour camera differ in size");
  EXPECT_EQ(depth_fault_of(frame), "");
}

TEST(RotationBetween, TurnsOneDirectionToTheOtherByTheSmallestAngle) {
  const Eigen::Vector3d from(0.3, -2.0, 0.7), side = from.unitOrthogonal() * from.norm();
  for (const double angle_rad : {0.0, 1e-9, 0.5, 2.0, 3.0, 3.14159, M_PI - 1e-7, M_PI - 1e-11, M_PI}) {
    const Eigen::Vector3d to = 4.0 * (std::cos(angle_rad) * from + std::sin(angle_rad) * side);
    const Eigen::Quaterniond rotation = rotation_between(from, to);
    EXPECT_NEAR(rotation.norm(), 1.0, 1e-14) << angle_rad;
    EXPECT_NEAR((rotation * from.normalized() - to.normalized()).norm(), 0.0, 1e-6) << angle_rad;
    EXPECT_NEAR(2.0 * std::atan2(rotation.vec().norm(), rotation.w()), angle_rad, 1e-10) << angle_rad;
  }
}

TEST(DepthNoise, FollowsNguyenAndStaysFiniteAtTheEnds) {
  EXPECT_NEAR(depth_sigma_m(DepthNoise{}, 0.4F), 0.0012F, 1e-7F);
  EXPECT_NEAR(depth_sigma_m(DepthNoise{}, 2.4F), 0.0012F + 0.0019F * 4.0F, 1e-6F);
  EXPECT_NEAR(depth_sigma_m(DepthNoise{}, 0.0F), 0.0012F, 1e-7F);
  EXPECT_TRUE(std::isfinite(depth_sigma_m(DepthNoise{}, 8.0F, 1.5707963F)));
  EXPECT_GT(depth_sigma_m(DepthNoise{}, 2.0F, 1.4F), depth_sigma_m(DepthNoise{}, 2.0F));
}

TEST(DepthNoise, OfEverySensorCanBeInvertedAndBounded) {
  const DepthNoise kinect, phone{0.003F, 0.008F, 0.0F, 0.0F, 0.0F},
      stereo{0.001F, 0.002F, 0.004F, 0.3F, 0.0F};
  for (const DepthNoise& noise : {kinect, phone, stereo}) {
    ASSERT_TRUE(is_valid(noise));
    for (const float depth_m : {0.5F, 1.0F, 2.5F, 8.0F}) {
      const float sigma_m = depth_sigma_m(noise, depth_m);
      EXPECT_NEAR(depth_of_sigma_m(noise, sigma_m), depth_m, 1e-4F * depth_m);
      EXPECT_LE(least_relative_sigma(noise), sigma_m / depth_m);
    }
  }
  EXPECT_NEAR(depth_sigma_m(phone, 2.0F), 0.019F, 1e-6F);
  const DepthNoise constant{0.01F, 0.0F, 0.0F, 0.0F, 0.0F};
  EXPECT_TRUE(std::isinf(depth_of_sigma_m(constant, 0.02F)));
  EXPECT_EQ(depth_of_sigma_m(constant, 0.01F), 0.0F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const DepthNoise& wrong :
       {DepthNoise{0.0F, 0, 0, 0, 0}, DepthNoise{-0.1F, 0, 0, 0, 0}, DepthNoise{nan, 0, 0, 0, 0},
        DepthNoise{0.001F, nan, 0, 0, 0}, DepthNoise{0.001F, 0, -0.1F, 0, 0},
        DepthNoise{0.001F, 0, 0, 50.0F, 0}, DepthNoise{2.0F, 0, 0, 0, 0}})
    EXPECT_FALSE(is_valid(wrong));
}

TEST(StageTimes, PercentilesAreNearestRank) {
  StageTimes times;
  for (int ms = 1; ms <= 100; ++ms) times.add_ms("fuse", ms);
  EXPECT_EQ(times.timed("read", [] { return 7; }), 7);
  const auto summaries = times.summaries();
  EXPECT_EQ(summaries.at("fuse").count, 100U);
  EXPECT_NEAR(summaries.at("fuse").median_ms, 50.0, 0.15);
  EXPECT_NEAR(summaries.at("fuse").p95_ms, 95.0, 0.3);
  EXPECT_NEAR(summaries.at("fuse").p99_ms, 99.0, 0.3);
  EXPECT_DOUBLE_EQ(summaries.at("fuse").max_ms, 100.0);
  EXPECT_EQ(summaries.at("read").count, 1U);
}

TEST(StageTimes, OneSampleIsItsOwnPercentilesHoweverLongOrShort) {
  for (const double ms : {0.0, 1e-6, 1e-3, 0.7, 16.6, 4e6, 1e9}) {
    StageTimes times;
    times.add_ms("frame", ms);
    const StageSummary summary = times.summaries().at("frame");
    for (const double told : {summary.median_ms, summary.p95_ms, summary.p99_ms, summary.max_ms})
      EXPECT_FLOAT_EQ(static_cast<float>(told), static_cast<float>(ms)) << ms;
  }
}

TEST(StageTimes, TakeNoMoreMemoryHoweverManyFramesThereAre) {
  StageTimes times;
  times.add_ms("frame", 1.0);
  const std::size_t before = test::allocations;
  for (int i = 0; i < 100'000; ++i) times.add_ms("frame", 1e-3 * i);
  EXPECT_EQ(test::allocations, before);
  EXPECT_NEAR(times.summaries().at("frame").median_ms, 50.0, 0.15);
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(format_number(-1.0), "-1");
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(0.1F), "0.1");
  EXPECT_EQ(format_number(1e-9), "1e-09");
  EXPECT_EQ(format_number(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(format_number(std::numeric_limits<int>::min()), "-2147483648");
  for (const double longest : {-std::numeric_limits<double>::denorm_min(), -1.0 / 3e200, 1.0 / 3.0})
    EXPECT_EQ(std::strtod(format_number(longest).c_str(), nullptr), longest);
}

TEST(NumberText, HasTheDigitsThatAreAskedForWhateverTheLocale) {
  EXPECT_EQ(format_fixed(1.5, 9), "1.500000000");
  EXPECT_EQ(format_fixed(-0.0000004, 6), "-0.000000");
  EXPECT_EQ(format_fixed(std::numeric_limits<double>::max(), 9).size(), 309U + 10U);
  EXPECT_EQ(format_general(1.0 / 3.0, 12), "0.333333333333");
  EXPECT_EQ(format_general(-1e-7, 12), "-1e-07");
  EXPECT_EQ(format_general(std::nan(""), 12), "nan");
  EXPECT_EQ(format_readable(0.35, 3), "0.35");
  EXPECT_EQ(format_readable(1039.7, 3), "1040");
  EXPECT_EQ(format_readable(999.9, 3), "1000") << "rounds up to more digits";
  EXPECT_EQ(format_readable(1e-7, 3), "1e-07");
  EXPECT_EQ(format_general(-std::numeric_limits<double>::max(), 20), "-1.7976931348623157081e+308");
}

TEST(ConfigCheck, SayWhatWasGivenHoweverSmall) {
  const ConfigCheck require{"fusion"};
  EXPECT_NO_THROW(require(true, "max_range_m", -1.0, "in 0..100 m"));
  try {
    require(false, "max_range_m", -1e-9, "in 0..100 m");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "fusion.max_range_m = -1e-09: must be in 0..100 m");
  }
}

TEST(Cells, OfVoxelsBelowZeroRoundDown) {
  for (const int edge : {1, 3, 8})
    for (int voxel = -20; voxel <= 20; ++voxel)
      EXPECT_EQ(floor_div(voxel, edge), static_cast<int>(std::floor(static_cast<double>(voxel) / edge)));
}

}  // namespace
}  // namespace roomradar::types_test
