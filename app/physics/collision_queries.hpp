// collision_queries.hpp: the radar queries by which a moving body finds contacts.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/motion/proximity.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Finds the first contact of the object at T_world_object along a unit direction, within distance_m. Calls
/// CyberRadar::query() with the object's mesh and the frame's scene, or an analytic room in tests.
using DistanceQuery = std::function<Contact(const Eigen::Isometry3d& T_world_object,
                                            const Eigen::Vector3d& direction_world, double distance_m)>;

/// The body of one of the scene's trees.
struct SceneBody {
  Body* body = nullptr;     ///< null: the tree is not a body
  double mass_ratio = 0.0;  ///< as SolverBody::mass_ratio; 0: the body is held, such as in a user's hand
};

/// Collision queries of a moving body: its own mesh against the frame's scene.
struct CollisionQueries {
  DistanceQuery travel;
  /// As ProximityQuery::near() and ProximityQuery::free_time().
  std::function<SurfaceKindMask(const Eigen::Isometry3d& T_world_object, double reach_m,
                                SurfaceKindMask left_out, std::vector<ClosestPoint>& points)>
      near;
  std::function<FreeTime(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                         double duration_s, double keep_m, SurfaceKindMask left_out)>
      free_time;
  /// One entry per tree of the scene, in its order; trees beyond the last entry are static.
  std::span<const SceneBody> others = {};
};

/// Binds the queries to an object's tree. All references must outlive the returned queries.
/// @param spent_ms  accumulates the time of all queries; may be null
CollisionQueries make_collision_queries(CyberRadar& radar, ProximityQuery& field, const TriangleTree& object,
                                        const RadarScene& scene, double* spent_ms = nullptr);

}  // namespace roomradar
