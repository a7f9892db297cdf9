// reduced_depth_test.cpp: fewer pixels, each from a single surface.
#include "dynamic/surface/reduced_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/exact_depth.hpp"

namespace roomradar::reduced_depth_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};

Frame frame_of(float depth_m) {
  Frame frame;
  frame.depth_camera = kCamera;
  frame.depth_m.resize(kCamera.width_px, kCamera.height_px, depth_m);
  return frame;
}

/// Depth at image coordinates of the plane n . p = 1, in the camera frame.
double plane_depth_m(const Intrinsics& camera, const Eigen::Vector3d& n_per_m, int x, int y) {
  return 1.0 / n_per_m.dot(back_project(camera, x, y, 1.0));
}

TEST(ReducedDepth, OfAPlaneIsWhatTheSmallerCameraSees) {
  // Steep: 60 degrees from the viewing direction, and several centimetres from pixel to pixel.
  const Eigen::Vector3d n_per_m(0.35, -0.2, 0.5);
  Frame frame = frame_of(0.0F);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      frame.depth_m.at(x, y) = static_cast<float>(plane_depth_m(kCamera, n_per_m, x, y));
  for (const int stride : {2, 4}) {
    Frame reduced;
    reduce_depth(frame, stride, reduced);
    ASSERT_EQ(reduced.depth_m.width, kCamera.width_px / stride);
    ASSERT_EQ(reduced.depth_m.height, reduced.depth_camera.height_px);
    for (int y = 0; y < reduced.depth_m.height; ++y)
      for (int x = 0; x < reduced.depth_m.width; ++x) {
        const double true_m = plane_depth_m(reduced.depth_camera, n_per_m, x, y);
        ASSERT_NEAR(reduced.depth_m.at(x, y), true_m, 1e-5 * true_m) << x << " " << y;
      }
  }
}

TEST(ReducedDepth, NothingLiesBetweenAnEdgeAndWhatIsBehindIt) {
  Frame frame = frame_of(2.0F);
  for (int y = 0; y < kCamera.height_px; ++y)  // its edge cuts blocks at every offset
    for (int x = 0; x < 40 + y / 3; ++x) frame.depth_m.at(x, y) = 1.0F;
  for (const int stride : {2, 4}) {
    Frame reduced;
    reduce_depth(frame, stride, reduced);
    for (int y = 0; y < reduced.depth_m.height; ++y)
      for (int x = 0; x < reduced.depth_m.width; ++x) {
        const float depth_m = reduced.depth_m.at(x, y);
        EXPECT_TRUE(std::abs(depth_m - 1.0F) < 1e-5F || std::abs(depth_m - 2.0F) < 1e-5F) << depth_m;
        int near = 0;
        for (int dy = 0; dy < stride; ++dy)
          for (int dx = 0; dx < stride; ++dx)
            near += frame.depth_m.at(x * stride + dx, y * stride + dy) < 1.5F ? 1 : 0;
        EXPECT_EQ(depth_m < 1.5F, 2 * near >= stride * stride) << "the nearer of equally many";
      }
  }
}

TEST(ReducedDepth, RimOfAHoleIsLeftOutAndNoDepthStaysNone) {
  Frame frame = frame_of(0.0F);
  Frame reduced;
  reduce_depth(frame, 2, reduced);
  for (const float depth_m : reduced.depth_m.pixels) ASSERT_EQ(depth_m, 0.0F);
  frame.depth_m.at(10, 10) = 1.0F;  // one of four
  frame.depth_m.at(20, 10) = 1.0F;  // two of four
  frame.depth_m.at(21, 11) = 1.002F;
  frame.depth_m.at(30, 10) = 1.0F;  // two of four, on two surfaces
  frame.depth_m.at(31, 10) = 3.0F;
  reduce_depth(frame, 2, reduced);
  EXPECT_EQ(reduced.depth_m.at(5, 5), 0.0F);
  EXPECT_NEAR(reduced.depth_m.at(10, 5), 1.001F, 1e-5F);
  EXPECT_EQ(reduced.depth_m.at(15, 5), 0.0F);
}

TEST(ReducedDepth, SmallImagesAreNotReducedToNothing) {
  EXPECT_EQ(usable_stride({640, 480, 585.0, 585.0, 319.5, 239.5}, 4), 4);
  EXPECT_EQ(usable_stride(kCamera, 4), 2);
  EXPECT_EQ(usable_stride({40, 30, 36.0, 36.0, 19.5, 14.5}, 2), 1);
}

}  // namespace
}  // namespace roomradar::reduced_depth_test
