// motion_prior.cpp: weighted combination of recorded motion and alignment.
#include "mapping/alignment/motion_prior.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

/// Standard deviation of an alignment's systematic errors (distortion of depth), m.
constexpr double kAlignmentBias_m = 0.004;
constexpr double kLeastSigma_m = 0.0015;
/// A difference of more than kOff_m plus kOffSigmas of the recorded poses' noise contradicts the prior.
constexpr double kOff_m = 0.03, kOffSigmas = 5.0;
/// Time in which the correction follows a difference between recorded and aligned poses, s.
constexpr double kDriftTime_s = 2.0;
/// Part of the distance by which recorded poses may drift.
constexpr double kDriftPart = 0.005;

/// Multiplies a twist's rotation by kPriorLever_m, which makes all its elements lengths.
Vector6d lever() {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, kPriorLever_m, kPriorLever_m, kPriorLever_m;
  return scale;
}

/// Directions in which an alignment constrains the pose, with the weight of each, 1/m^2. Twists are scaled by
/// lever().
struct Constrained {
  Matrix6d directions = Matrix6d::Zero();  ///< in columns
  Vector6d weights = Vector6d::Zero();     ///< 0: not constrained
};

Constrained constrained_by(const Matrix6d& information) {
  constexpr double kLeastWeight = 1.0 / (0.05 * 0.05);  // a deviation of 5 cm constrains nothing
  Constrained result;
  const Vector6d inverse_scale = lever().cwiseInverse();
  const SymmetricEigen<6> solved =
      symmetric_eigen(Matrix6d(inverse_scale.asDiagonal() * information * inverse_scale.asDiagonal()));
  if (!solved.converged) return result;
  result.directions = solved.vectors;
  for (int i = 0; i < 6; ++i) {
    if (!(solved.values(i) > kLeastWeight)) continue;
    result.weights(i) = 1.0 / (1.0 / solved.values(i) + kAlignmentBias_m * kAlignmentBias_m);
  }
  return result;
}

}  // namespace

void note_recorded(MotionPrior& prior, double stamp_s, const Eigen::Isometry3d& T_recorded_camera) {
  // Limits of a camera's acceleration, of a hand that shakes.
  constexpr double kMost_mps2 = 6.0, kMost_radps2 = 20.0;
  constexpr double kJump_m = 0.5;  // a larger step is a jump of the recorded world
  const std::optional<RecordedPose> first = prior.recorded[0], middle = prior.recorded[1];
  prior.recorded = {middle, RecordedPose{stamp_s, T_recorded_camera}};
  if (!first || !middle) return;
  const double before_s = middle->stamp_s - first->stamp_s, after_s = stamp_s - middle->stamp_s;
  if (!(before_s > 0.0 && after_s > 0.0)) return;
  const double part = before_s / (before_s + after_s);
  const Vector6d whole = local(first->T_recorded_camera.inverse() * T_recorded_camera);
  const Vector6d off =
      local((first->T_recorded_camera * retract(part * whole)).inverse() * middle->T_recorded_camera);
  if (!off.allFinite() || off.head<3>().norm() > kJump_m) return;
  const double lever_s2 = 0.5 * before_s * after_s;  // acceleration times this is the distance from the line
  const double excess_m = std::max(0.0, off.head<3>().norm() - kMost_mps2 * lever_s2);
  const double excess_rad = std::max(0.0, off.tail<3>().norm() - kMost_radps2 * lever_s2);
  prior.excess_m[static_cast<std::size_t>(prior.excesses++) % prior.excess_m.size()] =
      std::max(excess_m, kPriorLever_m * excess_rad);
  auto sorted = prior.excess_m;
  const auto end = sorted.begin() + std::min<std::int64_t>(prior.excesses, sorted.size());
  const auto median = sorted.begin() + (end - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), median, end);
  // Of noise with standard deviation s per axis, the distance has the variance 1 + part^2 + (1 - part)^2
  // times s^2 per axis, and the median 1.54 times its square root. Of single jumps, the median is 0.
  prior.jitter_m = *median / (1.54 * std::sqrt(1.0 + part * part + (1.0 - part) * (1.0 - part)));
  prior.sigma_m = std::max(prior.sigma_m, prior.jitter_m);
}

std::optional<Eigen::Isometry3d> predicted_by(const MotionPrior& prior,
                                              const std::optional<Eigen::Isometry3d>& T_recorded_camera) {
  if (!prior.T_world_recorded || !T_recorded_camera) return std::nullopt;
  Eigen::Isometry3d T = *prior.T_world_recorded * *T_recorded_camera;
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return T;
}

double constrained_difference_m(const Eigen::Isometry3d& T_world_prior, const Tracking& aligned) {
  const Constrained known = constrained_by(aligned.information);
  const Vector6d difference = lever().cwiseProduct(local(T_world_prior.inverse() * aligned.T_world_camera));
  double square = 0.0;
  for (int i = 0; i < 6; ++i) {
    if (known.weights(i) <= 0.0) continue;
    const double along = known.directions.col(i).dot(difference);
    square += along * along;
  }
  return std::sqrt(square);
}

bool contradicts(const MotionPrior& prior, double difference_m) {
  return difference_m > kOff_m + kOffSigmas * prior.sigma_m;
}

Tracking combine(MotionPrior& prior, const Eigen::Isometry3d& T_world_prior, const Tracking& aligned,
                 double dt_s) {
  const Vector6d scale = lever();
  const Constrained known = constrained_by(aligned.information);
  const Vector6d difference = scale.cwiseProduct(local(T_world_prior.inverse() * aligned.T_world_camera));
  // A recorded pose that is clearly off, such as after a jump or with a wrong time, has little weight.
  const double difference_m = constrained_difference_m(T_world_prior, aligned);
  const bool is_off = contradicts(prior, difference_m);
  prior.contradicted += is_off ? 1 : 0;
  if (!is_off) prior.contradicted_in_a_row = 0;
  const double sigma_m = is_off ? std::max(difference_m, prior.sigma_m) : prior.sigma_m;
  const double prior_weight = 1.0 / (sigma_m * sigma_m);
  const double follow = std::clamp(dt_s / kDriftTime_s, 0.0, 0.2);
  Vector6d step = Vector6d::Zero(), drift = Vector6d::Zero();
  Matrix6d information = prior_weight * Matrix6d::Identity();
  double sum_m = 0.0;
  int count = 0;
  for (int i = 0; i < 6; ++i) {
    const double weight = known.weights(i);
    if (weight <= 0.0) continue;
    const Vector6d direction = known.directions.col(i);
    const double along = direction.dot(difference);
    step += direction * (along * weight / (weight + prior_weight));
    drift += direction * (along * follow * weight * kAlignmentBias_m * kAlignmentBias_m);
    information += weight * direction * direction.transpose();
    if (1.0 / weight > 4.0 * kAlignmentBias_m * kAlignmentBias_m) continue;
    sum_m += std::abs(along);
    ++count;
  }
  Tracking result = aligned;
  result.status = TrackStatus::kTracked;
  result.unconstrained_dofs = 0;
  result.T_world_camera = T_world_prior * retract(step.cwiseQuotient(scale));
  result.information = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::Isometry3d T_corrected = T_world_prior * retract(drift.cwiseQuotient(scale));
  prior.T_world_recorded = T_corrected * T_world_prior.inverse() * *prior.T_world_recorded;
  ++prior.used;
  if (count > 0) {
    constexpr double kPart = 0.03;           // of a new value in the mean: about 30 frames
    constexpr double kSigmaOfMean = 1.2533;  // of a normal distribution: sigma / mean of the absolute value
    const double mean_m = sum_m / count;
    prior.mean_difference_m = prior.mean_difference_m < 0.0
                                  ? 0.5 * mean_m
                                  : (1.0 - kPart) * prior.mean_difference_m + kPart * mean_m;
    const double spread_m = kSigmaOfMean * prior.mean_difference_m;
    const double square = spread_m * spread_m - kAlignmentBias_m * kAlignmentBias_m;
    prior.sigma_m = std::max(std::sqrt(std::max(square, kLeastSigma_m * kLeastSigma_m)), prior.jitter_m);
  }
  return result;
}

void count_contradiction(MotionPrior& prior) {
  constexpr std::int64_t kJumped = 3;
  ++prior.contradicted;
  if (++prior.contradicted_in_a_row >= kJumped) interrupt_prior(prior);
}

void interrupt_prior(MotionPrior& prior) {
  prior.contradicted_in_a_row = 0;
  prior.T_world_recorded.reset();
  ++prior.stretch;
}

void restart_prior(MotionPrior& prior, const Eigen::Isometry3d& T_world_camera,
                   const Eigen::Isometry3d& T_recorded_camera) {
  prior.T_world_recorded = T_world_camera * T_recorded_camera.inverse();
}

Matrix6d prior_information(double sigma_m, const Eigen::Isometry3d& T_a_b) {
  const double drift_m = kDriftPart * T_a_b.translation().norm();
  const double weight = 1.0 / (sigma_m * sigma_m + drift_m * drift_m);
  const Vector6d scale = lever();
  return weight * Matrix6d(scale.cwiseProduct(scale).asDiagonal());
}

Matrix6d limited_information(const Matrix6d& information) {
  const Constrained known = constrained_by(information);
  const Vector6d scale = lever();
  return scale.asDiagonal() *
         Matrix6d(known.directions * known.weights.asDiagonal() * known.directions.transpose()) *
         scale.asDiagonal();
}

}  // namespace roomradar
