// scan_memory_test.cpp: the memory that is kept free for the stages after fusion.
#include "mapping/scan_memory.hpp"

#include <gtest/gtest.h>

namespace roomradar::scan_memory_test {
namespace {

TEST(ScanMemory, WhatSurfaceExtractionWasMeasuredToTakeIsKeptFree) {
  EXPECT_GE(memory_after_fusion(20e6), 68e6);    // a kitchen
  EXPECT_GE(memory_after_fusion(26e6), 62e6);    // a person at a desk
  EXPECT_GE(memory_after_fusion(203e6), 195e6);  // a flat of 470 m2
}

TEST(ScanMemory, LargeMapsNeedLessInProportion) {
  EXPECT_EQ(memory_after_fusion(0.0), 0.0);
  EXPECT_LE(memory_after_fusion(203e6), 2.0 * 203e6);
  EXPECT_LE(memory_after_fusion(2e9), 1.1 * 2e9);
  double before = 0.0;
  for (double bytes = 1e6; bytes < 1e10; bytes *= 1.5) {
    EXPECT_GT(memory_after_fusion(bytes), before) << bytes;
    before = memory_after_fusion(bytes);
  }
}

}  // namespace
}  // namespace roomradar::scan_memory_test
