// radar_volume.hpp: the box of space that an object sweeps on its way, and its pixels.
#pragma once
#include <Eigen/Geometry>

#include "radar/exact/radar_pictures.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// An object as seen along a direction, in its own mesh's frame: what stays while it keeps its orientation to
/// the direction. Outline coordinates: x and y in pixels across the direction from the outline's corner, z in
/// metres along it from the object's foremost point, so that the object lies in -length_m..0 and what is
/// near contact has small numbers.
struct RadarOutline {
  /// Rows: x, y and u, unit, right-handed.
  Eigen::Matrix3d R_outline_mesh = Eigen::Matrix3d::Identity();
  /// Where x, y and z are 0: m, along the rows, relative to the mesh's origin.
  Eigen::Vector3d corner_m = Eigen::Vector3d::Zero();
  double pixel_m = 0.0;
  double length_m = 0.0;  ///< of the object along u
  int width_px = 0;
  int height_px = 0;
};

/// Square pixels, resolution_px along the longer side of the outline and at least 1 along the other. The mesh
/// must have a triangle, u_mesh must have length 1.
RadarOutline fit_outline(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh, int resolution_px);

/// Affine, 3 x 4: outline coordinates from the local points (relative to its mesh's origin) of the object
/// itself.
Eigen::Matrix<double, 3, 4> outline_from_object(const RadarOutline& outline);
/// The same for any instance in the world, where the object's is at T_world_object. Nothing is lost far from
/// the world's origin.
Eigen::Matrix<double, 3, 4> outline_from_local(const RadarOutline& outline, const MeshInstance& object,
                                               const MeshInstance& instance);

/// The box of space that the object sweeps, in the world.
RadarVolume volume_of(const RadarOutline& outline, const MeshInstance& object, double distance_m);

}  // namespace roomradar
