// relative_pose_residual.hpp: Ceres residual of two camera poses and their measured relative pose.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roomradar {

/// Ceres functor over the poses of cameras a and b. Each pose is a translation (m) and a unit quaternion (x,
/// y, z, w). With E = T_a_b(measured)^-1 * T_world_a^-1 * T_world_b:
///   residual = S * (translation of E, 2 * vector part of the quaternion of E)
/// The quaternion's sign is chosen so that w is positive. S^T S is the information of the measurement. The
/// residual is thus in standard deviations, without a unit. Neither pose is constant in the functor. Source:
/// Ceres' pose_graph_3d example; Grisetti et al., A Tutorial on Graph-Based SLAM, 2010.
struct RelativePoseResidual {
  Eigen::Isometry3d T_b_a_measured;
  Eigen::Matrix<double, 6, 6> sqrt_information;

  template <typename T>
  bool operator()(const T* t_world_a, const T* q_world_a, const T* t_world_b, const T* q_world_b,
                  T* residual) const {
    const Eigen::Map<const Eigen::Matrix<T, 3, 1>> ta(t_world_a), tb(t_world_b);
    const Eigen::Map<const Eigen::Quaternion<T>> qa(q_world_a), qb(q_world_b);
    const Eigen::Quaternion<T> q_a_world = qa.conjugate();
    const Eigen::Matrix<T, 3, 1> t_a_b = q_a_world * (tb - ta);
    const Eigen::Quaternion<T> q_a_b = q_a_world * qb;
    const Eigen::Quaternion<T> q_b_a(Eigen::Quaterniond(T_b_a_measured.linear()).cast<T>());
    Eigen::Quaternion<T> q_error = q_b_a * q_a_b;
    if (q_error.w() < T(0)) q_error.coeffs() = -q_error.coeffs();
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = q_b_a * t_a_b + T_b_a_measured.translation().cast<T>();
    error.template tail<3>() = T(2) * q_error.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = sqrt_information.cast<T>() * error;
    return true;
  }
};

}  // namespace roomradar
