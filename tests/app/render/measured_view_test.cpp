// measured_view_test.cpp: measured depth seen from the picture's camera, and merged with the model.
#include "app/render/measured_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

namespace roomradar::measured_view_test {
namespace {

constexpr Intrinsics kDepth{160, 120, 140.0, 140.0, 79.5, 59.5};
constexpr PixelRect kAll{0, 0, 160, 120};

/// A square 40 pixels wide in front of a wall, with columns beside it in which nothing is measured.
DepthImage square_before_wall(float square_m, float wall_m) {
  DepthImage depth_m(kDepth.width_px, kDepth.height_px, wall_m);
  for (int y = 40; y < 80; ++y) {
    for (int x = 60; x < 100; ++x) depth_m.at(x, y) = square_m;
    for (int x = 100; x < 106; ++x) depth_m.at(x, y) = 0.0F;
  }
  return depth_m;
}

MeasuredView seen(const DepthImage& depth_m, const MaskImage& dynamic_mask = {},
                  const MaskImage& revealed_mask = {}) {
  MeasuredView view;
  view_measured({depth_m, dynamic_mask, kDepth, revealed_mask}, Eigen::Isometry3d::Identity(), kDepth, kAll,
                view);
  return view;
}

TEST(MeasuredView, TheSameCameraSeesTheSameImage) {
  const DepthImage depth_m = square_before_wall(0.8F, 2.0F);
  const DepthImage seen_m = seen(depth_m).depth_m;
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i)
    ASSERT_NEAR(seen_m.pixels[i], depth_m.pixels[i], 1e-5F);
}

TEST(MeasuredView, AFinerCameraBesideItSeesAllPixelsOfASurfaceAndItsParallax) {
  // A colour camera with four times the pixels, 5 cm to the right: the square moves by 140 * 4 * 0.05 / 0.8
  // px.
  const Intrinsics colour{640, 480, 560.0, 560.0, 319.5, 239.5};
  Eigen::Isometry3d T_view_depth = Eigen::Isometry3d::Identity();
  T_view_depth.translation().x() = -0.05;
  MeasuredView view;
  view_measured({square_before_wall(0.8F, 2.0F), {}, kDepth, {}}, T_view_depth, colour, {0, 0, 640, 480},
                view);
  const DepthImage& seen_m = view.depth_m;
  int near_px = 0;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) near_px += seen_m.at(x, y) > 0.0F && seen_m.at(x, y) < 1.0F ? 1 : 0;
  EXPECT_NEAR(near_px, 160 * 160, 2 * 4 * 160) << "within a pixel of the depth image along its outline";
  for (int y = 166; y < 314; ++y)
    for (int x = 211; x < 359; ++x) ASSERT_NEAR(seen_m.at(x, y), 0.8F, 1e-5F) << x << ' ' << y;
}

TEST(MeasuredView, OnlyTheRectangleIsWritten) {
  MeasuredView view;
  view.depth_m.resize(kDepth.width_px, kDepth.height_px, 7.0F);
  view.is_dynamic.resize(kDepth.width_px, kDepth.height_px, 7);
  const PixelRect rect{50, 30, 20, 20};
  view_measured({square_before_wall(0.8F, 2.0F), {}, kDepth, {}}, Eigen::Isometry3d::Identity(), kDepth, rect,
                view);
  const DepthImage& seen_m = view.depth_m;
  for (int y = 0; y < seen_m.height; ++y)
    for (int x = 0; x < seen_m.width; ++x) {
      const bool is_in = x >= 50 && x < 70 && y >= 30 && y < 50;
      ASSERT_EQ(seen_m.at(x, y), !is_in ? 7.0F : x >= 60 && y >= 40 ? 0.8F : 2.0F) << x << ' ' << y;
    }
}

TEST(MeasuredView, AMeasuredSurfaceCountsWhereTheModelHasNoneOrAFartherOne) {
  for (const float model_m : {0.0F, 2.0F, 0.5F}) {
    DepthImage real_m(kDepth.width_px, kDepth.height_px, model_m);
    MeasuredView view = seen(square_before_wall(0.8F, 2.0F));
    add_measured(view, {}, real_m);
    EXPECT_EQ(real_m.at(80, 60), model_m == 0.5F ? 0.5F : 0.8F) << model_m;
    EXPECT_EQ(real_m.at(103, 60), model_m) << "nothing was measured there";
    EXPECT_EQ(real_m.at(20, 60), model_m == 0.0F ? 2.0F : model_m);
  }
}

// A chair at 1 m that was taken away: the frame sees the wall there, but for some pixels without depth.
TEST(MeasuredView, APartOfTheRoomThatIsGoneHidesNothing) {
  DepthImage depth_m(kDepth.width_px, kDepth.height_px, 2.0F), real_m = depth_m;
  MaskImage revealed(kDepth.width_px, kDepth.height_px);
  for (int y = 40; y < 80; ++y)
    for (int x = 60; x < 100; ++x) real_m.at(x, y) = 1.0F, revealed.at(x, y) = 255;
  for (int y = 50; y < 53; ++y)
    for (int x = 70; x < 73; ++x) depth_m.at(x, y) = 0.0F, revealed.at(x, y) = 0;
  const DepthImage model_m = real_m;
  MeasuredView view = seen(depth_m, {}, revealed);
  add_measured(view, {}, real_m);
  for (const float z_m : real_m.pixels) ASSERT_FLOAT_EQ(z_m, 2.0F);
  real_m = model_m;
  view = seen(depth_m);
  add_measured(view, {}, real_m);
  EXPECT_EQ(real_m.at(80, 60), 1.0F) << "a difference that no region confirms, as one of poses";
}

TEST(MeasuredView, NoiseAndSpecksOfDepthAreNoSurfaces) {
  DepthImage real_m(kDepth.width_px, kDepth.height_px, 2.0F);
  DepthImage seen_m(kDepth.width_px, kDepth.height_px, 1.97F);  // the model is off by 3 cm, two sigmas
  seen_m.at(50, 50) = seen_m.at(51, 50) = 1.0F;
  MeasuredView view = seen(seen_m);
  add_measured(view, {.base_m = 0.01F}, real_m);
  for (const float z_m : real_m.pixels) ASSERT_EQ(z_m, 2.0F);
}

/// Not 0 where the depth is that of the square.
MaskImage mask_of_square(const DepthImage& depth_m) {
  MaskImage mask(depth_m.width, depth_m.height);
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i)
    mask.pixels[i] = depth_m.pixels[i] > 0.0F && depth_m.pixels[i] < 1.0F ? 255 : 0;
  return mask;
}

TEST(MeasuredView, DynamicPixelsBesideTheirMeshCount) {
  // The model has the square's mesh without its border, whose pixels are measured.
  const DepthImage depth_m = square_before_wall(0.8F, 2.0F);
  DepthImage real_m(kDepth.width_px, kDepth.height_px, 2.0F);
  for (int y = 41; y < 79; ++y)
    for (int x = 61; x < 99; ++x) real_m.at(x, y) = 0.79F;
  MeasuredView view = seen(depth_m, mask_of_square(depth_m));
  add_measured(view, {}, real_m);
  for (int y = 40; y < 80; ++y)
    for (int x = 60; x < 100; ++x) ASSERT_LT(real_m.at(x, y), 0.81F) << x << ' ' << y;
  EXPECT_EQ(real_m.at(59, 60), 2.0F);
}

constexpr Rgb kSkin{205, 150, 125}, kTable{165, 125, 85};

/// A skin-coloured square on a table, with a texture of +-8.
ColourImage square_on_table() {
  ColourImage image(kDepth.width_px, kDepth.height_px);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int texture = (x * 7 + y * 13) % 17 - 8;
      const Rgb colour = x >= 60 && x < 100 && y >= 40 && y < 80 ? kSkin : kTable;
      image.at(x, y) = {static_cast<std::uint8_t>(colour.r + texture),
                        static_cast<std::uint8_t>(colour.g + texture),
                        static_cast<std::uint8_t>(colour.b + texture)};
    }
  }
  return image;
}

TEST(MeasuredView, GapsAreBridgedAsFarAsTheColoursReach) {
  for (const auto& [block_px, part] : {std::pair{1, 0.4}, {2, 0.2}, {8, 0.5}}) {
    std::mt19937 random(3);
    DepthImage depth_m =
        square_before_wall(0.8F, 2.0F);  // beside it, in the sensor's shadow, nothing is measured
    for (int y = 40; y < 80; y += block_px)
      for (int x = 60; x < 100; x += block_px)
        if (std::bernoulli_distribution(part)(random))
          for (int v = y; v < y + block_px; ++v)
            for (int u = x; u < x + block_px; ++u) depth_m.at(u, v) = 0.0F;
    MeasuredView view = seen(depth_m, mask_of_square(depth_m));
    DepthImage real_m(kDepth.width_px, kDepth.height_px, 2.0F);
    add_measured(view, {}, real_m);
    bridge_gaps(square_on_table(), view, real_m);
    int missing = 0, wrong = 0;
    for (int y = 0; y < kDepth.height_px; ++y) {
      for (int x = 0; x < kDepth.width_px; ++x) {
        const bool is_square = x >= 60 && x < 100 && y >= 40 && y < 80;
        missing += is_square && std::abs(real_m.at(x, y) - 0.8F) > 1e-3F ? 1 : 0;
        wrong += !is_square && real_m.at(x, y) != 2.0F ? 1 : 0;
      }
    }
    EXPECT_LE(missing, 8) << "of 1600, " << block_px << " px";
    EXPECT_LE(wrong, 8) << block_px << " px";
  }
}

TEST(MeasuredView, WithoutColoursTheMajorityAroundAGapDecides) {
  DepthImage depth_m = square_before_wall(0.8F, 2.0F);
  for (int y = 54; y < 62; ++y)
    for (int x = 74; x < 82; ++x) depth_m.at(x, y) = 0.0F;
  MeasuredView view = seen(depth_m, mask_of_square(depth_m));
  DepthImage real_m(kDepth.width_px, kDepth.height_px, 2.0F);
  add_measured(view, {}, real_m);
  bridge_gaps(ColourImage(kDepth.width_px, kDepth.height_px, kTable), view, real_m);
  EXPECT_NEAR(real_m.at(77, 57), 0.8F, 1e-3F);
  EXPECT_EQ(real_m.at(105, 60), 2.0F) << "the sensor's shadow, of which the far side is nearer";
  // A shadow that falls on the table must not be aligned into the square: its pixels are decided, measured or
  // not.
  EXPECT_NE(view.is_decided.at(77, 57), 0);
  EXPECT_NE(view.is_decided.at(70, 50), 0);
  EXPECT_EQ(view.is_decided.at(50, 60), 0);
}

}  // namespace
}  // namespace roomradar::measured_view_test
