// linear_algebra.hpp: wrappers of Eigen's solvers for small dense problems, so that these are compiled only
// once.
//
// Eigen's decompositions take seconds to compile in every source that instantiates them.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roomradar {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Eigenvalues in ascending order, and the unit eigenvector of each in the column of the same index.
template <int N>
struct SymmetricEigen {
  bool converged = false;
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Returns the eigendecomposition of a symmetric matrix. Reads only its lower triangle. `converged` is false
/// for matrices that are not finite.
SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A);
SymmetricEigen<6> symmetric_eigen(const Matrix6d& A);

/// Returns the x that solves A x = b by LDLT with pivoting. A must be symmetric and positive or negative
/// semidefinite. The result is not finite if A or b is not.
Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);
Vector6d solve_symmetric(const Matrix6d& A, const Vector6d& b);

/// Returns the inverse, by LU decomposition. The result is not finite if A is singular.
Matrix6d inverse(const Matrix6d& A);

/// Returns the orthogonal matrix nearest to A in the least-squares sense, U V' of A's singular value
/// decomposition. Its determinant is -1 if A's is negative.
Eigen::Matrix3d nearest_orthogonal(const Eigen::Matrix3d& A);

/// Returns the length of a motion, in m; a radian of rotation counts as 1 m.
double motion_length_m(const Eigen::Isometry3d& T);

/// Returns the smallest rotation from one direction to another. Neither may be zero.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Returns the T_b_a that minimises the sum of |T_b_a a_i - b_i|^2, without scale. Points are in columns.
/// Source: Umeyama, Least-squares estimation of transformation parameters, PAMI 1991.
Eigen::Isometry3d fit_rigid(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b);

}  // namespace roomradar
