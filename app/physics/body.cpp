// body.cpp: pose, centre and inertia of a body in the world.
#include "app/physics/body.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

/// A freely rotating body: its angular momentum does not change.
struct FreeRotation {
  Eigen::Matrix3d inverse_inertia;  ///< in the body's axes, 1/m2
  Eigen::Vector3d momentum_world;

  [[nodiscard]] Eigen::Vector3d angular_rad_s(const Eigen::Quaterniond& q_world_body) const {
    return q_world_body * (inverse_inertia * (q_world_body.conjugate() * momentum_world));
  }
  /// Returns the derivative of the orientation by time.
  [[nodiscard]] Eigen::Vector4d rate(const Eigen::Vector4d& q_world_body) const {
    const Eigen::Quaterniond q(q_world_body);
    const Eigen::Vector3d w = angular_rad_s(q.normalized());
    return 0.5 * (Eigen::Quaterniond(0.0, w.x(), w.y(), w.z()) * q).coeffs();
  }
};

}  // namespace

double strayed_m(const Body& body, const Eigen::Isometry3d& T_world_before) {
  const Eigen::Matrix3d turned = T_world_before.linear().transpose() * body.T_world_object.linear();
  return (centre_world(body) - T_world_before * body.mass.centre_object).norm() +
         Eigen::AngleAxisd(turned).angle() * body.mass.radius_m;
}

Eigen::Vector3d centre_world(const Body& body) { return body.T_world_object * body.mass.centre_object; }

Eigen::Matrix3d inertia_world_m2(const Body& body) {
  const Eigen::Matrix3d R = body.T_world_object.linear();
  return R * body.mass.inertia_m2 * R.transpose();
}

Eigen::Vector3d mean_free_spin(const Body& body, const Eigen::Vector3d& angular_rad_s, double time_s) {
  constexpr double kStep_rad = 0.02;
  constexpr double kMaxSteps = 64.0;
  const double turn_rad = time_s * angular_rad_s.norm();
  if (!(turn_rad > 0.0)) return angular_rad_s;
  const FreeRotation rotation{body.mass.inertia_m2.inverse(), inertia_world_m2(body) * angular_rad_s};
  const Eigen::Quaterniond q_before(body.T_world_object.linear());
  const int steps = static_cast<int>(std::clamp(std::ceil(turn_rad / kStep_rad), 1.0, kMaxSteps));
  const double h = time_s / steps;
  Eigen::Vector4d q = q_before.coeffs();
  for (int i = 0; i < steps; ++i) {  // Runge-Kutta, fourth order
    const Eigen::Vector4d k1 = rotation.rate(q), k2 = rotation.rate(q + 0.5 * h * k1);
    const Eigen::Vector4d k3 = rotation.rate(q + 0.5 * h * k2), k4 = rotation.rate(q + h * k3);
    q = (q + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)).normalized();
  }
  const Eigen::AngleAxisd turned(Eigen::Quaterniond(q) * q_before.conjugate());
  return turned.angle() / time_s * turned.axis();
}

void note_contact(SurfaceKind touched, StepReport& report) {
  ++report.contacts;
  ++report.contacts_by_kind[static_cast<std::size_t>(touched)];
}

}  // namespace roomradar
