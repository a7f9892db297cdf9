// align.hpp: estimates a camera pose by aligning an image's depth and intensity with views of known pose.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string_view>

#include "mapping/alignment/view.hpp"

namespace roomradar {

enum class TrackStatus {
  kTracked,       ///< all six degrees of freedom are constrained by the measurements
  kTooFewPoints,  ///< too few correspondences; the returned pose is the initial guess
  /// Some degrees of freedom are unconstrained, e.g. because only one wall is in view. Unconstrained ones
  /// keep the initial guess's values; the others are aligned.
  kDegenerate,
  /// The image disagrees with the references at the aligned pose, or the correction exceeds
  /// AlignConfig::max_correction_m or max_correction_rad. The returned pose is the guess.
  kDiverged,
  /// A pose that nothing has verified for more than 0.15 s, or whose standard deviation has exceeded 5 cm:
  /// directions that depth leaves unconstrained were only predicted. Returned by locate(), not by align().
  kUncertain,
};
std::string_view to_string(TrackStatus status);

/// Result of an alignment. A default-constructed Tracking is a failed alignment.
struct [[nodiscard]] Tracking {
  TrackStatus status = TrackStatus::kDiverged;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< always finite
  double rms_m = -1.0;           ///< RMS point-to-plane distance of the inliers, m; < 0: no result
  double inlier_fraction = 0.0;  ///< fraction of the correspondences that are inliers (PointMatches::inliers)
  /// Fraction of the image's points that have a correspondence in the first reference.
  double overlap = 0.0;
  /// Number of unconstrained degrees of freedom, 0..6.
  int unconstrained_dofs = 0;
  /// Inverse covariance of the error of T_world_camera. The error is a twist (translation m, rotation rad) in
  /// the camera frame: T_true = T_world_camera * exp(twist). The matrix is scaled down, since the errors of
  /// neighbouring pixels are correlated.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  /// Part of `information` along directions that depth constrains clearly: ten times above
  /// AlignConfig::min_constraint. Along the others, bumps and noise may pretend a constraint.
  Eigen::Matrix<double, 6, 6> clear_information = Eigen::Matrix<double, 6, 6>::Zero();
  explicit operator bool() const { return status == TrackStatus::kTracked; }
};

/// Standard deviations of a pose, from Tracking::information.
struct PoseSigma {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();    ///< along x, y, z of the world; infinite: unknown
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();  ///< about x, y, z of the world; infinite: unknown
  /// Unit direction in the world along which the position is least certain; zero if all are known.
  Eigen::Vector3d least_certain_world = Eigen::Vector3d::Zero();
};

/// Directions without information get an infinite standard deviation along each axis that they have a part
/// in.
PoseSigma pose_sigma(const Tracking& tracking);

/// Returns true if T_world_camera is an aligned pose, possibly with unconstrained degrees of freedom.
inline bool has_pose(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

/// Returns true if T_world_camera is an aligned pose or, with kUncertain, the best guess.
inline bool has_guess(const Tracking& tracking) {
  return has_pose(tracking) || tracking.status == TrackStatus::kUncertain;
}

struct AlignConfig {
  int coarsest_level = 2;  ///< pyramid level at which alignment begins
  int finest_level = 0;    ///< pyramid level at which alignment ends; 0: finest level of the pyramid
  int iterations = 6;      ///< max number of iterations per level
  /// Max point-to-plane distance of an inlier at the coarsest level, m. Pairs above the limit have no
  /// residual, but count as correspondences for min_points and overlap. The limit is halved at each finer
  /// level, but never below 0.03 m.
  float gate_m = 0.10F;
  /// Scale of the robust kernel at the finest level, in standard deviations: a residual of this size has
  /// weight 1/4.
  float robust_sigma = 2.5F;
  /// Standard deviation of intensity residuals, in grey levels of 0..255. 0: intensity is not used.
  float intensity_sigma = 8.0F;
  int min_points = 150;  ///< min number of correspondences at the finest level
  float min_inlier_fraction = 0.3F;
  /// Min mean squared derivative of the point-to-plane distances along a direction that depth constrains. A
  /// direction is a unit twist; its rotation is scaled by the points' mean distance from the camera. For a
  /// translation, the value is the mean squared cosine between normals and direction. With a smaller
  /// threshold, noise of the normals alone would make a direction look constrained.
  float min_constraint = 0.001F;
  /// Max standard deviation of the pose along a constrained direction, m. Above it, the direction counts as
  /// unconstrained.
  float max_uncertainty_m = 0.01F;
  /// Max corrections of the guess's translation and rotation. A larger correction gives kDiverged.
  float max_correction_m = 0.5F;
  float max_correction_rad = 0.5F;
};

/// A reference view with a pose that replaces the view's own T_world_view.
struct PosedReference {
  const TargetView* view = nullptr;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Earlier pose, from which align() computes the camera's velocity during the readout of the image. Each
/// iteration recomputes the velocity from its current pose.
struct ReadoutMotion {
  Eigen::Isometry3d T_world_before = Eigen::Isometry3d::Identity();
  double dt_s = 0.0;  ///< time from that pose to the image; 0: the velocity is unknown and assumed to be 0
  double readout_s = 0.0;  ///< readout time of the depth image; 0: global shutter
};

/// Estimates T_world_camera by point-to-plane ICP with projective association. Adds intensity residuals, with
/// one gain and one offset per reference. Minimises by Gauss-Newton, from coarse to fine. Residuals are
/// weighted by their standard deviations and by a robust kernel, so moving objects have little effect. Each
/// reference contributes in proportion to its number of correspondences.
///
/// If the guess is not finite, returns kDiverged with the identity as pose. Source: Chen and Medioni 1992
/// (point to plane); Newcombe et al., KinectFusion, ISMAR 2011 (projective association); Zhang, Kaess, Singh,
/// On Degeneracy of Optimization-based State Estimation Problems, ICRA 2016.
Tracking align(const SourcePoints& live, std::span<const PosedReference> references,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {},
               const ReadoutMotion& readout = {});

/// Aligns with a single reference, at its own T_world_view.
Tracking align(const SourcePoints& live, const TargetView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// Agreement of an image's depth with references at a given pose.
struct DepthFit {
  double overlap = 0.0;          ///< as Tracking::overlap
  double inlier_fraction = 0.0;  ///< as Tracking::inlier_fraction; 0 without correspondences
};

/// Compares the image's depth with the references at a pose, at the finest level, without aligning.
DepthFit depth_fit(const SourcePoints& live, std::span<const PosedReference> references,
                   const Eigen::Isometry3d& T_world_camera, const AlignConfig& config = {});

/// Returns the motion for a twist (translation m, rotation vector rad). Converts translation and rotation
/// separately, which equals the exponential map to first order.
Eigen::Isometry3d retract(const Eigen::Matrix<double, 6, 1>& twist);
/// Returns the twist of a motion: the inverse of retract().
Eigen::Matrix<double, 6, 1> local(const Eigen::Isometry3d& T);

/// Predicts the motion from this frame to the next. Returns T_last_now (the motion from the last frame to
/// this one) if `tracking` is kTracked. Otherwise returns half of T_last_now, so that the velocity of
/// unobserved degrees of freedom decays.
Eigen::Isometry3d expected_motion(const Tracking& tracking, const Eigen::Isometry3d& T_last_now);

}  // namespace roomradar
