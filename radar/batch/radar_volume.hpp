// radar_volume.hpp: the volume that an object sweeps along its motion, and its pixels.
#pragma once
#include <Eigen/Geometry>

#include "radar/exact/radar_pictures.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// An object seen along a direction, in its own mesh's frame; valid while its orientation relative to the
/// direction is unchanged. Outline coordinates: x and y in pixels across the direction from the outline's
/// corner, z in metres along it from the object's foremost point. The object lies in z = -length_m..0, so
/// values near contact are small.
struct RadarOutline {
  /// Rows: x, y and u, unit, right-handed.
  Eigen::Matrix3d R_outline_mesh = Eigen::Matrix3d::Identity();
  /// Origin of x, y and z: m, along the rows, relative to the mesh's origin.
  Eigen::Vector3d corner_m = Eigen::Vector3d::Zero();
  double pixel_m = 0.0;
  double length_m = 0.0;  ///< length of the object along u
  int width_px = 0;
  int height_px = 0;
};

/// Fits square pixels to the object: resolution_px along the longer side of the outline, at least 1 along the
/// other. The mesh must have a triangle, and u_mesh must have length 1.
RadarOutline fit_outline(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh, int resolution_px);

/// Returns the affine 3 x 4 matrix from the object's local points (relative to its mesh's origin) to outline
/// coordinates.
Eigen::Matrix<double, 3, 4> outline_from_object(const RadarOutline& outline);
/// Returns the matrix for any instance in the world, with `object` at its own pose. Keeps full precision far
/// from the world's origin.
Eigen::Matrix<double, 3, 4> outline_from_local(const RadarOutline& outline, const MeshInstance& object,
                                               const MeshInstance& instance);

/// Returns the volume that the object sweeps, in the world.
RadarVolume volume_of(const RadarOutline& outline, const MeshInstance& object, double distance_m);

/// Returns the max error across the direction of the object's vertices in the renderer's floats, px; same
/// formula as kTileVertexShader.
double vertex_error_px(const GpuMesh& mesh, const RadarOutline& outline);

/// Returns the distance from 0 within which L counts as touching, m.
double touching_m(const RadarOutline& outline, double distance_m);

}  // namespace roomradar
