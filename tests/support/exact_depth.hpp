// exact_depth.hpp: noise-free depth images of simple scenes, from a ray through each pixel's centre.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>

#include "mapping/types/frame.hpp"

namespace roomradar::test {

/// Distance along a ray (from, direction; any length) to the first hit, in units of the direction's length;
/// infinity if nothing is hit.
using Scene = std::function<double(const Eigen::Vector3d& from, const Eigen::Vector3d& direction)>;

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

/// Plane of the points with normal . p = offset, visible from both sides.
inline Scene plane(const Eigen::Vector3d& normal, double offset_m) {
  return [=](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    const double t = (offset_m - normal.dot(from)) / normal.dot(direction);
    return t > 0.0 ? t : kNoHit;
  };
}

inline Scene sphere(const Eigen::Vector3d& centre, double radius_m) {
  return [=](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d to_centre = centre - from;
    const double a = direction.squaredNorm();
    const double b = direction.dot(to_centre);
    const double discriminant = b * b - a * (to_centre.squaredNorm() - radius_m * radius_m);
    if (discriminant < 0.0) return kNoHit;
    const double t = (b - std::sqrt(discriminant)) / a;
    return t > 0.0 ? t : kNoHit;
  };
}

inline Scene box(const Eigen::AlignedBox3d& bounds) {
  return [=](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    const Eigen::Array3d low = (bounds.min() - from).array() / direction.array();
    const Eigen::Array3d high = (bounds.max() - from).array() / direction.array();
    const double enter = low.min(high).maxCoeff();
    const double leave = low.max(high).minCoeff();
    return enter > 0.0 && enter <= leave ? enter : kNoHit;
  };
}

inline Scene nearest_of(Scene a, Scene b) {
  return [a = std::move(a), b = std::move(b)](const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
    return std::min(a(from, direction), b(from, direction));
  };
}

/// Corner of a room with a ball in it: floor at z = 0, walls at y = 2.5 and x = -1.8.
inline Scene corner_with_ball() {
  return nearest_of(nearest_of(plane({0, 0, 1}, 0.0), plane({0, 1, 0}, 2.5)),
                    nearest_of(plane({1, 0, 0}, -1.8), sphere({0.5, 1.8, 0.4}, 0.4)));
}

/// Returns the pose of a camera at `eye_world` that looks at `target_world`. The image's down axis points
/// roughly along -up_world.
inline Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world,
                                    const Eigen::Vector3d& up_world = Eigen::Vector3d::UnitZ()) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d forward = (target_world - eye_world).normalized();
  const Eigen::Vector3d right = forward.cross(up_world).normalized();
  T_world_camera.linear().col(0) = right;
  T_world_camera.linear().col(1) = forward.cross(right);
  T_world_camera.linear().col(2) = forward;
  T_world_camera.translation() = eye_world;
  return T_world_camera;
}

/// Renders a frame with exact depth and pose. If `colour` is given, the whole image has that colour;
/// otherwise the frame has no colour image.
inline Frame exact_frame(const Scene& scene, const Intrinsics& camera,
                         const Eigen::Isometry3d& T_world_camera, std::optional<Rgb> colour = std::nullopt) {
  Frame frame;
  frame.depth_camera = frame.colour_camera = camera;
  frame.T_world_camera = T_world_camera;
  frame.depth_m.resize(camera.width_px, camera.height_px);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const double depth_m =
          scene(T_world_camera.translation(), T_world_camera.linear() * back_project(camera, x, y, 1.0));
      frame.depth_m.at(x, y) = std::isfinite(depth_m) ? static_cast<float>(depth_m) : 0.0F;
    }
  if (colour) frame.colour.resize(camera.width_px, camera.height_px, *colour);
  return frame;
}

/// Walls of a room of 4 x 5 m, a ball and two boxes, without floor and ceiling.
inline Scene walls_and_things() {
  const Scene walls = nearest_of(nearest_of(plane({0, 1, 0}, 2.5), plane({0, 1, 0}, -2.5)),
                                 nearest_of(plane({1, 0, 0}, 2.0), plane({1, 0, 0}, -2.0)));
  const Scene boxes = nearest_of(box({Eigen::Vector3d(-1.9, 1.2, 0.0), Eigen::Vector3d(-1.0, 2.4, 0.8)}),
                                 box({Eigen::Vector3d(1.1, -2.4, 0.0), Eigen::Vector3d(1.9, -1.0, 1.3)}));
  return nearest_of(walls, nearest_of(boxes, sphere({0.9, 1.8, 0.4}, 0.4)));
}

}  // namespace roomradar::test
