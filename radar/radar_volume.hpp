// radar_volume.hpp: the box of space that an object sweeps on its way, and its pixels.
#pragma once
#include <Eigen/Geometry>

#include "radar/gpu_mesh.hpp"

namespace roomradar {

/// Where the images of one query stand: pixel (i, j) is centred at
/// origin_world + (i + 0.5) * pixel_m * x_world + (j + 0.5) * pixel_m * y_world, and depth runs along
/// u_world.
struct RadarVolume {
  /// Corner of the rear plane, just behind the object.
  Eigen::Vector3d origin_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_world = Eigen::Vector3d::UnitX();
  Eigen::Vector3d y_world = Eigen::Vector3d::UnitY();
  Eigen::Vector3d u_world = Eigen::Vector3d::UnitZ();  ///< unit, the direction of motion; x cross y = u
  double pixel_m = 0.0;
  double length_m = 0.0;  ///< of the object along u
  double depth_m = 0.0;   ///< d: the object's length plus the distance asked for, plus a pad at both ends
  int width_px = 0;
  int height_px = 0;
};

/// The volume from the object's rear over its length plus distance_m, as wide and high as the object is
/// across the direction, with square pixels, resolution_px along the longer side and at least 1 along the
/// other. The object must have a triangle, u_world must have length 1. The pad (10 um + 1e-6 d) keeps extreme
/// vertices inside.
RadarVolume fit_volume(const MeshInstance& object, const Eigen::Vector3d& u_world, double distance_m,
                       int resolution_px);

/// Clip space of the volume as seen from the rear plane: x and y fill -1..1, depth_buffer01 is 0 at the rear
/// plane, 1 at the far plane. Seen with x to the right and y up, triangles that oppose the motion are
/// clockwise: glFrontFace(GL_CW).
Eigen::Matrix4d clip_from_world(const RadarVolume& volume);

/// The same as seen from the far plane, reflected, not turned: z becomes 1 - z and a point keeps its pixel,
/// so nothing needs swapping left to right.
Eigen::Matrix4d reflected_clip_from_world(const RadarVolume& volume);

}  // namespace roomradar
