// free_time.hpp: contact-free duration of a rigid motion, by conservative advancement with separating planes.
#pragma once
#include <cstddef>
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/closest_point.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Result of free_time().
struct FreeTime {
  /// Duration from now on during which every pair of triangles keeps its minimum distance (see free_time()),
  /// s.
  double free_s = 0.0;
  /// Of the pair that limits free_s: the object's point nearest to the scene's triangle, and the scene's
  /// point nearest to that. Its kind is kNothing if the whole duration is free.
  ClosestPoint limit;
};

/// A tree and its rigid motion. Refers to both, which must outlive it.
struct MovingTree {
  const TreeInstance& instance;
  const RigidMotion& motion;
};

/// Trees of a scene to ignore, and the trees' motions, both in the scene's order. A tree beyond the end of
/// left_out is not ignored; one beyond the end of `motions` is at rest.
struct TreeStates {
  std::vector<bool> left_out;
  std::vector<RigidMotion> motions;

  [[nodiscard]] bool is_left_out(std::size_t tree) const { return tree < left_out.size() && left_out[tree]; }
};

/// Returns a lower bound of the duration for which rigid motions of the object and of the scene's trees stay
/// free of contact between the object and the trees. Ignores pairs of triangles that intersect or touch now.
/// A plane separates each pair of triangles: either the plane of one triangle, or a plane perpendicular to
/// the segment between their nearest points. The latter plane may rotate, as when an edge rocks on another. A
/// vertex approaches the plane at most at its present speed plus a bound of the change by rotation. A pair
/// farther apart than 2 * keep_m keeps a distance of keep_m. A nearer pair keeps the mean of its present
/// distance and keep_m / 100, or its present distance if that is less. Sources: Mirtich, PhD thesis, Berkeley
/// 1996, section 2.3; Tang, Kim, Manocha, C2A: controlled conservative advancement, ICRA 2009.
///
/// @param keep_m    minimum distance to keep, m
/// @param left_out  kinds of surfaces to ignore
FreeTime free_time(const MovingTree& moving_object, double duration_s, double keep_m, const RadarScene& scene,
                   SurfaceKindMask left_out = 0, const TreeStates& trees = {});

}  // namespace roomradar
