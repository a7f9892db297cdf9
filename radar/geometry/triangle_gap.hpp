// triangle_gap.hpp: gap between a triangle that moves along z and another triangle, and the kind of their
// contact.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

namespace roomradar {

/// Triangle in a frame whose z axis is the direction of motion, corners in m. The unit normal follows the
/// winding and is zero for a triangle without area.
struct FrameTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;
};
/// Sets the normal from the corners.
void set_normal(FrameTriangle& triangle);

/// Triangles with |normal.z()| up to this count as edge-on.
inline constexpr double kEdgeOn = 1e-9;

/// Gap between two triangles: height of the scene's triangle above the object's, along z, m. The gap is
/// linear over the intersection of the two projected triangles. Its minimum low_m and maximum high_m are
/// therefore at vertices of the intersection: corners of one triangle inside the other, and crossings of
/// their edges.
struct TriangleGap {
  struct Place {
    double x, y, scene_z, gap;
  };
  std::array<Place, 18> places;
  std::size_t count = 0;
  double low_m = 0.0, high_m = 0.0;
  std::size_t lowest = 0;  ///< index of a vertex whose gap is low_m
};

/// Computes the gap of two triangles.
/// @return false if their projections have no point in common. Corners within rounding of an outline count as
///         on it, so no contact is missed at an edge that two triangles share.
bool find_gap(const FrameTriangle& object, const FrameTriangle& scene, TriangleGap& gap);

/// Returns a cheap lower bound of the gap, from the triangles' z ranges and from the object's corners against
/// the scene triangle's extended plane. Infinite if the object slides along the scene (see classify_pair()).
double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m);

enum class PairContact {
  kNone,      ///< no contact at or ahead of the present position
  kContact,   ///< contact after the object moves by max(low_m, 0)
  kCrossing,  ///< the triangles intersect now
  kLeaving    ///< the triangles intersect now, and the scene's triangle faces along the motion
};

/// Classifies the contact of an object that moves along +z.
///
/// If low_m > touching_m, contact is ahead. If high_m < -touching_m, the scene is behind. Otherwise the
/// triangles touch or intersect now. They touch if they overlap by less than touching_m along the normal of
/// one of them. Touching is then a contact if the scene is ahead of the plane between them, and no contact if
/// the scene is behind this plane or the plane is parallel to the motion.
///
/// The object slides along a scene triangle that is edge-on, without contact at any distance, if their
/// overlap across that triangle's plane is less than touching_m. A back-facing scene triangle (normal.z() >
/// 0) is a surface that the object leaves: touching it now is kNone and intersecting it is kLeaving. Ahead of
/// the object, a back-facing triangle is a contact like any other.
PairContact classify_pair(const FrameTriangle& object, const FrameTriangle& scene, const TriangleGap& gap,
                          double touching_m);

}  // namespace roomradar
