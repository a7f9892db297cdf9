// stamp_repair_test.cpp: stamps as other programs write them, and what they become.
#include "app/sources/decisions/stamp_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace roomradar::stamp_repair_test {
namespace {

constexpr double kPeriod_s = 1.0 / 30.0;
constexpr double kBegin_s = 1'305'031'102.0;

/// Stamps of `count` images with the jitter of a real device.
std::vector<StatedTime> regular(std::size_t count, bool received = false) {
  std::vector<StatedTime> times;
  for (std::size_t i = 0; i < count; ++i) {
    const double stamp_s =
        kBegin_s + kPeriod_s * static_cast<double>(i) + 0.002 * std::sin(static_cast<double>(i));
    times.push_back(
        {stamp_s, received ? stamp_s + 0.030 + 0.004 * std::cos(7.0 * static_cast<double>(i)) : kNoStamp});
  }
  return times;
}

struct Repaired {
  RepairedStamps stamps;
  std::vector<InputDecision> decisions;
};

Repaired repaired(const std::vector<StatedTime>& times, StampRules rules = {}) {
  if (rules.what.empty()) rules.what = "depth images";
  InputReport report;
  Repaired result;
  result.stamps = repair_stamps(times, rules, report);
  result.decisions = report.decisions();
  return result;
}

void expect_near(const std::vector<double>& got_s, const std::vector<StatedTime>& wanted,
                 double tolerance_s) {
  ASSERT_EQ(got_s.size(), wanted.size());
  for (std::size_t i = 0; i < got_s.size(); ++i) ASSERT_NEAR(got_s[i], wanted[i].stamp_s, tolerance_s) << i;
}

TEST(StampRepair, RightStampsStayAsTheyAreToTheBit) {
  for (const bool received : {false, true}) {
    const auto times = regular(200, received);
    const Repaired result = repaired(times, {.have_no_unit = true});
    EXPECT_TRUE(result.decisions.empty());
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(result.stamps.stamps_s[i], times[i].stamp_s);
  }
}

TEST(StampRepair, ARecordingMayBeginAtZero) {
  std::vector<StatedTime> times;
  for (int i = 0; i < 40; ++i) times.push_back({0.1 * i});
  const Repaired result = repaired(times);
  EXPECT_TRUE(result.decisions.empty());
  EXPECT_EQ(result.stamps.stamps_s[0], 0.0);
}

TEST(StampRepair, UnitsAreRecognisedByTheRate) {
  const auto good = regular(100);
  for (const double factor : {1e3, 1e6, 1e9}) {
    std::vector<StatedTime> times = good;
    for (StatedTime& time : times) time.stamp_s = std::round(time.stamp_s * factor);
    const Repaired result = repaired(times, {.have_no_unit = true});
    ASSERT_EQ(result.decisions.size(), 1U) << factor;
    EXPECT_EQ(result.stamps.unit_s, 1.0 / factor);
    expect_near(result.stamps.stamps_s, good, 0.001);
  }
}

TEST(StampRepair, UnitsAreRecognisedByTheTimesOfReception) {
  const auto good = regular(100, true);
  for (const double factor : {1e-3, 1e3, 1e9}) {
    std::vector<StatedTime> times = good;
    for (StatedTime& time : times) time.stamp_s *= factor;
    const Repaired result = repaired(times);
    EXPECT_FALSE(result.decisions.empty()) << factor;
    for (std::size_t i = 1; i < times.size(); ++i)
      ASSERT_NEAR(result.stamps.stamps_s[i] - result.stamps.stamps_s[0], good[i].stamp_s - good[0].stamp_s, 0.010)
          << factor << ' ' << i;
  }
}

TEST(StampRepair, KeyframesSecondsApartAreInSeconds) {
  for (const double period_s : {0.67, 1.0, 2.3, 7.7}) {
    std::vector<StatedTime> times;
    for (int i = 0; i < 30; ++i) times.push_back({1000.125 + period_s * i});
    EXPECT_TRUE(repaired(times, {.have_no_unit = true}).decisions.empty()) << period_s;
    EXPECT_TRUE(repaired(times).decisions.empty()) << period_s;
  }
}

TEST(StampRepair, StampsOfAnyOrderKeepTheirImages) {
  std::vector<StatedTime> times = regular(120);
  std::mt19937 random(3);
  std::shuffle(times.begin(), times.end(), random);
  expect_near(repaired(times).stamps.stamps_s, times, 0.0);
  times = regular(120);
  std::reverse(times.begin(), times.end());
  expect_near(repaired(times).stamps.stamps_s, times, 0.0);
  EXPECT_EQ(repaired(times).decisions.size(), 1U);
  times = regular(120);
  std::rotate(times.begin(), times.begin() + 50, times.end());  // listed by name: 10.0 before 9.9
  expect_near(repaired(times).stamps.stamps_s, times, 0.0);
  times = regular(120);
  std::swap(times[40], times[41]);
  expect_near(repaired(times).stamps.stamps_s, times, 0.0);
}

TEST(StampRepair, AClockThatWasSetBackContinues) {
  for (const double step_s : {0.7, 12.0, 3600.0, 1e9}) {
    const auto good = regular(120);
    std::vector<StatedTime> times = good;
    for (std::size_t i = 50; i < times.size(); ++i) times[i].stamp_s -= step_s;
    const Repaired result = repaired(times);
    ASSERT_EQ(result.stamps.stretches.size(), 1U) << step_s;
    EXPECT_EQ(result.stamps.stretches[0].first, 50U);
    expect_near(result.stamps.stamps_s, good, 0.2 * kPeriod_s);
    ASSERT_EQ(result.decisions.size(), 1U);
    EXPECT_TRUE(result.decisions[0].is_advice);
  }
}

TEST(StampRepair, StampsOfTwoClocksThatAlternateAreJoined) {
  const auto good = regular(40);
  std::vector<StatedTime> times = good;
  for (std::size_t i = 1; i < times.size(); i += 2) times[i].stamp_s -= 100.0;
  const Repaired result = repaired(times);
  expect_near(result.stamps.stamps_s, good, 0.3 * kPeriod_s);
  ASSERT_EQ(result.decisions.size(), 1U);
  EXPECT_TRUE(result.decisions[0].is_advice);
}

TEST(StampRepair, ListsOfOneRecordingAreMovedTogether) {
  std::vector<StatedTime> depth = regular(120), colour = regular(120);
  for (StatedTime& time : colour) time.stamp_s += 0.004;
  depth.erase(depth.begin() + 49);  // an image is missing just before the step
  for (std::size_t i = 49; i < depth.size(); ++i) depth[i].stamp_s -= 0.7;
  for (std::size_t i = 50; i < colour.size(); ++i) colour[i].stamp_s -= 0.7;
  const Repaired first = repaired(depth);
  StampRules rules{.what = "colour images", .like = &first.stamps};
  const Repaired second = repaired(colour, rules);
  EXPECT_NEAR(second.stamps.stamps_s[60] - first.stamps.stamps_s[59], 0.004, 1e-3);
  std::vector<StampedPose> track;
  for (const StatedTime& time : depth) track.push_back({time.stamp_s});
  repair_track(track, first.stamps);
  for (std::size_t i = 0; i < track.size(); ++i)
    EXPECT_NEAR(track[i].stamp_s, first.stamps.stamps_s[i], 1e-9) << i;
}

TEST(StampRepair, OneAbsurdStampCostsNothing) {
  for (const double absurd : {-5.0, 0.0, 1e18, kBegin_s + 86400.0, kNoStamp, HUGE_VAL}) {
    const auto good = regular(120);
    for (const std::size_t at : {std::size_t{0}, std::size_t{60}, std::size_t{119}}) {
      std::vector<StatedTime> times = good;
      times[at].stamp_s = absurd;
      const Repaired result = repaired(times, {.have_no_unit = true});
      expect_near(result.stamps.stamps_s, good, 0.5 * kPeriod_s);
      EXPECT_FALSE(result.decisions.empty()) << absurd;
    }
  }
}

TEST(StampRepair, EqualStampsAreSpread) {
  const auto good = regular(60);
  std::vector<StatedTime> times = good;
  for (std::size_t i = 1; i < times.size(); i += 2) times[i].stamp_s = times[i - 1].stamp_s;
  const Repaired result = repaired(times);
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_GT(result.stamps.stamps_s[i], result.stamps.stamps_s[i - 1]);
  expect_near(result.stamps.stamps_s, good, 1.1 * kPeriod_s);
}

TEST(StampRepair, ReceptionReplacesHeadersThatAreZero) {
  const auto good = regular(120, true);
  for (const int every : {1, 7}) {
    std::vector<StatedTime> times = good;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (i % static_cast<std::size_t>(every) == 0) times[i].stamp_s = 0.0;
    const Repaired result = repaired(times);
    expect_near(result.stamps.stamps_s, good, every == 1 ? 0.040 : 0.010);
    EXPECT_EQ(result.decisions.size(), 1U);
  }
}

TEST(StampRepair, ReceptionBridgesAHeaderClockThatWasSet) {
  for (const double step_s : {-0.7, 0.9, -3600.0, 3600.0, 1e8}) {
    const auto good = regular(200, true);
    std::vector<StatedTime> times = good;
    for (std::size_t i = 90; i < times.size(); ++i) times[i].stamp_s += step_s;
    const Repaired result = repaired(times);
    expect_near(result.stamps.stamps_s, good, 0.010);
    EXPECT_EQ(result.decisions.size(), 1U) << step_s;
  }
}

TEST(StampRepair, ARecorderThatStallsChangesNothing) {
  std::vector<StatedTime> times = regular(200, true);
  for (std::size_t i = 90; i < 130; ++i)  // the images of 1.3 s are received at once
    times[i].received_s = times[130].received_s - 0.001 * static_cast<double>(130 - i);
  const Repaired result = repaired(times);
  EXPECT_TRUE(result.decisions.empty());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(result.stamps.stamps_s[i], times[i].stamp_s) << i;
}

TEST(StampRepair, NoneAndOneAreNotAProblem) {
  EXPECT_TRUE(repaired({}).stamps.stamps_s.empty());
  EXPECT_EQ(repaired({{5.0}}).stamps.stamps_s[0], 5.0);
  EXPECT_EQ(repaired({{kNoStamp}}).stamps.stamps_s[0], 0.0);
  EXPECT_EQ(repaired({{0.0}, {0.0}, {0.0}}).stamps.stamps_s[2], 2.0 / 30.0);
}

TEST(StampRepair, TheUsersWordIsTaken) {
  const auto times = regular(30, true);
  EXPECT_NEAR(repaired(times, {.choice = StampChoice::kIndex}).stamps.stamps_s[10], 10.0 / 30.0, 1e-12);
  EXPECT_EQ(repaired(times, {.choice = StampChoice::kReception}).stamps.stamps_s[10], times[10].received_s);
  EXPECT_NEAR(repaired(regular(30), {.choice = StampChoice::kMilliseconds}).stamps.stamps_s[10],
              times[10].stamp_s / 1000.0, 1e-6);
}

}  // namespace
}  // namespace roomradar::stamp_repair_test
