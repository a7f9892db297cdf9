// progress_test.cpp: a progress line states the fraction done, the speed and the remaining time.
#include "app/cli/progress.hpp"

#include <gtest/gtest.h>

namespace roomradar::progress_test {
namespace {

TEST(ProgressLine, SaysHowFarHowFastAndHowLongYet) {
  const ProgressState state{"track", 120, 300, 24.05, "tracked, 12.4 m2 seen"};
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
  EXPECT_EQ(progress_line({"fuse", 35, 36, 2.0, "fused", true}, false), "fuse 35/36, 2.0/s, fused");
}

TEST(ProgressLine, LongWaitsAreInMinutes) {
  EXPECT_EQ(progress_line({"fuse", 1, 1201, 2.0, {}}, false), "fuse 1/1201, 2.0/s, 10:00 left");
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
  for (int i = 0; i < 600; ++i) rate.add(1.0, 0.1);  // the speed has halved for a minute
  EXPECT_NEAR(rate.per_s(), 10.0, 0.3);
}

}  // namespace
}  // namespace roomradar::progress_test
