// triangle_gap.hpp: gap and kind of contact between a triangle that moves along z and another triangle.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

namespace roomradar {

/// Triangle in a frame whose z axis is the direction of motion. `corners` are its vertices, in m. The unit
/// normal follows the winding and is zero for a triangle without area.
struct FrameTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;
};
/// Computes the normal from the vertices.
void set_normal(FrameTriangle& triangle);

/// Max |normal.z()| of a triangle that counts as edge-on.
inline constexpr double kEdgeOn = 1e-9;

/// Gap between two triangles: height of the scene's triangle above the object's, along z, m. The gap is
/// linear over the intersection of the two projected triangles. The gap's minimum low_m and maximum high_m
/// are therefore at vertices of the intersection: vertices of one triangle inside the other, and crossings of
/// the triangles' edges.
struct TriangleGap {
  struct Vertex {
    double x, y, scene_z, gap;
  };
  std::array<Vertex, 18> vertices;
  std::size_t count = 0;
  double low_m = 0.0, high_m = 0.0;
  std::size_t lowest = 0;  ///< index of a vertex whose gap is low_m
};

/// Computes the gap of two triangles.
/// @return false if their projections have no point in common. A projected vertex within rounding error of
///         the other triangle's boundary counts as on the boundary. Hence no contact is missed at a shared
///         edge of two triangles.
bool find_gap(const FrameTriangle& object, const FrameTriangle& scene, TriangleGap& gap);

/// Returns a cheap lower bound of the gap, from the triangles' z ranges and from the heights of the scene
/// triangle's plane above the object's vertices. Infinite if the object slides along the scene (see
/// classify_pair()).
double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m);

enum class PairContact {
  kNone,      ///< no contact, now or ahead
  kContact,   ///< contact after the object moves by max(low_m, 0)
  kCrossing,  ///< the triangles intersect now
  kLeaving    ///< the triangles intersect now, and the scene's is back-facing
};

/// Classifies the contact of an object that moves along +z.
///
/// If low_m > touching_m, contact is ahead. If high_m < -touching_m, the scene triangle is behind the object
/// triangle. Otherwise the triangles touch or intersect now. The triangles touch if they overlap by less than
/// touching_m along the normal of one triangle. That triangle's plane then lies between the two. Touching is
/// a contact if the object triangle is behind this plane and the scene triangle is ahead. Touching is no
/// contact in the opposite order, or if the plane is parallel to the motion.
///
/// If the scene triangle is edge-on and the object triangle reaches through its plane by less than
/// touching_m, the object slides along the plane. Sliding is no contact at any distance. The object leaves a
/// back-facing scene triangle (normal.z() > 0). Touching it now is kNone, and intersecting it now is
/// kLeaving. Ahead of the object, a back-facing triangle is a contact like any other.
PairContact classify_pair(const FrameTriangle& object, const FrameTriangle& scene, const TriangleGap& gap,
                          double touching_m);

}  // namespace roomradar
