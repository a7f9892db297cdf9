// local_surface.hpp: a mesh's surface about a point: its nearest point, and the plane fitted to it.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Returns the surface's nearest point within reach_m; nothing if there is none.
std::optional<Eigen::Vector3d> nearest_point(const TreeInstance& surface, const Eigen::Vector3d& point_world,
                                             double reach_m);

/// Least-squares plane of the part of a surface within a cube about a point.
struct FittedPlane {
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit; zero if nothing is in the cube
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();  ///< centroid of the surface, on the plane
  /// Standard deviation of the surface from the plane, m.
  double roughness_m = 0.0;
  /// Standard deviation of the surface along its shorter extent in the plane, m.
  double extent_m = 0.0;
};

/// Fits a plane to the triangles whose normals are within 60 degrees of facing_world, or of its opposite.
/// Weights the triangles by their area inside the cube.
/// @param facing_world  unit; the plane's normal faces this way
/// @param reach_m       half the cube's side, m
FittedPlane fit_plane(const TreeInstance& surface, const Eigen::Vector3d& point_world,
                      const Eigen::Vector3d& facing_world, double reach_m);

}  // namespace roomradar
