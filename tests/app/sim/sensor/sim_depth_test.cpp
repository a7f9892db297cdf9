// sim_depth_test.cpp: the simulated Kinect's depth: closed-form scenes, noise, quantisation, shadow,
// dropouts.
#include <gtest/gtest.h>

#include <cmath>

#include "app/sim/sensor/kinect_depth.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/depth_noise.hpp"

namespace roomradar::sim_depth_test {
namespace {

using Eigen::Vector3d;

/// A camera at the origin, with the world's axes, in front of the given solids.
struct Scene {
  std::vector<Solid> solids;
  std::vector<float> infrared;
  Intrinsics camera = kKinectDepthCamera;
  ViewCaster view;
  ExactView exact;
  KinectScratch scratch;

  explicit Scene(std::vector<Solid> given, float returned = 0.8F)
      : solids(std::move(given)), infrared(solids.size(), returned) {
    view.prepare(solids, camera, Eigen::Isometry3d::Identity());
    render_exact(solids, view, camera, {}, exact);
  }
  DepthImage measured(double noise_scale, std::int64_t frame = 0, std::uint64_t seed = 5) {
    DepthImage depth_m;
    measure_depth({solids, infrared}, {view, exact, camera, Eigen::Isometry3d::Identity()},
                  {{}, noise_scale, seed, frame}, scratch, depth_m);
    return depth_m;
  }
};

Solid wall_at(double depth_m) { return box({0, 0, depth_m + 0.5}, {30, 30, 1}); }

TEST(SimDepth, ExactDepthOfAWallAndABallIsTheirClosedForm) {
  Scene scene({wall_at(3.0), sphere({0, 0, 2}, 0.5)});
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const Vector3d d = back_project(scene.camera, x, y, 1.0);
      const double b = d.z() * 2.0, a = d.squaredNorm(), c = 4.0 - 0.25;  // |t d - (0, 0, 2)| = 0.5
      const double discriminant = b * b - a * c;
      const double expected_m = discriminant >= 0.0 ? (b - std::sqrt(discriminant)) / a : 3.0;
      EXPECT_NEAR(scene.exact.depth_m.at(x, y), expected_m, 1e-6) << x << ", " << y;
      EXPECT_EQ(scene.exact.solid.at(x, y), discriminant >= 0.0 ? 1 : 0);
    }
}

TEST(SimDepth, NothingBeforeTheCameraIsNoDepth) {
  Scene scene({box({0, 0, -2}, {1, 1, 1}), sphere({5, 0, 1}, 0.2)});
  for (const float depth_m : scene.exact.depth_m.pixels) EXPECT_EQ(depth_m, 0.0F);
  for (const float depth_m : scene.measured(1.0).pixels) EXPECT_EQ(depth_m, 0.0F);
}

TEST(SimDepth, NoiseHasTheModelsSigmaAtEveryDepth) {
  for (const double depth_m : {0.8, 1.3, 2.0, 3.1, 4.2, 5.5}) {
    Scene scene({wall_at(depth_m)}, 1.0F);
    double sum = 0.0, squares = 0.0;
    std::size_t count = 0;
    for (std::int64_t frame = 0; frame < 12; ++frame) {
      const DepthImage measured = scene.measured(1.0, frame);
      for (int y = 160; y < 320; ++y)
        for (int x = 220; x < 420; ++x) {
          if (measured.at(x, y) == 0.0F) continue;
          const double off_m = measured.at(x, y) - depth_m;
          sum += off_m;
          squares += off_m * off_m;
          ++count;
        }
    }
    ASSERT_GT(count, 300'000U);
    const double mean_m = sum / static_cast<double>(count);
    const double sigma_m = std::sqrt(squares / static_cast<double>(count) - mean_m * mean_m);
    const double model_m = depth_sigma_m(DepthNoise{}, static_cast<float>(depth_m));
    EXPECT_NEAR(sigma_m, model_m, 0.1 * model_m) << "at " << depth_m << " m";
    EXPECT_LT(std::abs(mean_m), 0.15 * model_m) << "at " << depth_m << " m";
  }
}

TEST(SimDepth, EveryDepthIsAWholeNumberOfDisparitySteps) {
  Scene scene({wall_at(2.3), sphere({0.2, 0.1, 1.5}, 0.3)});
  const double disparity = 585.0 * 0.075;
  std::size_t valid = 0;
  for (const float depth_m : scene.measured(1.0).pixels) {
    if (depth_m == 0.0F) continue;
    ++valid;
    const double steps = 8.0 * disparity / depth_m;
    EXPECT_NEAR(steps, std::round(steps), 1e-4);
  }
  EXPECT_GT(valid, 280'000U);
  // 2.85 mm at 1 m, as measured by Khoshelham and Elberink, and their square law.
  EXPECT_NEAR(quantisation_step_m(scene.camera, 1.0), 0.00285, 0.00002);
  EXPECT_NEAR(quantisation_step_m(scene.camera, 4.0), 16 * 0.00285, 0.0003);
  // A smaller image is a scaled image of the same sensor: same steps.
  EXPECT_DOUBLE_EQ(quantisation_step_m(scaled(scene.camera, 0.5), 2.0),
                   quantisation_step_m(scene.camera, 2.0));
}

TEST(SimDepth, ShadowFallsLeftOfTheNearerThingAndIsAsWideAsTheBaselineSays) {
  Scene scene({wall_at(2.0), box({0, 0, 1.05}, {0.2, 0.2, 0.1})});
  const DepthImage measured = scene.measured(0.02);
  const auto column_of_wall = [](double x_m) { return 585.0 * x_m / 2.0 + 320.0; };
  // From the projector at x = 0.075 the box's left front edge (-0.1, 1) hides the wall up to x = -0.275; the
  // camera sees the wall up to x = -0.2.
  const int first = static_cast<int>(std::ceil(column_of_wall(-0.275)));
  const int last = static_cast<int>(std::floor(column_of_wall(-0.2)));
  for (int y = 200; y < 280; ++y) {
    EXPECT_GT(measured.at(first - 3, y), 1.9F);
    for (int x = first + 1; x < last; ++x) EXPECT_EQ(measured.at(x, y), 0.0F) << x;
    EXPECT_GT(measured.at(static_cast<int>(column_of_wall(0.2)) + 3, y), 1.9F) << "no shadow on the right";
  }
}

TEST(SimDepth, OnlyTheSensorsRangeIsReported) {
  for (const double depth_m : {0.3, 0.45, 8.6, 12.0}) {
    Scene scene({wall_at(depth_m)}, 1.0F);
    for (const float measured_m : scene.measured(0.05).pixels) EXPECT_EQ(measured_m, 0.0F) << depth_m;
  }
  for (const double depth_m : {0.55, 7.5}) {
    Scene scene({wall_at(depth_m)}, 1.0F);
    EXPECT_GT(scene.measured(0.05).at(320, 240), 0.0F) << depth_m;
  }
}

TEST(SimDepth, DarkAndGrazingSurfacesDropOut) {
  const auto valid_part = [](Scene& scene) {
    std::size_t valid = 0;
    const DepthImage measured = scene.measured(1.0);
    for (int y = 236; y < 244; ++y)
      for (int x = 120; x < 520; ++x) valid += measured.at(x, y) > 0.0F;
    return static_cast<double>(valid) / 3200.0;
  };
  Scene bright({wall_at(3.0)}, 0.6F), dark({wall_at(3.0)}, 0.02F), dark_near({wall_at(0.8)}, 0.02F);
  EXPECT_GT(valid_part(bright), 0.99);
  EXPECT_LT(valid_part(dark), 0.03);
  EXPECT_GT(valid_part(dark_near), 0.9);
  const auto tilted = [](double from_normal_deg) {
    Solid slab = box({0, 0, 0}, {20, 20, 0.02});
    slab.T_world_solid.rotate(Eigen::AngleAxisd(from_normal_deg * 0.017453292519943295, Vector3d::UnitX()));
    slab.T_world_solid.translation() = Vector3d(0, 0, 3.0);
    return slab;
  };
  Scene slanted({tilted(60.0)}, 0.6F), grazing({tilted(87.0)}, 0.3F);
  EXPECT_GT(valid_part(slanted), 0.99);
  EXPECT_LT(valid_part(grazing), 0.3);
}

TEST(SimDepth, DependsOnSeedAndFrameAndOnNothingElse) {
  Scene scene({wall_at(2.0), sphere({0, 0, 1.2}, 0.2)});
  const DepthImage once = scene.measured(1.0, 4);
  scene.measured(1.0, 9);
  EXPECT_EQ(scene.measured(1.0, 4).pixels, once.pixels);
  EXPECT_NE(scene.measured(1.0, 5).pixels, once.pixels);
  EXPECT_NE(scene.measured(1.0, 4, 6).pixels, once.pixels);
}

TEST(SimDepth, NoiseOfNeighbouringPixelsIsAlikeAndOfDistantOnesIsNot) {
  Scene scene({wall_at(3.0)}, 1.0F);
  const DepthImage measured = scene.measured(1.0);
  const auto correlation = [&](int apart_px) {
    double product = 0.0, square = 0.0;
    for (int y = 160; y < 320; ++y)
      for (int x = 220; x < 420; ++x) {
        product += (measured.at(x, y) - 3.0) * (measured.at(x + apart_px, y) - 3.0);
        square += (measured.at(x, y) - 3.0) * (measured.at(x, y) - 3.0);
      }
    return product / square;
  };
  EXPECT_GT(correlation(1), 0.4);
  EXPECT_LT(std::abs(correlation(9)), 0.1);
}

}  // namespace
}  // namespace roomradar::sim_depth_test
