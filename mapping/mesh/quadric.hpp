// quadric.hpp: quadric error metric, a weighted sum of squared distances from a point to a set of planes.
#pragma once
#include <Eigen/Core>
#include <Eigen/LU>

namespace roomradar {

/// Quadric error p^T A p + 2 b . p + c. Source: Garland and Heckbert, Surface Simplification Using Quadric
/// Error Metrics, SIGGRAPH 1997, section 5.
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0.0;
  double weight = 0.0;  ///< sum of the planes' weights

  /// Adds the plane through `point` with this unit normal.
  void add_plane(const Eigen::Vector3d& unit_normal, const Eigen::Vector3d& point, double plane_weight) {
    const double offset = -unit_normal.dot(point);
    A += plane_weight * unit_normal * unit_normal.transpose();
    b += plane_weight * offset * unit_normal;
    c += plane_weight * offset * offset;
    weight += plane_weight;
  }
  Quadric& operator+=(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    weight += other.weight;
    return *this;
  }
  /// Returns the weighted sum of squared distances from p to the planes, >= 0.
  [[nodiscard]] double at(const Eigen::Vector3d& p) const {
    const double sum = p.dot(A * p) + 2.0 * b.dot(p) + c;
    return sum > 0.0 ? sum : 0.0;
  }
  /// Returns the least-squares intersection of all planes. Along poorly constrained directions, the result
  /// stays near `guess`.
  [[nodiscard]] Eigen::Vector3d nearest_to_all(const Eigen::Vector3d& guess) const {
    // Regularisation relative to trace(A); large enough that noise on a flat wall does not constrain the
    // point along the wall.
    constexpr double kHardly = 5e-3;
    const double trace = A.trace();
    if (!(trace > 0.0)) return guess;
    const Eigen::Matrix3d held = A + kHardly * trace * Eigen::Matrix3d::Identity();
    return guess - held.inverse() * (A * guess + b);
  }
};

}  // namespace roomradar
