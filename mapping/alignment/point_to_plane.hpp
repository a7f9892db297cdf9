// point_to_plane.hpp: residuals of points against the planes and intensities of a target view.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "mapping/alignment/view.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {

/// Normal equations of residuals r = r0 + J twist: H = J'wJ, g = J'wr.
struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double weight = 0.0;

  /// Fills in the lower triangle of H; needed after match_points().
  void mirror() { H.triangularView<Eigen::StrictlyLower>() = H.transpose(); }
};

/// Intensity mapping to one reference: reference = gain * live + offset.
struct Exposure {
  float gain = 1.0F;
  float offset = 0.0F;
  bool known = false;
};

/// Sums over all points and one reference.
struct PointMatches {
  NormalEquations depth, colour;
  std::size_t met = 0;      ///< points that project to a reference pixel with a surface
  std::size_t inliers = 0;  ///< correspondences within the gate and three standard deviations
  double squares = 0.0;     ///< sum of the inliers' squared distances
  /// weighted sums of intensities
  double n = 0.0, live = 0.0, reference = 0.0, live_live = 0.0, reference_reference = 0.0;
};

/// Which residuals count, and how much.
struct MatchLimits {
  float gate_m;
  float inverse_soft;             ///< 1 / (standard deviations at which the weight is 1/4)
  float inverse_intensity_sigma;  ///< 0: colour is ignored
};

/// Projects the points into the reference, and sums the residuals of those with a correspondence: distance to
/// the plane and, if exposure.known, difference of intensity. The twist is in the camera frame.
/// @param pass  sums are added to it; H as an upper triangle only
void match_points(const std::vector<SourcePoint>& points, const TargetLevel& reference,
                  const Eigen::Isometry3d& T_view_camera, const MatchLimits& limits, const Exposure& exposure,
                  PointMatches& pass);

/// Computes the gain and offset that give the live intensities the mean and spread of the reference's;
/// unknown if there are too few.
Exposure match_exposure(const PointMatches& pass);

}  // namespace roomradar
