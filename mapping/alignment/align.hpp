// align.hpp: the pose of a depth (and intensity) image relative to views whose poses are known.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string_view>

#include "mapping/alignment/view.hpp"

namespace roomradar {

enum class TrackStatus {
  kTracked,       ///< all six directions of motion are fixed by what was seen
  kTooFewPoints,  ///< hardly anything of the image meets the reference; the pose is the guess
  kDegenerate,    ///< some directions are not fixed (one wall): these are the guess's, the others are aligned
  kDiverged,      ///< the image does not agree with the reference at the pose found
};
std::string_view to_string(TrackStatus status);

/// A pose found by alignment. Unset means failed.
struct [[nodiscard]] Tracking {
  TrackStatus status = TrackStatus::kDiverged;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< always finite
  double rms_m = -1.0;           ///< of the inliers' distances to the reference's planes; < 0: none
  double inlier_fraction = 0.0;  ///< of the points that met a reference, those within the noise
  double overlap = 0.0;          ///< of the image's points, those that met the first reference
  int held_directions = 0;       ///< 0..6: how many directions of motion are the guess's
  /// Inverse covariance of the error of T_world_camera, as a twist (translation m, rotation rad) in the
  /// camera frame: T_true = T_world_camera * exp(twist). Neighbouring pixels are not independent; that is
  /// discounted.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  explicit operator bool() const { return status == TrackStatus::kTracked; }
};

/// Whether there is a pose to go on with, though some of its directions may be the guess's.
inline bool has_pose(const Tracking& tracking) {
  return tracking.status == TrackStatus::kTracked || tracking.status == TrackStatus::kDegenerate;
}

struct AlignConfig {
  int coarsest_level = 2;  ///< levels of the views that are used: from here ...
  int finest_level = 0;    ///< ... down to here
  int iterations = 6;      ///< at most, a level
  /// Distance to the reference's plane past which a point says nothing, at the coarsest level; half of it at
  /// the next finer one and so on, but never less than 3 cm.
  float gate_m = 0.10F;
  float robust_sigma = 2.5F;     ///< distance in standard deviations at which a point's weight is 1/4
  float intensity_sigma = 8.0F;  ///< grey levels of 255; 0 leaves the colour out
  int min_points = 150;          ///< that must meet a reference at the finest level
  float min_inlier_fraction = 0.3F;
  /// Mean squared cosine between normals and a direction, below which the depth is said not to fix it: the
  /// normals' own noise looks like information.
  float min_constraint = 0.001F;
  float max_uncertainty_m = 0.01F;  ///< standard deviation past which a direction is held
  float max_correction_m = 0.5F;    ///< further (or by more radians) from the guess than this is kDiverged
};

/// A reference and where it stands; the pose that the view itself has is not looked at.
struct PosedReference {
  const ReferenceView* view = nullptr;
  Eigen::Isometry3d T_world_view = Eigen::Isometry3d::Identity();
};

/// Finds T_world_camera such that the image's points lie on the planes that the references show at the pixels
/// where these points project, and show the same intensity, up to one gain and offset a reference.
/// Gauss-Newton from coarse to fine; weights by the depths' standard deviations, robust to parts of the image
/// that have moved. A reference counts with what it overlaps. A guess that is not finite answers kDiverged at
/// the identity. Directions that nothing fixes keep the guess's value and are counted in held_directions.
/// Source: Chen and Medioni 1992 (point to plane); Newcombe et al., KinectFusion, ISMAR 2011 (projective
/// association); Zhang, Kaess, Singh, On Degeneracy of Optimization-based State Estimation Problems, ICRA
/// 2016.
Tracking align(const LiveView& live, std::span<const PosedReference> references,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// The same with one reference, at the pose that it has itself.
Tracking align(const LiveView& live, const ReferenceView& reference,
               const Eigen::Isometry3d& T_world_camera_guess, const AlignConfig& config = {});

/// The motion with a twist's translation (m) and rotation vector (rad), and the other way round. To first
/// order this is the exponential map; translation and rotation are kept apart.
Eigen::Isometry3d exp_twist(const Eigen::Matrix<double, 6, 1>& twist);
Eigen::Matrix<double, 6, 1> log_twist(const Eigen::Isometry3d& T);

/// What to expect after this motion, which tracking led to: the same, or half of it where not all was fixed
/// by what was seen. That must not run on for ever with the speed it once had.
Eigen::Isometry3d expected_motion(const Tracking& tracking, const Eigen::Isometry3d& T_last_now);

}  // namespace roomradar
