// radar_accuracy_test.cpp: the sampled radar against the exact reference on random poses, convex and concave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "radar/batch/gl_radar.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::radar_accuracy_test {
namespace {

struct Errors {
  std::vector<double> late_m;   // radar minus exact, if both have a contact
  std::vector<double> width_m;  // between the bounds, if the radar has a contact
  int missed = 0;               // contact in truth, none from the radar
  int invented = 0;             // contact from the radar, none in truth
  double pixel_m = 0.0;

  [[nodiscard]] double quantile_m(double q) const {
    return late_m[static_cast<std::size_t>(q * static_cast<double>(late_m.size() - 1))];
  }
};

/// Throws the object at the scene from outside, `count` times, in directions up to about 60 degrees off
/// straight down.
Errors measure(const Mesh& object, const Mesh& scene, int resolution_px, int count, unsigned seed) {
  GlContext context;
  GlRadar radar(context, {.resolution_px = resolution_px});
  GpuMesh object_gpu(context), scene_gpu(context);
  object_gpu.upload(object, MeshUsage::kStatic);
  scene_gpu.upload(scene, MeshUsage::kStatic);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> distance_m(0.3, 1.2);
  Errors errors;
  for (int i = 0; i < count; ++i) {
    Eigen::Isometry3d T_world_object(shapes::random_rotation(random));
    T_world_object.pretranslate(Eigen::Vector3d(0, 0, 0.6) +
                                Eigen::Vector3d(0.4, 0.4, 0.1).cwiseProduct(shapes::random_point(random)));
    const Eigen::Vector3d direction = Eigen::Vector3d(0, 0, -1) + 0.9 * shapes::random_point(random);
    const double reach_m = distance_m(random);
    const GpuSceneMesh scene_mesh{{&scene_gpu, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic};
    const Contact got = radar.query({&object_gpu, T_world_object}, direction, reach_m, {&scene_mesh, 1});
    const auto expected_m =
        exact_travel(object, T_world_object, direction, reach_m, scene, Eigen::Isometry3d::Identity());
    EXPECT_NE(got.status, ContactStatus::kInvalidInput);
    // The bounds are valid with and without a contact.
    const double truth_m = expected_m.value_or(std::numeric_limits<double>::infinity());
    EXPECT_LE(got.lower_m, truth_m) << "pose " << i;
    EXPECT_GE(got.upper_m, truth_m) << "pose " << i;
    EXPECT_LE(got.lower_m, reach_m);
    if (got) errors.width_m.push_back(got.upper_m - got.lower_m);
    EXPECT_NE(got.status, ContactStatus::kOverlap) << "pose " << i << " is free";
    errors.pixel_m = std::max(errors.pixel_m, got.pixel_m);
    if (got && expected_m) errors.late_m.push_back(got.contact_distance_m - *expected_m);
    if (!got && expected_m) ++errors.missed;
    if (got && !expected_m) ++errors.invented;
  }
  std::sort(errors.late_m.begin(), errors.late_m.end());
  std::sort(errors.width_m.begin(), errors.width_m.end());
  return errors;
}

void expect_late_but_close(const std::string& name, const Errors& errors, double median_px, double worst_px) {
  std::printf(
      "%s: %zu contacts, pixel %.2f mm; late by median %.3f, p95 %.3f, worst %.3f mm, earliest %.4f mm; "
      "missed %d, invented %d; bounds apart by median %.3f, p95 %.3f mm\n",
      name.c_str(), errors.late_m.size(), 1e3 * errors.pixel_m, 1e3 * errors.quantile_m(0.5),
      1e3 * errors.quantile_m(0.95), 1e3 * errors.late_m.back(), 1e3 * errors.late_m.front(), errors.missed,
      errors.invented, 1e3 * errors.width_m[errors.width_m.size() / 2],
      1e3 * errors.width_m[errors.width_m.size() * 95 / 100]);
  EXPECT_GT(errors.late_m.size(), 150U);
  // Early only because vertices snap to 1/256 pixel on a slope.
  EXPECT_GT(errors.late_m.front(), -errors.pixel_m / 32.0);
  EXPECT_LT(errors.quantile_m(0.5), median_px * errors.pixel_m);
  EXPECT_LT(errors.late_m.back(), worst_px * errors.pixel_m);
  EXPECT_EQ(errors.invented, 0);
}

TEST(RadarAccuracy, ConvexBoxOnBumpyGround) {
  const Errors errors = measure(shapes::box({0.25F, 0.15F, 0.1F}), shapes::bumpy_ground(60), 128, 400, 1);
  expect_late_but_close("box", errors, 1.0, 5.0);
}

TEST(RadarAccuracy, SmoothTorusOnBumpyGround) {
  const Errors errors =
      measure(shapes::torus(48, 24, 0.1F, 0.04F, 0.0F), shapes::bumpy_ground(60), 128, 400, 2);
  expect_late_but_close("torus", errors, 1.0, 5.0);
}

TEST(RadarAccuracy, ConcaveBumpyTorusOnBumpyGround) {
  const Errors errors =
      measure(shapes::torus(48, 24, 0.1F, 0.04F, 0.015F), shapes::bumpy_ground(60), 128, 400, 3);
  // A bump that grazes another sideways may be late by a bump's height.
  expect_late_but_close("bumpy torus", errors, 1.0, 10.0);
}

TEST(RadarAccuracy, ConcaveOnConcave) {
  const Errors errors = measure(shapes::torus(48, 24, 0.1F, 0.04F, 0.015F),
                                shapes::torus(60, 30, 0.3F, 0.1F, 0.03F), 128, 400, 4);
  expect_late_but_close("bumpy torus on bumpy torus", errors, 1.0, 5.0);
}

TEST(RadarAccuracy, FinerPixelsAreLessLate) {
  const Mesh object = shapes::torus(48, 24, 0.1F, 0.04F, 0.015F);
  const Mesh ground = shapes::bumpy_ground(60);
  double last_median_m = 1.0;
  for (const int resolution_px : {32, 64, 128, 256}) {
    const Errors errors = measure(object, ground, resolution_px, 300, 5);
    expect_late_but_close(std::to_string(resolution_px) + " px", errors, 1.0, 10.0);
    EXPECT_LT(errors.quantile_m(0.5), 0.7 * last_median_m);
    last_median_m = errors.quantile_m(0.5);
  }
}

}  // namespace
}  // namespace roomradar::radar_accuracy_test
