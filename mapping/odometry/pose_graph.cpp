// pose_graph.cpp: optimises poses to fit measured relative poses.
#include "mapping/odometry/pose_graph.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapping/odometry/relative_pose_residual.hpp"
#include "mapping/types/disjoint_sets.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

// Scale of the robust constraints' Cauchy loss, in standard deviations of the whole 6D residual. Larger
// residuals count linearly, then less.
constexpr double kRobustSigma = 4.0;

struct PoseBlock {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
};

/// A usable measurement of b in a. The world's index, for a, is the number of poses.
struct Measured {
  std::size_t a, b;
  Eigen::Isometry3d T_a_b;
  Matrix6d square_root;
  bool robust;
};

/// Returns S with S' S = information; nullopt if the matrix is not finite, zero, or not positive
/// semidefinite.
std::optional<Matrix6d> square_root(const Matrix6d& information) {
  if (!information.allFinite()) return std::nullopt;
  const SymmetricEigen<6> solved = symmetric_eigen(Matrix6d(0.5 * (information + information.transpose())));
  const double most = solved.values.maxCoeff();
  if (most <= 0.0 || solved.values.minCoeff() < -1e-9 * most) return std::nullopt;
  return solved.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * solved.vectors.transpose();
}

std::optional<Measured> usable(std::size_t a, std::size_t b, std::size_t count,
                               const Eigen::Isometry3d& T_a_b, const Matrix6d& information, bool robust) {
  if (a > count || b >= count || a == b || !T_a_b.matrix().allFinite()) return std::nullopt;
  const std::optional<Matrix6d> root = square_root(information);
  if (!root) return std::nullopt;
  return Measured{a, b, T_a_b, *root, robust};
}

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // SuiteSparse calls a BLAS whose threads wait for each other; a solve concurrent with tracking took up to
  // 30 s.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-4;  // smaller changes of the cost move poses by less than their error
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

/// Returns the measurements that can move a pose, constraints first.
/// @param count          number of poses
/// @param is_constant    callable with the index of a pose; true if the pose is constant
/// @param constraint_of  out: index in `constraints` of each measured constraint
template <typename IsConstant>
std::vector<Measured> usable_measurements(std::size_t count, const std::vector<PoseConstraint>& constraints,
                                          const std::vector<PoseAnchor>& anchors,
                                          const IsConstant& is_constant,
                                          std::vector<std::size_t>& constraint_of) {
  std::vector<Measured> measured;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const PoseConstraint& c = constraints[i];
    if (c.a >= count || (is_constant(c.a) && is_constant(c.b))) continue;  // both constant: moves nothing
    if (const auto m = usable(c.a, c.b, count, c.T_a_b, c.information, c.robust)) {
      measured.push_back(*m);
      constraint_of.push_back(i);
    }
  }
  for (const PoseAnchor& anchor : anchors) {
    if (anchor.pose < count && is_constant(anchor.pose)) continue;
    if (const auto m = usable(count, anchor.pose, count, anchor.T_world_camera, anchor.information, true))
      measured.push_back(*m);
  }
  return measured;
}

/// Returns each pose's index among the free poses: those that a chain of measurements connects to a constant
/// pose or the world. -1 for the others and the world, which comes last.
template <typename IsConstant>
std::vector<int> number_free_poses(std::size_t count, const std::vector<Measured>& measured,
                                   const IsConstant& is_constant) {
  DisjointSets<std::size_t> connected(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (is_constant(i)) connected.join(i, count);
  }
  for (const Measured& m : measured) connected.join(m.a, m.b);
  std::vector<int> place(count + 1, -1);
  int free_poses = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_constant(i)) continue;
    if (connected.find(i) == connected.find(count)) place[i] = free_poses++;
  }
  return place;
}

/// Adds a residual per measurement, and holds all poses without a place constant. The problem keeps pointers
/// to `blocks`.
std::vector<ceres::ResidualBlockId> add_residuals(const std::vector<Measured>& measured,
                                                  const std::vector<int>& place,
                                                  std::vector<PoseBlock>& blocks, ceres::Problem& problem) {
  std::vector<ceres::ResidualBlockId> ids;
  for (const Measured& m : measured) {
    auto* cost = new ceres::AutoDiffCostFunction<RelativePoseResidual, 6, 3, 4, 3, 4>(
        new RelativePoseResidual{m.T_a_b.inverse(), m.square_root});
    ids.push_back(problem.AddResidualBlock(cost, m.robust ? new ceres::CauchyLoss(kRobustSigma) : nullptr,
                                           blocks[m.a].t.data(), blocks[m.a].q.coeffs().data(),
                                           blocks[m.b].t.data(), blocks[m.b].q.coeffs().data()));
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!problem.HasParameterBlock(blocks[i].t.data())) continue;
    problem.SetManifold(blocks[i].q.coeffs().data(), new ceres::EigenQuaternionManifold);
    if (place[i] >= 0) continue;
    problem.SetParameterBlockConstant(blocks[i].t.data());
    problem.SetParameterBlockConstant(blocks[i].q.coeffs().data());
  }
  return ids;
}

}  // namespace

std::string describe(const PoseGraphResult& result) {
  switch (result.status) {
    case PoseGraphStatus::kSolved:
      return "the poses agree with what was measured between them";
    case PoseGraphStatus::kUnderdetermined:
      return "no measurement constrains " + std::to_string(result.untied) + " poses; these are unchanged";
    case PoseGraphStatus::kNothingToSolve:
      return "no usable measurement connects the poses; they are unchanged";
    case PoseGraphStatus::kNotFinite:
      return "a pose is not a number; all poses are unchanged";
    case PoseGraphStatus::kFailed:
      return "the poses cannot be made to agree; they are unchanged";
  }
  return "unknown";
}

PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints,
                                    const std::vector<PoseAnchor>& anchors,
                                    const std::vector<bool>& constant) {
  PoseGraphResult result;
  result.residual_sigma.assign(constraints.size(), -1.0);
  const std::size_t count = T_world_camera.size();
  std::vector<PoseBlock> blocks;
  blocks.reserve(count + 1);
  for (const Eigen::Isometry3d& T : T_world_camera) {
    if (!T.matrix().allFinite()) {
      result.status = PoseGraphStatus::kNotFinite;
      return result;
    }
    blocks.push_back({T.translation(), Eigen::Quaterniond(T.linear()).normalized()});
  }
  blocks.push_back({Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});

  const auto is_constant = [&](std::size_t i) {
    return constant.empty() ? i == 0 : i < constant.size() && constant[i];
  };
  std::vector<std::size_t> constraint_of;
  std::vector<Measured> measured =
      usable_measurements(count, constraints, anchors, is_constant, constraint_of);
  if (measured.empty()) {
    result.status = PoseGraphStatus::kNothingToSolve;
    return result;
  }

  const std::vector<int> place = number_free_poses(count, measured, is_constant);
  for (std::size_t i = 0; i < count; ++i) result.untied += !is_constant(i) && place[i] < 0 ? 1 : 0;

  ceres::Problem problem;
  const std::vector<ceres::ResidualBlockId> ids = add_residuals(measured, place, blocks, problem);
  measured = std::vector<Measured>();  // the problem has copies, and the solver needs memory
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  if (!summary.IsSolutionUsable()) return result;
  for (const PoseBlock& block : blocks) {
    if (!block.t.allFinite() || !block.q.coeffs().allFinite()) return result;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (place[i] < 0) continue;
    T_world_camera[i].translation() = blocks[i].t;
    T_world_camera[i].linear() = blocks[i].q.normalized().toRotationMatrix();
  }
  for (std::size_t i = 0; i < constraint_of.size(); ++i) {
    double half_square = 0.0;
    problem.EvaluateResidualBlock(ids[i], false, &half_square, nullptr, nullptr);
    result.residual_sigma[constraint_of[i]] = std::sqrt(2.0 * half_square);
  }
  result.cost_before = summary.initial_cost;
  result.cost_after = summary.final_cost;
  result.status = result.untied > 0 ? PoseGraphStatus::kUnderdetermined : PoseGraphStatus::kSolved;
  return result;
}

}  // namespace roomradar
