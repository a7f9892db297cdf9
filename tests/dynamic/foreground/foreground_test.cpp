// foreground_test.cpp: pixels labelled as moved, as revealed, and as not known.
#include "dynamic/foreground/foreground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "mapping/types/system/error.hpp"
#include "tests/dynamic/foreground/foreground_views.hpp"

namespace roomradar::foreground_test {
namespace {

using namespace test;

TEST(Foreground, NothingMovesInTheNoiseOfAKinect) {
  for (const float depth_m : {0.6F, 1.0F, 2.0F, 4.0F, 7.0F}) {
    DepthImage live_m = flat(depth_m);
    add_noise(live_m, 1);
    const Marked marked = mark(live_m, flat(depth_m));
    EXPECT_EQ(marked.counts.moved, 0U) << depth_m;
    EXPECT_EQ(marked.counts.revealed, 0U) << depth_m;
    EXPECT_EQ(marked.counts.valid, 640U * 480U);
    EXPECT_EQ(marked.labels.at(320, 240), PixelLabel::kStatic);
  }
}

TEST(Foreground, ModelOneCentimetreOffIsNotMovement) {
  for (const float offset_m : {-0.01F, 0.01F}) {
    DepthImage live_m = table_view(0.0, 0.0);
    DepthImage expected_m = live_m;
    add_noise(live_m, 2);
    for (float& z : expected_m.pixels) z += offset_m;
    const Marked marked = mark(live_m, expected_m);
    EXPECT_EQ(marked.counts.moved, 0U) << offset_m;
    EXPECT_EQ(marked.counts.revealed, 0U) << offset_m;
  }
}

TEST(Foreground, PoseOffByFiveMillimetresAndAThirdOfADegreeLightsUpNoSilhouette) {
  for (const double turn_deg : {-0.3, 0.3}) {
    for (const double shift_m : {-0.005, 0.005}) {
      DepthImage live_m = table_view(shift_m, turn_deg);
      add_noise(live_m, 3);
      const Marked marked = mark(live_m, table_view(0.0, 0.0));
      EXPECT_LT(static_cast<double>(marked.counts.moved), 0.001 * 640 * 480) << turn_deg << " " << shift_m;
      EXPECT_LT(static_cast<double>(marked.counts.revealed), 0.001 * 640 * 480) << turn_deg << " " << shift_m;
    }
  }
}

TEST(Foreground, HandThreeCentimetresBeforeASurfaceIsFoundToItsEdges) {
  const auto hand = [](int x, int y) { return x >= 200 && x < 320 && y >= 150 && y < 260; };
  for (const float clearance_m : {0.03F, 0.05F, 0.1F, 0.2F}) {
    DepthImage live_m = flat(1.0F);
    fill_rectangle(live_m, 200, 150, 320, 260, 1.0F - clearance_m);
    add_noise(live_m, 4);
    EXPECT_GT(intersection_over_union(mark(live_m, flat(1.0F)).dynamic_mask, hand), 0.95) << clearance_m;
  }
}

TEST(Foreground, WhatIsWithinTheNoiseOfTheSensorDoesNotMove) {
  DepthImage live_m = flat(1.0F);
  fill_rectangle(live_m, 200, 150, 320, 260, 0.94F);
  ForegroundConfig phone;
  phone.noise = {0.012F, 0.008F, 0.0F, 0.0F, 0.0F};  // 6 cm are 3 sigmas
  EXPECT_EQ(mark(live_m, flat(1.0F), phone).counts.moved, 0U);
  EXPECT_GT(mark(live_m, flat(1.0F)).counts.moved, 10'000U);
}

TEST(Foreground, HandThreeCentimetresOverAnObliqueTableIsFound) {
  for (const double below_deg : {35.0, 50.0, 70.0, 89.0}) {
    MaskImage truth;
    const DepthImage expected_m = hand_over_table(below_deg, 0.0, truth);
    for (const double above_m : {0.03, 0.05, 0.1, 0.2}) {
      DepthImage live_m = hand_over_table(below_deg, above_m, truth);
      add_noise(live_m, 7);
      const Marked marked = mark(live_m, expected_m, {}, kKinect, 2);
      const double iou =
          intersection_over_union(marked.dynamic_mask, [&](int x, int y) { return truth.at(x, y) != 0; });
      EXPECT_GT(iou, 0.93) << below_deg << " degrees, " << above_m << " m";
    }
  }
}

TEST(Foreground, FoundAtBothEndsOfTheRange) {
  const auto square = [](int x, int y) { return x >= 280 && x < 340 && y >= 200 && y < 260; };
  for (const auto& [near_m, far_m] : {std::pair{0.4F, 0.6F}, std::pair{6.0F, 8.0F}, std::pair{8.0F, 9.5F}}) {
    DepthImage live_m = flat(far_m);
    fill_rectangle(live_m, 280, 200, 340, 260, near_m);
    add_noise(live_m, 5);
    EXPECT_GT(intersection_over_union(mark(live_m, flat(far_m)).dynamic_mask, square), 0.97) << near_m;
  }
}

TEST(Foreground, HandOverTheLensIsAllMoved) {
  const Marked marked = mark(flat(0.45F), table_view(0.0, 0.0));
  EXPECT_EQ(marked.counts.moved, 640U * 480U);
}

TEST(Foreground, WhatWasTakenAwayIsRevealedNotMoved) {
  DepthImage expected_m = flat(1.5F);
  fill_rectangle(expected_m, 300, 200, 360, 260, 1.2F);
  const Marked marked = mark(flat(1.5F), expected_m);
  EXPECT_EQ(marked.counts.moved, 0U);
  EXPECT_NEAR(static_cast<double>(marked.counts.revealed), 60.0 * 60.0, 60.0);
  EXPECT_EQ(marked.labels.at(330, 230), PixelLabel::kRevealed);
  EXPECT_EQ(marked.dynamic_mask.at(330, 230), 0);
}

TEST(Foreground, WhatIsTakenAwayIsWiderThanWhatAMisplacedEdgeUncovers) {
  // The back of a chair in front of a niche in a wall. In the model it is too high and hides the niche.
  for (const float z : {1.0F, 1.7F, 2.5F}) {
    const auto px = [&](float metres) { return static_cast<int>(std::lround(metres * 585.0F / z)); };
    const ForegroundConfig config;
    const int off_px = px(1.2F * (config.edge_error_m + config.edge_error_rad * z));
    const int wide_px = px(0.15F);
    DepthImage live_m = flat(1.3F * z), expected_m = flat(1.3F * z);
    fill_rectangle(live_m, 250, 330 - off_px, 350, 330, 1.6F * z);
    fill_rectangle(live_m, 200, 330, 400, 480, z);
    fill_rectangle(expected_m, 200, 330 - off_px, 400, 480, z);
    DepthImage gone_m = expected_m;
    fill_rectangle(gone_m, 440, 100, 440 + wide_px, 100 + wide_px, z);
    add_noise(live_m, 9);
    EXPECT_EQ(mark(live_m, expected_m, {}, kKinect, 2).counts.revealed, 0U) << z;
    const Marked marked = mark(live_m, gone_m, {}, kKinect, 2);
    EXPECT_NEAR(static_cast<double>(marked.counts.revealed), wide_px * wide_px, 2.0 * wide_px) << z;
    EXPECT_EQ(marked.labels.at(440 + wide_px / 2, 100 + wide_px / 2), PixelLabel::kRevealed) << z;
    EXPECT_EQ(marked.counts.moved, 0U) << z;
  }
}

TEST(Foreground, UnmeasuredPixelsAreNotKnown) {
  DepthImage live_m = flat(1.0F);
  fill_rectangle(live_m, 200, 150, 320, 260, 0.8F);
  fill_rectangle(live_m, 240, 190, 270, 220, 0.0F);  // a hole in the middle of the hand
  const Marked marked = mark(live_m, flat(1.0F));
  EXPECT_EQ(marked.labels.at(255, 205), PixelLabel::kNotKnown);
  EXPECT_EQ(marked.dynamic_mask.at(255, 205), 0);
  EXPECT_EQ(marked.counts.moved, 120U * 110U - 30U * 30U);
  EXPECT_EQ(marked.counts.not_known, 0U) << "counts pixels with live depth only";

  const Marked blind = mark(flat(0.0F), flat(1.0F));
  EXPECT_EQ(blind.counts.valid, 0U);
  EXPECT_EQ(blind.counts.moved, 0U);
}

TEST(Foreground, WithoutAModelNothingIsKnown) {
  const Marked marked = mark(flat(1.0F), flat(0.0F));
  EXPECT_EQ(marked.counts.moved, 0U);
  EXPECT_EQ(marked.counts.not_known, 640U * 480U);
}

TEST(Foreground, ArmOverTheModelsHolesIsMovedAsAWhole) {
  // Half of the surface behind the arm is unmapped, in stripes: pixels there can at most be weak.
  DepthImage expected_m = flat(2.0F);
  for (int y = 0; y < 480; y += 24) fill_rectangle(expected_m, 0, y, 640, y + 12, 0.0F);
  DepthImage live_m = flat(2.0F);
  fill_rectangle(live_m, 300, 0, 360, 400, 1.5F);
  const auto arm = [](int x, int y) { return x >= 300 && x < 360 && y < 400; };
  EXPECT_GT(intersection_over_union(mark(live_m, expected_m).dynamic_mask, arm), 0.95);
}

TEST(Foreground, HoleOfTheModelIsMovedOnlyNearerThanAllAroundIt) {
  DepthImage expected_m = flat(2.0F);
  fill_rectangle(expected_m, 300, 200, 320, 220, 0.0F);
  DepthImage live_m = flat(2.0F);
  fill_rectangle(live_m, 290, 190, 330, 230, 1.5F);  // in front of the hole and its surroundings
  EXPECT_EQ(mark(live_m, expected_m).labels.at(310, 210), PixelLabel::kMoved);

  live_m = flat(2.0F);
  fill_rectangle(live_m, 300, 200, 320, 220, 2.6F);  // the camera sees into the hole
  EXPECT_EQ(mark(live_m, expected_m).labels.at(310, 210), PixelLabel::kNotKnown);
  EXPECT_EQ(mark(live_m, expected_m).counts.revealed, 0U);
}

TEST(Foreground, AHandFullOfGapsIsMovedWhereverItIsMeasured) {
  const auto is_hand = [](int x, int y) { return x >= 200 && x < 320 && y >= 150 && y < 260; };
  for (const auto& [block_px, gaps] : {std::pair{1, 0.4}, {1, 0.6}, {2, 0.3}, {8, 0.5}}) {
    std::mt19937 random(5);
    DepthImage live_m = flat(1.0F);
    fill_rectangle(live_m, 200, 150, 320, 260, 0.8F);
    add_noise(live_m, 3);
    for (int y = 150; y < 260; y += block_px)
      for (int x = 200; x < 320; x += block_px)
        if (std::bernoulli_distribution(gaps)(random))
          fill_rectangle(live_m, x, y, std::min(x + block_px, 320), std::min(y + block_px, 260), 0.0F);
    const Marked marked = mark(live_m, flat(1.0F));
    int measured = 0, moved = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        const bool is_moved = marked.dynamic_mask.at(x, y) != 0;
        measured += is_hand(x, y) && live_m.at(x, y) > 0.0F ? 1 : 0;
        moved += is_hand(x, y) && is_moved ? 1 : 0;
        EXPECT_FALSE(is_moved && !(live_m.at(x, y) > 0.0F)) << "only what is measured is in the mask";
      }
    }
    EXPECT_GT(moved, 0.98 * measured) << block_px << " px, " << gaps;
  }
}

TEST(Foreground, APersonWhoHidesAHoleOfTheModelIsMovedAsAWhole) {
  // As where the scan never saw what is behind the person: the outline is in front of the wall, the rest not.
  DepthImage expected_m = flat(2.6F);
  fill_rectangle(expected_m, 220, 100, 420, 480, 0.0F);
  DepthImage live_m = flat(2.6F);
  fill_rectangle(live_m, 170, 60, 470, 480, 0.85F);
  add_noise(live_m, 4);
  const auto person = [](int x, int y) { return x >= 170 && x < 470 && y >= 60; };
  EXPECT_GT(intersection_over_union(mark(live_m, expected_m).dynamic_mask, person), 0.98);
}

TEST(Foreground, WhatHidesOnlyUnmappedSpaceIsThereButHasNotMoved) {
  DepthImage expected_m = flat(2.6F);
  fill_rectangle(expected_m, 100, 60, 500, 420, 0.0F);
  DepthImage live_m = expected_m;
  fill_rectangle(live_m, 200, 150, 400, 300, 0.85F);
  const Marked marked = mark(live_m, expected_m, {}, kKinect, 40);
  EXPECT_EQ(marked.labels.at(300, 200), PixelLabel::kUnmapped);
  EXPECT_EQ(marked.counts.moved, 0U);
}

TEST(Foreground, ARestOfAPersonInTheModelDoesNotCutThePersonInTwo) {
  // The scan took a strip of the person for a part of the room.
  DepthImage expected_m = flat(2.6F);
  fill_rectangle(expected_m, 220, 100, 420, 480, 0.0F);
  fill_rectangle(expected_m, 300, 260, 330, 400, 0.86F);
  DepthImage live_m = flat(2.6F);
  fill_rectangle(live_m, 170, 60, 470, 480, 0.85F);
  add_noise(live_m, 4);
  const auto person = [](int x, int y) { return x >= 170 && x < 470 && y >= 60; };
  EXPECT_GT(intersection_over_union(mark(live_m, expected_m).dynamic_mask, person), 0.98);
  EXPECT_EQ(mark(expected_m, expected_m).counts.moved, 0U) << "alone it is a part of the room";
}

TEST(Foreground, FarInsideAnUnmappedViewNothingIsKnownToMove) {
  DepthImage expected_m = flat(0.0F);
  fill_rectangle(expected_m, 0, 0, 320, 480, 2.0F);
  DepthImage live_m = flat(2.0F);
  fill_rectangle(live_m, 500, 100, 600, 300, 1.0F);
  const Marked marked = mark(live_m, expected_m);
  EXPECT_EQ(marked.counts.moved, 0U);
  EXPECT_EQ(marked.labels.at(550, 200), PixelLabel::kUnmapped);
  EXPECT_EQ(marked.labels.at(450, 200), PixelLabel::kNotKnown);
}

TEST(Foreground, SpecksAreNoise) {
  DepthImage live_m = flat(1.0F);
  fill_rectangle(live_m, 100, 100, 105, 105, 0.7F);
  live_m.at(300, 300) = 0.5F;
  EXPECT_EQ(mark(live_m, flat(1.0F)).counts.moved, 0U);
}

TEST(Foreground, ObjectOnePixelThickIsFoundIfItIsLong) {
  DepthImage live_m = flat(1.2F);
  fill_rectangle(live_m, 300, 100, 301, 300, 0.9F);
  EXPECT_EQ(mark(live_m, flat(1.2F)).counts.moved, 0U) << "as small as that, it waits for a second frame";
  EXPECT_EQ(mark(live_m, flat(1.2F), {}, kKinect, 2).counts.moved, 200U);
}

TEST(Foreground, PersonLeavingThroughTheBorderIsFoundUpToTheLastPixel) {
  DepthImage live_m = flat(3.0F);
  fill_rectangle(live_m, 630, 100, 640, 480, 2.0F);
  const Marked marked = mark(live_m, flat(3.0F));
  EXPECT_EQ(marked.counts.moved, 10U * 380U);
  EXPECT_EQ(marked.dynamic_mask.at(639, 479), 255);
}

TEST(Foreground, HandBesideANearEdgeKeepsItsRim) {
  // The static box's edge is nearer than the hand behind it; the window around the edge must not remove the
  // hand.
  DepthImage expected_m = flat(2.0F);
  fill_rectangle(expected_m, 0, 0, 300, 480, 1.0F);
  DepthImage live_m = expected_m;
  fill_rectangle(live_m, 300, 200, 380, 300, 1.5F);
  add_noise(live_m, 6);
  const auto hand = [](int x, int y) { return x >= 300 && x < 380 && y >= 200 && y < 300; };
  EXPECT_GT(intersection_over_union(mark(live_m, expected_m).dynamic_mask, hand), 0.99);
}

TEST(Foreground, BallHalfBehindABoxIsFound) {
  // The visible part of the ball is within the box's edge tolerance, but neither at the box's depth nor at
  // the table's.
  DepthImage expected_m = flat(1.7F);
  fill_rectangle(expected_m, 200, 240, 400, 480, 1.0F);
  DepthImage live_m = expected_m;
  fill_rectangle(live_m, 280, 226, 330, 240, 1.4F);
  add_noise(live_m, 8);
  const auto ball = [](int x, int y) { return x >= 280 && x < 330 && y >= 226 && y < 240; };
  EXPECT_GT(intersection_over_union(mark(live_m, expected_m).dynamic_mask, ball), 0.95);
}

TEST(Foreground, HandOnAMisplacedSurfaceIsFoundAndTheSurfaceIsNot) {
  // The left half of the wall is 2 cm nearer than in the map: weak everywhere, and far larger than the hand.
  DepthImage live_m = flat(1.0F);
  fill_rectangle(live_m, 0, 0, 320, 480, 0.98F);
  const MaskImage without_hand = mark(live_m, flat(1.0F)).dynamic_mask;
  EXPECT_EQ(std::count(without_hand.pixels.begin(), without_hand.pixels.end(), 255), 0);
  fill_rectangle(live_m, 80, 100, 240, 260, 0.966F);  // too small a step to stop region growing
  const MaskImage mask = mark(live_m, flat(1.0F)).dynamic_mask;
  EXPECT_EQ(mask.at(160, 180), 255);
  EXPECT_EQ(mask.at(60, 400), 0);
}

TEST(Foreground, WorksAtAnySizeOfImage) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, std::pair{3, 2}, std::pair{7, 481}, std::pair{321, 5}}) {
    const Intrinsics camera{width, height, 300.0, 300.0, width / 2.0, height / 2.0};
    ForegroundConfig config;
    config.min_region_px = 0;
    config.min_region_m2 = 0.0F;
    const Marked marked = mark(flat(0.5F, camera), flat(1.0F, camera), config, camera);
    EXPECT_EQ(marked.counts.moved, static_cast<std::size_t>(width * height));
  }
  const Intrinsics none{0, 0, 300.0, 300.0, 0.0, 0.0};
  EXPECT_EQ(mark(flat(1.0F, none), flat(1.0F, none), {}, none).counts.valid, 0U);
}

TEST(Foreground, ImpossibleSettingsAreNamed) {
  ForegroundConfig config;
  EXPECT_NO_THROW(require_valid(config));
  config.strong_sigmas = 1.0F;  // below weak_sigmas
  try {
    require_valid(config);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("foreground.strong_sigmas = 1"), std::string::npos)
        << error.what();
  }
  config = {};
  config.model_sigma_m = std::nanf("");
  EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::foreground_test
