// contact_shadow.hpp: ambient occlusion by an object of the surfaces below it.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Points spread evenly over an object's surface, in its own frame; sufficient to compute its shadow.
struct SurfacePoints {
  std::vector<Eigen::Vector3f> p_object_m;
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();  ///< centre of their bounding box
};

/// Samples about 8,000 points, each representing the same area; triangles smaller than that get a point with
/// proportional frequency. Deterministic. Ignores invalid triangles; a mesh without valid ones gets no
/// points.
SurfacePoints spread_points(const Mesh& mesh);

/// Ambient occlusion by an object's underside, tabulated over (x, y, clearance) for one orientation. Axes are
/// the world's (z up), relative to the object's origin.
struct ContactShadow {
  Eigen::Matrix3d R_world_object = Eigen::Matrix3d::Identity();  ///< orientation of the table
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();     ///< centre of the object's bounding box
  float x0_m = 0.0F, y0_m = 0.0F;  ///< centre of the first cell, relative to the object's origin
  float cell_m = 0.0F;
  int columns = 0, rows = 0;
  float bottom_m = 0.0F;            ///< the object's lowest point relative to its origin
  float extent_m = 0.0F;            ///< no shadow farther than this below the lowest point
  std::vector<float> clearances_m;  ///< clearance of each level, ascending
  int cells_across = 0;             ///< resolution of the table
  std::vector<float> covered;       ///< occluded fraction of the sky, 0..1; level by level, row by row
};

/// Tabulates the form factors of the underside's patches, seen from a horizontal point below: dF = H^2 dA /
/// (pi (r^2 + H^2)^2). Source: Cohen, Wallace, Radiosity and Realistic Image Synthesis 1993, section 4. An
/// object without points gives an empty table. Reuses the shadow's memory; takes a few milliseconds.
/// @param cells_across  along the object's longer side; the time grows with its fourth power. 16: cells
/// of 1.5 cm
///                      for a 25 cm teapot, since a shadow is soft
void make_contact_shadow(const SurfacePoints& object, const Eigen::Matrix3d& R_world_object,
                         ContactShadow& shadow, int cells_across = 16);

/// Returns the world position of the table's origin for an object at this pose. If the object has rotated
/// slightly since the table was made, its centre stays aligned, wherever its origin is.
Eigen::Vector3d origin_world(const ContactShadow& shadow, const Eigen::Isometry3d& T_world_object);

/// Returns the occluded fraction of the sky at a real surface point; p_object_m = point minus the object's
/// origin, world axes. Returns 0 for points more than some centimetres above the object's lowest point.
float ambient_occlusion(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m);

}  // namespace roomradar
