// solid.cpp: exact signed distances and ray entries of inflated boxes and cylinders.
#include "app/sim/solids/solid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

Eigen::Isometry3d placed(const Vector3d& centre_world, double yaw_rad) {
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();
  T_world_solid.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T_world_solid.translation() = centre_world;
  return T_world_solid;
}

/// Returns the ray's entry into an origin-centred box; negative if it misses or starts inside.
double box_entry(const Vector3d& half_m, const Vector3d& o, const Vector3d& d) {
  double t_in = -std::numeric_limits<double>::infinity();
  double t_out = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0.0) {
      if (std::abs(o[axis]) > half_m[axis]) return -1.0;
      continue;
    }
    const double inverse = 1.0 / d[axis];
    const double at_centre = -o[axis] * inverse;
    const double half_t = half_m[axis] * std::abs(inverse);
    t_in = std::max(t_in, at_centre - half_t);
    t_out = std::min(t_out, at_centre + half_t);
  }
  return t_in <= t_out ? t_in : -1.0;
}

/// Returns the ray's entry into an origin-centred cylinder about z; negative if it misses or starts inside.
double cylinder_entry(double radius_m, double half_height_m, const Vector3d& o, const Vector3d& d) {
  double t_in = -std::numeric_limits<double>::infinity();
  double t_out = std::numeric_limits<double>::infinity();
  if (d.z() == 0.0) {
    if (std::abs(o.z()) > half_height_m) return -1.0;
  } else {
    const double at_centre = -o.z() / d.z();
    const double half_t = half_height_m / std::abs(d.z());
    t_in = at_centre - half_t;
    t_out = at_centre + half_t;
  }
  const double a = d.x() * d.x() + d.y() * d.y();
  const double c = o.x() * o.x() + o.y() * o.y() - radius_m * radius_m;
  if (a == 0.0) {
    if (c > 0.0) return -1.0;
  } else {
    const double b = o.x() * d.x() + o.y() * d.y();
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return -1.0;
    const double root = std::sqrt(discriminant);
    t_in = std::max(t_in, (-b - root) / a);
    t_out = std::min(t_out, (-b + root) / a);
  }
  return t_in <= t_out ? t_in : -1.0;
}

double sphere_entry(double radius_m, const Vector3d& o, const Vector3d& d) {
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double c = o.squaredNorm() - radius_m * radius_m;
  const double discriminant = b * b - a * c;
  return discriminant < 0.0 ? -1.0 : (-b - std::sqrt(discriminant)) / a;
}

/// Newton's method on the signed distance along the ray, a convex function for a convex solid. Started
/// outside, it converges monotonically to the first root, or finds that the distance grows, so the ray
/// misses.
double convex_entry(const Solid& solid, const Vector3d& o, const Vector3d& d) {
  const Vector3d bounds_m = bounds_half_m(solid);
  double t = box_entry(bounds_m, o, d);
  if (t < 0.0) {
    // The ray may start between the bounding box and the rounded solid.
    if ((o.cwiseAbs() - bounds_m).maxCoeff() > 0.0 || signed_distance_local_m(solid, o) <= 0.0) return -1.0;
    t = 0.0;
  }
  constexpr double kNearEnough_m = 1e-10;
  for (int step = 0; step < 64; ++step) {
    const Vector3d p = o + t * d;
    const double distance_m = signed_distance_local_m(solid, p);
    if (distance_m < kNearEnough_m) return t;
    const double slope = normal_local(solid, p).dot(d);
    if (slope >= 0.0) return -1.0;
    t -= distance_m / slope;
  }
  return -1.0;  // grazing: touches in at most one point
}

}  // namespace

Solid box(const Vector3d& centre_world, const Vector3d& size_m, double yaw_rad) {
  return {SolidShape::kBox, placed(centre_world, yaw_rad), 0.5 * size_m, 0.0};
}

Solid rounded_box(const Vector3d& centre_world, const Vector3d& size_m, double round_m, double yaw_rad) {
  return {SolidShape::kBox, placed(centre_world, yaw_rad), 0.5 * size_m - Vector3d::Constant(round_m),
          round_m};
}

Solid cylinder(const Vector3d& foot_world, double radius_m, double height_m) {
  return {SolidShape::kCylinder,
          placed(foot_world + Vector3d(0, 0, 0.5 * height_m), 0.0),
          {radius_m, radius_m, 0.5 * height_m},
          0.0};
}

Solid sphere(const Vector3d& centre_world, double radius_m) {
  return {SolidShape::kBox, placed(centre_world, 0.0), Vector3d::Zero(), radius_m};
}

Solid capsule(const Vector3d& a_world, const Vector3d& b_world, double radius_m) {
  Solid solid{
      SolidShape::kBox, Eigen::Isometry3d::Identity(), {0, 0, 0.5 * (b_world - a_world).norm()}, radius_m};
  solid.T_world_solid.linear() = rotation_between(Vector3d::UnitZ(), b_world - a_world).toRotationMatrix();
  solid.T_world_solid.translation() = 0.5 * (a_world + b_world);
  return solid;
}

double signed_distance_local_m(const Solid& solid, const Vector3d& p) {
  if (solid.shape == SolidShape::kBox) {
    const Vector3d beyond = p.cwiseAbs() - solid.half_m;
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0) - solid.round_m;
  }
  const double beyond_side = std::hypot(p.x(), p.y()) - solid.half_m.x();
  const double beyond_cap = std::abs(p.z()) - solid.half_m.z();
  return std::hypot(std::max(beyond_side, 0.0), std::max(beyond_cap, 0.0)) +
         std::min(std::max(beyond_side, beyond_cap), 0.0) - solid.round_m;
}

double signed_distance_m(const Solid& solid, const Vector3d& p_world) {
  return signed_distance_local_m(
      solid, solid.T_world_solid.linear().transpose() * (p_world - solid.T_world_solid.translation()));
}

Vector3d normal_local(const Solid& solid, const Vector3d& p) {
  const auto signed_unit = [](double of) { return of < 0.0 ? -1.0 : 1.0; };
  if (solid.shape == SolidShape::kBox) {
    const Vector3d beyond = p.cwiseAbs() - solid.half_m;
    int axis = 0;
    const double most = beyond.maxCoeff(&axis);
    Vector3d normal = Vector3d::Zero();
    if (most <= 0.0 || (solid.round_m == 0.0 && most < 1e-9)) {
      normal[axis] = signed_unit(p[axis]);
      return normal;
    }
    for (int i = 0; i < 3; ++i) normal[i] = std::max(beyond[i], 0.0) * signed_unit(p[i]);
    return normal.normalized();
  }
  const double radial_m = std::hypot(p.x(), p.y());
  const double beyond_side = radial_m - solid.half_m.x();
  const double beyond_cap = std::abs(p.z()) - solid.half_m.z();
  const Vector3d outward =
      radial_m > 0.0 ? Vector3d(p.x() / radial_m, p.y() / radial_m, 0.0) : Vector3d::UnitX();
  const Vector3d up = Vector3d::UnitZ() * signed_unit(p.z());
  const double most = std::max(beyond_side, beyond_cap);
  if (most <= 0.0 || (solid.round_m == 0.0 && most < 1e-9)) return beyond_side > beyond_cap ? outward : up;
  return (std::max(beyond_side, 0.0) * outward + std::max(beyond_cap, 0.0) * up).normalized();
}

double ray_entry_local(const Solid& solid, const Vector3d& o, const Vector3d& d) {
  if (solid.round_m == 0.0) {
    return solid.shape == SolidShape::kBox ? box_entry(solid.half_m, o, d)
                                           : cylinder_entry(solid.half_m.x(), solid.half_m.z(), o, d);
  }
  if (solid.half_m.isZero(0.0)) return sphere_entry(solid.round_m, o, d);
  return convex_entry(solid, o, d);
}

}  // namespace roomradar
