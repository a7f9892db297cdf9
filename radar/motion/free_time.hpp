// free_time.hpp: how long a rigid motion stays free of contact.
#pragma once
#include <vector>

#include "radar/geometry/contact.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/closest_point.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Result of free_time().
struct FreeTime {
  double free_s = 0.0;  ///< until then every pair of triangles keeps its minimum distance
  ClosestPoint limit;   ///< present closest features of the pair that limits free_s; kNothing if the whole
                        ///< duration is free
};

/// Computes how long a rigid motion is free of contact with surfaces that do not cross the object now. A
/// plane separates each pair of triangles: the plane of one of them, or the one across their nearest
/// points. No corner approaches the plane faster than its present speed plus what the rotation can add. The
/// minimum distance of a pair is keep_m, or half its present distance if that is under twice keep_m.
/// Source: Mirtich, PhD thesis, Berkeley 1996, section 2.3; Tang, Kim, Manocha, C2A: controlled
/// conservative advancement, ICRA 2009.
///
/// @param left_out  kinds to ignore
/// @param pending   scratch memory
FreeTime free_time(const TreeInstance& object, const RigidMotion& motion, double duration_s, double keep_m,
                   const RadarScene& scene, SurfaceKindMask left_out, std::vector<PendingPair>& pending);

}  // namespace roomradar
