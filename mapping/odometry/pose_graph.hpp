// pose_graph.hpp: the poses that agree best with many measured relative poses.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {

/// A measurement of where camera b stands in camera a.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of the twist (translation m, rotation rad) at camera b
  bool robust = false;                          ///< may be wrong altogether (a loop closure)
};

/// A measurement of where a camera stands in the world; may be wrong altogether.
struct PoseAnchor {
  std::size_t pose = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< of the twist at the camera
};

enum class PoseGraphStatus {
  kSolved,
  kUnderdetermined,  ///< solved; what no measurement fixes was kept near where it was
  kNothingToSolve,   ///< no usable measurement ties one pose to another; the poses were left as they were
  kNotFinite,        ///< a pose is no number; all were left as they were
  kFailed,           ///< the solver gave up; the poses were left as they were
};

/// The poses are at least as good as before.
constexpr bool is_usable(PoseGraphStatus status) {
  return status == PoseGraphStatus::kSolved || status == PoseGraphStatus::kUnderdetermined;
}

struct PoseGraphResult {
  PoseGraphStatus status = PoseGraphStatus::kFailed;
  std::size_t untied = 0;           ///< poses that no chain of measurements ties to what is held
  std::size_t free_directions = 0;  ///< of the other poses together, directions that nothing fixes
  double cost_before = 0.0;         ///< half the sum of squared residuals, in standard deviations
  double cost_after = 0.0;
  /// One a constraint: length of its residual after, in standard deviations.
  std::vector<double> residual_sigma;
};

/// The status in a sentence, with the numbers that belong to it.
std::string describe(const PoseGraphResult& result);

/// Moves T_world_camera to minimise the residuals of constraints and anchors. `held` has a value a pose;
/// empty holds the first one. Poses that no chain of constraints ties to a held or anchored one stay where
/// they are, and so do directions that nothing fixes; both are counted. Never throws; measurements with
/// indices out of range, numbers that are not finite, or information that is not positive semidefinite are
/// left out (residual_sigma -1), and so is what was measured between two that are held.
PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints,
                                    const std::vector<PoseAnchor>& anchors = {},
                                    const std::vector<bool>& held = {});

}  // namespace roomradar
