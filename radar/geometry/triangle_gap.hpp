// triangle_gap.hpp: two triangles, one moving along z: how far apart are they, and what happens next?
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

namespace roomradar {

/// Corners in a frame whose z axis is the direction of motion, m, with the unit normal by the winding (zero
/// for a triangle without area).
struct FrameTriangle {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal;
};
/// Sets the normal from the corners.
void set_normal(FrameTriangle& triangle);

/// A normal nearer to right angles with the motion than this is taken as edge-on.
inline constexpr double kEdgeOn = 1e-9;

/// Places where the outlines of two projected triangles meet: corners of one within the other and crossings
/// of their edges. The gap (height of the scene's triangle above the object's) is linear over the common
/// outline, so that its least and greatest values are among these.
struct TriangleGap {
  struct Place {
    double x, y, scene_z, gap;
  };
  std::array<Place, 18> places;
  std::size_t count = 0;
  double low_m = 0.0, high_m = 0.0;
  std::size_t lowest = 0;  ///< the place of low_m
};

/// @return nothing if their projections have no point in common. Corners within rounding of an outline count
///         as on it, so that nothing slips through between triangles that share an edge.
bool find_gap(const FrameTriangle& object, const FrameTriangle& scene, TriangleGap& gap);

enum class Meeting {
  kNone,      ///< they do not meet ahead
  kContact,   ///< they touch after max(low_m, 0)
  kCrossing,  ///< each is on both sides of the other already
  kLeaving    ///< they cross, and the scene's triangle faces along the motion
};

/// What a gap means for an object that moves along +z.
///
/// low_m > touching_m: contact ahead. high_m < -touching_m: the scene is behind. Else they meet now: by less
/// than touching_m (measured along the normal of either triangle: then it is touching, and what lies ahead of
/// a plane between them is a contact, what lies behind it or slides along it is not), or they cross.
/// A scene triangle seen edge-on that the object only grazes sideways by less than touching_m is slid along,
/// however far ahead. A scene triangle that faces along the motion is what the object leaves: touching it now
/// is no meeting, crossing it is kLeaving; ahead it is met like any other.
Meeting meeting_of(const FrameTriangle& object, const FrameTriangle& scene, const TriangleGap& gap,
                   double touching_m);

}  // namespace roomradar
