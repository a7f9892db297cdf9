// pose_graph.cpp: the poses that agree best with many measured relative poses.
#include "mapping/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "mapping/relative_pose_residual.hpp"

namespace roomradar {
namespace {

// Residuals of robust constraints past this many standard deviations (of six together) count linearly, then
// less.
constexpr double kRobustSigma = 4.0;

struct PoseBlock {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
};

/// S with S' S = information, or nothing if the matrix is no information.
std::optional<Matrix6d> square_root(const Matrix6d& information) {
  if (!information.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(0.5 * (information + information.transpose()));
  const double most = solver.eigenvalues().maxCoeff();
  if (most <= 0.0 || solver.eigenvalues().minCoeff() < -1e-9 * most) return std::nullopt;
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
}

std::size_t root_of(std::vector<std::size_t>& parent, std::size_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

PoseGraphResult optimise_pose_graph(std::vector<Eigen::Isometry3d>& T_world_camera,
                                    const std::vector<PoseConstraint>& constraints) {
  PoseGraphResult result;
  result.residual_sigma.assign(constraints.size(), -1.0);
  if (T_world_camera.empty()) return result;

  std::vector<PoseBlock> blocks;
  blocks.reserve(T_world_camera.size());
  for (const Eigen::Isometry3d& T : T_world_camera) {
    if (!T.matrix().allFinite()) return result;
    blocks.push_back({T.translation(), Eigen::Quaterniond(T.linear()).normalized()});
  }

  std::vector<std::size_t> parent(blocks.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  ceres::Problem problem;
  std::vector<ceres::ResidualBlockId> ids(constraints.size(), nullptr);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const PoseConstraint& c = constraints[i];
    if (c.a >= blocks.size() || c.b >= blocks.size() || c.a == c.b || !c.T_a_b.matrix().allFinite()) continue;
    const std::optional<Matrix6d> root = square_root(c.information);
    if (!root) continue;
    auto* cost = new ceres::AutoDiffCostFunction<RelativePoseResidual, 6, 3, 4, 3, 4>(
        new RelativePoseResidual{c.T_a_b.inverse(), *root});
    ids[i] = problem.AddResidualBlock(cost, c.robust ? new ceres::CauchyLoss(kRobustSigma) : nullptr,
                                      blocks[c.a].t.data(), blocks[c.a].q.coeffs().data(),
                                      blocks[c.b].t.data(), blocks[c.b].q.coeffs().data());
    parent[root_of(parent, c.a)] = root_of(parent, c.b);
  }
  if (problem.NumResidualBlocks() == 0) return result;

  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!problem.HasParameterBlock(blocks[i].t.data())) continue;
    problem.SetManifold(blocks[i].q.coeffs().data(), new ceres::EigenQuaternionManifold);
    if (i != 0 && root_of(parent, i) == root_of(parent, 0)) continue;
    problem.SetParameterBlockConstant(blocks[i].t.data());
    problem.SetParameterBlockConstant(blocks[i].q.coeffs().data());
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return result;

  for (const PoseBlock& block : blocks) {
    if (!block.t.allFinite() || !block.q.coeffs().allFinite()) return result;
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    T_world_camera[i].translation() = blocks[i].t;
    T_world_camera[i].linear() = blocks[i].q.normalized().toRotationMatrix();
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == nullptr) continue;
    double half_square = 0.0;
    problem.EvaluateResidualBlock(ids[i], false, &half_square, nullptr, nullptr);
    result.residual_sigma[i] = std::sqrt(2.0 * half_square);
  }
  result.cost_before = summary.initial_cost;
  result.cost_after = summary.final_cost;
  result.usable = true;
  return result;
}

}  // namespace roomradar
