// triangle_gap.hpp: gap between two triangles, one of them moving along z, and their kind of contact.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

namespace roomradar {

/// Corners in a frame whose z axis is the direction of motion, m. The unit normal follows the winding; zero
/// for a triangle without area.
struct FrameTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;
};
/// Computes the normal from the corners.
void set_normal(FrameTriangle& triangle);

/// Triangles with |normal.z()| up to this count as edge-on.
inline constexpr double kEdgeOn = 1e-9;

/// Vertices of the intersection of two projected triangles: corners of one inside the other, and crossings of
/// their edges. The gap (height of the scene's triangle above the object's) is linear over the intersection,
/// so its minimum and maximum are among the vertices.
struct TriangleGap {
  struct Place {
    double x, y, scene_z, gap;
  };
  std::array<Place, 18> places;
  std::size_t count = 0;
  double low_m = 0.0, high_m = 0.0;
  std::size_t lowest = 0;  ///< index of the place with gap low_m
};

/// @return false if the projections have no point in common. Corners within rounding of an outline count
///         as on it, so nothing slips between triangles that share an edge.
bool find_gap(const FrameTriangle& object, const FrameTriangle& scene, TriangleGap& gap);

/// Returns a cheap lower bound of the gap, from the triangles' heights and from the object's corners under
/// the scene's extended plane. Infinite if the object slides along the scene (see classify_pair()).
double least_gap_bound(const FrameTriangle& object, const FrameTriangle& scene, double touching_m);

enum class PairContact {
  kNone,      ///< no contact ahead
  kContact,   ///< contact after max(low_m, 0)
  kCrossing,  ///< each is already on both sides of the other
  kLeaving    ///< they cross, and the scene's triangle is back-facing
};

/// Classifies a gap for an object that moves along +z.
///
/// low_m > touching_m: contact ahead. high_m < -touching_m: the scene is behind. Otherwise the triangles
/// touch or cross now. They touch if they overlap by less than touching_m along the normal of either. Then
/// scene ahead of the plane between them is a contact; scene behind the plane or sliding along it is not.
///
/// A scene triangle seen edge-on slides along an object that overlaps it sideways by less than touching_m, at
/// any distance ahead. A back-facing scene triangle (normal.z() > 0) is what the object leaves: touching it
/// now is kNone, crossing it is kLeaving, and ahead it is a contact like any other.
PairContact classify_pair(const FrameTriangle& object, const FrameTriangle& scene, const TriangleGap& gap,
                          double touching_m);

}  // namespace roomradar
