// align.cpp: registers a depth (and intensity) image to views of known pose.
#include "mapping/alignment/align.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// Normal equations of residuals r = r0 + J twist, J = (m, p x m), packed: 21 entries of J'wJ, 6 of J'wr.
struct Normals {
  std::array<float, 27> sums{};

  void add(const Eigen::Vector3f& p, const Eigen::Vector3f& m, float residual, float weight) {
    const Eigen::Vector3f c = p.cross(m);
    const std::array<float, 6> J{m.x(), m.y(), m.z(), c.x(), c.y(), c.z()};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      const float wj = weight * J[i];
      for (std::size_t j = i; j < 6; ++j) sums[k++] += wj * J[j];
      sums[21 + i] += wj * residual;
    }
  }
};

/// Double-precision sum of Normals, which sum one block of points each in float.
struct System {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weight = 0.0;

  void add(const Normals& block) {
    std::size_t k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) H(i, j) += static_cast<double>(block.sums[k++]);
      g(i) += static_cast<double>(block.sums[21 + static_cast<std::size_t>(i)]);
    }
  }
  void mirror() { H.triangularView<Eigen::StrictlyLower>() = H.transpose(); }
};

/// Intensity mapping to one reference: reference = gain * live + offset.
struct Exposure {
  float gain = 1.0F;
  float offset = 0.0F;
  bool known = false;
};

/// Sums over all points and one reference.
struct Pass {
  System depth, colour;
  std::size_t met = 0;      ///< points that project to a reference pixel with a surface
  std::size_t inliers = 0;  ///< correspondences within the gate and three standard deviations
  double squares = 0.0;     ///< sum of the inliers' squared distances
  /// weighted sums of intensities
  double n = 0.0, live = 0.0, reference = 0.0, live_live = 0.0, reference_reference = 0.0;
};

struct Limits {
  float gate_m;
  float inverse_soft;             ///< 1 / (standard deviations at which the weight is 1/4)
  float inverse_intensity_sigma;  ///< 0: colour is ignored
};

/// Geman-McClure weight of a residual: 1 at x = 0, 1/4 at 1, decreasing with the fourth power of x.
float robust_weight(float x) {
  const float w = 1.0F / (1.0F + x * x);
  return w * w;
}

void pass_points(const std::vector<SourcePoint>& points, const TargetLevel& reference,
                 const Eigen::Isometry3d& T_view_camera, const Limits& limits, const Exposure& exposure,
                 Pass& pass) {
  constexpr std::size_t kBlock = 512;  // float sums over this many points keep five digits
  const Eigen::Matrix3f R = T_view_camera.linear().cast<float>();
  const Eigen::Matrix3f R_transposed = R.transpose();
  const Eigen::Vector3f t = T_view_camera.translation().cast<float>();
  const auto fx = static_cast<float>(reference.camera.fx_px), fy = static_cast<float>(reference.camera.fy_px);
  const auto cx = static_cast<float>(reference.camera.cx_px), cy = static_cast<float>(reference.camera.cy_px);
  const auto end_u = static_cast<float>(reference.camera.width_px) - 0.5F;
  const auto end_v = static_cast<float>(reference.camera.height_px) - 0.5F;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, points.size());
    Normals depth, colour;
    float weights = 0.0F, squares = 0.0F;
    float n = 0.0F, sl = 0.0F, sr = 0.0F, sll = 0.0F, srr = 0.0F;
    for (std::size_t i = begin; i < end; ++i) {
      const SourcePoint& point = points[i];
      const Eigen::Vector3f p = R * point.p_camera + t;
      if (p.z() < 0.1F) continue;
      const float inverse_z = 1.0F / p.z();
      const float u = fx * p.x() * inverse_z + cx, v = fy * p.y() * inverse_z + cy;
      if (!(u > -0.5F && v > -0.5F && u < end_u && v < end_v)) continue;
      const int x = static_cast<int>(u + 0.5F), y = static_cast<int>(v + 0.5F);
      const TargetPixel& pixel = reference.pixels.at(x, y);
      if (pixel.inverse_sigma_per_m <= 0.0F) continue;
      ++pass.met;
      const float r_m = pixel.normal.dot(p) - pixel.offset_m;
      if (std::abs(r_m) > limits.gate_m) continue;
      const float r = r_m * pixel.inverse_sigma_per_m;
      const float w = robust_weight(r * limits.inverse_soft);
      if (std::abs(r) < 4.0F) {  // difference of two measurements: 3 sqrt(2) standard deviations
        ++pass.inliers;
        squares += r_m * r_m;
      }
      const Eigen::Vector3f m = pixel.inverse_sigma_per_m * (R_transposed * pixel.normal);
      depth.add(point.p_camera, m, r, w);
      weights += w * pixel.inverse_sigma_per_m * pixel.inverse_sigma_per_m;

      if (limits.inverse_intensity_sigma <= 0.0F || point.intensity < 0.0F || pixel.intensity < 0.0F)
        continue;
      n += w, sl += w * point.intensity, sr += w * pixel.intensity;
      sll += w * point.intensity * point.intensity, srr += w * pixel.intensity * pixel.intensity;
      const float gu = pixel.gradient_u * fx * inverse_z, gv = pixel.gradient_v * fy * inverse_z;
      if (!exposure.known || (gu == 0.0F && gv == 0.0F)) continue;
      const float expected = pixel.intensity + pixel.gradient_u * (u - static_cast<float>(x)) +
                             pixel.gradient_v * (v - static_cast<float>(y));
      const float rc =
          (expected - exposure.gain * point.intensity - exposure.offset) * limits.inverse_intensity_sigma;
      const Eigen::Vector3f h(gu, gv, -(gu * p.x() + gv * p.y()) * inverse_z);
      colour.add(point.p_camera, limits.inverse_intensity_sigma * (R_transposed * h), rc,
                 w * robust_weight(rc * limits.inverse_soft));
    }
    pass.depth.add(depth);
    pass.colour.add(colour);
    pass.depth.weight += static_cast<double>(weights);
    pass.squares += static_cast<double>(squares);
    pass.n += static_cast<double>(n), pass.live += static_cast<double>(sl);
    pass.reference += static_cast<double>(sr);
    pass.live_live += static_cast<double>(sll), pass.reference_reference += static_cast<double>(srr);
  }
}

/// Computes the gain and offset that give the live intensities the mean and spread of the reference's.
Exposure match_exposure(const Pass& pass) {
  if (pass.n < 50.0) return {};
  const double live_mean = pass.live / pass.n, reference_mean = pass.reference / pass.n;
  const double live_variance = pass.live_live / pass.n - live_mean * live_mean;
  const double reference_variance = pass.reference_reference / pass.n - reference_mean * reference_mean;
  Exposure exposure;
  const double ratio = std::max(reference_variance, 1.0) / std::max(live_variance, 1.0);
  exposure.gain = static_cast<float>(std::clamp(std::sqrt(ratio), 0.5, 2.0));
  exposure.offset = static_cast<float>(reference_mean - static_cast<double>(exposure.gain) * live_mean);
  exposure.known = true;
  return exposure;
}

struct Step {
  Vector6d twist = Vector6d::Zero();
  Matrix6d information = Matrix6d::Zero();
  int held = 0;
};

/// Solves for the step. Rotation is scaled by the points' mean distance, so all directions are lengths.
/// Directions that depth does not constrain are removed from the depth term. After the colour term is added,
/// directions that are still unconstrained keep the guess. `independent` is the fraction of points with
/// independent errors. `fixed` projects onto the directions that depth constrained at coarser levels. This
/// level removes directions that it finds unconstrained, because the normals of finer levels are noisier.
Step solve(const System& depth, const System& colour, double length_m, double independent,
           const AlignConfig& config, Matrix6d& fixed) {
  Vector6d scale;
  scale << 1.0, 1.0, 1.0, 1.0 / length_m, 1.0 / length_m, 1.0 / length_m;
  const Matrix6d depth_H = fixed * (scale.asDiagonal() * depth.H * scale.asDiagonal()) * fixed;
  const Vector6d depth_g = fixed * scale.cwiseProduct(depth.g);
  const SymmetricEigen<6> by_depth = symmetric_eigen(depth_H);
  fixed.setZero();
  Matrix6d H = scale.asDiagonal() * colour.H * scale.asDiagonal();
  Vector6d g = scale.cwiseProduct(colour.g);
  for (int i = 0; i < 6; ++i) {
    const double strength = by_depth.values(i);
    if (strength <= static_cast<double>(config.min_constraint) * depth.weight) continue;
    const Vector6d direction = by_depth.vectors.col(i);
    H += strength * direction * direction.transpose();
    g += direction * direction.dot(depth_g);
    fixed += direction * direction.transpose();
  }
  const double least = 1.0 / (independent * static_cast<double>(config.max_uncertainty_m) *
                              static_cast<double>(config.max_uncertainty_m));
  const SymmetricEigen<6> both = symmetric_eigen(H);
  Step step;
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
  return step;
}

double mean_distance_m(const std::vector<SourcePoint>& points) {
  double sum = 0.0;
  for (const SourcePoint& point : points) sum += static_cast<double>(point.p_camera.z());
  return points.empty() ? 1.0 : sum / static_cast<double>(points.size());
}

Limits limits_at(int level, const AlignConfig& config) {
  const int finer = config.coarsest_level - level;
  const float soft =
      config.robust_sigma * static_cast<float>(1 << std::clamp(level - config.finest_level, 0, 8));
  return {.gate_m = std::max(config.gate_m / static_cast<float>(1 << std::clamp(finer, 0, 8)), 0.03F),
          .inverse_soft = 1.0F / soft,
          .inverse_intensity_sigma = config.intensity_sigma > 0.0F ? 1.0F / config.intensity_sigma : 0.0F};
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
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config) {
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
  Pass total;
  Matrix6d fixed = Matrix6d::Identity();  // directions constrained by depth at all coarser levels
  for (int level = std::min(config.coarsest_level, last); level >= std::min(config.finest_level, last);
       --level) {
    const std::vector<SourcePoint>& points = live.levels[static_cast<std::size_t>(level)];
    const double length_m = std::max(mean_distance_m(points), 0.1);
    const Limits limits = limits_at(level, config);
    const Matrix6d fixed_coarser = fixed;
    for (int iteration = 0; iteration < config.iterations; ++iteration) {
      total = Pass{};
      for (std::size_t k = 0; k < references.size(); ++k) {
        const TargetView& reference = *references[k].view;
        if (static_cast<std::size_t>(level) >= reference.levels.size()) continue;
        Pass pass;
        pass_points(points, reference.levels[static_cast<std::size_t>(level)],
                    references[k].T_world_view.inverse() * T_world_camera, limits, exposures[k], pass);
        exposures[k] = match_exposure(pass);
        total.depth.H += pass.depth.H, total.depth.g += pass.depth.g, total.depth.weight += pass.depth.weight;
        total.colour.H += pass.colour.H, total.colour.g += pass.colour.g;
        total.met += pass.met, total.inliers += pass.inliers, total.squares += pass.squares;
        if (k == 0) {
          result.overlap =
              points.empty() ? 0.0 : static_cast<double>(pass.met) / static_cast<double>(points.size());
        }
      }
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

  const Vector6d correction = local(T_world_camera_guess.inverse() * T_world_camera);
  result.inlier_fraction = static_cast<double>(total.inliers) / static_cast<double>(total.met);
  const bool moved_too_far = !correction.allFinite() ||
                             correction.head<3>().norm() > static_cast<double>(config.max_correction_m) ||
                             correction.tail<3>().norm() > static_cast<double>(config.max_correction_m);
  if (moved_too_far || result.inlier_fraction < static_cast<double>(config.min_inlier_fraction)) {
    result.status = TrackStatus::kDiverged;
    result.T_world_camera = T_world_camera_guess;
    return result;
  }
  result.T_world_camera = T_world_camera;
  result.rms_m = std::sqrt(total.squares / static_cast<double>(std::max<std::size_t>(total.inliers, 1)));
  result.unconstrained_dofs = step.held;
  result.information = step.information;
  result.status = step.held > 0 ? TrackStatus::kDegenerate : TrackStatus::kTracked;
  return result;
}

Tracking align(const SourcePoints& live, const TargetView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config) {
  const PosedReference one{&reference, reference.T_world_view};
  return align(live, std::span<const PosedReference>(&one, 1), T_world_camera_guess, config);
}

Eigen::Isometry3d expected_motion(const Tracking& tracking, const Eigen::Isometry3d& T_last_now) {
  return tracking ? T_last_now : retract(0.5 * local(T_last_now));
}

}  // namespace roomradar
