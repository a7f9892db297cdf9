// pose_graph.hpp: the poses that agree best with many measured relative poses.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace roomradar {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A measurement of where camera b stands in camera a.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of the twist (translation m, rotation rad) at camera b
  bool robust = false;                          ///< may be wrong altogether (a loop closure)
};

struct PoseGraphResult {
  bool usable = false;       ///< false: the poses were left as they were
  double cost_before = 0.0;  ///< half the sum of squared residuals, in standard deviations
  double cost_after = 0.0;
  /// One a constraint: length of its residual after, in standard deviations.
  std::vector<double> residual_sigma;
};

/// Moves T_world_camera (all but the first, which is held) to minimise the constraints' residuals. Poses that
/// no chain of constraints ties to the first stay where they are. Never throws; constraints with indices out
/// of range, numbers that are not finite, or information that is not positive semidefinite are left out
/// (residual_sigma -1).
PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints);

}  // namespace roomradar
