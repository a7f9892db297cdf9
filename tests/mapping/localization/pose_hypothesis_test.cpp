// pose_hypothesis_test.cpp: which pose hypotheses of a search are accepted, and which are rejected however
// good they look.
#include "mapping/localization/pose_hypothesis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace roomradar::pose_hypothesis_test {
namespace {

/// @param status      kDegenerate: the depth leaves a direction unconstrained
/// @param alike       matching patches, of 100 compared
/// @param depth_alike fraction of 1,000 pixels whose depth agrees with the model
/// @param farther     fraction of them at which the camera sees through the model
PoseHypothesis hypothesis(TrackStatus status, std::size_t alike, double depth_alike, double farther = 0.0) {
  PoseHypothesis tried;
  tried.tracking.status = status;
  tried.uncertainty_m = 0.005;
  tried.appearance.compared = 100;
  tried.appearance.alike.resize(alike);
  tried.agreement = {1000, 1000, static_cast<int>(std::lround(1000 * depth_alike)),
                     static_cast<int>(std::lround(1000 * farther))};
  return tried;
}

constexpr TrackStatus kFixed = TrackStatus::kTracked, kOpen = TrackStatus::kDegenerate;

TEST(PoseHypothesis, LookAndDepthTogetherMakeItCertain) {
  EXPECT_TRUE(is_certain(hypothesis(kFixed, 50, 0.8)));
  EXPECT_FALSE(is_certain(hypothesis(kFixed, 50, 0.3))) << "the depth speaks against it";
  EXPECT_TRUE(is_certain(hypothesis(kFixed, 50, 0.8, 0.1))) << "something was taken away";
  EXPECT_FALSE(is_certain(hypothesis(kFixed, 50, 0.8, 0.13)));
  EXPECT_FALSE(is_certain(hypothesis(TrackStatus::kDiverged, 90, 0.99)));
}

TEST(PoseHypothesis, DepthAloneMustBeClear) {
  PoseHypothesis bare = hypothesis(kFixed, 0, 0.95);
  bare.appearance.compared = 5;
  EXPECT_TRUE(is_certain(bare)) << "a bare wall has no patches";
  bare.agreement.alike = 850;
  EXPECT_FALSE(is_certain(bare));
  EXPECT_FALSE(is_certain(hypothesis(kFixed, 10, 0.99))) << "of many patches hardly any is alike";
  bare = hypothesis(kOpen, 0, 0.99);
  bare.appearance.compared = 5;
  EXPECT_FALSE(is_certain(bare)) << "a direction is open";
}

TEST(PoseHypothesis, WithADirectionOpenTheDepthOrBothTogetherAreClear) {
  // Half of a floor's boards match after a shift by one board, and the depth is almost the same there.
  EXPECT_FALSE(is_certain(hypothesis(kOpen, 50, 0.93)));
  EXPECT_TRUE(is_certain(hypothesis(kFixed, 50, 0.93)));
  EXPECT_TRUE(is_certain(hypothesis(kOpen, 65, 0.93)));
  EXPECT_TRUE(is_certain(hypothesis(kOpen, 50, 0.96)));
  // Two thirds of a rug's flowers match after a shift by some flowers; a person in the view costs as much
  // depth agreement.
  EXPECT_FALSE(is_certain(hypothesis(kOpen, 70, 0.79)));
  EXPECT_TRUE(is_certain(hypothesis(kOpen, 71, 0.84)));
  EXPECT_FALSE(is_certain(hypothesis(kOpen, 65, 0.90, 0.06))) << "edges stand where none is seen";
  EXPECT_TRUE(is_certain(hypothesis(kFixed, 65, 0.90, 0.06)));
}

TEST(PoseHypothesis, AFewPatchesFixNoOpenDirection) {
  PoseHypothesis few = hypothesis(kOpen, 30, 0.95);
  few.appearance.compared = 50;
  EXPECT_FALSE(is_certain(few)) << "boards repeat";
  few.appearance.compared = 38;
  EXPECT_TRUE(is_certain(few)) << "next to nothing speaks against it";
}

TEST(PoseHypothesis, WhatIsNotKnownWellOrHardlyCoveredIsNotCertain) {
  PoseHypothesis loose = hypothesis(kFixed, 80, 0.99);
  loose.uncertainty_m = 0.016;
  EXPECT_FALSE(is_certain(loose));
  loose.uncertainty_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_certain(loose));
  PoseHypothesis outside = hypothesis(kFixed, 80, 0.99);
  outside.agreement.both = 190;
  EXPECT_FALSE(is_certain(outside));
  EXPECT_FALSE(is_certain(PoseHypothesis{}));
}

TEST(PoseHypothesis, ATwinElsewhereMakesItDoubtful) {
  const PoseHypothesis best = hypothesis(kFixed, 80, 0.95);
  PoseHypothesis twin = hypothesis(kFixed, 78, 0.94);
  EXPECT_FALSE(is_ambiguous(best, {best, twin})) << "they are one place";
  twin.tracking.T_world_camera.translation().x() = 1.0;
  EXPECT_TRUE(is_ambiguous(best, {best, twin}));
  twin.appearance.alike.resize(40);
  twin.agreement.alike = 700;
  EXPECT_FALSE(is_ambiguous(best, {best, twin}));
}

TEST(PoseHypothesis, WhatNothingFixesIsInfinitelyUncertain) {
  Tracking tracking;
  tracking.information.setZero();
  EXPECT_EQ(uncertainty_m(tracking), std::numeric_limits<double>::infinity());
  tracking.information.setIdentity();
  tracking.information.topLeftCorner<3, 3>() *= 1e4;
  EXPECT_NEAR(uncertainty_m(tracking), 0.01, 1e-6);
}

}  // namespace
}  // namespace roomradar::pose_hypothesis_test
