// progress_test.cpp: a progress line states the fraction done, the speed and the remaining time.
#include "app/cli/progress.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>

namespace roomradar::progress_test {
namespace {

TEST(ProgressLine, SaysHowFarHowFastAndHowLongYet) {
  const ProgressState state{"track", 120, 300, 24.05, "tracked, 12.4 m2 seen", 7.5};
  EXPECT_EQ(progress_line(state, false), "track 120/300, 24.1/s, 0:08 left, tracked, 12.4 m2 seen");
  EXPECT_EQ(progress_line(state, true),
            "track [############                  ] 120/300, 24.1/s, 0:08 left, tracked, 12.4 m2 seen");
}

TEST(ProgressLine, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progress_line({"record", 5, std::nullopt, 0.0, {}}, true), "record 5");
  EXPECT_EQ(progress_line({"record", 5, std::nullopt, 10.0, {}}, true), "record 5, 10.0/s");
  EXPECT_EQ(progress_line({"fuse", 0, 0, 0.0, {}}, true), "fuse 0");
}

TEST(ProgressLine, StaysWithinItsBarWhereMoreIsDoneThanAnnounced) {
  EXPECT_EQ(progress_line({"fuse", 9, 3, 1.0, {}}, true), "fuse [##############################] 9/3, 1.0/s");
  EXPECT_EQ(progress_line({"fuse", 3, 3, 1.0, {}}, false), "fuse 3/3, 1.0/s");
}

TEST(ProgressLine, NothingIsLeftOnceItIsOver) {
  EXPECT_EQ(progress_line({"fuse", 35, 36, 2.0, "fused"}, false), "fuse 35/36, 2.0/s, fused");
}

TEST(ProgressLine, LongWaitsAreInMinutes) {
  EXPECT_EQ(progress_line({"fuse", 1, 1201, 2.0, {}, 600.0}, false), "fuse 1/1201, 2.0/s, 10:00 left");
}

TEST(SmoothRemaining, CountsDownAndFollowsAChangeOfSpeedWithoutAJump) {
  SmoothRemaining remaining;
  EXPECT_EQ(remaining.add(40.0, 5.0), 40.0);
  EXPECT_NEAR(remaining.add(35.0, 5.0), 35.0, 1e-9);
  const double slower_s = remaining.add(110.0, 5.0);  // one step took three times as long
  EXPECT_GT(slower_s, 30.0);
  EXPECT_LT(slower_s, 50.0);
  EXPECT_NEAR(remaining.add(37.0, 5.0), 38.0, 3.0);
  double shown_s = 0.0, estimate_s = 400.0;  // a lasting change is followed
  for (int i = 0; i < 12; ++i, estimate_s -= 5.0) shown_s = remaining.add(estimate_s, 5.0);
  EXPECT_NEAR(shown_s, estimate_s, 30.0);
  for (int i = 0; i < 2; ++i) shown_s = remaining.add(3.0, 5.0);
  EXPECT_LT(shown_s, 5.0) << "near the end";
}

TEST(SmoothRemaining, StaysNearTheEstimateWhereWorkSlowsDownTowardsItsEnd) {
  // Frames left and recent speed every 5 s while a recording was tracked again, whose last part is slow.
  constexpr double kLeft[] = {283, 196, 123, 108, 96, 83, 74, 56, 43, 31};
  constexpr double kPer_s[] = {14.7, 15.7, 15.2, 9.1, 7.0, 5.5, 4.3, 4.0, 3.5, 3.1};
  SmoothRemaining remaining;
  double before_s = 0.0;
  for (std::size_t i = 0; i < std::size(kLeft); ++i) {
    const double estimate_s = kLeft[i] / kPer_s[i];
    const double shown_s = remaining.add(estimate_s, 5.0);
    EXPECT_GT(shown_s, 0.5 * estimate_s) << "line " << i;
    if (i > 0) {
      EXPECT_LT(shown_s, before_s + 3.0) << "line " << i;
    }
    before_s = shown_s;
  }
}

TEST(SmoothRate, OneSlowSecondHardlyMovesTheRemainingTime) {
  SmoothRate rate;
  EXPECT_EQ(rate.per_s(), 0.0);
  rate.add(1.0, 0.0);  // no time has passed
  EXPECT_EQ(rate.per_s(), 0.0);
  for (int i = 0; i < 300; ++i) rate.add(2.0, 0.1);
  EXPECT_NEAR(rate.per_s(), 20.0, 1e-9);
  rate.add(0.0, 1.0);  // a checkpoint
  EXPECT_GT(rate.per_s(), 18.0);
  for (int i = 0; i < 1000; ++i) rate.add(1.0, 0.1);  // the speed has halved
  EXPECT_NEAR(rate.per_s(), 10.0, 0.5);
}

TEST(SmoothRate, SlowAndFastPartsOfALongWorkHardlyMoveTheRemainingTime) {
  SmoothRate rate;
  for (int second = 0; second < 600; ++second) {
    rate.add(second % 40 < 20 ? 5.0 : 35.0, 1.0);
    if (second > 300) {
      EXPECT_NEAR(rate.per_s(), 20.0, 4.0) << second;
    }
  }
}

}  // namespace
}  // namespace roomradar::progress_test
