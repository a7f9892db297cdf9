// align.hpp: registers a depth (and intensity) image to views of known pose.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string_view>

#include "mapping/alignment/view.hpp"

namespace roomradar {

enum class TrackStatus {
  kTracked,       ///< all six degrees of freedom are constrained by the measurements
  kTooFewPoints,  ///< too little overlap with the references; the pose is the guess
  kDegenerate,    ///< unconstrained degrees of freedom (one wall) keep the guess; the others are aligned
  kDiverged,      ///< the image disagrees with the references at the pose found; the pose is the guess
};
std::string_view to_string(TrackStatus status);

/// Pose found by alignment. A default-constructed Tracking means failed.
struct [[nodiscard]] Tracking {
  TrackStatus status = TrackStatus::kDiverged;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< always finite
  double rms_m = -1.0;           ///< RMS of the inliers' point-to-plane distances; < 0: none
  double inlier_fraction = 0.0;  ///< fraction of the correspondences that are within the noise
  double overlap = 0.0;  ///< fraction of the image's points with a correspondence in the first reference
  int unconstrained_dofs = 0;  ///< number of unconstrained degrees of freedom, 0..6; these keep the guess
  /// Inverse covariance of the error of T_world_camera, as a twist (translation m, rotation rad) in the
  /// camera frame: T_true = T_world_camera * exp(twist). Reduced to account for the correlation of
  /// neighbouring pixels.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  explicit operator bool() const { return status == TrackStatus::kTracked; }
};

/// Returns whether the pose is usable, though some degrees of freedom may be the guess's.
inline bool has_pose(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

struct AlignConfig {
  int coarsest_level = 2;  ///< coarsest pyramid level used
  int finest_level = 0;    ///< finest pyramid level used
  int iterations = 6;      ///< max per level
  /// Max point-to-plane distance of a correspondence at the coarsest level; halved per finer level, but never
  /// less than 3 cm.
  float gate_m = 0.10F;
  float robust_sigma = 2.5F;  ///< residual, in standard deviations, whose weight is 1/4 at the finest level
  float intensity_sigma = 8.0F;  ///< grey levels of 255; 0: colour is ignored
  int min_points = 150;          ///< min number of correspondences at the finest level
  float min_inlier_fraction = 0.3F;
  /// Min mean squared cosine between the normals and a direction for depth to constrain this direction. Below
  /// it, noise of the normals looks like information.
  float min_constraint = 0.001F;
  float max_uncertainty_m = 0.01F;  ///< standard deviation above which a direction counts as unconstrained
  float max_correction_m = 0.5F;    ///< larger corrections of the guess, in m or rad, count as kDiverged
};

/// A reference and its pose; the view's own T_world_view is ignored.
struct PosedReference {
  const TargetView* view = nullptr;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Estimates T_world_camera by point-to-plane ICP with projective association, plus intensity residuals up to
/// one gain and offset per reference. Gauss-Newton from coarse to fine; residuals are weighted by their
/// standard deviations and robust to parts of the image that have moved. Each reference contributes in
/// proportion to its overlap. Returns kDiverged at the identity if the guess is not finite. Unconstrained
/// degrees of freedom keep the guess's value and are counted in unconstrained_dofs. Source: Chen and Medioni
/// 1992 (point to plane); Newcombe et al., KinectFusion, ISMAR 2011 (projective association); Zhang, Kaess,
/// Singh, On Degeneracy of Optimization-based State Estimation Problems, ICRA 2016.
Tracking align(const SourcePoints& live, std::span<const PosedReference> references,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// Same with one reference, at its own T_world_view.
Tracking align(const SourcePoints& live, const TargetView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// Converts a twist (translation m, rotation vector rad) to a motion, and back. Translation and rotation are
/// converted separately; to first order this equals the exponential map.
Eigen::Isometry3d retract(const Eigen::Matrix<double, 6, 1>& twist);
Eigen::Matrix<double, 6, 1> local(const Eigen::Isometry3d& T);

/// Predicts the next motion: T_last_now if `tracking` is kTracked, else half of it. Halving stops unobserved
/// degrees of freedom from keeping a past speed.
Eigen::Isometry3d expected_motion(const Tracking& tracking, const Eigen::Isometry3d& T_last_now);

}  // namespace roomradar
