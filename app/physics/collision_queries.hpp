// collision_queries.hpp: collision queries of a moving body against the scene.
#pragma once
#include <Eigen/Geometry>
#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "radar/exact/radar.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/motion/local_surface.hpp"
#include "radar/motion/proximity.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Returns the first contact of the object as it is translated from T_world_object by up to distance_m along
/// a unit direction. Implemented by Radar::query(); tests substitute an analytic room.
using DistanceQuery = std::function<Contact(const Eigen::Isometry3d& T_world_object,
                                            const Eigen::Vector3d& direction_world, double distance_m)>;

/// The rigid body, if any, to which one triangle tree of the scene belongs.
struct SceneBody {
  Body* body = nullptr;  ///< null: the tree is a static or dynamic surface, not a body
  /// Mass of the querying body (AdvancedBody::mass_kg) divided by the mass of this body. Used only for bodies
  /// that are not advanced in the same call. 0: impulses do not move this body, for example while it is
  /// carried.
  double mass_ratio = 0.0;
};

/// Queries of one body. near() and free_time() of different bodies may run on two threads at the same time.
struct CollisionQueries {
  /// First contact along a direction.
  DistanceQuery travel;
  /// Closest features within reach_m; see near_features().
  std::function<SurfaceKindMask(const Eigen::Isometry3d& T_world_object, double reach_m,
                                SurfaceKindMask left_out, const TreeStates& trees,
                                std::vector<ClosestPoint>& points)>
      near;
  /// Contact-free duration of a motion; see roomradar::free_time().
  std::function<FreeTime(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                         double duration_s, double keep_m, SurfaceKindMask left_out, const TreeStates& trees)>
      free_time;
  /// Plane fitted to a tree of the scene about a point; see fit_plane(). Null: contacts have the normals of
  /// the closest features.
  std::function<FittedPlane(std::uint32_t tree, const Eigen::Vector3d& point_world,
                            const Eigen::Vector3d& facing_world, double reach_m)>
      patch{};
  /// One entry per tree of the scene, in the scene's order. Trees beyond the last entry do not belong to
  /// bodies.
  std::span<const SceneBody> others = {};
};

/// Returns queries of `object` against `scene`. All arguments passed by reference must outlive the returned
/// queries.
/// @param spent_ms  incremented by the duration of each query, on whichever thread; may be null
CollisionQueries make_collision_queries(Radar& radar, const TriangleTree& object, const RadarScene& scene,
                                        std::atomic<double>* spent_ms = nullptr);

}  // namespace roomradar
