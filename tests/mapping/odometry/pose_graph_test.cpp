// pose_graph_test.cpp: poses from relative measurements, and the residual's derivatives.
#include "mapping/odometry/pose_graph.hpp"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "mapping/odometry/relative_pose_residual.hpp"

namespace roomradar::pose_graph_test {
namespace {

Eigen::Isometry3d pose(double x, double y, double z, double yaw_rad, double roll_rad = 0.0) {
  return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

/// Ten cameras on a circle, each measured relative to the previous one, and the first relative to the last.
struct Circle {
  std::vector<Eigen::Isometry3d> truth;
  std::vector<PoseConstraint> constraints;
};

Circle circle() {
  Circle c;
  constexpr int kPoses = 10;
  for (int i = 0; i < kPoses; ++i) {
    const double a = 2.0 * 3.14159265358979 * i / kPoses;
    c.truth.push_back(pose(std::cos(a), std::sin(a), 0.1 * i, a, 0.05 * i));
  }
  for (std::size_t i = 0; i < kPoses; ++i) {
    const std::size_t next = (i + 1) % kPoses;
    c.constraints.push_back(
        {i, next, c.truth[i].inverse() * c.truth[next], 1e4 * Matrix6d::Identity(), false});
  }
  return c;
}

/// Returns the true poses, all but the first disturbed.
std::vector<Eigen::Isometry3d> disturbed(const std::vector<Eigen::Isometry3d>& truth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-0.1, 0.1);
  std::vector<Eigen::Isometry3d> poses = truth;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    poses[i] = poses[i] * pose(off(random), off(random), off(random), off(random), off(random));
  }
  return poses;
}

double worst_error_m(const std::vector<Eigen::Isometry3d>& poses,
                     const std::vector<Eigen::Isometry3d>& truth) {
  double worst = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    worst = std::max(worst, (poses[i].matrix() - truth[i].matrix()).cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(RelativePoseResidual, DerivativeIsTheNumericOne) {
  const Eigen::Isometry3d T_world_a = pose(1, 2, 3, 0.4, -0.2), T_world_b = pose(1.5, 1.7, 3.2, 0.9, 0.3);
  const Eigen::Isometry3d measured = T_world_a.inverse() * T_world_b * pose(0.02, -0.01, 0.03, 0.05, -0.04);
  Matrix6d S = Matrix6d::Identity();
  S(0, 1) = 0.5, S(3, 5) = -0.7, S(2, 2) = 3.0;
  const ceres::AutoDiffCostFunction<RelativePoseResidual, 6, 3, 4, 3, 4> cost(
      new RelativePoseResidual{measured.inverse(), S});
  std::array<Eigen::VectorXd, 4> blocks{
      T_world_a.translation(), Eigen::Quaterniond(T_world_a.linear()).coeffs(), T_world_b.translation(),
      Eigen::Quaterniond(T_world_b.linear()).coeffs()};
  const auto evaluate = [&](Eigen::Matrix<double, 6, 1>& residual, double** jacobians) {
    const std::array<const double*, 4> parameters{blocks[0].data(), blocks[1].data(), blocks[2].data(),
                                                  blocks[3].data()};
    ASSERT_TRUE(cost.Evaluate(parameters.data(), residual.data(), jacobians));
  };
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  std::array<Jacobian, 4> analytic{Jacobian(6, 3), Jacobian(6, 4), Jacobian(6, 3), Jacobian(6, 4)};
  std::array<double*, 4> jacobians{analytic[0].data(), analytic[1].data(), analytic[2].data(),
                                   analytic[3].data()};
  Eigen::Matrix<double, 6, 1> residual, ahead, behind;
  evaluate(residual, jacobians.data());
  EXPECT_GT(residual.norm(), 0.05);
  constexpr double kStep = 1e-6;
  for (std::size_t block = 0; block < 4; ++block) {
    for (Eigen::Index k = 0; k < blocks[block].size(); ++k) {
      const double value = blocks[block](k);
      blocks[block](k) = value + kStep;
      evaluate(ahead, nullptr);
      blocks[block](k) = value - kStep;
      evaluate(behind, nullptr);
      blocks[block](k) = value;
      const Eigen::Matrix<double, 6, 1> numeric = (ahead - behind) / (2.0 * kStep);
      EXPECT_TRUE(numeric.isApprox(analytic[block].col(k), 1e-6)) << "block " << block << " column " << k;
    }
  }
}

TEST(PoseGraph, ExactMeasurementsGiveTheExactPoses) {
  const Circle c = circle();
  std::vector<Eigen::Isometry3d> poses = disturbed(c.truth);
  const PoseGraphResult result = optimise_pose_graph(poses, c.constraints);
  EXPECT_TRUE(is_usable(result.status));
  EXPECT_LT(worst_error_m(poses, c.truth), 1e-6);
  EXPECT_GT(result.cost_before, 1.0);
  EXPECT_LT(result.cost_after, 1e-6);
  EXPECT_TRUE(poses[0].isApprox(c.truth[0]));  // the first is fixed
}

TEST(PoseGraph, AWrongLoopIsRefused) {
  Circle c = circle();
  c.constraints.push_back({2, 7, pose(0.1, 0, 0, 0), 1e4 * Matrix6d::Identity(), true});
  std::vector<Eigen::Isometry3d> poses = disturbed(c.truth);
  const PoseGraphResult result = optimise_pose_graph(poses, c.constraints);
  EXPECT_TRUE(is_usable(result.status));
  EXPECT_LT(worst_error_m(poses, c.truth), 0.01);
  EXPECT_GT(result.residual_sigma.back(), 10.0 * result.residual_sigma.front());
}

TEST(PoseGraph, WhatNothingMeasuresStaysFinite) {
  // No constraint measures the heights: information without the z row is rank deficient.
  Circle c = circle();
  for (PoseConstraint& constraint : c.constraints) {
    constraint.information.row(2).setZero();
    constraint.information.col(2).setZero();
  }
  std::vector<Eigen::Isometry3d> poses = disturbed(c.truth);
  const PoseGraphResult result = optimise_pose_graph(poses, c.constraints);
  for (const Eigen::Isometry3d& T : poses) EXPECT_TRUE(T.matrix().allFinite());
  EXPECT_TRUE(is_usable(result.status));
  EXPECT_EQ(result.untied, 0U);
}

TEST(PoseGraph, ParallelConstraintsThatMissADirectionLeaveItFree) {
  // Two cameras, three measurements between them, none of which measures the translation along x (a
  // corridor).
  Matrix6d corridor = 1e4 * Matrix6d::Identity();
  corridor(0, 0) = 0.0;
  const Eigen::Isometry3d T = pose(1, 0.2, 0.1, 0.0);
  const std::vector<PoseConstraint> constraints(3, {0, 1, T, corridor, false});
  std::vector<Eigen::Isometry3d> poses{Eigen::Isometry3d::Identity(), pose(1.5, 0, 0, 0.1)};
  EXPECT_TRUE(is_usable(optimise_pose_graph(poses, constraints).status));
  EXPECT_NEAR(poses[1].translation().y(), 0.2, 1e-6);
  EXPECT_NEAR(poses[1].translation().z(), 0.1, 1e-6);
  EXPECT_NEAR(poses[1].translation().x(), 1.5, 0.05);  // stays near its initial value
}

TEST(PoseGraph, NothingHeldAndNothingAnchoredStays) {
  const Circle c = circle();
  const std::vector<Eigen::Isometry3d> before = disturbed(c.truth);
  std::vector<Eigen::Isometry3d> poses = before;
  const PoseGraphResult result =
      optimise_pose_graph(poses, c.constraints, {}, std::vector<bool>(poses.size(), false));
  EXPECT_EQ(result.untied, poses.size());
  EXPECT_EQ(result.status, PoseGraphStatus::kUnderdetermined);
  EXPECT_NE(describe(result).find(std::to_string(poses.size()) + " poses"), std::string::npos);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_TRUE(poses[i].isApprox(before[i])) << i;
}

TEST(PoseGraph, AnchorsSayWhereInTheWorldItIs) {
  const Circle c = circle();
  const Eigen::Isometry3d T_map_world = pose(3, -2, 0.5, 1.0);
  std::vector<PoseAnchor> anchors;
  for (const std::size_t i : {std::size_t{2}, std::size_t{6}})
    anchors.push_back({i, T_map_world * c.truth[i], 1e4 * Matrix6d::Identity()});
  anchors.push_back({4, pose(9, 9, 9, 0), 1e4 * Matrix6d::Identity()});  // wrong: mistaken for another place
  anchors.push_back({99, pose(0, 0, 0, 0), Matrix6d::Identity()});       // no such pose
  std::vector<Eigen::Isometry3d> poses = c.truth, truth = c.truth;
  for (Eigen::Isometry3d& T : poses) T = T_map_world * pose(0.1, 0.1, 0, 0.05) * T;
  for (Eigen::Isometry3d& T : truth) T = T_map_world * T;
  const PoseGraphResult result =
      optimise_pose_graph(poses, c.constraints, anchors, std::vector<bool>(poses.size(), false));
  EXPECT_EQ(result.status, PoseGraphStatus::kSolved);
  EXPECT_LT(worst_error_m(poses, truth), 0.02);
}

TEST(PoseGraph, HeldPosesStayAndOthersMove) {
  const Circle c = circle();
  std::vector<Eigen::Isometry3d> poses = disturbed(c.truth);
  poses[4] = c.truth[4];
  std::vector<bool> held(poses.size(), false);
  held[0] = held[4] = true;
  std::vector<PoseConstraint> constraints = c.constraints;
  constraints.push_back(
      {.a = 0, .b = 4, .T_a_b = Eigen::Isometry3d::Identity()});  // wrong, and moves nothing
  const PoseGraphResult result = optimise_pose_graph(poses, constraints, {}, held);
  EXPECT_EQ(result.status, PoseGraphStatus::kSolved);
  EXPECT_EQ(result.residual_sigma.back(), -1.0);
  EXPECT_EQ(poses[4].matrix(), c.truth[4].matrix());
  EXPECT_LT(worst_error_m(poses, c.truth), 1e-6);
}

TEST(PoseGraph, APoseThatIsNoNumberIsSaid) {
  const Circle c = circle();
  std::vector<Eigen::Isometry3d> poses = c.truth;
  poses[3].translation().x() = std::numeric_limits<double>::quiet_NaN();
  const PoseGraphResult result = optimise_pose_graph(poses, c.constraints);
  EXPECT_EQ(result.status, PoseGraphStatus::kNotFinite);
  EXPECT_EQ(poses[5].matrix(), c.truth[5].matrix());
}

TEST(PoseGraph, PosesWithoutAWayToTheFirstStay) {
  Circle c = circle();
  c.constraints.resize(4);  // 0-1-2-3-4
  c.constraints.push_back({7, 8, pose(5, 5, 5, 1.0), Matrix6d::Identity(), false});
  const std::vector<Eigen::Isometry3d> before = disturbed(c.truth);
  std::vector<Eigen::Isometry3d> poses = before;
  EXPECT_EQ(optimise_pose_graph(poses, c.constraints).status, PoseGraphStatus::kUnderdetermined);
  EXPECT_LT((poses[4].matrix() - c.truth[4].matrix()).norm(), 1e-6);
  for (std::size_t i = 5; i < poses.size(); ++i) EXPECT_TRUE(poses[i].isApprox(before[i])) << i;
}

TEST(PoseGraph, BrokenConstraintsAreLeftOut) {
  Circle c = circle();
  const std::size_t good = c.constraints.size();
  c.constraints.push_back({0, 99, pose(0, 0, 0, 0), Matrix6d::Identity(), false});
  c.constraints.push_back({3, 3, pose(1, 0, 0, 0), Matrix6d::Identity(), false});
  c.constraints.push_back(
      {0, 5, pose(std::numeric_limits<double>::quiet_NaN(), 0, 0, 0), Matrix6d::Identity(), false});
  c.constraints.push_back({0, 5, pose(9, 9, 9, 0), -Matrix6d::Identity(), false});
  std::vector<Eigen::Isometry3d> poses = disturbed(c.truth);
  const PoseGraphResult result = optimise_pose_graph(poses, c.constraints);
  EXPECT_TRUE(is_usable(result.status));
  EXPECT_LT(worst_error_m(poses, c.truth), 1e-6);
  for (std::size_t i = good; i < c.constraints.size(); ++i) EXPECT_EQ(result.residual_sigma[i], -1.0);
}

TEST(PoseGraph, NothingToDoIsNotUsable) {
  std::vector<Eigen::Isometry3d> none, one{pose(1, 2, 3, 0.5)};
  EXPECT_EQ(optimise_pose_graph(none, {}).status, PoseGraphStatus::kNothingToSolve);
  EXPECT_EQ(optimise_pose_graph(one, {}).status, PoseGraphStatus::kNothingToSolve);
  EXPECT_TRUE(one[0].isApprox(pose(1, 2, 3, 0.5)));
}

}  // namespace
}  // namespace roomradar::pose_graph_test
