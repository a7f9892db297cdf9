// lens_correction_test.cpp: images of a lens become those of a pinhole camera.
#include "app/sources/formats/lens_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/error_of.hpp"

namespace roomradar::lens_correction_test {
namespace {

constexpr Intrinsics kReal{320, 240, 200, 202, 158, 121};
constexpr RationalLens kLens{.k1 = 0.51,
                             .k2 = -0.02,
                             .p1 = 2e-5,
                             .p2 = -7e-5,
                             .k3 = -0.0026,
                             .k4 = 0.89,
                             .k5 = 0.086,
                             .k6 = -0.0139};  // like an Azure Kinect's depth camera

/// A slanted plane as a real lens sees it: depth of the plane along the ray of each distorted pixel.
TEST(LensCorrection, MakesAPlaneFlatAgain) {
  LensCorrection correction(kReal, kLens, "test");
  const auto plane_depth_m = [](double x, double y) { return 2.0 / (1.0 + 0.3 * x - 0.2 * y); };
  DepthImage depth_m(kReal.width_px, kReal.height_px);
  for (int v = 0; v < kReal.height_px; ++v)
    for (int u = 0; u < kReal.width_px; ++u) {
      // The undistorted direction by bisection along the radius; tangential terms are small and ignored.
      const double xd = (u - kReal.cx_px) / kReal.fx_px, yd = (v - kReal.cy_px) / kReal.fy_px;
      double low = 1.0, high = 3.0;
      for (int i = 0; i < 50; ++i) {
        const double s = (low + high) / 2;
        const PlanePoint<double> p = distorted({xd * s, yd * s}, kLens);
        (p.x * p.x + p.y * p.y < xd * xd + yd * yd ? low : high) = s;
      }
      depth_m.at(u, v) = static_cast<float>(plane_depth_m(xd * low, yd * low));
    }
  correction.correct(depth_m);
  const Intrinsics& ideal = correction.ideal();
  EXPECT_LT(ideal.fx_px, kReal.fx_px);
  int seen = 0;
  for (int v = 0; v < ideal.height_px; ++v)
    for (int u = 0; u < ideal.width_px; ++u) {
      const float depth = depth_m.at(u, v);
      if (depth == 0.0F) continue;
      ++seen;
      const double x = (u - ideal.cx_px) / ideal.fx_px, y = (v - ideal.cy_px) / ideal.fy_px;
      // Nearest neighbour is off by at most 0.7 px of the ideal camera, 1 px in the corners, where the lens
      // compresses: 1 / 150 in slope, times the plane's gradient of 0.18 z^2. Uncorrected: up to 0.02 z^2.
      const double z = plane_depth_m(x, y);
      EXPECT_NEAR(static_cast<double>(depth), z, 0.003 * z * z) << u << " " << v;
    }
  EXPECT_GT(seen, ideal.width_px * ideal.height_px * 4 / 5);
}

TEST(LensCorrection, KeepsTheMiddlesOfTheEdges) {
  const LensCorrection correction(kReal, kLens, "test");
  const Intrinsics& ideal = correction.ideal();
  const PlanePoint<double> left = distorted({-ideal.cx_px / ideal.fx_px, 0.0}, kLens);
  EXPECT_LE(left.x * kReal.fx_px + kReal.cx_px, 1e-3);  // column 0 of the real image is inside
  EXPECT_EQ(LensCorrection(kReal, RationalLens{}, "test").ideal(), kReal);
}

TEST(LensCorrection, RefusesALensThatFoldsTheImage) {
  EXPECT_NE(test::error_of([] { LensCorrection(kReal, {.k1 = -1000.0}, "the depth camera"); }).find("fold"),
            std::string::npos);
  EXPECT_NE(test::error_of([] {
              LensCorrection(kReal, {.k2 = std::nan("")}, "the depth camera");
            }).find("not finite"),
            std::string::npos);
  // Far from the centre a fold is cut off: no pixel beyond it is filled twice.
  LensCorrection correction({100, 100, 40, 40, 50, 50}, {.k1 = -0.3}, "test");
  DepthImage depth_m(100, 100, 1.0F);
  correction.correct(depth_m);
  EXPECT_EQ(depth_m.at(0, 0), 0.0F);
  EXPECT_EQ(depth_m.at(50, 50), 1.0F);
}

}  // namespace
}  // namespace roomradar::lens_correction_test
