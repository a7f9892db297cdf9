// scan_resources_test.cpp: what is left is extrapolated from the last minute.
#include "app/scan/live/scan_resources.hpp"

#include <gtest/gtest.h>

namespace roomradar::scan_resources_test {
namespace {

ScanResources at(double time_s, double memory_used, double disk_free) {
  return {time_s, memory_used, 2e9, disk_free};
}

TEST(ResourceForecast, IsTheFirstThatRunsOut) {
  ResourceForecast forecast;
  for (int i = 0; i <= 30; ++i) forecast.add(at(i, 5e8 + 1e6 * i, 1e10 - 2e7 * i));
  // Memory: 1.47e9 bytes at 1e6 bytes/s. Disk: 9.4e9 bytes at 2e7 bytes/s.
  ASSERT_TRUE(forecast.left_s());
  EXPECT_NEAR(*forecast.left_s(), 470.0, 1.0);
}

TEST(ResourceForecast, FollowsTheLastMinuteOnly) {
  ResourceForecast forecast;
  for (int i = 0; i <= 200; ++i) forecast.add(at(i, i < 100 ? 5e8 + 5e6 * i : 1e9 + 1e6 * (i - 100), 1e12));
  ASSERT_TRUE(forecast.left_s());
  EXPECT_NEAR(*forecast.left_s(), 900.0, 1.0);
}

TEST(ResourceForecast, IsUnknownAtFirstAndWhileNothingShrinks) {
  ResourceForecast forecast;
  EXPECT_FALSE(forecast.left_s());
  for (int i = 0; i < 15; ++i) forecast.add(at(i, 5e8 + 1e7 * i, 1e10));
  EXPECT_FALSE(forecast.left_s());
  ResourceForecast steady;
  for (int i = 0; i < 60; ++i) steady.add(at(i, 5e8, 1e10));
  EXPECT_FALSE(steady.left_s());
  ResourceForecast full;
  for (int i = 0; i < 60; ++i) full.add(at(i, 2e9 + 1e7 * i, 1e10));
  EXPECT_EQ(full.left_s(), 0.0);
}

TEST(ScanResources, AreThoseOfThisProcess) {
  const ScanResources now = resources_now(1.0, 0, ".");
  EXPECT_GT(now.memory_used, 1e6);
  EXPECT_GT(now.memory_limit, now.memory_used);
  EXPECT_GT(now.disk_free, 0.0);
  EXPECT_EQ(resources_now(1.0, 123, ".").memory_limit, 123.0);
  EXPECT_EQ(resources_now(1.0, 0, "/no/such/folder").disk_free, 0.0);
}

}  // namespace
}  // namespace roomradar::scan_resources_test
