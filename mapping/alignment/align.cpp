// align.cpp: registers a depth (and intensity) image to views of known pose.
#include "mapping/alignment/align.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "mapping/alignment/point_to_plane.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

// Residuals of neighbouring pixels are correlated: a Kinect v1 matches blocks of 9 x 9 pixels. The summed
// information is scaled by 1/50 if the finest level has half the sensor's resolution, and by more if its
// pixels are farther apart.
constexpr double kIndependentPart = 0.02;
constexpr double kIndependentFocal_px = 292.5;

double independent_part(const Intrinsics& finest_camera) {
  const double spacing = kIndependentFocal_px / finest_camera.fx_px;
  return std::clamp(kIndependentPart * spacing * spacing, kIndependentPart, 1.0);
}

struct Step {
  Vector6d twist = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
  Matrix6d clear = Matrix6d::Zero();  ///< see Tracking::clear_information
  int held = 0;
};

/// Solves for the step. Rotation is scaled by the points' mean distance, so all directions are lengths.
/// Directions that depth does not constrain are removed from the depth term. After the colour term is added,
/// directions that are still unconstrained keep the guess. `independent` is the fraction of points with
/// independent errors. `fixed` projects onto the directions that depth constrained at coarser levels. This
/// level removes directions that it finds unconstrained, because the normals of finer levels are noisier.
Step solve(const NormalEquations& depth, const NormalEquations& colour, double length_m, double independent,
           const AlignConfig& config, Matrix6d& fixed) {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, 1.0 / length_m, 1.0 / length_m, 1.0 / length_m;
  const Matrix6d depth_H = fixed * (scale.asDiagonal() * depth.H * scale.asDiagonal()) * fixed;
  const Vector6d depth_g = fixed * scale.cwiseProduct(depth.g);
  const SymmetricEigen<6> by_depth = symmetric_eigen(depth_H);
  fixed.setZero();
  Matrix6d H = scale.asDiagonal() * colour.H * scale.asDiagonal();
  Vector6d g = scale.cwiseProduct(colour.g);
  constexpr double kClearly = 10.0;
  Step step;
  for (int i = 0; i < 6; ++i) {
    const double strength = by_depth.values(i);
    if (strength <= static_cast<double>(config.min_constraint) * depth.weight) continue;
    const Vector6d direction = by_depth.vectors.col(i);
    H += strength * direction * direction.transpose();
    g += direction * direction.dot(depth_g);
    fixed += direction * direction.transpose();
    if (strength > kClearly * static_cast<double>(config.min_constraint) * depth.weight)
      step.clear += strength * direction * direction.transpose();
  }
  const double least = 1.0 / (independent * static_cast<double>(config.max_uncertainty_m) *
                              static_cast<double>(config.max_uncertainty_m));
  const SymmetricEigen<6> both = symmetric_eigen(H);
  for (int i = 0; i < 6; ++i) {
    const double strength = both.values(i);
    if (!(strength > least)) {
      ++step.held;
      continue;
    }
    const Vector6d direction = both.vectors.col(i);
    step.twist -= direction * (direction.dot(g) / strength);
    step.information += strength * direction * direction.transpose();
  }
  step.twist = scale.cwiseProduct(step.twist);
  const Vector6d inverse_scale = scale.cwiseInverse();
  step.information =
      independent * (inverse_scale.asDiagonal() * step.information * inverse_scale.asDiagonal());
  step.clear = independent * (inverse_scale.asDiagonal() * step.clear * inverse_scale.asDiagonal());
  return step;
}

double mean_distance_m(const std::vector<SourcePoint>& points) {
  double sum = 0.0;
  for (const SourcePoint& point : points) sum += static_cast<double>(point.p_camera.z());
  return points.empty() ? 1.0 : sum / static_cast<double>(points.size());
}

MatchLimits limits_at(int level, const AlignConfig& config) {
  const int finer = config.coarsest_level - level;
  const float soft =
      config.robust_sigma * static_cast<float>(1 << std::clamp(level - config.finest_level, 0, 8));
  return {.gate_m = std::max(config.gate_m / static_cast<float>(1 << std::clamp(finer, 0, 8)), 0.03F),
          .inverse_soft = 1.0F / soft,
          .inverse_intensity_sigma = config.intensity_sigma > 0.0F ? 1.0F / config.intensity_sigma : 0.0F};
}

/// Returns true if a correction of the guess is not finite, or larger than the config allows.
bool is_too_large(const Eigen::Isometry3d& T_guess_found, const AlignConfig& config) {
  const Vector6d correction = local(T_guess_found);
  return !correction.allFinite() ||
         correction.head<3>().norm() > static_cast<double>(config.max_correction_m) ||
         correction.tail<3>().norm() > static_cast<double>(config.max_correction_rad);
}

/// Matches of one level's points.
struct LevelMatches {
  PointMatches total;  ///< summed over all references
  /// Fraction of the points with a correspondence in the first reference. Unset: it lacks the level.
  std::optional<double> overlap;
};

/// Matches one level's points with all references, and updates the references' exposures.
LevelMatches match_references(const MovingPoints& live, std::span<const PosedReference> references,
                              std::size_t level, const Eigen::Isometry3d& T_world_camera,
                              const MatchLimits& limits, std::vector<Exposure>& exposures) {
  const std::vector<SourcePoint>& points = live.points;
  LevelMatches matches;
  PointMatches& total = matches.total;
  for (std::size_t k = 0; k < references.size(); ++k) {
    const TargetView& reference = *references[k].view;
    if (level >= reference.levels.size()) continue;
    PointMatches pass;
    match_points(
        live, reference.levels[level],
        {.T_view_camera = references[k].T_world_view.inverse() * T_world_camera, .exposure = exposures[k]},
        limits, pass);
    exposures[k] = match_exposure(pass);
    total.depth.H += pass.depth.H, total.depth.g += pass.depth.g, total.depth.weight += pass.depth.weight;
    total.colour.H += pass.colour.H, total.colour.g += pass.colour.g;
    total.met += pass.met, total.inliers += pass.inliers, total.squares += pass.squares;
    if (k == 0)
      matches.overlap =
          points.empty() ? 0.0 : static_cast<double>(pass.met) / static_cast<double>(points.size());
  }
  return matches;
}

/// Returns the motion of a level's points if the camera is at T_world_camera.
RowMotion motion_at(const SourcePoints& live, int level, const Eigen::Isometry3d& T_world_camera,
                    const ReadoutMotion& readout) {
  const auto i = static_cast<std::size_t>(level);
  if (readout.readout_s == 0.0 || i >= live.cameras.size()) return {};
  return row_motion(live.cameras[i],
                    velocity_of(readout.T_world_before.inverse() * T_world_camera, readout.dt_s),
                    readout.readout_s);
}

}  // namespace

std::string_view to_string(TrackStatus status) {
  switch (status) {
    case TrackStatus::kTracked:
      return "tracked";
    case TrackStatus::kTooFewPoints:
      return "too few points";
    case TrackStatus::kDegenerate:
      return "degenerate";
    case TrackStatus::kDiverged:
      return "diverged";
    case TrackStatus::kUncertain:
      return "uncertain";
  }
  return "unknown";
}

Eigen::Isometry3d retract(const Vector6d& twist) {
  const Eigen::Vector3d omega = twist.tail<3>();
  const double angle = omega.norm();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = twist.head<3>();
  if (angle > 1e-12) T.linear() = Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
  return T;
}

Vector6d local(const Eigen::Isometry3d& T) {
  const Eigen::AngleAxisd rotation(T.linear());
  Vector6d twist;
  twist << T.translation(), rotation.angle() * rotation.axis();
  return twist;
}

Tracking align(const SourcePoints& live, std::span<const PosedReference> references,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config,
               const ReadoutMotion& readout) {
  Tracking result;
  if (!T_world_camera_guess.matrix().allFinite()) return result;
  result.T_world_camera = T_world_camera_guess;
  result.status = TrackStatus::kTooFewPoints;
  if (references.empty() || live.levels.empty()) return result;

  Eigen::Isometry3d T_world_camera = T_world_camera_guess;
  const TargetView& first = *references.front().view;
  const double independent =
      first.levels.empty() ? kIndependentPart : independent_part(first.levels.front().camera);
  std::vector<Exposure> exposures(references.size());
  const int last = static_cast<int>(live.levels.size()) - 1;
  Step step;
  PointMatches total;
  Matrix6d fixed = Matrix6d::Identity();  // directions constrained by depth at all coarser levels
  for (int level = std::min(config.coarsest_level, last); level >= std::min(config.finest_level, last);
       --level) {
    const std::vector<SourcePoint>& points = live.levels[static_cast<std::size_t>(level)];
    const double length_m = std::max(mean_distance_m(points), 0.1);
    const MatchLimits limits = limits_at(level, config);
    const Matrix6d fixed_coarser = fixed;
    for (int iteration = 0; iteration < config.iterations; ++iteration) {
      const LevelMatches matches =
          match_references({.points = points, .motion = motion_at(live, level, T_world_camera, readout)},
                           references, static_cast<std::size_t>(level), T_world_camera, limits, exposures);
      total = matches.total;
      result.overlap = matches.overlap.value_or(result.overlap);
      // Coarser levels have fewer points, so the min count is divided by 4 per level.
      const int coarser = std::min(level - std::min(config.finest_level, last), 8);
      if (total.met < static_cast<std::size_t>(std::max(config.min_points >> (2 * coarser), 12))) {
        result.status = TrackStatus::kTooFewPoints;
        result.T_world_camera = T_world_camera_guess;
        return result;
      }
      total.depth.mirror();
      total.colour.mirror();
      fixed = fixed_coarser;
      step = solve(total.depth, total.colour, length_m, independent, config, fixed);
      T_world_camera = T_world_camera * retract(step.twist);
      const double moved_m = step.twist.head<3>().norm() + length_m * step.twist.tail<3>().norm();
      if (iteration > 0 && moved_m < (level == config.finest_level ? 1e-4 : 5e-4)) break;
    }
  }
  T_world_camera.linear() = Eigen::Quaterniond(T_world_camera.linear()).normalized().toRotationMatrix();

  result.inlier_fraction = static_cast<double>(total.inliers) / static_cast<double>(total.met);
  if (is_too_large(T_world_camera_guess.inverse() * T_world_camera, config) ||
      result.inlier_fraction < static_cast<double>(config.min_inlier_fraction)) {
    result.status = TrackStatus::kDiverged;
    result.T_world_camera = T_world_camera_guess;
    return result;
  }
  result.T_world_camera = T_world_camera;
  result.rms_m = std::sqrt(total.squares / static_cast<double>(std::max<std::size_t>(total.inliers, 1)));
  result.unconstrained_dofs = step.held;
  result.information = step.information;
  result.clear_information = step.clear;
  result.status = step.held > 0 ? TrackStatus::kDegenerate : TrackStatus::kTracked;
  return result;
}

Tracking align(const SourcePoints& live, const TargetView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config) {
  const PosedReference one{&reference, reference.T_world_view};
  return align(live, std::span<const PosedReference>(&one, 1), T_world_camera_guess, config);
}

PoseSigma pose_sigma(const Tracking& tracking) {
  constexpr double kNone = 1e-3;  // weight of a direction without information, 1/m^2
  constexpr double kPart = 0.1;   // smaller parts of a direction along an axis are rounding
  constexpr double kCertain_m = 0.02;
  PoseSigma sigma;
  const Eigen::Matrix3d& R = tracking.T_world_camera.linear();
  Matrix6d to_world = Matrix6d::Zero();
  to_world.topLeftCorner<3, 3>() = R;
  to_world.bottomRightCorner<3, 3>() = R;
  const SymmetricEigen<6> solved =
      symmetric_eigen(Matrix6d(to_world * tracking.information * to_world.transpose()));
  Matrix6d covariance = Matrix6d::Zero();
  Vector6d free = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d direction = solved.vectors.col(i);
    if (solved.converged && solved.values(i) > kNone)
      covariance += direction * direction.transpose() / solved.values(i);
    else
      free = free.cwiseMax(direction.cwiseAbs());
  }
  for (int axis = 0; axis < 3; ++axis) {
    sigma.position_m(axis) =
        free(axis) > kPart ? std::numeric_limits<double>::infinity() : std::sqrt(covariance(axis, axis));
    sigma.rotation_rad(axis) = free(axis + 3) > kPart ? std::numeric_limits<double>::infinity()
                                                      : std::sqrt(covariance(axis + 3, axis + 3));
  }
  if (free.head<3>().maxCoeff() > kPart) {
    for (int i = 0; i < 6; ++i) {
      if (solved.converged && solved.values(i) > kNone) continue;
      const Eigen::Vector3d part = solved.vectors.col(i).head<3>();
      if (part.norm() > sigma.least_certain_world.norm()) sigma.least_certain_world = part;
    }
    sigma.least_certain_world.normalize();
  } else {
    const SymmetricEigen<3> position = symmetric_eigen(Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()));
    if (position.converged && position.values(2) > kCertain_m * kCertain_m)
      sigma.least_certain_world = position.vectors.col(2);
  }
  return sigma;
}

DepthFit depth_fit(const SourcePoints& live, std::span<const PosedReference> references,
                   const Eigen::Isometry3d& T_world_camera, const AlignConfig& config) {
  DepthFit fit;
  if (references.empty() || live.levels.empty() || !T_world_camera.matrix().allFinite()) return fit;
  const int level = std::min(config.finest_level, static_cast<int>(live.levels.size()) - 1);
  std::vector<Exposure> exposures(references.size());
  const LevelMatches matches =
      match_references({.points = live.levels[static_cast<std::size_t>(level)], .motion = {}}, references,
                       static_cast<std::size_t>(level), T_world_camera, limits_at(level, config), exposures);
  fit.overlap = matches.overlap.value_or(fit.overlap);
  const PointMatches& total = matches.total;
  if (total.met > 0)
    fit.inlier_fraction = static_cast<double>(total.inliers) / static_cast<double>(total.met);
  return fit;
}

Eigen::Isometry3d expected_motion(const Tracking& tracking, const Eigen::Isometry3d& T_last_now) {
  return tracking ? T_last_now : retract(0.5 * local(T_last_now));
}

}  // namespace roomradar
