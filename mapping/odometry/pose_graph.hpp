// pose_graph.hpp: optimises camera poses to fit measured relative and absolute poses.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {

/// Measured pose of camera b in the frame of camera a.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  /// Inverse covariance of T_a_b, as a twist (translation m, rotation rad) in the frame of camera b.
  Matrix6d information = Matrix6d::Identity();
  /// True if the measurement may be an outlier, e.g. a loop closure. The solver then uses a robust kernel.
  bool robust = false;
  bool recorded = false;  ///< measured by the recording's own poses, not by alignment
};

/// Measured pose of a camera in the world frame. The measurement may be an outlier, so the solver uses a
/// robust kernel.
struct PoseAnchor {
  std::size_t pose = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Inverse covariance of T_world_camera, as a twist (translation m, rotation rad) in the camera frame.
  Matrix6d information = Matrix6d::Identity();
};

enum class PoseGraphStatus {
  kSolved,
  /// Solved. Poses that no chain of measurements connects to a constant pose or an anchor are unchanged.
  kUnderdetermined,
  kNothingToSolve,  ///< no valid measurement involves a pose that may move; poses unchanged
  kNotFinite,       ///< a pose is not finite; poses unchanged
  kFailed,          ///< the solver failed; poses unchanged
};

/// Returns true if the poses were optimised.
constexpr bool is_usable(PoseGraphStatus status) {
  return status == PoseGraphStatus::kSolved || status == PoseGraphStatus::kUnderdetermined;
}

struct PoseGraphResult {
  PoseGraphStatus status = PoseGraphStatus::kFailed;
  /// Number of poses that no chain of measurements connects to a constant pose or an anchor.
  std::size_t untied = 0;
  /// Initial cost: half the sum of the squared residuals, which are in standard deviations.
  double cost_before = 0.0;
  double cost_after = 0.0;
  /// Norm of each constraint's final residual, in standard deviations; -1: the constraint was left out.
  std::vector<double> residual_sigma;
};

/// Returns a sentence that states the status and the count of unconstrained poses.
std::string describe(const PoseGraphResult& result);

/// Optimises the poses T_world_camera to minimise the residuals of constraints and anchors. Poses that no
/// chain of measurements connects to a constant pose or an anchor do not change. Connected poses do not
/// change in unconstrained directions. Does not throw.
///
/// Leaves out measurements between two constant poses, and invalid measurements. A measurement is invalid if
/// an index is out of range, both indices are equal, or a number is not finite. It is also invalid if the
/// information is zero or not positive semidefinite. Measurements left out get a residual_sigma of -1.
/// @param constant  per pose: true if the pose is constant; if empty, only the first pose is constant
PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints,
                                    const std::vector<PoseAnchor>& anchors = {},
                                    const std::vector<bool>& constant = {});

}  // namespace roomradar
