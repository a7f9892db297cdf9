// frame_along.hpp: the frame of a motion: two axes across a direction, then the direction.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace roomradar {

/// Rows: x and y across the direction, then the direction, which has length 1; right-handed. A function of
/// the direction alone, so that the same direction has the same pixels. Source: Duff et al., Building an
/// Orthonormal Basis, Revisited, JCGT 6(1), 2017.
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
