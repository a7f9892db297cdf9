// contact_shadow.hpp: soft shadow of an object on surfaces below it, stored as a lookup table of ambient
// occlusion.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Points sampled uniformly on an object's surface, in the object's frame. An object's contact shadow is
/// computed from them.
struct SurfacePoints {
  std::vector<Eigen::Vector3f> p_object_m;
  /// Centre of the object's bounding box.
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();
};

/// Samples about 8,000 points deterministically. Each point represents the same area. A triangle smaller than
/// that area gets a point with a probability proportional to the triangle's area. Ignores invalid triangles.
/// Returns no points for a mesh without valid triangles.
SurfacePoints spread_points(const Mesh& mesh);

/// Lookup table of the ambient occlusion by an object's underside, for one orientation of the object. The
/// table has columns along x, rows along y, and levels of clearance. x and y are world axes (z up), relative
/// to the object's origin. The clearance of a point is its vertical distance below the object's lowest point.
struct ContactShadow {
  /// Orientation of the object for which the table was made.
  Eigen::Matrix3d R_world_object = Eigen::Matrix3d::Identity();
  /// Centre of the object's bounding box, in the object's frame.
  Eigen::Vector3d middle_object_m = Eigen::Vector3d::Zero();
  /// Centre of the first cell, relative to the object's origin, world axes.
  float x0_m = 0.0F, y0_m = 0.0F;
  /// Side of a cell.
  float cell_m = 0.0F;
  int columns = 0, rows = 0;
  /// Height of the object's lowest point relative to its origin.
  float bottom_m = 0.0F;
  /// Height of the object's highest point above its lowest.
  float height_m = 0.0F;
  /// Max clearance. Points with at least this clearance get no shadow.
  float extent_m = 0.0F;
  /// Clearance of each level, ascending.
  std::vector<float> clearances_m;
  /// Number of cells along the longer side of the object's bounding box.
  int cells_across = 0;
  /// Occluded fraction of the sky, 0 to 1, of each cell: level by level, row by row.
  std::vector<float> covered;
};

/// Computes the lookup table. The object's underside is divided into patches of area dA. A horizontal surface
/// point is at distance H below a patch and at horizontal distance r from it. Their form factor is dF = H^2
/// dA / (pi (r^2 + H^2)^2). The occlusion is the sum of the form factors of all patches. Source: Cohen,
/// Wallace, Radiosity and Realistic Image Synthesis 1993, section 4. An object without points gives an empty
/// table. Reuses the shadow's memory. Takes a few milliseconds.
/// @param cells_across  number of cells along the longer side of the object's bounding box. Run time grows
///                      with its fourth power. With 16, the cells of a 25 cm teapot are 1.5 cm wide.
void make_contact_shadow(const SurfacePoints& object, const Eigen::Matrix3d& R_world_object,
                         ContactShadow& shadow, int cells_across = 16);

/// Returns the world position of the table's origin for an object at this pose. After small rotations of the
/// object, the table is aligned with the centre of the object's bounding box, not with its origin.
Eigen::Vector3d origin_world(const ContactShadow& shadow, const Eigen::Isometry3d& T_world_object);

/// Returns the occluded fraction of the sky at a real surface point. Returns 0 for points more than 4 cm
/// above the object's lowest point.
/// @param p_object_m  surface point relative to the table's origin (origin_world()), world axes, m
float ambient_occlusion(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m);

/// Returns the occluded fraction of a light at a real surface point, 0 to 1. The object is approximated by a
/// vertical column with the shape of its underside. Returns 0 for light from below 15 degrees, and for points
/// more than 4 cm above the object's lowest point.
/// @param p_object_m  as for ambient_occlusion()
/// @param to_light    unit, world axes
float light_occlusion(const ContactShadow& shadow, const Eigen::Vector3f& p_object_m,
                      const Eigen::Vector3f& to_light);
/// Least height of to_light at which light_occlusion() finds a shadow: sine of 15 degrees.
inline constexpr float kLowestLight = 0.26F;

}  // namespace roomradar
