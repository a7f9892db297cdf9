// pose_graph.hpp: optimises poses to fit measured relative poses.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {

/// Measured pose of camera b in camera a.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< for a twist (translation m, rotation rad) at camera b
  bool robust = false;                          ///< may be an outlier (a loop closure)
};

/// Measured pose of a camera in the world; may be an outlier.
struct PoseAnchor {
  std::size_t pose = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Identity();  ///< for a twist at the camera
};

enum class PoseGraphStatus {
  kSolved,
  kUnderdetermined,  ///< solved; unconstrained poses and directions stay near their initial values
  kNothingToSolve,   ///< no usable measurement involves a free pose; poses unchanged
  kNotFinite,        ///< a pose is not finite; poses unchanged
  kFailed,           ///< the solver failed; poses unchanged
};

/// Returns whether the poses are at least as good as before.
constexpr bool is_usable(PoseGraphStatus status) {
  return status == PoseGraphStatus::kSolved || status == PoseGraphStatus::kUnderdetermined;
}

struct PoseGraphResult {
  PoseGraphStatus status = PoseGraphStatus::kFailed;
  std::size_t untied = 0;  ///< poses that no chain of measurements connects to a constant pose or an anchor
  std::size_t free_directions = 0;  ///< unconstrained directions, summed over the other poses
  double cost_before = 0.0;         ///< half the sum of squared residuals, in standard deviations
  double cost_after = 0.0;
  /// Per constraint: length of its final residual, in standard deviations; -1: left out.
  std::vector<double> residual_sigma;
};

/// Returns the status as a sentence, with its numbers.
std::string describe(const PoseGraphResult& result);

/// Moves T_world_camera to minimise the residuals of constraints and anchors. `held` marks constant poses,
/// one value per pose; if empty, the first pose is constant. Poses without a chain of measurements to a
/// constant pose or an anchor stay unchanged, as do unconstrained directions; both are counted. Never throws.
/// Leaves out measurements between two constant poses, and invalid ones: index out of range, a number that is
/// not finite, information that is not positive semidefinite. Their residual_sigma is -1.
PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints,
                                    const std::vector<PoseAnchor>& anchors = {},
                                    const std::vector<bool>& held = {});

}  // namespace roomradar
