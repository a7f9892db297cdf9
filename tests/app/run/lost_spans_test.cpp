// lost_spans_test.cpp: the start and the end of each tracking loss are reported once.
#include "app/run/lost_spans.hpp"

#include <gtest/gtest.h>

namespace roomradar::lost_spans_test {
namespace {

TEST(LostSpans, TellOnceWhenTheCameraIsLostAndOnceWhenItIsFound) {
  LostSpans lost;
  EXPECT_EQ(lost.add(10, true), "");
  EXPECT_NE(lost.add(11, false).find("frame 11"), std::string::npos);
  EXPECT_EQ(lost.add(12, false), "");
  EXPECT_NE(lost.add(14, true).find("frame 14"), std::string::npos);
  EXPECT_EQ(lost.add(15, true), "");
  EXPECT_NE(lost.add(16, false), "");
  ASSERT_EQ(lost.spans.size(), 2U);
  EXPECT_EQ(lost.spans[0].from, 11);
  EXPECT_EQ(lost.spans[0].until, 14);
  EXPECT_EQ(lost.spans[1].from, 16);
  EXPECT_EQ(lost.spans[1].until, -1);
  EXPECT_EQ(lost.last_frame, 16);
}

TEST(LostSpans, ARunThatBeginsLostSaysSo) {
  LostSpans lost;
  EXPECT_NE(lost.add(0, false), "");
  EXPECT_NE(lost.add(1, true), "");
}

}  // namespace
}  // namespace roomradar::lost_spans_test
