// occlusion_test.cpp: occlusion edges where depth is wrong and colour right, and edges in depth only.
#include "app/render/occlusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar::occlusion_test {
namespace {

constexpr int kWidth = 96, kHeight = 64, kTrueEdge = 48;
constexpr Rgb kSkin{205, 150, 125}, kWall{90, 100, 120};

/// A wall with a hand in front of its left half; texture by a fixed pattern of +-12.
ColourImage hand_before_wall(Rgb hand = kSkin) {
  ColourImage picture(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int texture = (x * 7 + y * 13) % 25 - 12;
      const Rgb colour = x < kTrueEdge ? hand : kWall;
      picture.at(x, y) = {static_cast<std::uint8_t>(colour.r + texture),
                          static_cast<std::uint8_t>(colour.g + texture),
                          static_cast<std::uint8_t>(colour.b + texture)};
    }
  }
  return picture;
}

/// The hand's depth ends up to 3 px beside its true edge, varying by row.
DepthImage ragged_depth(float hand_m = 1.0F, float wall_m = 2.5F) {
  DepthImage depth_m(kWidth, kHeight, wall_m);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kTrueEdge + (y * 5) % 7 - 3; ++x) depth_m.at(x, y) = hand_m;
  return depth_m;
}

/// An object that covers all but a margin of the picture, at one depth.
ObjectLayer object_at(float depth_m) {
  ObjectLayer layer;
  layer.rect = {8, 8, kWidth - 16, kHeight - 16};
  layer.samples = 1;
  layer.colour.resize(layer.rect.width, layer.rect.height);
  layer.depth_m.resize(layer.rect.width, layer.rect.height, depth_m);
  return layer;
}

/// Mean difference from the true occlusion, over the layer.
double mean_error(const Occlusion& occlusion, const ObjectLayer& layer) {
  double sum = 0.0;
  for (int y = layer.rect.y; y < layer.rect.y + layer.rect.height; ++y)
    for (int x = layer.rect.x; x < layer.rect.x + layer.rect.width; ++x)
      sum += std::abs(occlusion.hidden.at(x - occlusion.rect.x, y - occlusion.rect.y) -
                      (x < kTrueEdge ? 1.0F : 0.0F));
  return sum / (layer.rect.width * layer.rect.height);
}

Occlusion found(const ColourImage& background, const DepthImage& real_depth_m, const ObjectLayer& layer,
                const OcclusionConfig& config = {}) {
  Occlusion occlusion;
  find_occlusion(background, background, real_depth_m, {layer, {}}, config, occlusion);
  return occlusion;
}

TEST(Occlusion, RaggedEdgesGoToWhereTheColoursChange) {
  const ObjectLayer layer = object_at(1.5F);
  const double by_depth = mean_error(
      found(hand_before_wall(), ragged_depth(), layer, OcclusionConfig{.edge_reach_px = 0}), layer);
  const double by_colour = mean_error(found(hand_before_wall(), ragged_depth(), layer), layer);
  const double at_best = 0.5 / layer.rect.width;  // a true edge, softened over 3 x 3 pixels
  EXPECT_GT(by_depth, 3.0 * at_best);
  EXPECT_LT(by_colour, 1.3 * at_best);
}

TEST(Occlusion, SidesThatLookAlikeKeepTheEdgeOfTheirDepth) {
  const ObjectLayer layer = object_at(1.5F);
  const ColourImage plain = hand_before_wall(kWall);
  const Occlusion with = found(plain, ragged_depth(), layer);
  const Occlusion without = found(plain, ragged_depth(), layer, OcclusionConfig{.edge_reach_px = 0});
  for (int y = layer.rect.y; y < layer.rect.y + layer.rect.height; ++y)
    for (int x = layer.rect.x; x < layer.rect.x + layer.rect.width; ++x)
      ASSERT_EQ(with.hidden.at(x - with.rect.x, y - with.rect.y),
                without.hidden.at(x - without.rect.x, y - without.rect.y));
}

TEST(Occlusion, AnObjectThatDipsIntoASurfaceEndsWhereItDoesWhateverTheColours) {
  DepthImage slope_m(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) slope_m.at(x, y) = 1.5F + 0.006F * static_cast<float>(x - 30);
  // The slope passes the object's depth, minus the tolerance, near column 27; the colours change at 48.
  const Occlusion occlusion = found(hand_before_wall(), slope_m, object_at(1.5F));
  EXPECT_EQ(occlusion.hidden.at(20 - occlusion.rect.x, 30 - occlusion.rect.y), 1.0F);
  EXPECT_EQ(occlusion.hidden.at(35 - occlusion.rect.x, 30 - occlusion.rect.y), 0.0F);
  EXPECT_EQ(occlusion.hidden.at(45 - occlusion.rect.x, 30 - occlusion.rect.y), 0.0F);
}

TEST(Occlusion, WhatHidesHasItsOwnColourToTheEdge) {
  // One column of pixels on the edge is half wall in the picture.
  ColourImage picture = hand_before_wall();
  for (int y = 0; y < kHeight; ++y) picture.at(kTrueEdge, y) = {148, 125, 122};
  const Occlusion occlusion = found(picture, ragged_depth(), object_at(1.5F));
  double red = 0.0;
  for (int y = 16; y < kHeight - 16; ++y)
    red += occlusion.front.at(kTrueEdge - occlusion.rect.x, y - occlusion.rect.y).r;
  EXPECT_GT(red / (kHeight - 32), 160.0);  // 148 in the picture, 205 in the hand
}

TEST(Occlusion, NothingMeasuredAndNothingInFrontHideNothing) {
  const ObjectLayer layer = object_at(1.5F);
  for (const float depth_m : {0.0F, 1.5F, 1e6F}) {
    const Occlusion occlusion = found(hand_before_wall(), DepthImage(kWidth, kHeight, depth_m), layer);
    for (const float hidden : occlusion.hidden.pixels) ASSERT_EQ(hidden, 0.0F);
  }
  const Occlusion all = found(hand_before_wall(), DepthImage(kWidth, kHeight, 0.3F), layer);
  for (const float hidden : all.hidden.pixels) ASSERT_EQ(hidden, 1.0F);
}

TEST(Occlusion, ALayerOfOnePixelInACornerAndOneWithoutDepthAreTaken) {
  ObjectLayer layer;
  layer.rect = {0, 0, 1, 1};
  layer.samples = 1;
  layer.colour.resize(1, 1);
  layer.depth_m.resize(1, 1, 1.5F);
  EXPECT_EQ(found(hand_before_wall(), ragged_depth(), layer).hidden.at(0, 0), 1.0F);
  layer.depth_m.at(0, 0) = 0.0F;
  EXPECT_EQ(found(hand_before_wall(), ragged_depth(), layer).hidden.at(0, 0), 0.0F);
}

TEST(Occlusion, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(require_valid(OcclusionConfig{}));
  for (const OcclusionConfig& config :
       {OcclusionConfig{.softness_m = 0.0F}, OcclusionConfig{.edge_reach_px = -1},
        OcclusionConfig{.tolerance_m = std::nanf("")}})
    EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::occlusion_test
