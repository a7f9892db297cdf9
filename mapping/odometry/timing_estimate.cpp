// timing_estimate.cpp: damped steps towards the times with the least residuals.
#include "mapping/odometry/timing_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

// Standard deviations of the stated times. Readouts of one device's cameras are about as long as its frames,
// so their difference is known better than either.
constexpr double kReadoutSigma_s = 0.010, kReadoutDifferenceSigma_s = 0.003, kDelaySigma_s = 0.030;
constexpr double kOffsetSigma_per_m = 0.02;
// Residuals of neighbouring pixels are correlated, see align.cpp, and so are those of successive frames.
// Chosen: with 0.3, estimates on real recordings jump by many of their standard deviations; with 0.05 they
// converge.
constexpr double kIndependentPart = 0.05;

constexpr int kDepthReadout = 0, kColourReadout = 1, kColourDelay = 2;  // indices of a TimingVector

double weight(double sigma) { return 1.0 / (sigma * sigma); }

TimingVector vector_of(const SensorTiming& timing) {
  TimingVector times = TimingVector::Zero();
  times.head<3>() << timing.depth_readout_s, timing.colour_readout_s, timing.colour_delay_s;
  return times;
}

struct Solution {
  TimingVector correction, sigma;
};

Solution solve(const TimingEstimate& estimate) {
  TimingMatrix prior = weight(kOffsetSigma_per_m) * TimingMatrix::Identity();
  const double difference = weight(kReadoutDifferenceSigma_s);
  prior.topLeftCorner<3, 3>() << weight(kReadoutSigma_s) + difference, -difference, 0.0,  //
      -difference, weight(kReadoutSigma_s) + difference, 0.0,                             //
      0.0, 0.0, weight(kDelaySigma_s);
  const TimingMatrix H = kIndependentPart * estimate.sum.H + prior;
  const TimingVector b =
      kIndependentPart * estimate.sum.b + prior * (vector_of(estimate.stated) - vector_of(estimate.current));
  const TimingMatrix covariance = H.llt().solve(TimingMatrix::Identity());
  return {covariance * b, covariance.diagonal().cwiseMax(0.0).cwiseSqrt()};
}

/// Returns the corrected value, or `current` if the correction is within its error.
double corrected(double current, const Solution& solution, int parameter, double least, double most) {
  constexpr double kSignificant = 2.0;  // standard deviations
  // Solutions are 60 to 70 % of the error on simulated recordings with delays of 20 and 40 ms, probably
  // because velocities are noisy.
  constexpr double kOverRelaxation = 1.5, kMostStep_s = 0.015;
  const double step_s = solution.correction(parameter);
  if (!(std::abs(step_s) > kSignificant * solution.sigma(parameter))) return current;
  // A stated time may lie outside the limits.
  return std::clamp(current + std::clamp(kOverRelaxation * step_s, -kMostStep_s, kMostStep_s),
                    std::min(least, current), std::max(most, current));
}

/// Expresses the evidence relative to the corrected times, and lets it fade: it was linearised at earlier
/// ones.
void correct(TimingEstimate& estimate, const SensorTiming& next) {
  constexpr double kLarge_s = 0.004, kKeptAfterLarge = 0.3, kKept = 0.7;
  const TimingVector step = vector_of(next) - vector_of(estimate.current);
  const double kept = step.cwiseAbs().maxCoeff() > kLarge_s ? kKeptAfterLarge : kKept;
  estimate.sum.b = kept * (estimate.sum.b - estimate.sum.H * step);
  estimate.sum.H *= kept;
  estimate.current = next;
}

}  // namespace

TimingEstimate start_estimate(const SensorTiming& stated) { return {stated, stated, {}, 0}; }

bool add_evidence(TimingEstimate& estimate, const TimingEvidence& evidence) {
  constexpr int kFrames = 20;
  // Registered with a delay above 55 ms, colour follows the errors of the velocity so closely that
  // corrections have the wrong sign and grow.
  constexpr double kMostReadout_s = 0.05, kMostDelay_s = 0.05;
  if (!evidence.H.allFinite() || !evidence.b.allFinite()) return false;
  estimate.sum.H += evidence.H;
  estimate.sum.b += evidence.b;
  if (++estimate.frames % kFrames != 0) return false;
  const Solution solution = solve(estimate);
  if (!solution.correction.allFinite()) return false;
  const SensorTiming& now = estimate.current;
  const SensorTiming next{corrected(now.depth_readout_s, solution, kDepthReadout, 0.0, kMostReadout_s),
                          corrected(now.colour_readout_s, solution, kColourReadout, 0.0, kMostReadout_s),
                          corrected(now.colour_delay_s, solution, kColourDelay, -kMostDelay_s, kMostDelay_s)};
  if (next == now) return false;
  correct(estimate, next);
  return true;
}

bool are_times_wrong(const TimingEstimate& estimate) {
  constexpr double kReadout_s = 0.008, kDelay_s = 0.008;
  const SensorTiming &stated = estimate.stated, &current = estimate.current;
  return std::abs(current.depth_readout_s - stated.depth_readout_s) > kReadout_s ||
         std::abs(current.colour_readout_s - stated.colour_readout_s) > kReadout_s ||
         std::abs(current.colour_delay_s - stated.colour_delay_s) > kDelay_s;
}

}  // namespace roomradar
