// radar_volume.hpp: bounding rectangle (RadarOutline) of an object seen along its motion, with its pixel
// grid, and the swept volume.
#pragma once
#include <Eigen/Geometry>

#include "radar/exact/radar_pictures.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Bounding rectangle of an object seen along a direction u. u is given in the frame of the object's mesh.
/// The rectangle is valid while the object's orientation relative to u is unchanged. Defines the outline
/// coordinates. x and y are perpendicular to u, in pixels from the rectangle's corner. z is along u, in
/// metres from the object's foremost point. The object extends from z = -length_m to z = 0.
struct RadarOutline {
  /// Rotation from the mesh's frame to the outline's. Its rows are the right-handed axes x, y and u.
  Eigen::Matrix3d R_outline_mesh = Eigen::Matrix3d::Identity();
  /// Origin of the outline coordinates relative to the mesh's origin: components along x, y and u, m.
  Eigen::Vector3d corner_m = Eigen::Vector3d::Zero();
  double pixel_m = 0.0;
  /// Length of the object along u.
  double length_m = 0.0;
  int width_px = 0;
  int height_px = 0;
};

/// Fits a grid of square pixels to the object's outline. The longer side has resolution_px pixels, the
/// shorter at least 1. The mesh must have at least one triangle. u_mesh must have length 1.
RadarOutline fit_outline(const GpuMesh& mesh, const Eigen::Vector3d& u_mesh, int resolution_px);

/// Returns the affine 3 x 4 matrix from the object's local points (relative to its mesh's origin) to outline
/// coordinates.
Eigen::Matrix<double, 3, 4> outline_from_object(const RadarOutline& outline);
/// Returns the matrix from any instance's local points (relative to its mesh's origin) to the outline
/// coordinates of `object`, with both at their poses in the world. Keeps full precision far from the world's
/// origin.
Eigen::Matrix<double, 3, 4> outline_from_local(const RadarOutline& outline, const MeshInstance& object,
                                               const MeshInstance& instance);

/// Returns the box, with axes along x, y and u in the world frame, that contains the object and the volume it
/// sweeps over distance_m.
RadarVolume volume_of(const RadarOutline& outline, const MeshInstance& object, double distance_m);

/// Returns the max rounding error of the object's vertex positions in the renderer, perpendicular to u, in
/// pixels. The formula is that of kTileVertexShader.
double vertex_error_px(const GpuMesh& mesh, const RadarOutline& outline);

/// Returns the contact tolerance, m: a gap L counts as touching if |L| is at most 10 um + 1e-6 (length_m +
/// distance_m).
double touching_m(const RadarOutline& outline, double distance_m);

}  // namespace roomradar
