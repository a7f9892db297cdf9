// contact_shadow.hpp: how much of the sky an object takes from the surfaces below it.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Points spread evenly over an object's surface, in its own frame: all that a shadow needs to know of it.
struct SurfacePoints {
  std::vector<Eigen::Vector3f> p_object_m;
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();  ///< of their box
};

/// Some 8,000 points, each standing for the same area; each triangle that has less area than that has one by
/// chance, the same each time. Triangles that are broken are left out; of none there are no points.
SurfacePoints spread_points(const Mesh& mesh);

/// Ambient occlusion by an object's underside, tabulated over (x, y, clearance) for one orientation. Axes are
/// the world's (z up); the origin is the object's.
struct ContactShadow {
  Eigen::Matrix3d R_world_object = Eigen::Matrix3d::Identity();  ///< that it was made for
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();     ///< of the object's box
  float x0_m = 0.0F, y0_m = 0.0F;  ///< centre of the first cell, relative to the object's origin
  float cell_m = 0.0F;
  int columns = 0, rows = 0;
  float bottom_m = 0.0F;            ///< the object's lowest point relative to its origin
  float extent_m = 0.0F;            ///< no shadow farther below the bottom than this
  std::vector<float> clearances_m;  ///< of the levels, growing
  int cells_across = 0;             ///< that it was made with
  std::vector<float> covered;       ///< part of the sky that is taken, 0..1; level by level, row by row
};

/// Tabulates it by the form factor of each piece of the underside seen from a level point below:
/// dF = H^2 dA / (pi (r^2 + H^2)^2). Source: Cohen, Wallace, Radiosity and Realistic Image Synthesis 1993,
/// section 4. An object without points gives an empty table. Reuses the shadow's allocations; a few
/// milliseconds.
/// @param cells_across  of the object's longer side; the time goes with their fourth power. 16: a cell of a
///                      25 cm teapot is 1.5 cm, a shadow is soft
void make_contact_shadow(const SurfacePoints& object, const Eigen::Matrix3d& R_world_object,
                         ContactShadow& shadow, int cells_across = 16);

/// Where the table's origin is for an object that stands so: turned a little from what the table was made
/// for, the middle stays under the object, wherever in or outside the object its origin is.
Eigen::Vector3d origin_world(const ContactShadow& shadow, const Eigen::Isometry3d& T_world_object);

/// Part of the sky taken from a real surface point; p_object_m = point minus the object's origin, world axes.
/// Points above the object's bottom by more than some centimetres get none.
float sky_taken(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m);

}  // namespace roomradar
