// body.cpp: pose, centre and inertia of a body in the world.
#include "app/physics/body.hpp"

#include <Eigen/LU>

namespace roomradar {

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
  const double speed_rad_s = angular_rad_s.norm();
  if (!(speed_rad_s > 0.0)) return angular_rad_s;
  const Eigen::Matrix3d R_half = Eigen::AngleAxisd(0.5 * time_s * speed_rad_s, angular_rad_s / speed_rad_s) *
                                 body.T_world_object.linear();
  const Eigen::Matrix3d inertia_half = R_half * body.mass.inertia_m2 * R_half.transpose();
  return inertia_half.inverse() * (inertia_world_m2(body) * angular_rad_s);
}

void note_contact(SurfaceKind touched, StepReport& report) {
  ++report.contacts;
  ++report.contacts_by_kind[static_cast<std::size_t>(touched)];
}

}  // namespace roomradar
