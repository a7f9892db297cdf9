// scan_advice_test.cpp: each fault is stated soon, once it lasts; a good scan has none.
#include "app/scan/live/scan_advice.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>

namespace roomradar::scan_advice_test {
namespace {

ScanFacts good() {
  ScanFacts facts;
  facts.depth_fraction = 0.8;
  facts.near_fraction = 0.05;
  facts.far_fraction = 0.1;
  facts.brightness = 110.0;
  facts.moved_fraction = 0.005;
  facts.speed_mps = 0.3;
  facts.speed_rad_s = 0.4;
  return facts;
}

/// Stamp at which a fault that begins at 0 s is stated, at 30 frames per second; < 0: within 0.5 s it is not.
double stated_after_s(const ScanFacts& facts, ScanFault fault) {
  ScanAdvice advice;
  for (int i = 0; i <= 15; ++i) {
    advice.add(facts, i / 30.0);
    if (advice.fault() == fault) return i / 30.0;
  }
  return -1.0;
}

TEST(ScanAdvice, AGoodScanHasNone) {
  ScanAdvice advice;
  for (int i = 0; i < 60; ++i) {
    advice.add(good(), i / 30.0);
    EXPECT_FALSE(advice.fault());
  }
}

TEST(ScanAdvice, EachFaultIsStatedWithinHalfASecond) {
  const auto with = [](const std::function<void(ScanFacts&)>& change) {
    ScanFacts facts = good();
    change(facts);
    return facts;
  };
  const std::pair<ScanFault, ScanFacts> cases[] = {
      {ScanFault::kLost, with([](ScanFacts& f) { f.status = TrackStatus::kDiverged; })},
      {ScanFault::kLost, with([](ScanFacts& f) { f.status = TrackStatus::kTooFewPoints; })},
      {ScanFault::kTooNear, with([](ScanFacts& f) {
         f.depth_fraction = 0.3;
         f.near_fraction = 0.2;
         f.far_fraction = 0.0;
       })},
      {ScanFault::kTooFar, with([](ScanFacts& f) {
         f.depth_fraction = 0.3;
         f.near_fraction = 0.0;
         f.far_fraction = 0.25;
       })},
      {ScanFault::kOneWall, with([](ScanFacts& f) { f.status = TrackStatus::kDegenerate; })},
      {ScanFault::kTooFast, with([](ScanFacts& f) { f.speed_mps = 1.3; })},
      {ScanFault::kTooFast, with([](ScanFacts& f) { f.speed_rad_s = 1.6; })},
      {ScanFault::kMovement, with([](ScanFacts& f) { f.moved_fraction = 0.08; })},
      {ScanFault::kTooDark, with([](ScanFacts& f) { f.brightness = 8.0; })},
  };
  for (const auto& [fault, facts] : cases) {
    const double after_s = stated_after_s(facts, fault);
    EXPECT_GE(after_s, ScanAdvice::kLasts_s - 1e-9) << to_sentence(fault);
    EXPECT_LE(after_s, 0.5) << to_sentence(fault);
  }
}

TEST(ScanAdvice, ASingleBadFrameIsNotStated) {
  ScanAdvice advice;
  ScanFacts lost = good();
  lost.status = TrackStatus::kDiverged;
  for (int i = 0; i < 60; ++i) {
    advice.add(i % 10 == 5 ? lost : good(), i / 30.0);
    EXPECT_FALSE(advice.fault()) << i;
  }
}

TEST(ScanAdvice, AFaultStaysLongEnoughToBeRead) {
  ScanAdvice advice;
  ScanFacts fast = good();
  fast.speed_mps = 2.0;
  int i = 0;
  for (; i < 15; ++i) advice.add(fast, i / 30.0);
  ASSERT_EQ(advice.fault(), ScanFault::kTooFast);
  const int ended = i;
  for (; advice.fault(); ++i) advice.add(good(), i / 30.0);
  EXPECT_NEAR((i - ended) / 30.0, ScanAdvice::kStated_s, 0.1);
}

TEST(ScanAdvice, TheMostUrgentIsStated) {
  ScanFacts facts = good();
  facts.brightness = 5.0;
  facts.speed_mps = 2.0;
  EXPECT_GE(stated_after_s(facts, ScanFault::kTooFast), 0.0);
  facts.status = TrackStatus::kDiverged;
  EXPECT_GE(stated_after_s(facts, ScanFault::kLost), 0.0);
}

TEST(ScanAdvice, EveryFaultHasASentenceOfItsOwn) {
  std::set<std::string_view> sentences;
  for (std::size_t i = 0; i < kScanFaults; ++i) sentences.insert(to_sentence(static_cast<ScanFault>(i)));
  EXPECT_EQ(sentences.size(), kScanFaults);
  EXPECT_FALSE(sentences.contains(""));
}

TEST(ScanAdvice, FactsOfAFrameWithoutDepthAndColour) {
  Frame frame;
  Tracking tracking;
  tracking.status = TrackStatus::kTooFewPoints;
  ScanFacts facts = facts_of(frame, tracking);
  EXPECT_EQ(facts.depth_fraction, 0.0);
  EXPECT_LT(facts.brightness, 0.0);
  frame.depth_m.resize(64, 48);
  frame.colour.resize(64, 48, {30, 60, 90});
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      frame.depth_m.at(x, y) = x < 16 ? 0.0F : x < 32 ? 0.55F : x < 48 ? 2.0F : 4.5F;
  facts = facts_of(frame, tracking);
  EXPECT_DOUBLE_EQ(facts.depth_fraction, 0.75);
  EXPECT_DOUBLE_EQ(facts.near_fraction, 0.25);
  EXPECT_DOUBLE_EQ(facts.far_fraction, 0.25);
  EXPECT_DOUBLE_EQ(facts.brightness, 60.0);
  EXPECT_EQ(facts.status, TrackStatus::kTooFewPoints);
}

}  // namespace
}  // namespace roomradar::scan_advice_test
