// rolling_shutter_test.cpp: images read row by row by a moving camera, against images read at one time.
#include "mapping/alignment/rolling_shutter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mapping/alignment/align.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::rolling_shutter_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};
constexpr double kReadout_s = 0.03, kFrame_s = 1.0 / 30.0;

Eigen::Isometry3d eye() { return test::looking_at({0.6, 0.2, 1.3}, {0.0, 2.2, 0.5}); }

/// Motion of a camera that turns at 92 degrees/s while it is carried.
Eigen::Isometry3d after(double t_s) {
  Vector6d twist;
  twist << 0.3, -0.1, 0.2, 0.4, 1.5, 0.3;
  return eye() * retract(t_s * twist);
}

/// Frame whose rows are seen from where the camera is at their time.
Frame skewed_frame() {
  Frame frame = test::exact_frame(test::corner_with_ball(), kCamera, after(0.0));
  constexpr int kRows = 4;
  for (int y = 0; y < kCamera.height_px; y += kRows) {
    const double t_s =
        ((y + 0.5 * (kRows - 1)) - 0.5 * (kCamera.height_px - 1)) / kCamera.height_px * kReadout_s;
    const Frame seen = test::exact_frame(test::corner_with_ball(), kCamera, after(t_s));
    std::copy(seen.depth_m.row(y), seen.depth_m.row(y) + kRows * kCamera.width_px, frame.depth_m.row(y));
  }
  return frame;
}

Image<float> inverse_of(const DepthImage& depth_m) {
  Image<float> inverse(depth_m.width, depth_m.height);
  std::transform(depth_m.pixels.begin(), depth_m.pixels.end(), inverse.pixels.begin(),
                 [](float z) { return z > 0.0F ? 1.0F / z : 0.0F; });
  return inverse;
}

/// Mean difference over the pixels that both images have.
double mean_difference(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (a.pixels[i] > 0.0F && b.pixels[i] > 0.0F)
      sum += std::abs(static_cast<double>(a.pixels[i] - b.pixels[i])), ++count;
  return sum / count;
}

CameraVelocity velocity() { return velocity_of(after(-kFrame_s).inverse() * after(0.0), kFrame_s); }

TEST(RollingShutter, DeskewGivesTheImageOfItsMiddle) {
  const Image<float> exact =
      inverse_of(test::exact_frame(test::corner_with_ball(), kCamera, after(0.0)).depth_m);
  Image<float> image = inverse_of(skewed_frame().depth_m), none;
  const double before = mean_difference(image, exact);
  deskew(kCamera, velocity(), kReadout_s, image, none);
  EXPECT_LT(mean_difference(image, exact), 0.15 * before);
  EXPECT_GT(std::count_if(image.pixels.begin(), image.pixels.end(), [](float q) { return q > 0.0F; }),
            static_cast<std::ptrdiff_t>(0.9 * kCamera.width_px * kCamera.height_px));
}

TEST(RollingShutter, IntensityMovesWithItsDepth) {
  Image<float> image = inverse_of(skewed_frame().depth_m);
  Image<float> intensity = image;
  for (float& grey : intensity.pixels) grey *= 100.0F;
  deskew(kCamera, velocity(), kReadout_s, image, intensity);
  // Depth changes a little with the time, intensity does not.
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    if (image.pixels[i] <= 0.0F) continue;
    ASSERT_NEAR(intensity.pixels[i], 100.0F * image.pixels[i], 0.05F * intensity.pixels[i]);
  }
}

TEST(RollingShutter, AlignmentFindsThePoseOfTheMiddle) {
  ViewPyramid pyramid;
  TargetView reference;
  make_pyramid(test::exact_frame(test::corner_with_ball(), kCamera, after(-kFrame_s)), {}, pyramid);
  make_target_view(pyramid, after(-kFrame_s), {}, reference);
  SourcePoints live;
  make_pyramid(skewed_frame(), {}, pyramid);
  make_source_points(pyramid, live);
  const std::vector<PosedReference> references{{&reference, after(-kFrame_s)}};
  const auto error_m = [&](const ReadoutMotion& readout) {
    const Tracking tracking = align(live, references, after(0.0), {}, readout);
    EXPECT_TRUE(tracking);
    return (tracking.T_world_camera.translation() - after(0.0).translation()).norm();
  };
  const double with = error_m({after(-kFrame_s), kFrame_s, kReadout_s});
  EXPECT_LT(with, 0.004);
  EXPECT_LT(with, 0.5 * error_m({}));
}

TEST(RollingShutter, StampsThatMakeNoSenseGiveNoVelocity) {
  const Eigen::Isometry3d T = after(0.0).inverse() * after(kFrame_s);
  for (const double dt_s : {0.0, -kFrame_s, 5.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(velocity_of(T, dt_s).angular_radps.norm(), 0.0) << dt_s;
  EXPECT_NEAR(velocity_of(T, kFrame_s).angular_radps.y(), 1.5, 1e-3);
}

}  // namespace
}  // namespace roomradar::rolling_shutter_test
