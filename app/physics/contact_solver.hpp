// contact_solver.hpp: the impulses with which contacts keep a rigid body out, and rub.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <span>

namespace roomradar {

/// Of a body of 1 kg about its centre of mass.
struct Velocity {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// Another body that a contact lies on.
struct SolverOther {
  Velocity velocity;
  Eigen::Matrix3d inverse_inertia_m2 = Eigen::Matrix3d::Zero();  ///< of 1 kg, 1/m^2, in world axes
  double gives = 0.0;  ///< the body's mass over its own, >= 0; 0: it goes on as it goes, whatever it meets
};

constexpr std::size_t kNoOther = std::numeric_limits<std::size_t>::max();

struct SolverContact {
  Eigen::Vector3d arm_m = Eigen::Vector3d::Zero();    ///< from the centre of mass to the contact
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, towards the body
  double leaves_mps = 0.0;       ///< at least so fast along the normal afterwards, against what it lies on
  std::size_t other = kNoOther;  ///< whose; kNoOther: what stands still
  Eigen::Vector3d other_arm_m = Eigen::Vector3d::Zero();  ///< from the other's centre of mass
  double impulse_mps = 0.0;                               ///< out: along the normal, >= 0
  Eigen::Vector3d rub_mps = Eigen::Vector3d::Zero();      ///< out: across the normal
};

/// The velocity of the body at a contact, against what it lies on there.
Eigen::Vector3d slip_at(const SolverContact& contact, const Velocity& velocity,
                        std::span<const SolverOther> others);

struct Rubbing {
  double friction = 0.0;  ///< Coulomb's coefficient
  /// The torque that holds a rolling body back: this part of the normal force times the arm.
  double rolling = 0.0;
};

/// The velocity of a body's point at an arm.
inline Eigen::Vector3d velocity_at(const Velocity& velocity, const Eigen::Vector3d& arm_m) {
  return velocity.linear_mps + velocity.angular_rad_s.cross(arm_m);
}

/// m^2/s^2: the energy of motion of 1 kg.
double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2);

/// Changes the velocity by impulses until no contact is entered faster than it may be and no contact rubs
/// more than Coulomb's law lets it, one contact after the other, again and again (projected Gauss-Seidel).
/// What an impulse does to the body it does to the other, the other way; the momentum of both stays. Where
/// all contacts may be at rest no impulse adds energy.
/// @param inertia_m2  about the centre of mass, in world axes
/// @param others      that contacts name by their number; a contact with one that is not there lies on what
///                    stands still
/// Source: Catto, Iterative dynamics with temporal coherence, GDC 2005.
void solve_contacts(std::span<SolverContact> contacts, const Eigen::Matrix3d& inertia_m2,
                    const Rubbing& rubbing, Velocity& velocity, std::span<SolverOther> others = {});

}  // namespace roomradar
