// contact_system.hpp: the contacts of bodies that move together, for the contact solver.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// A contact at which a dynamic surface pushes the body throughout a step. All other contacts with dynamic
/// surfaces are ignored in the step, since dynamic surfaces intersect the body until the push ends.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  double speed_mps = 0.0;  ///< min speed of the body at point_world along the normal
  SurfaceKind touched = SurfaceKind::kDynamic;
};

/// Dynamic surfaces and their inferred backs.
inline constexpr SurfaceKindMask kMovingSurfaces =
    bit_of(SurfaceKind::kDynamic) | bit_of(SurfaceKind::kInferredBack);
constexpr bool is_moving_surface(SurfaceKind kind) { return (bit_of(kind) & kMovingSurfaces) != 0; }

/// A body in a substep, and how far it has come.
struct MovingBody {
  Body* body = nullptr;
  const CollisionQueries* probe = nullptr;
  double mass_kg = 1.0;
  bool is_carried = false;  ///< moves without gravity, friction and restitution
  std::optional<Push> push{};
  StepReport* report = nullptr;  ///< the substep's contacts are added
  double dt_s = 0.0;             ///< length of the substep
  /// Called after each change of the body's pose, so that the other bodies' scenes follow. May be null.
  const std::function<void()>* moved = nullptr;

  double left_s = 0.0;  ///< time of the substep that is not simulated so far
  /// A surface other than the pushing one intersects the body, so it does not move by contacts.
  bool crosses = false;
  Velocity velocity{}, after{};      ///< before and after left_s of gravity, support and friction
  ClosestPoint limited_by{};         ///< feature that ended the body's last motion
  bool contacts_known = false;       ///< of a sleeping body: its contacts are part of the system
  std::vector<ClosestPoint> near{};  ///< closest features at its pose
};

/// A body that takes part in a substep without being moved: it is in the scene, but advanced at another time.
struct Bystander {
  Body* body = nullptr;
  double inverse_mass_per_kg = 0.0;
};

/// The normal impulse and friction of a contact in an earlier solve.
struct PastContact {
  const Body* body = nullptr;
  const Body* other = nullptr;  ///< null: static surface
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero(), normal_world = Eigen::Vector3d::Zero();
  double impulse_Ns = 0.0;
  Eigen::Vector3d friction_impulse_Ns = Eigen::Vector3d::Zero();
};

/// Contacts of a substep's bodies. Indices of solver bodies: first the substep's bodies, then the bystanders.
struct ContactSystem {
  std::vector<SolverContact> contacts;
  std::vector<double> gap_m;       ///< of each contact; a push: 0
  std::vector<SurfaceKind> kinds;  ///< of the surface that SolverContact::body touches
  std::vector<bool> is_push;       ///< the contact is a Push
  std::vector<SolverBody> bodies;
  std::vector<Bystander> bystanders;
  std::vector<PastContact> past;  ///< contacts of the last support solve, for initial guesses
  ContactSolver solver;
  std::vector<std::size_t> upwards;  ///< scratch: indices of bodies by height
};

/// Returns true if the substep still has to move the body.
bool is_active(const MovingBody& moving);

/// Finds the contacts of all active bodies within 1.5 contact margins, and of the sleeping bodies that they
/// touch, directly or through other sleeping bodies. Sets `crosses` of bodies that a surface intersects.
/// Contacts are ordered from the lowest body upwards.
/// @param up_world  unit, against gravity; zero without gravity
void find_contacts(std::span<MovingBody> bodies, const PhysicsConfig& config, const Eigen::Vector3d& up_world,
                   ContactSystem& system);

/// Bodies that a solve moves; all others are immovable in it.
enum class Movable {
  kAllButSleeping,          ///< and sleeping bodies that something hits faster than 5 cm/s
  kActiveAndKnownSleepers,  ///< active bodies, and sleeping bodies whose contacts are in the system
  kActive,
};
/// Sets the inverse masses of the solver bodies. kAllButSleeping needs their velocities.
void set_masses(std::span<const MovingBody> bodies, Movable movable, ContactSystem& system);

/// Returns the time left for the motion of a contact's bodies, s, > 0.
double left_s(std::span<const MovingBody> bodies, const SolverContact& contact);
/// Allows each contact to close its gap, down to the margin, in the time left. Pushes keep their speed.
void allow_closing_gaps(std::span<const MovingBody> bodies, double margin_m, ContactSystem& system);
void clear_impulses(ContactSystem& system);
/// Sets the contacts' impulses to those of the same contacts in system.past, scaled; to 0 where there are
/// none.
void guess_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system);
/// Stores the contacts' impulses, scaled, in system.past.
void keep_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system);

}  // namespace roomradar
