// frame_along.hpp: orthonormal frame with its z axis along a direction of motion, and a grid of square pixels
// across it.
#pragma once
#include <Eigen/Core>
#include <algorithm>
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

struct PixelGrid {
  double pixel_m = 0.0;
  int width_px = 0, height_px = 0;
};

/// Returns a grid of square pixels that covers the rectangle, with `resolution_px` pixels along the longer
/// side and at least one along the shorter. A rectangle without area (an object seen edge-on) gets pixels,
/// too.
inline PixelGrid fit_pixels(double width_m, double height_m, int resolution_px) {
  constexpr double kLeastSide_m = 1e-6;
  PixelGrid grid;
  grid.pixel_m = std::max({width_m, height_m, kLeastSide_m}) / resolution_px;
  const auto pixels = [&](double side_m) {
    return std::clamp(static_cast<int>(std::ceil(side_m / grid.pixel_m - 1e-9)), 1, resolution_px);
  };
  grid.width_px = pixels(width_m);
  grid.height_px = pixels(height_m);
  return grid;
}

}  // namespace roomradar
