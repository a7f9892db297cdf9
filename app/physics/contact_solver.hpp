// contact_solver.hpp: contact and friction impulses on a rigid body.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <span>

namespace roomradar {

/// Linear velocity of a body's centre of mass, and the body's angular velocity.
struct Velocity {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// State of another body that touches the solved body.
struct SolverBody {
  Velocity velocity;
  Eigen::Matrix3d inverse_inertia_m2 = Eigen::Matrix3d::Zero();  ///< per kg, 1/m^2, in world axes
  /// Mass of the solved body divided by the mass of this other body, >= 0. 0: impulses do not move this body.
  double mass_ratio = 0.0;
};

/// Value of SolverContact::other for a contact with a static surface.
constexpr std::size_t kNoOther = std::numeric_limits<std::size_t>::max();

struct SolverContact {
  Eigen::Vector3d contact_offset_m = Eigen::Vector3d::Zero();  ///< from the centre of mass to the contact
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();           ///< unit, towards the body
  /// Lower bound of the separation speed along the normal after the solve. A negative bound permits approach
  /// at up to -leaves_mps.
  double leaves_mps = 0.0;
  std::size_t other = kNoOther;  ///< index of the other body; kNoOther: static surface
  /// From the other body's centre of mass to the contact.
  Eigen::Vector3d other_offset_m = Eigen::Vector3d::Zero();
  double impulse_mps = 0.0;  ///< out: normal impulse per kg, >= 0
  Eigen::Vector3d friction_impulse_mps =
      Eigen::Vector3d::Zero();  ///< out: friction impulse per kg, tangential
};

/// Returns the full velocity vector of the body at a contact, relative to the other body or static surface.
Eigen::Vector3d slip_at(const SolverContact& contact, const Velocity& velocity,
                        std::span<const SolverBody> others);

struct FrictionConfig {
  double friction = 0.0;  ///< Coulomb's coefficient
  /// Rolling resistance: max torque = `rolling` x normal force x length of contact_offset_m.
  double rolling = 0.0;
};

/// Returns the velocity of the body at contact_offset_m from its centre of mass.
inline Eigen::Vector3d velocity_at(const Velocity& velocity, const Eigen::Vector3d& contact_offset_m) {
  return velocity.linear_mps + velocity.angular_rad_s.cross(contact_offset_m);
}

/// Returns the kinetic energy per kg of body mass, m^2/s^2.
double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2);

/// Solves for contact impulses by projected Gauss-Seidel and applies them to `velocity` and `others`. After
/// the solve, each contact separates at leaves_mps or faster and obeys Coulomb's friction law. Other bodies
/// receive opposite impulses, so total momentum is conserved. If leaves_mps <= 0 at all contacts, impulses
/// add no energy. Contacts beyond the first 32 are ignored.
/// @param inertia_m2  about the centre of mass, in world axes
/// @param others      indexed by SolverContact::other; an index out of range stands for a static surface
/// Source: Catto, Iterative dynamics with temporal coherence, GDC 2005.
void solve_contacts(std::span<SolverContact> contacts, const Eigen::Matrix3d& inertia_m2,
                    const FrictionConfig& rubbing, Velocity& velocity, std::span<SolverBody> others = {});

}  // namespace roomradar
