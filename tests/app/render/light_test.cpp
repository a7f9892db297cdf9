// light_test.cpp: light estimated from surfaces of known and unknown albedo, its split, shade and shadows,
// and contacts that stay visible.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "app/objects/object_light.hpp"
#include "app/render/contact_shadow.hpp"
#include "app/render/light_estimate.hpp"
#include "app/render/occlusion.hpp"
#include "app/render/room_light.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar::light_test {
namespace {

using Eigen::Vector3f;

/// Surface points around the origin in five hues, each with normals in all directions, under a distant light
/// of twice the ambient light's irradiance.
std::vector<LightSample> lit_points(const Vector3f& to_light, float level) {
  std::vector<LightSample> samples;
  for (int i = 0; i < 1000; ++i) {
    const auto k = static_cast<float>(i);
    const float z = 1.0F - 2.0F * (k + 0.5F) / 1000.0F, r = std::sqrt(1.0F - z * z);
    const Vector3f normal(r * std::cos(2.4F * k), r * std::sin(2.4F * k), z);
    const int hue = (i * 7) % 5;
    const Vector3f log_albedo(-0.5F - 0.3F * static_cast<float>(hue), -0.8F,
                              -0.6F - 0.25F * static_cast<float>((hue * 2) % 5));
    const float light = level * (1.0F + 0.2F * z + 2.0F * std::max(0.0F, normal.dot(to_light)));
    samples.push_back({0.5F * normal, normal, log_albedo + Vector3f::Constant(std::log(light))});
  }
  return samples;
}

float angle_deg(const Eigen::Vector3d& a, const Vector3f& b) {
  return static_cast<float>(std::acos(std::clamp(a.dot(b.cast<double>()), -1.0, 1.0)) * 57.29578);
}

RoomLight estimated(const std::vector<LightSample>& samples) {
  LightEstimator estimator;
  estimator.add(samples, Vector3f::Zero(), 0.0, {});
  EXPECT_TRUE(estimator.light());
  return estimator.light().value_or(RoomLight{});
}

TEST(LightEstimator, FindsTheDirectionUnderUnknownAlbedos) {
  for (const Vector3f& to_light :
       {Vector3f(0.8F, 0.1F, 0.59F), Vector3f(-0.5F, -0.6F, 0.62F), Vector3f(0, 0, 1)}) {
    const MainLight main = main_light(estimated(lit_points(to_light.normalized(), 0.3F)));
    EXPECT_LT(angle_deg(main.to_light_world, to_light.normalized()), 15.0F) << to_light.transpose();
    EXPECT_GT(main.directed.mean(), 0.8F * main.ambient.mean());
  }
}

TEST(LightEstimator, TwiceTheLightIsTwiceTheIrradiance) {
  const Vector3f to_light = Vector3f(0.6F, 0, 0.8F);
  const float once = irradiance(estimated(lit_points(to_light, 0.2F)), to_light).sum();
  const float twice = irradiance(estimated(lit_points(to_light, 0.4F)), to_light).sum();
  EXPECT_NEAR(twice / once, 2.0F, 0.02F);
}

TEST(LightEstimator, ChangesWithItsTimeConstant) {
  const Vector3f to_light = Vector3f(0.6F, 0, 0.8F);
  LightEstimator estimator;
  estimator.add(lit_points(to_light, 0.2F), Vector3f::Zero(), 0.0, {});
  const float before = irradiance(*estimator.light(), to_light).sum();
  estimator.add(lit_points(to_light, 0.4F), Vector3f::Zero(), 1.0 / 30.0, {});
  const float next = irradiance(*estimator.light(), to_light).sum();
  EXPECT_LT(next / before, 1.05F);  // no jump in one frame
  for (int i = 0; i < 150; ++i) estimator.add(lit_points(to_light, 0.4F), Vector3f::Zero(), 1.0 / 30.0, {});
  EXPECT_NEAR(irradiance(*estimator.light(), to_light).sum() / before, 2.0F, 0.1F);
}

TEST(LightEstimator, IgnoresWhatIsNotFiniteAndTooFewPoints) {
  LightEstimator estimator;
  estimator.add({}, Vector3f::Zero(), 0.03, {});
  EXPECT_FALSE(estimator.light());
  std::vector<LightSample> samples = lit_points({0, 0, 1}, 0.3F);
  const RoomLight clean = estimated(samples);
  samples.push_back(
      {Vector3f::Zero(), Vector3f::UnitZ(), Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())});
  EXPECT_EQ(estimated(samples).coefficients, clean.coefficients);
  EXPECT_THROW(require_valid(LightConfig{.memory_s = 0.0}), Error);
}

TEST(RoomLight, SplitsIntoAmbientAndDirectedLight) {
  const Vector3f to_light = Vector3f(0.6F, 0, 0.8F);
  RoomLight light;
  light.coefficients.row(0).array() = 0.3F;
  light.coefficients += directed_light(to_light) * Vector3f(0.8F, 0.6F, 0.4F).transpose();
  const MainLight main = main_light(light);
  EXPECT_LT(angle_deg(main.to_light_world, to_light), 0.5F);
  EXPECT_TRUE(main.directed.isApprox(Vector3f(0.8F, 0.6F, 0.4F), 1e-3F));
  EXPECT_TRUE(main.ambient.isApprox(Vector3f::Constant(0.3F), 1e-3F));
  EXPECT_TRUE(irradiance(shaded(light, 0.0F, 1.0F), to_light).isApprox(Vector3f::Constant(0.3F), 1e-3F));
}

/// A level plate at a height.
Mesh plate(float half_m, float z_m) {
  Mesh mesh;
  mesh.vertices = {
      {-half_m, -half_m, z_m}, {half_m, -half_m, z_m}, {half_m, half_m, z_m}, {-half_m, half_m, z_m}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(ObjectLight, ATableAboveTakesTheLampAndSomeOfTheSky) {
  TriangleTree table;
  table.build_by_place(plate(0.8F, 0.7F));
  const TreeInstance room{&table};
  const LightReach under = light_reach(room, {0, 0, 0.1}, 0.1, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(under.directed, 0.0F);
  EXPECT_LT(under.ambient, 0.95F);
  EXPECT_GT(under.ambient, 0.4F);
  const LightReach beside = light_reach(room, {3.0, 0, 0.1}, 0.1, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(beside.directed, 1.0F);
  EXPECT_EQ(beside.ambient, 1.0F);
  EXPECT_EQ(light_reach({}, {0, 0, 0.1}, 0.1, Eigen::Vector3d::UnitZ()).directed, 1.0F);
}

TEST(ContactShadow, TheMainLightsShadowFallsAwayFromIt) {
  Mesh column = plate(0.05F, 0.0F);
  const Mesh top = plate(0.05F, 0.2F);
  column.vertices.insert(column.vertices.end(), top.vertices.begin(), top.vertices.end());
  column.triangles.push_back({4, 5, 6});
  column.triangles.push_back({4, 6, 7});
  ContactShadow shadow;
  make_contact_shadow(spread_points(column), Eigen::Matrix3d::Identity(), shadow);
  const Vector3f to_light = Vector3f(1, 0, 1).normalized();
  EXPECT_GT(light_occlusion(shadow, {-0.12F, 0, 0}, to_light), 0.6F);
  EXPECT_LT(light_occlusion(shadow, {0.12F, 0, 0}, to_light), 0.1F);
  EXPECT_EQ(light_occlusion(shadow, {-0.12F, 0, 0}, Vector3f(1, 0, 0)), 0.0F);
}

/// The camera looks level from 0.3 m above a table whose measured depth is 1.4 cm too high; an object stands
/// at 1 m.
TEST(Occlusion, WhatAnObjectStandsOnDoesNotHideItsContact) {
  const Intrinsics camera{64, 64, 60.0, 60.0, 31.5, 31.5};
  const float camera_m = 0.3F, object_m = 1.0F;
  DepthImage real_m(64, 64, 3.0F);
  ObjectLayer layer;
  layer.rect = {24, 24, 16, 26};
  layer.samples = 1;
  layer.colour.resize(16, 26);
  layer.depth_m.resize(16, 26, object_m);
  for (int y = 36; y < 64; ++y)  // table, 1.4 cm too high
    for (int x = 0; x < 64; ++x)
      real_m.at(x, y) = (camera_m - 0.014F) / ((static_cast<float>(y) - 31.5F) / 60.0F);
  const ColourImage picture(64, 64, Rgb{90, 90, 90});
  const Feet feet{camera, {{Vector3f(0, -1, 0), camera_m}}};
  const int foot_y = 49;  // the object's last row, 8 mm above the table's true height
  const auto hidden_at = [&](const Feet& given, const DepthImage& depth_m) {
    Occlusion occlusion;
    find_occlusion(picture, picture, depth_m, layer, {}, occlusion, given);
    return occlusion.hidden.at(32 - occlusion.rect.x, foot_y - occlusion.rect.y);
  };
  EXPECT_GT(hidden_at({}, real_m), 0.1F);
  EXPECT_EQ(hidden_at(feet, real_m), 0.0F);
  DepthImage hand_m = real_m;
  for (float& z_m : hand_m.pixels) z_m = std::min(z_m, 0.6F);
  EXPECT_GT(hidden_at(feet, hand_m), 0.9F);  // a hand before the contact hides it
}

}  // namespace
}  // namespace roomradar::light_test
