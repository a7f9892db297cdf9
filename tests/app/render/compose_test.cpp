// compose_test.cpp: occlusion, edges and shadows on scenes with known pictures.
#include "app/render/compose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/render/draw.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/depth/depth_pass.hpp"

namespace roomradar::compose_test {
namespace {

constexpr Rgb kGrey{100, 100, 100};
constexpr Rgb kRed{200, 0, 0};
const Intrinsics kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};

/// A layer of one colour at one depth over a rectangle.
ObjectLayer flat_layer(const PixelRect& rect, float depth_m, int samples = 2) {
  ObjectLayer layer;
  layer.rect = rect;
  layer.samples = samples;
  layer.colour.resize(rect.width * samples, rect.height * samples, kRed);
  layer.depth_m.resize(rect.width * samples, rect.height * samples, depth_m);
  return layer;
}

ColourImage composed(const DepthImage& real_depth_m, const ObjectLayer& layer,
                     const ComposeConfig& config = {}) {
  ColourImage picture(kCamera.width_px, kCamera.height_px, kGrey);
  Occlusion occlusion;
  lay_objects({layer, {}}, real_depth_m, config.occlusion, occlusion, picture);
  return picture;
}

/// A square plate of side 2 * half_m at height z_m, facing up and down.
Mesh plate(float half_m, float z_m) {
  Mesh mesh;
  mesh.vertices = {
      {-half_m, -half_m, z_m}, {half_m, -half_m, z_m}, {half_m, half_m, z_m}, {-half_m, half_m, z_m}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Pose of a camera that looks straight down from 1 m above a table at z = 0.
Eigen::Isometry3d over_the_table() {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T_world_camera.translation().z() = 1.0;
  return T_world_camera;
}

ContactShadow shadow_of(const Mesh& mesh,
                        const Eigen::Matrix3d& R_world_object = Eigen::Matrix3d::Identity()) {
  ContactShadow shadow;
  make_contact_shadow(spread_points(mesh), R_world_object, shadow);
  return shadow;
}

TEST(Compose, ShowsTheObjectInFrontOfTheRoomAndHidesItBehind) {
  DepthImage real_depth_m(64, 48, 2.0F);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 32; ++x) real_depth_m.at(x, y) = 0.5F;  // a hand in the left half
  const ColourImage picture = composed(real_depth_m, flat_layer({10, 10, 40, 20}, 1.0F));
  EXPECT_EQ(picture.at(5, 5), kGrey);
  EXPECT_EQ(picture.at(15, 15), kGrey);  // behind the hand
  EXPECT_EQ(picture.at(40, 15), kRed);   // in front of the wall
  EXPECT_EQ(picture.at(49, 29), kRed);   // the rectangle's last pixel
  EXPECT_EQ(picture.at(50, 29), kGrey);
  // The hand's edge is soft over one pixel to each side, and decreases monotonically.
  EXPECT_LT(picture.at(31, 15).r, picture.at(32, 15).r);
  EXPECT_EQ(picture.at(30, 15), kGrey);
  EXPECT_EQ(picture.at(33, 15), kRed);
}

TEST(Compose, AHiddenObjectLeavesNoOutlineWhereAnotherIsNearer) {
  ObjectLayer layer = flat_layer({5, 10, 40, 20}, 0.0F, 1);
  for (int y = 0; y < 20; ++y) {
    std::fill_n(layer.depth_m.row(y), 10, 1.0F);
    if (y > 3) std::fill_n(layer.depth_m.row(y) + 25, 15, 3.0F);  // its top rim is just below the other's
  }
  const ColourImage picture = composed(DepthImage(64, 48, 2.0F), layer);
  for (int y = 10; y < 30; ++y) {
    for (int x = 5; x < 15; ++x) EXPECT_EQ(picture.at(x, y), kRed) << x << " " << y;
    for (int x = 20; x < 60; ++x) EXPECT_EQ(picture.at(x, y), kGrey) << x << " " << y;
  }
}

TEST(Compose, AnObjectOnASurfaceDoesNotFlickerWithItsNoise) {
  DepthImage real_depth_m(64, 48, 1.0F);
  for (std::size_t i = 0; i < real_depth_m.pixels.size(); ++i)
    real_depth_m.pixels[i] += (i % 2 == 0 ? 0.006F : -0.006F);
  const ColourImage picture = composed(real_depth_m, flat_layer({10, 10, 10, 10}, 1.0F));
  for (int y = 10; y < 20; ++y)
    for (int x = 10; x < 20; ++x) EXPECT_EQ(picture.at(x, y), kRed);
}

TEST(Compose, NothingKnownHidesNothing) {
  const ColourImage picture = composed(DepthImage(64, 48, 0.0F), flat_layer({0, 0, 64, 48}, 3.0F));
  EXPECT_EQ(picture.pixels, ColourImage(64, 48, kRed).pixels);
}

TEST(Compose, HalfCoveredPixelsAreHalfMixed) {
  ObjectLayer layer = flat_layer({10, 10, 1, 1}, 1.0F);
  layer.depth_m.at(0, 0) = layer.depth_m.at(0, 1) = 0.0F;
  const ColourImage picture = composed(DepthImage(64, 48, 2.0F), layer);
  EXPECT_EQ(picture.at(10, 10), (Rgb{150, 50, 50}));
  ObjectLayer coarse = flat_layer({10, 10, 1, 1}, 1.0F, 1);
  EXPECT_EQ(composed(DepthImage(64, 48, 2.0F), coarse).at(10, 10), kRed);
}

TEST(Compose, AnEmptyLayerLeavesThePicture) {
  const ColourImage picture = composed(DepthImage(64, 48, 2.0F), ObjectLayer{});
  EXPECT_EQ(picture.pixels, ColourImage(64, 48, kGrey).pixels);
}

TEST(Compose, RefusesSizesThatDisagree) {
  EXPECT_THROW((void)composed(DepthImage(63, 48, 1.0F), ObjectLayer{}), Error);
  EXPECT_THROW((void)composed(DepthImage(64, 48, 1.0F), flat_layer({60, 10, 10, 10}, 1.0F)), Error);
  ObjectLayer cut = flat_layer({10, 10, 10, 10}, 1.0F);
  cut.colour.resize(19, 20);
  EXPECT_THROW((void)composed(DepthImage(64, 48, 1.0F), cut), Error);
}

TEST(Compose, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(require_valid(ComposeConfig{}));
  ComposeConfig config;
  config.shadow_strength = 2.0F;
  try {
    require_valid(config);
    FAIL() << "a strength of 2 was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("compose.shadow_strength"), std::string::npos);
  }
  config = {};
  config.occlusion.softness_m = 0.0F;
  EXPECT_THROW(require_valid(config), Error);
}

TEST(ContactShadow, AgreesWithTheFormFactorOfASquarePlate) {
  const float half_m = 0.1F;
  const ContactShadow shadow = shadow_of(plate(half_m, 0.0F));
  // A point under a corner of a rectangle: 1/(2 pi) (A/sqrt(1+A^2) atan(B/sqrt(1+A^2)) + B/... ), four times
  // that under the centre. Source: Howell's catalogue of configuration factors, B-3.
  for (const double below_m : {0.02, 0.05, 0.1, 0.14}) {
    const double a = half_m / below_m;
    const double root = std::sqrt(1.0 + a * a);
    const double exact = 4.0 / (2.0 * M_PI) * 2.0 * a / root * std::atan(a / root);
    const float taken = ambient_occlusion(shadow, Eigen::Vector3f(0, 0, static_cast<float>(-below_m)));
    EXPECT_NEAR(taken, exact, 0.03) << below_m;
  }
}

TEST(ContactShadow, IsDarkestInContactAndFadesSidewaysAndDownwards) {
  const ContactShadow shadow = shadow_of(plate(0.1F, 0.05F));
  EXPECT_NEAR(shadow.bottom_m, 0.05, 1e-6);
  float before = 2.0F;
  for (float below_m = 0.0F; below_m < 0.25F; below_m += 0.01F) {
    const float taken = ambient_occlusion(shadow, {0, 0, 0.05F - below_m});
    EXPECT_LE(taken, before + 1e-4F);
    before = taken;
  }
  EXPECT_GT(ambient_occlusion(shadow, {0, 0, 0.05F}), 0.9F);
  EXPECT_LT(before, 0.01F);
  before = 2.0F;
  for (float x_m = 0.0F; x_m < 0.4F; x_m += 0.01F) {
    const float taken = ambient_occlusion(shadow, {x_m, 0, 0.03F});
    EXPECT_LE(taken, before + 1e-4F);
    before = taken;
  }
  EXPECT_EQ(before, 0.0F);
  const float in_contact = ambient_occlusion(shadow, {0, 0, 0.05F});
  // A noisy surface may reach slightly above the bottom.
  EXPECT_NEAR(ambient_occlusion(shadow, {0, 0, 0.06F}), in_contact, 1e-3F);
  EXPECT_NEAR(ambient_occlusion(shadow, {0, 0, 0.08F}), in_contact / 2,
              1e-3F);  // farther above, the shadow fades
  EXPECT_EQ(ambient_occlusion(shadow, {0, 0, 0.10F}), 0.0F);
  EXPECT_EQ(ambient_occlusion(shadow, {0, 0, -5.0F}), 0.0F);
}

TEST(ContactShadow, WithFewerCellsIsNearlyTheSame) {
  const SurfacePoints points = spread_points(plate(0.1F, 0.0F));
  ContactShadow fine, coarse;
  make_contact_shadow(points, Eigen::Matrix3d::Identity(), fine);
  make_contact_shadow(points, Eigen::Matrix3d::Identity(), coarse, 8);
  EXPECT_LT(4 * coarse.covered.size(), 2 * fine.covered.size());
  for (const float clearance_m : {0.02F, 0.05F, 0.1F})
    for (float x_m = -0.2F; x_m <= 0.2F; x_m += 0.01F) {
      const Eigen::Vector3f p_m(x_m, 0.03F, -clearance_m);
      EXPECT_NEAR(ambient_occlusion(coarse, p_m), ambient_occlusion(fine, p_m), 0.05F)
          << x_m << " " << clearance_m;
    }
}

TEST(ContactShadow, OfAPlateOnEdgeIsASliver) {
  const ContactShadow flat = shadow_of(plate(0.1F, 0.0F));
  const ContactShadow on_edge =
      shadow_of(plate(0.1F, 0.0F), Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()).toRotationMatrix());
  EXPECT_NEAR(on_edge.bottom_m, -0.1F, 0.002F);
  EXPECT_GT(ambient_occlusion(flat, {0, 0.06F, -0.02F}), 0.7F);
  EXPECT_LT(ambient_occlusion(on_edge, {0, 0.06F, -0.12F}), 0.1F);
  EXPECT_GT(ambient_occlusion(on_edge, {0, 0.0F, -0.1F}), 0.2F);
}

TEST(ContactShadow, PointsStandForTheSameArea) {
  Mesh mesh = plate(0.1F, 0.0F);
  mesh.vertices.insert(mesh.vertices.end(), {{1, 0, 0}, {1.02F, 0, 0}, {1, 0.02F, 0}});  // 0.0002 of 0.0402
  mesh.triangles.push_back({4, 5, 6});
  const SurfacePoints points = spread_points(mesh);
  const auto small = std::count_if(points.p_object_m.begin(), points.p_object_m.end(),
                                   [](const Eigen::Vector3f& p) { return p.x() > 0.5F; });
  EXPECT_NEAR(static_cast<double>(points.p_object_m.size()), 8000.0, 2.0);
  EXPECT_NEAR(static_cast<double>(small), 8000.0 * 0.0002 / 0.0402, 1.0);
  const auto left = std::count_if(points.p_object_m.begin(), points.p_object_m.end(),
                                  [](const Eigen::Vector3f& p) { return p.x() < 0.0F; });
  EXPECT_NEAR(static_cast<double>(left), 3980.0, 60.0);
  EXPECT_TRUE(spread_points(Mesh{}).p_object_m.empty());
}

TEST(ContactShadow, NothingCastsNone) {
  EXPECT_EQ(ambient_occlusion(shadow_of(Mesh{}), {0, 0, 0}), 0.0F);
  Mesh broken = plate(0.1F, 0.0F);
  broken.vertices[0].x() = std::nanf("");
  broken.triangles[1][2] = 99;
  EXPECT_EQ(ambient_occlusion(shadow_of(broken), {0, 0, -0.01F}), 0.0F);
  EXPECT_EQ(ambient_occlusion(ContactShadow{}, {0, 0, 0}), 0.0F);
}

TEST(Compose, AShadowStaysUnderAnObjectThatTurnedALittleWhereverItsOriginIs) {
  const Eigen::Isometry3d T_world_camera = over_the_table();
  const Eigen::Vector3d middle_world(0.1, 0.05, 0.03);
  const auto picture_of = [&](const Eigen::Vector3f& away_m) {
    Mesh mesh = plate(0.1F, 0.0F);
    for (Eigen::Vector3f& p : mesh.vertices) p += away_m;
    const ContactShadow shadow = shadow_of(mesh);
    ShadowCaster caster{&shadow, Eigen::Isometry3d::Identity()};
    caster.T_world_object.linear() = (Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY()))
                                         .toRotationMatrix();
    caster.T_world_object.translation() =
        middle_world - caster.T_world_object.linear() * away_m.cast<double>();
    ComposeConfig config;
    config.shadow_strength = 1.0F;
    ColourImage picture;
    cast_shadows(ColourImage(64, 48, kGrey), {DepthImage(64, 48, 1.0F), kCamera, T_world_camera},
                 {&caster, 1}, config, picture);
    return picture;
  };
  const ColourImage about_its_middle = picture_of({0, 0, 0}), far_off = picture_of({2, -1, 0.5F});
  EXPECT_LT(about_its_middle.at(38, 20).r, 40);
  for (std::size_t i = 0; i < far_off.pixels.size(); ++i)
    EXPECT_NEAR(far_off.pixels[i].r, about_its_middle.pixels[i].r, 3) << i;
}

TEST(Compose, TheShadowFallsOnTheSurfaceBelowTheObject) {
  const Eigen::Isometry3d T_world_camera = over_the_table();
  const ContactShadow shadow = shadow_of(plate(0.1F, 0.0F));
  ShadowCaster caster{&shadow, Eigen::Isometry3d::Identity()};
  caster.T_world_object.translation() = Eigen::Vector3d(0.2, 0.1, 0.03);
  const DepthImage table_m(64, 48, 1.0F);
  const ColourImage grey(64, 48, kGrey);
  ColourImage picture;
  cast_shadows(grey, {table_m, kCamera, T_world_camera}, {&caster, 1}, {}, picture);
  const int x = static_cast<int>(std::lround(60.0 * 0.2 + 31.5));
  const int y = static_cast<int>(std::lround(60.0 * -0.1 + 23.5));  // world y points up in the picture
  EXPECT_LT(picture.at(x, y).r, 60);
  EXPECT_EQ(picture.at(3, 24), kGrey);
  const PixelRect rect = pixels_to_compose({&caster, 1}, kCamera, T_world_camera, {}, {});
  for (int v = 0; v < 48; ++v) {
    for (int u = 0; u < 64; ++u) {
      const bool is_inside =
          u >= rect.x && u < rect.x + rect.width && v >= rect.y && v < rect.y + rect.height;
      if (!is_inside) {
        EXPECT_EQ(picture.at(u, v), kGrey);
      }
    }
  }
  cast_shadows(grey, {DepthImage(64, 48), kCamera, T_world_camera}, {&caster, 1}, {}, picture);
  EXPECT_EQ(picture.pixels, grey.pixels);  // no surface, no shadow
  ComposeConfig config;
  config.shadow_strength = 0.0F;
  cast_shadows(grey, {table_m, kCamera, T_world_camera}, {&caster, 1}, config, picture);
  EXPECT_EQ(picture.pixels, grey.pixels);
  EXPECT_THROW(cast_shadows(grey, {DepthImage(63, 48), kCamera, T_world_camera}, {}, {}, picture), Error);
}

TEST(Compose, AShadowEndsAtTheColourEdgeOfWhatStandsInIt) {
  // A red box stands in the shadow, whose depth edge is ragged and up to 4 pixels from its colour edge.
  const Eigen::Isometry3d T_world_camera = over_the_table();
  const ContactShadow shadow = shadow_of(plate(0.2F, 0.0F));
  ShadowCaster caster{&shadow, Eigen::Isometry3d::Identity()};
  caster.T_world_object.translation() = Eigen::Vector3d(0.0, 0.0, 0.03);
  constexpr int kEdge_px = 32;
  constexpr Rgb kBoxColour{200, 40, 40};
  DepthImage depth_m(64, 48, 1.0F);
  ColourImage image(64, 48, kGrey);
  for (int y = 0; y < 48; ++y) {
    for (int x = kEdge_px; x < 64; ++x) image.at(x, y) = kBoxColour;
    const int depth_edge_px = kEdge_px + (y * 7) % 9 - 4;
    for (int x = depth_edge_px; x < 64; ++x) depth_m.at(x, y) = 0.6F;
  }
  const MaskImage all_decided(64, 48, 255);
  const auto wrong_pixels = [&](int edge_reach_px, const MaskImage* is_decided = nullptr) {
    ComposeConfig config;
    config.occlusion.edge_reach_px = edge_reach_px;
    ColourImage picture;
    cast_shadows(image, {depth_m, kCamera, T_world_camera}, {&caster, 1}, config, picture, is_decided);
    int wrong = 0;
    for (int y = 20; y < 28; ++y) {
      for (int x = kEdge_px - 5; x < kEdge_px + 5; ++x) {
        const bool is_dark = 10 * picture.at(x, y).r < 8 * image.at(x, y).r;
        wrong += is_dark != (x < kEdge_px) ? 1 : 0;
      }
    }
    return wrong;
  };
  EXPECT_GT(wrong_pixels(0), 10);
  EXPECT_EQ(wrong_pixels(5), 0);
  EXPECT_EQ(wrong_pixels(5, &all_decided), wrong_pixels(0)) << "depth that is decided stays";

  // Without a difference of colour the shadow's edge stays within the band, and what has no depth stays lit.
  image = ColourImage(64, 48, kGrey);
  ColourImage picture;
  cast_shadows(image, {depth_m, kCamera, T_world_camera}, {&caster, 1}, {}, picture);
  EXPECT_LT(picture.at(kEdge_px - 12, 24).r, 0.8 * kGrey.r);
  EXPECT_EQ(picture.at(kEdge_px + 12, 24), kGrey);
}

TEST(ShadeDepth, IsBrighterWhereTheSurfaceFacesTheCamera) {
  DepthImage depth_m(64, 48, 1.0F);
  for (int y = 0; y < 48; ++y)
    for (int x = 32; x < 64; ++x) depth_m.at(x, y) = 1.0F + 0.02F * static_cast<float>(x - 32);  // faces away
  depth_m.at(5, 5) = 0.0F;
  ColourImage picture;
  shade_depth(depth_m, kCamera, picture);
  EXPECT_GT(picture.at(20, 24).r, picture.at(45, 24).r + 30);
  EXPECT_LT(picture.at(5, 5).r, 40);
  shade_depth(DepthImage{}, kCamera, picture);
  EXPECT_TRUE(picture.empty());
}

class Drawer : public ::testing::Test {
 protected:
  GlContext context_;
  ObjectDrawer drawer_{context_};
  GpuMesh mesh_{context_};
  DrawnObject object_{{&mesh_, Eigen::Isometry3d::Identity()}};
};

TEST_F(Drawer, DepthAgreesWithTheDepthPassAndTheRectangleHoldsTheObject) {
  Mesh mesh = plate(0.2F, 0.0F);
  mesh.vertices[1].z() = 0.1F;
  mesh_.upload(mesh, MeshUsage::kStatic);
  object_.instance.T_world_mesh.translation() = Eigen::Vector3d(0.1, -0.05, 1.2);
  ObjectLayer layer;
  drawer_.draw({&object_, 1}, kCamera, Eigen::Isometry3d::Identity(), {}, layer);
  ASSERT_EQ(layer.samples, 2);
  DepthImage expected_m;
  DepthPass pass(context_);
  (void)pass.render({&object_.instance, 1}, scaled(kCamera, 2), Eigen::Isometry3d::Identity(), expected_m);
  int covered = 0;
  for (int y = 0; y < expected_m.height; ++y) {
    for (int x = 0; x < expected_m.width; ++x) {
      const int i = x - layer.rect.x * 2;
      const int j = y - layer.rect.y * 2;
      const float drawn_m = layer.depth_m.contains(i, j) ? layer.depth_m.at(i, j) : 0.0F;
      ASSERT_NEAR(drawn_m, expected_m.at(x, y), 1e-4F) << x << " " << y;
      covered += drawn_m > 0.0F;
    }
  }
  EXPECT_GT(covered, 300);
}

TEST_F(Drawer, UpperSidesAreBrighterThanLowerOnes) {
  Mesh mesh = plate(0.3F, 0.0F);
  mesh_.upload(mesh, MeshUsage::kStatic);
  Lighting lighting;
  lighting.to_key_light_world = Eigen::Vector3d::UnitX();  // grazes both sides: only ambient light is left
  const auto green_seen_from = [&](double height_m) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    if (height_m > 0) T_world_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks down
    T_world_camera.translation().z() = height_m;
    ObjectLayer layer;
    drawer_.draw({&object_, 1}, kCamera, T_world_camera, lighting, layer);
    EXPECT_GT(layer.depth_m.at(layer.depth_m.width / 2, layer.depth_m.height / 2), 0.0F);
    return layer.colour.at(layer.colour.width / 2, layer.colour.height / 2).g;
  };
  EXPECT_GT(green_seen_from(1.0), green_seen_from(-1.0) + 30);
}

TEST_F(Drawer, WhatIsOutOfViewDrawsNothing) {
  mesh_.upload(plate(0.2F, 0.0F), MeshUsage::kStatic);
  object_.instance.T_world_mesh.translation() = Eigen::Vector3d(0, 0, -1.0);
  ObjectLayer layer;
  drawer_.draw({&object_, 1}, kCamera, Eigen::Isometry3d::Identity(), {}, layer);
  EXPECT_EQ(layer.rect.width * layer.rect.height, 0);
  drawer_.draw({}, kCamera, Eigen::Isometry3d::Identity(), {}, layer);
  EXPECT_EQ(layer.rect.width * layer.rect.height, 0);
  const DrawnObject nothing;
  drawer_.draw({&nothing, 1}, kCamera, Eigen::Isometry3d::Identity(), {}, layer);
  EXPECT_EQ(layer.rect.width * layer.rect.height, 0);
}

TEST_F(Drawer, KeepsItsDigitsFarFromTheWorldsOrigin) {
  mesh_.upload(plate(0.2F, 0.0F), MeshUsage::kStatic);
  const Eigen::Vector3d far_away(1e6, -2e6, 3e5);
  const auto layer_at = [&](const Eigen::Vector3d& where) {
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
    T_world_camera.translation() = where;
    object_.instance.T_world_mesh.translation() = where + Eigen::Vector3d(0.05, 0.02, 1.0);
    ObjectLayer layer;
    drawer_.draw({&object_, 1}, kCamera, T_world_camera, {}, layer);
    return layer;
  };
  const ObjectLayer near = layer_at(Eigen::Vector3d::Zero());
  const ObjectLayer far = layer_at(far_away);
  ASSERT_EQ(near.rect, far.rect);
  for (std::size_t i = 0; i < near.depth_m.pixels.size(); ++i)
    ASSERT_NEAR(near.depth_m.pixels[i], far.depth_m.pixels[i], 1e-5F);
  EXPECT_EQ(near.colour.pixels, far.colour.pixels);
}

}  // namespace
}  // namespace roomradar::compose_test
