// frame_along.hpp: orthonormal frame with its z axis along a direction of motion.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace roomradar {

/// Returns the rotation into a right-handed frame whose z axis is the unit direction u. The rotation's rows
/// are the frame's x, y and z axes. Depends on u alone, so queries with equal directions use equal pixels.
/// Source: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
inline Eigen::Matrix3d frame_along(const Eigen::Vector3d& u) {
  const double sign = std::copysign(1.0, u.z());
  const double a = -1.0 / (sign + u.z());
  const double b = u.x() * u.y() * a;
  Eigen::Matrix3d R;
  R << 1.0 + sign * u.x() * u.x() * a, sign * b, -sign * u.x(),  //
      b, sign + u.y() * u.y() * a, -u.y(),                       //
      u.x(), u.y(), u.z();
  return R;
}

}  // namespace roomradar
