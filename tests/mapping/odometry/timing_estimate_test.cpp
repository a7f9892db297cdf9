// timing_estimate_test.cpp: steps of the estimate of a sensor's times, from evidence made for the purpose.
#include "mapping/odometry/timing_estimate.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace roomradar::timing_estimate_test {
namespace {

/// Evidence of one frame of a sensor with the times `truth`, of which a frame corrects the fraction `part`.
TimingEvidence evidence_of(const SensorTiming& truth, const TimingEstimate& estimate, double part,
                           double sigma_s) {
  TimingEvidence evidence;
  evidence.H.diagonal().head<3>().setConstant(1.0 / (sigma_s * sigma_s));
  TimingVector error = TimingVector::Zero();
  error.head<3>() << truth.depth_readout_s - estimate.current.depth_readout_s,
      truth.colour_readout_s - estimate.current.colour_readout_s,
      truth.colour_delay_s - estimate.current.colour_delay_s;
  evidence.b = part * evidence.H * error;
  return evidence;
}

TimingEstimate after_frames(int frames, const SensorTiming& truth, double part, double sigma_s) {
  TimingEstimate estimate = start_estimate({});
  for (int i = 0; i < frames; ++i) add_evidence(estimate, evidence_of(truth, estimate, part, sigma_s));
  return estimate;
}

TEST(TimingEstimate, ReachesTheTimesThoughEachStepCorrectsAPart) {
  const SensorTiming truth{0.030, 0.028, -0.040};
  const SensorTiming found = after_frames(300, truth, 0.4, 0.0005).current;
  EXPECT_NEAR(found.depth_readout_s, truth.depth_readout_s, 0.002);
  EXPECT_NEAR(found.colour_readout_s, truth.colour_readout_s, 0.002);
  EXPECT_NEAR(found.colour_delay_s, truth.colour_delay_s, 0.003);
}

TEST(TimingEstimate, StaysAtTheStatedTimesWithoutEvidenceForOthers) {
  EXPECT_EQ(after_frames(300, {0.001, 0.001, 0.001}, 0.4, 0.1).current, SensorTiming{});
  EXPECT_FALSE(are_times_wrong(after_frames(300, {0.001, 0.001, 0.001}, 0.4, 0.1)));
  EXPECT_TRUE(are_times_wrong(after_frames(300, {0.03, 0.03, 0.0}, 0.4, 0.002)));
}

TEST(TimingEstimate, StaysWithinWhatSensorsDo) {
  const SensorTiming found = after_frames(600, {0.4, -0.4, 3.0}, 1.0, 0.0001).current;
  EXPECT_LE(found.depth_readout_s, 0.05);
  EXPECT_GE(found.colour_readout_s, 0.0);
  EXPECT_LE(found.colour_delay_s, 0.05);
  // A stated time beyond the limits is corrected towards them, in steps.
  TimingEstimate late = start_estimate({0.0, 0.0, 0.08});
  for (int i = 0; i < 20; ++i) add_evidence(late, evidence_of({0.0, 0.0, 0.075}, late, 1.0, 0.0001));
  EXPECT_NEAR(late.current.colour_delay_s, 0.0725, 0.001);
}

TEST(TimingEstimate, IgnoresEvidenceThatIsNotFinite) {
  TimingEstimate estimate = start_estimate({});
  TimingEvidence bad;
  bad.b(0) = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(add_evidence(estimate, bad));
  EXPECT_TRUE(estimate.sum.b.allFinite());
}

}  // namespace
}  // namespace roomradar::timing_estimate_test
