// timing_estimate.hpp: estimates a sensor's readout times and colour delay while its camera is tracked.
#pragma once
#include <cstdint>

#include "mapping/alignment/timing_evidence.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Estimate of a sensor's times, and the evidence gathered since it last changed.
struct TimingEstimate {
  SensorTiming stated;  ///< times given by the first frame (Frame::timing); prior of the estimate
  SensorTiming current;
  TimingEvidence sum;  ///< evidence of frames tracked with `current`
  int frames = 0;      ///< number of frames in `sum`
};

TimingEstimate start_estimate(const SensorTiming& stated);

/// Adds one frame's evidence. After every 20 frames, solves for corrections of the times, and applies each
/// correction that exceeds two standard deviations. Corrected readouts are within 0 to 50 ms, corrected
/// delays within -50 to 50 ms, unless the stated time lies outside.
/// @return true if `current` changed
bool add_evidence(TimingEstimate& estimate, const TimingEvidence& evidence);

/// Returns true if a current time differs from the stated one by more than 8 ms. The recording should then be
/// tracked again from its beginning with the current times. Callers test this after kProbeFrames frames, or
/// at the end of a shorter recording. With 300 frames instead of 100, tracking was no more accurate (kitchen,
/// fr1_rpy, a simulated delay of 40 ms), and three times as much work was repeated.
bool are_times_wrong(const TimingEstimate& estimate);
inline constexpr std::int64_t kProbeFrames = 100;
inline constexpr int kMostRestarts = 3;

}  // namespace roomradar
