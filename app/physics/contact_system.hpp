// contact_system.hpp: finds the contacts of bodies that are advanced together, as input of the contact
// solver.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "app/physics/physics_config.hpp"
#include "app/physics/sleeper_contacts.hpp"
#include "mapping/types/system/worker_thread.hpp"

namespace roomradar {

/// A contact at which a dynamic surface pushes the body throughout a step. Until the push ends, dynamic
/// surfaces intersect the body, so the step ignores all other contacts with them.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  /// Min speed of the body at point_world along the normal. Negative: the body may approach the surface, at
  /// up to -speed_mps.
  double speed_mps = 0.0;
  SurfaceKind touched = SurfaceKind::kDynamic;
};

/// Dynamic surfaces and their inferred backs.
inline constexpr SurfaceKindMask kMovingSurfaces =
    bit_of(SurfaceKind::kDynamic) | bit_of(SurfaceKind::kInferredBack);
constexpr bool is_moving_surface(SurfaceKind kind) { return (bit_of(kind) & kMovingSurfaces) != 0; }

/// Plane fitted to a tree of the scene about a point.
struct PatchPlane {
  std::uint32_t tree = 0;
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  FittedPlane plane;
};

/// A body in a substep, with its progress.
struct MovingBody {
  Body* body = nullptr;
  const CollisionQueries* probe = nullptr;
  double mass_kg = 1.0;
  bool is_carried = false;       ///< moves without gravity, friction and restitution
  std::vector<Push> pushes{};    ///< pushes by dynamic surfaces that overlap the body
  SurfaceKindMask left_out = 0;  ///< kinds excluded from the contacts, because they push or grip the body
  StepReport* report = nullptr;  ///< the substep adds its contacts
  double dt_s = 0.0;             ///< length of the substep
  /// Called after each change of the body's pose, to update the other bodies' scenes. May be null.
  const std::function<void()>* moved = nullptr;
  /// True if nothing but the bodies of the call has moved near the body since its last substep.
  bool is_undisturbed = false;
  /// Per tree of the probe's scene: index of the tree's body among the substep's bodies; kNoOther if it has
  /// none.
  std::vector<std::size_t> member_of_tree{};

  double left_s = 0.0;  ///< time of the substep that remains to be simulated
  /// A surface other than the pushing one intersects the body. The contact solver then does not move it.
  bool crosses = false;
  ClosestPoint limited_by{};          ///< feature that ended the body's last motion
  int stops_in_place = 0;             ///< motions in this substep that hardly moved the body
  bool contacts_known = false;        ///< sleeping bodies: contacts are in the system
  std::vector<ClosestPoint> near{};   ///< closest features at its pose
  std::vector<PatchPlane> patches{};  ///< fitted in this call
  std::size_t near_found = 0;  ///< size of `near` without the feature that ended the body's last motion
  /// Pose at which the body's features were queried in this substep; unset if they were not.
  std::optional<Eigen::Isometry3d> T_world_near{};
};

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

/// Normal of a contact's closest features, and their point on the body, from its centre of mass.
struct Feature {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), offset_m = Eigen::Vector3d::Zero();
  bool is_on_patch = false;  ///< the contact has patch_normal instead
  Eigen::Vector3d patch_normal = Eigen::Vector3d::UnitZ();
};

/// Contacts of a substep's bodies. The solver's bodies are first the substep's bodies, then the bystanders.
struct ContactSystem {
  /// Their normals, and the points where impulses act, are those of the surface's patch; see patch_contact().
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

/// Returns the worker for the queries of this number of bodies; null if one thread is as fast.
WorkerThread* worker_for(std::size_t queried_bodies, ContactSystem& system);

/// Returns true if the body is awake, has time left in the substep, and no surface intersects it.
bool is_active(const MovingBody& moving);

/// Finds the contacts within 1.5 contact margins of all active bodies. Adds those of sleeping bodies in the
/// same connected component. Leaves out sleeping bodies that rest on a dynamic surface or that a surface
/// intersects. Sets `crosses` of active bodies that a surface intersects. Orders contacts by body height, the
/// lowest first, and active bodies before sleeping ones.
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
/// Stores the contacts' impulses, times `scale`, in system.past.
void keep_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system);

}  // namespace roomradar
