// linear_algebra.cpp: the instantiations of Eigen's decompositions.
#include "mapping/types/linear_algebra.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace roomradar {
namespace {

template <int N>
SymmetricEigen<N> decomposed(const Eigen::Matrix<double, N, N>& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(A);
  return {solver.info() == Eigen::Success, solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A) { return decomposed<3>(A); }
SymmetricEigen<6> symmetric_eigen(const Matrix6d& A) { return decomposed<6>(A); }

Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  return A.ldlt().solve(b);
}
Vector6d solve_symmetric(const Matrix6d& A, const Vector6d& b) { return A.ldlt().solve(b); }

Matrix6d inverse(const Matrix6d& A) { return A.inverse(); }

Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& A) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

double motion_length_m(const Eigen::Isometry3d& T) {
  return T.translation().norm() + Eigen::AngleAxisd(T.linear()).angle();
}

// Eigen's FromTwoVectors() decomposes a matrix to find the axis of a half turn. That takes 7 s to compile,
// and loses half of the digits near a half turn.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kNearHalfTurn = -0.99, kHalfTurn_rad = 1e-12;
  const Eigen::Vector3d from_unit = from.normalized(), to_unit = to.normalized();
  const double cosine = to_unit.dot(from_unit);
  const Eigen::Vector3d axis = from_unit.cross(to_unit);
  Eigen::Quaterniond rotation;
  if (cosine > kNearHalfTurn) {
    const double twice_w = std::sqrt(2.0 * (1.0 + cosine));
    rotation.w() = 0.5 * twice_w;
    rotation.vec() = axis * (1.0 / twice_w);
  } else if (axis.norm() > kHalfTurn_rad) {
    rotation.w() = 0.5 * (from_unit + to_unit).norm();
    rotation.vec() = axis.normalized() * (0.5 * (to_unit - from_unit).norm());
  } else {
    rotation.w() = 0.0;
    rotation.vec() = from_unit.unitOrthogonal();
  }
  return rotation;
}

Eigen::Isometry3d fit_rigid(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  Eigen::Isometry3d T_b_a;
  T_b_a.matrix() = Eigen::umeyama(a, b, /*with_scaling=*/false);
  return T_b_a;
}

}  // namespace roomradar
