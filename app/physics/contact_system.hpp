// contact_system.hpp: finds the contacts of bodies that are advanced together, as input of the contact
// solver.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "app/physics/moving_body.hpp"
#include "app/physics/physics_config.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {

/// Contacts of a sleeping body, valid while neither that body nor a body that it touches has moved.
struct SleeperContacts {
  struct ContactBody {
    const Body* body;  ///< null: static surface
    Eigen::Isometry3d T_world_body;
  };
  const Body* body = nullptr;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  std::vector<ClosestPoint> near;
  std::vector<ContactBody> bodies;  ///< per point of `near`
};

/// Returns the body that a point of the scene lies on; null: a surface.
/// @param others  one per triangle tree of the scene: the tree's body. Trees beyond the last entry are
///                surfaces
inline const Body* body_of(std::span<const SceneBody> others, const ClosestPoint& p) {
  return p.tree < others.size() ? others[p.tree].body : nullptr;
}

/// Copies a body's known contacts to `near` if they are still valid. Otherwise returns false, and `near` may
/// be overwritten. ClosestPoint::tree is set to the other body's index in `others`, which may have changed.
/// @param others  as in body_of()
bool recall_contacts(std::span<const SleeperContacts> known, const Body& body,
                     std::span<const SceneBody> others, std::vector<ClosestPoint>& near);

/// Replaces the known contacts of a body.
void remember_contacts(std::vector<SleeperContacts>& known, const Body& body,
                       std::span<const SceneBody> others, const std::vector<ClosestPoint>& near);

/// A body in the scene that is not advanced in this substep.
struct Bystander {
  Body* body = nullptr;
  double inverse_mass_per_kg = 0.0;
};

/// Normal and friction impulse of a contact in an earlier solve.
struct PastContact {
  const Body* body = nullptr;
  const Body* other = nullptr;  ///< null: static surface
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero(), normal_world = Eigen::Vector3d::Zero();
  double impulse_Ns = 0.0;
  Eigen::Vector3d friction_impulse_Ns = Eigen::Vector3d::Zero();
};

/// Closest features of a contact: their normal, and their point on the body relative to its centre of mass.
struct Feature {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), offset_m = Eigen::Vector3d::Zero();
  bool is_on_patch = false;  ///< the contact has patch_normal instead
  Eigen::Vector3d patch_normal = Eigen::Vector3d::UnitZ();
};

/// Contacts of a substep's bodies. `bodies` holds the substep's bodies, then the bystanders.
struct ContactSystem {
  /// The contacts' normals, and the points where impulses act, are those of the surface's patch; see
  /// patch_contact().
  std::vector<SolverContact> contacts;
  std::vector<Feature> features;   ///< per contact: the closest features
  std::vector<double> gap_m;       ///< per contact; 0 for a Push
  std::vector<SurfaceKind> kinds;  ///< per contact: kind of the surface that SolverContact::body touches
  std::vector<const Push*> push;   ///< per contact; null if the contact is not a Push
  std::vector<SolverBody> bodies;
  std::vector<Bystander> bystanders;
  std::vector<PastContact> past;  ///< contacts of the last support solve, for warm starts
  std::vector<SleeperContacts> sleepers;
  ContactSolver solver;
  /// Runs some of the queries of many bodies on a second thread; created when first needed. Results are the
  /// same without it.
  std::unique_ptr<WorkerThread> worker;
  bool is_one_thread = false;        ///< true: no worker is created
  std::vector<std::size_t> upwards;  ///< scratch: indices of bodies by height
};

/// Returns the worker for the queries of this number of bodies; null if one thread is as fast, or with
/// is_one_thread.
WorkerThread* worker_for(std::size_t queried_bodies, ContactSystem& system);

/// Finds the contacts within 1.5 contact margins of all active bodies. Adds those of sleeping bodies in the
/// same connected component. Leaves out sleeping bodies that rest on a dynamic surface or that a surface
/// intersects. Sets `crosses` of active bodies that a surface intersects. The contacts of active bodies come
/// first, then those of sleeping ones; within each, those of the lowest body first.
/// @param up_world  unit, against gravity; zero without gravity
void find_contacts(std::span<MovingBody> bodies, const PhysicsConfig& config, const Eigen::Vector3d& up_world,
                   ContactSystem& system);

/// Bodies that a solve moves. All others are immovable in it.
enum class Movable {
  kActiveAndKnownSleepers,  ///< active bodies, and sleeping bodies whose contacts are in the system
  kActive,
};
/// Sets the inverse masses of the solver bodies.
void set_masses(std::span<const MovingBody> bodies, Movable movable, ContactSystem& system);
/// Sets the inverse masses of the solver bodies for impacts. These move awake bodies, and sleeping bodies
/// that another body hits faster than 5 cm/s.
/// @param velocities  of the solver bodies, before the impacts
void set_masses_for_impacts(std::span<const MovingBody> bodies, std::span<const Velocity> velocities,
                            ContactSystem& system);

/// Returns the longer left_s (s) of a contact's two bodies; dt_s if neither has time left. Always > 0.
double left_s(std::span<const MovingBody> bodies, const SolverContact& contact);
/// Sets leaves_mps so that each contact may close its gap, down to the margin, in the time left. A Push keeps
/// its own speed.
void allow_closing_gaps(std::span<const MovingBody> bodies, double margin_m, ContactSystem& system);
void clear_impulses(ContactSystem& system);
/// Warm start: sets the contacts' impulses to those of the same contacts in system.past, times `scale`.
/// Contacts without a match get 0.
void guess_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system);
/// Stores the contacts' positive impulses, times `scale`, in system.past, except those with bystanders.
void keep_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system);

}  // namespace roomradar
