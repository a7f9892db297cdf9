// point_to_plane.hpp: point-to-plane and intensity residuals of points against a target view.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "mapping/alignment/view.hpp"
#include "mapping/types/linear_algebra.hpp"
#include "mapping/types/simd8f.hpp"

namespace roomradar {

/// Normal equations of weighted least squares: H = J^T w J, g = J^T w r. r are the residuals, J their
/// Jacobian with respect to the camera's twist, w their weights.
struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weight = 0.0;

  /// Copies the upper triangle of H to the lower. Call it after match_points(), which fills only the upper
  /// triangle.
  void mirror() { H.triangularView<Eigen::StrictlyLower>() = H.transpose(); }
};

/// Affine brightness model: reference intensity = gain * live intensity + offset. The live image is the one
/// being aligned.
struct Exposure {
  float gain = 1.0F;
  float offset = 0.0F;
  bool known = false;
};

/// Sums over all points for one reference.
struct PointMatches {
  NormalEquations depth, colour;
  std::size_t met = 0;  ///< number of points that project to a pixel with a surface
  /// Number of correspondences whose distance is within the gate and below 4 standard deviations of a single
  /// measurement, i.e. 2.8 of the difference of two measurements.
  std::size_t inliers = 0;
  double squares = 0.0;  ///< sum of the inliers' squared distances, m^2
  /// Weighted sums over the correspondences with two known intensities, for match_exposure(): the weights
  /// (n), the intensities, and their squares.
  double n = 0.0, live = 0.0, reference = 0.0, live_live = 0.0, reference_reference = 0.0;
};

/// Points of one pyramid level of the live image, and their motion during its readout. Refers to both, which
/// must outlive it.
struct MovingPoints {
  const std::vector<SourcePoint>& points;
  const RowMotion& motion;
};

/// Pose and brightness of the live image relative to a reference. Refers to both, which must outlive it.
struct ViewRelation {
  const Eigen::Isometry3d& T_view_camera;
  const Exposure& exposure;
};

/// Limits and weights of the residuals.
struct MatchLimits {
  float gate_m;  ///< max point-to-plane distance of an inlier, m
  /// 1 / scale of the Geman-McClure kernel. The scale is the residual, in standard deviations, with weight
  /// 1/4.
  float inverse_soft;
  float inverse_intensity_sigma;  ///< 1 / standard deviation, in grey levels; 0: intensity is not used
};

/// Geman-McClure weight of a residual: 1 at x = 0, 1/4 at 1, about x^-4 for large x.
template <typename Real>
Real robust_weight(const Real& x) {
  const Real one(1);
  const Real w = one / (one + x * x);
  return w * w;
}

/// Projects the points into the reference to find correspondences, and sums their residuals. Residuals are
/// the distance to the reference's plane and, if the exposure is known, the difference of intensity.
/// Residuals are linearised with respect to the camera's twist in the camera frame.
/// @param[in,out] pass  sums to which the residuals are added. Only the upper triangle of H is filled
/// @param arithmetic    results are bit-identical for all values
void match_points(const MovingPoints& live, const TargetLevel& reference, const ViewRelation& relation,
                  const MatchLimits& limits, PointMatches& pass,
                  Arithmetic arithmetic = Arithmetic::kFastest);

/// Computes the gain and offset that map the mean and standard deviation of the live intensities to those of
/// the reference's intensities. The gain is limited to 0.5..2. `known` is false if there are too few
/// correspondences.
Exposure match_exposure(const PointMatches& pass);

}  // namespace roomradar
