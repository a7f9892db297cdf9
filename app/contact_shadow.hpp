// contact_shadow.hpp: how much of the sky an object takes from the surfaces below it.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Ambient occlusion by an object's underside, tabulated over (x, y, clearance). Made once an object and
/// orientation: physics only translates. Axes are the world's (z up); the origin is the object's.
struct ContactShadow {
  double x0_m = 0.0, y0_m = 0.0;  ///< centre of the first cell, relative to the object's origin
  double cell_m = 0.0;
  int columns = 0, rows = 0;
  double bottom_m = 0.0;             ///< the object's lowest point relative to its origin
  double extent_m = 0.0;             ///< no shadow farther below the bottom than this
  std::vector<double> clearances_m;  ///< of the levels, growing
  std::vector<float> covered;        ///< part of the sky that is taken, 0..1; level by level, row by row
};

/// Tabulates it by the form factor of each piece of the underside seen from a level point below:
/// dF = H^2 dA / (pi (r^2 + H^2)^2). Source: Cohen, Wallace, Radiosity and Realistic Image Synthesis 1993,
/// section 4. R_world_object: the object's orientation. An object without triangles gives an empty table.
ContactShadow make_contact_shadow(const Mesh& mesh, const Eigen::Matrix3d& R_world_object);

/// Part of the sky taken from a real surface point; p_object_m = point minus the object's origin, world axes.
/// Points above the object's bottom by more than some centimetres get none.
float sky_taken(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m);

}  // namespace roomradar
