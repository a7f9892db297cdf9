// light_test.cpp: light estimated from surfaces of known and unknown albedo, its split, shade and shadows,
// contacts that stay visible, and the camera's noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "app/objects/object_light.hpp"
#include "app/render/camera_noise.hpp"
#include "app/render/contact_shadow.hpp"
#include "app/render/light_estimate.hpp"
#include "app/render/occlusion.hpp"
#include "app/render/room_light.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"

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
    samples.push_back({0.5F * normal, normal, log_albedo + Vector3f::Constant(std::log(light)), {}});
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
  const std::vector<LightSample> brighter = lit_points(to_light, 0.4F);
  const auto add_six = [&](std::size_t frame) {
    estimator.add(std::span(brighter).subspan(6 * frame % 990, 6), Vector3f::Zero(), 1.0 / 30.0, {});
  };
  add_six(0);
  const float next = irradiance(*estimator.light(), to_light).sum();
  EXPECT_LT(next / before, 1.05F);  // no jump in one frame
  for (std::size_t i = 1; i < 250; ++i) add_six(i);
  EXPECT_NEAR(irradiance(*estimator.light(), to_light).sum() / before, 2.0F, 0.1F);
}

TEST(LightEstimator, IgnoresWhatIsNotFiniteAndTooFewPoints) {
  LightEstimator estimator;
  estimator.add({}, Vector3f::Zero(), 0.03, {});
  EXPECT_FALSE(estimator.light());
  std::vector<LightSample> samples = lit_points({0, 0, 1}, 0.3F);
  const RoomLight clean = estimated(samples);
  samples.push_back(
      {Vector3f::Zero(), Vector3f::UnitZ(), Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()), {}});
  EXPECT_EQ(estimated(samples).coefficients, clean.coefficients);
  EXPECT_THROW(require_valid(LightConfig{.memory_s = 0.0}), Error);
}

TEST(RoomLight, SplitsIntoAmbientAndDirectedLight) {
  const Vector3f to_light = Vector3f(0.6F, 0, 0.8F);
  RoomLight light;
  light.coefficients.row(0).array() = 0.3F;
  light.coefficients.row(3).array() = 0.3F * kFromAbove;
  light.coefficients += directed_light(to_light) * Vector3f(0.8F, 0.6F, 0.4F).transpose();
  const MainLight main = main_light(light);
  EXPECT_LT(angle_deg(main.to_light_world, to_light), 0.5F);
  EXPECT_TRUE(main.directed.isApprox(Vector3f(0.8F, 0.6F, 0.4F), 1e-3F));
  EXPECT_TRUE(main.ambient.isApprox(Vector3f::Constant(0.3F), 1e-3F));
}

TEST(LightEstimator, SurfacesTakeTheLampOrTheAmbientLight) {
  const Vector3f to_light = Vector3f(0.6F, 0, 0.8F);
  LightEstimator estimator;
  estimator.add(lit_points(to_light, 0.3F), Vector3f::Zero(), 0.0, {});
  const MainLight open = main_light(*estimator.light());
  LightReach no_lamp;
  no_lamp.lamps.fill(0.0F);
  const MainLight shade = main_light(estimator.light_at(no_lamp));
  EXPECT_LT(shade.directed.sum(), 0.01F * open.directed.sum());
  EXPECT_NEAR(shade.ambient.sum(), open.ambient.sum(), 0.25F * open.ambient.sum());
  LightReach half;
  half.ambient = 0.5F;
  half.lamps.fill(0.5F);
  EXPECT_NEAR(irradiance(estimator.light_at(half), to_light).sum(),
              0.5F * irradiance(*estimator.light(), to_light).sum(), 1e-4F);
}

/// Points on a level floor and on a wall, of one albedo; the floor's are in the lamp's shadow for x < 0.
std::vector<LightSample> floor_in_half_shadow(const Vector3f& to_light, bool shadow_is_known) {
  std::vector<LightSample> samples;
  for (int i = 0; i < 600; ++i) {
    const float x = -1.0F + 2.0F * (static_cast<float>(i % 30) + 0.5F) / 30.0F;
    const bool is_wall = i % 3 == 0, in_shadow = !is_wall && x < 0.0F;
    LightSample sample;
    sample.normal_world = is_wall ? Vector3f(1, 0, 0) : Vector3f(0, 0, 1);
    sample.p_world_m = {x, static_cast<float>(i / 30) * 0.1F - 1.0F, 0.0F};
    if (shadow_is_known && in_shadow) sample.reach.lamps.fill(0.0F);
    const float lamp = in_shadow ? 0.0F : 2.0F * std::max(0.0F, sample.normal_world.dot(to_light));
    sample.log_colour.setConstant(std::log(0.2F * (1.0F + kFromAbove * sample.normal_world.z() + lamp)));
    samples.push_back(sample);
  }
  return samples;
}

TEST(LightEstimator, AKnownShadowTellsHowStrongTheLampIs) {
  const Vector3f to_light = Vector3f(0.5F, 0, 0.866F);
  const auto lamp_over_ambient = [&](bool is_known) {
    const MainLight main = main_light(estimated(floor_in_half_shadow(to_light, is_known)));
    return main.directed.sum() / main.ambient.sum();
  };
  constexpr float kTruth = 2.0F;
  EXPECT_NEAR(lamp_over_ambient(true), kTruth, 0.2F);
  EXPECT_GT(lamp_over_ambient(false), kTruth + 0.3F);
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
  constexpr std::size_t kOverhead = kLampDirections - 1;
  TriangleTree table;
  table.build_by_place(plate(0.8F, 0.7F));
  const TreeInstance room{&table};
  const LightReach under = light_reach(room, {0, 0, 0.1}, 0.1);
  EXPECT_EQ(under.lamps[kOverhead], 0.0F);
  EXPECT_EQ(under.lamps[0], 1.0F);  // from the side
  EXPECT_LT(under.ambient, 0.95F);
  EXPECT_GT(under.ambient, 0.4F);
  const LightReach beside = light_reach(room, {3.0, 0, 0.1}, 0.1);
  EXPECT_EQ(beside.lamps[kOverhead], 1.0F);
  EXPECT_EQ(beside.ambient, 1.0F);
  EXPECT_EQ(light_reach({}, {0, 0, 0.1}, 0.1).lamps[kOverhead], 1.0F);
}

TEST(ObjectLight, ACeilingIsBehindTheLamps) {
  TriangleTree ceiling;
  ceiling.build_by_place(plate(3.0F, 1.5F));
  EXPECT_EQ(light_reach({&ceiling}, {0, 0, 0.1}, 0.1).lamps[kLampDirections - 1], 1.0F);
}

TEST(ObjectLight, AFloorUnderATableIsInShade) {
  TriangleTree table;
  table.build_by_place(plate(0.8F, 0.4F));
  const LightReach under = surface_reach({&table}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(under.lamps[kLampDirections - 1], 0.0F);
  EXPECT_LT(under.ambient, 0.97F);
  const LightReach above = surface_reach({&table}, {0, 0, 0.4}, {0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(above.lamps[kLampDirections - 1], 1.0F);
  EXPECT_EQ(above.ambient, 1.0F);
}

TEST(ObjectReaches, MovedObjectsTakeTurns) {
  GlContext context;
  TriangleTree table;
  table.build_by_place(plate(0.8F, 0.7F));
  std::vector<std::unique_ptr<VirtualObject>> objects;
  for (int i = 0; i < 3; ++i) {
    objects.push_back(object_of(context, "plate", plate(0.1F, 0.0F), objects));
    objects.back()->in_room = true;
    objects.back()->body.T_world_object.translation() = Eigen::Vector3d(3.0, 0.3 * i, 0.1);
  }
  ObjectReaches reaches;
  const auto shaded_objects = [&] {
    reaches.update(objects, {&table}, 0.03, 1.0F);
    int shaded = 0;
    for (std::size_t i = 0; i < objects.size(); ++i)
      shaded += reaches.of(i)->lamps[kLampDirections - 1] < 0.5F ? 1 : 0;
    return shaded;
  };
  EXPECT_EQ(shaded_objects(), 0);  // all at once, when they are new
  for (const auto& object : objects) object->body.T_world_object.translation().x() = 0.0;
  EXPECT_EQ(shaded_objects(), 1);
  EXPECT_EQ(shaded_objects(), 2);
  EXPECT_EQ(shaded_objects(), 3);
  objects[1]->in_room = false;
  reaches.update(objects, {&table}, 0.03, 1.0F);
  EXPECT_EQ(reaches.of(1), nullptr);
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
    find_occlusion(picture, picture, depth_m, {layer, given}, {}, occlusion);
    return occlusion.hidden.at(32 - occlusion.rect.x, foot_y - occlusion.rect.y);
  };
  EXPECT_GT(hidden_at({}, real_m), 0.1F);
  EXPECT_EQ(hidden_at(feet, real_m), 0.0F);
  DepthImage hand_m = real_m;
  for (float& z_m : hand_m.pixels) z_m = std::min(z_m, 0.6F);
  EXPECT_GT(hidden_at(feet, hand_m), 0.9F);  // a hand before the contact hides it
}

/// As above, with a thing before the contact whose top ends in the middle of the foot's row, in the same
/// picture: red, before a bright table that the object's shadow darkens to the same red.
TEST(Occlusion, AShadowIsNotTakenForAnOccluder) {
  constexpr Rgb kTable{200, 160, 120}, kThing{60, 30, 20};
  DepthImage real_m(64, 64, 1.5F);
  ColourImage camera_image(64, 64, kTable);
  for (int y = 40; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      real_m.at(x, y) = 0.6F;
      if (y >= 42) camera_image.at(x, y) = kThing;  // the depth edge is 2 pixels too high
    }
  ColourImage shadowed = camera_image;
  for (int y = 30; y < 42; ++y) std::fill_n(shadowed.row(y), 64, kThing);
  ObjectLayer layer;
  layer.rect = {16, 16, 32, 32};
  layer.samples = 1;
  layer.colour.resize(32, 32);
  layer.depth_m.resize(32, 32, 1.0F);
  const auto hidden_above_edge = [&](const ColourImage& judged) {
    Occlusion occlusion;
    find_occlusion(judged, shadowed, real_m, {layer, {}}, {}, occlusion);
    return occlusion.hidden.at(32 - occlusion.rect.x, 40 - occlusion.rect.y);
  };
  EXPECT_GT(hidden_above_edge(shadowed), 0.7F);
  EXPECT_LT(hidden_above_edge(camera_image), 0.3F);
}

TEST(Soften, DoesNotBlurAnOccluderOverAFoot) {
  Image<float> hidden(3, 3, 0.0F), softened;
  for (int x = 0; x < 3; ++x) hidden.at(x, 2) = 1.0F;
  const MaskImage covered(3, 3, 255);
  MaskImage contact(3, 3, 0);
  soften(hidden, covered, contact, softened);
  EXPECT_GT(softened.at(1, 1), 0.2F);
  contact.at(1, 1) = contact.at(1, 2) = kAtFoot;
  soften(hidden, covered, contact, softened);
  EXPECT_EQ(softened.at(1, 1), 0.0F);
  EXPECT_GT(softened.at(1, 2), 0.5F);  // an occluder stays before the foot
}

ColourImage noisy_picture(float deviation) {
  // Grain over a whole picture with a smooth ramp.
  ColourImage picture(640, 480);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const auto level = static_cast<std::uint8_t>(60 + x / 8);
      picture.at(x, y) = {level, level, static_cast<std::uint8_t>(level / 2)};
    }
  ObjectLayer layer;
  layer.rect = {0, 0, 640, 480};
  layer.samples = 1;
  layer.depth_m.resize(640, 480, 1.0F);
  Occlusion occlusion;
  occlusion.rect = layer.rect;
  occlusion.hidden.resize(640, 480);
  add_grain(layer, occlusion, deviation, 7, picture);
  return picture;
}

TEST(CameraNoise, TheGrainThatIsGivenIsMeasured) {
  for (const float deviation : {1.0F, 2.0F, 5.0F})
    EXPECT_NEAR(noise_of(noisy_picture(deviation)).value_or(0.0F), deviation, 0.15F * deviation);
  EXPECT_FALSE(noise_of(ColourImage(640, 480, Rgb{255, 255, 255})));
}

TEST(CameraNoise, GrainIsTheSameInAReplayAndOnlyOnVisibleParts) {
  EXPECT_EQ(noisy_picture(3.0F).pixels, noisy_picture(3.0F).pixels);
  ColourImage picture(8, 8, Rgb{100, 100, 100});
  ObjectLayer layer;
  layer.rect = {2, 2, 4, 4};
  layer.samples = 1;
  layer.depth_m.resize(4, 4, 1.0F);
  layer.depth_m.at(0, 0) = 0.0F;  // no object
  Occlusion occlusion;
  occlusion.rect = {0, 0, 8, 8};
  occlusion.hidden.resize(8, 8);
  occlusion.hidden.at(3, 2) = 1.0F;
  add_grain(layer, occlusion, 20.0F, 1, picture);
  int changed = 0;
  for (const Rgb& pixel : picture.pixels) changed += pixel == Rgb{100, 100, 100} ? 0 : 1;
  EXPECT_GT(changed, 8);
  EXPECT_EQ(picture.at(2, 2), (Rgb{100, 100, 100}));
  EXPECT_EQ(picture.at(3, 2), (Rgb{100, 100, 100}));
  EXPECT_EQ(picture.at(1, 4), (Rgb{100, 100, 100}));
}

}  // namespace
}  // namespace roomradar::light_test
