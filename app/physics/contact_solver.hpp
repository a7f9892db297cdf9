// contact_solver.hpp: contact and friction impulses on rigid bodies that touch each other and static
// surfaces.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace roomradar {

/// Linear velocity of a body's centre of mass, and the body's angular velocity.
struct Velocity {
  Eigen::Vector3d linear_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
};

/// How a body yields to impulses.
struct SolverBody {
  double inverse_mass_per_kg = 0.0;  ///< 0: impulses do not move this body
  /// Inertia per kg about the centre of mass, in world axes, and its inverse.
  Eigen::Matrix3d inertia_m2 = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d inverse_inertia_m2 = Eigen::Matrix3d::Identity();
};

/// Value of SolverContact::other for a contact with a static surface.
constexpr std::size_t kNoOther = std::numeric_limits<std::size_t>::max();

struct SolverContact {
  std::size_t body = 0;          ///< index of the body that the normal points to
  std::size_t other = kNoOther;  ///< index of the other body
  Eigen::Vector3d contact_offset_m = Eigen::Vector3d::Zero();  ///< from the body's centre of mass
  Eigen::Vector3d other_offset_m = Eigen::Vector3d::Zero();    ///< from the other body's centre of mass
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();           ///< unit
  /// Lower bound of the separation velocity along the normal after the solve. A negative bound permits
  /// approach at up to -leaves_mps.
  double leaves_mps = 0.0;
  double friction = 0.0;     ///< Coulomb's coefficient
  double restitution = 0.0;  ///< not used by the solver: callers set leaves_mps
  /// In: warm-start guess. Out: normal impulse on the body, >= 0.
  double impulse_Ns = 0.0;
  /// In: warm-start guess. Out: tangential friction impulse on the body.
  Eigen::Vector3d friction_impulse_Ns = Eigen::Vector3d::Zero();
};

/// Returns the velocity of the body's point at a contact relative to the other body or static surface.
/// @param velocities  of all bodies; an `other` out of range means a static surface
Eigen::Vector3d slip_at(const SolverContact& contact, std::span<const Velocity> velocities);

/// Returns the velocity of the body at contact_offset_m from its centre of mass.
inline Eigen::Vector3d velocity_at(const Velocity& velocity, const Eigen::Vector3d& contact_offset_m) {
  return velocity.linear_mps + velocity.angular_rad_s.cross(contact_offset_m);
}

/// Returns the kinetic energy per kg of body mass, m^2/s^2.
double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2);

/// Returns the kinetic energy of the bodies that impulses move, J.
double energy(std::span<const SolverBody> bodies, std::span<const Velocity> velocities);

/// Solves for contact impulses by projected Gauss-Seidel (sequential impulses), and for the velocities that
/// they give the bodies. Each connected component of bodies in contact (island) is solved as one system.
/// Sweeps end when none changes a velocity by 1e-8 m/s, and after 200. Each contact then separates at
/// leaves_mps or faster and obeys Coulomb's friction law, within this tolerance. The impulses on the two
/// bodies of a contact are opposite, so linear momentum is conserved. If leaves_mps <= 0 at all contacts and
/// all guesses are 0, impulses add no energy.
///
/// Nonlinear conjugate gradients speed up the convergence of the sweeps. Sources: Catto, Iterative dynamics
/// with temporal coherence, GDC 2005; Silcowitz, Niebe, Erleben, A nonsmooth nonlinear conjugate gradient
/// method for interactive contact force problems, The Visual Computer 2010.
class ContactSolver {
 public:
  /// Sets the impulses of the contacts, and returns the velocities of the bodies after these impulses.
  /// @param contacts    `body` and `other` are indices into `bodies`. An `other` out of range means a static
  ///                    surface
  /// @param velocities  before the impulses, one per body
  /// @param rolling     rolling resistance coefficient. Max torque = rolling x normal force x distance of the
  ///                    centre of mass from the contact's tangent plane (a ball's radius)
  [[nodiscard]] std::vector<Velocity> solve(std::span<SolverContact> contacts,
                                            std::span<const SolverBody> bodies,
                                            std::vector<Velocity> velocities, double rolling);

 private:
  using Vec4 = Eigen::Vector4d;  ///< three coordinates and 0: one register of four numbers

  struct Twist {
    Vec4 linear_mps = Vec4::Zero(), angular_rad_s = Vec4::Zero();
  };
  /// A direction of a contact, and the velocity changes by a unit impulse along it.
  struct Row {
    Vec4 direction, lever, other_lever, turns, other_turns;
    double effective_mass_kg, inverse_effective_mass_per_kg;
  };
  /// Contact of the system being solved, with its impulses along the normal and two tangents.
  struct SystemContact {
    std::array<Row, 3> rows;  ///< normal, x, y
    Eigen::Vector3d impulses_Ns, impulses_before_Ns, search_Ns;
    std::size_t index;        ///< of the contact in the span given to solve()
    std::size_t body, other;  ///< indices into twists_
    double inverse_mass_per_kg, other_inverse_mass_per_kg;
    double leaves_mps, friction;
    double arm_m, other_arm_m;  ///< distances of the centres of mass from the tangent plane

    [[nodiscard]] double slip_mps(int row, const Twist& own, const Twist& others) const;
    void apply(int row, double impulse_Ns, Twist& own, Twist& others) const;
  };
  struct Rolling {
    Eigen::Vector3d held_m2_rad_s;  ///< angular impulse per kg so far
    double limit_m2_rad_s;
  };

  std::vector<Twist> twists_;  ///< per body, and at the end that of static surfaces: zero
  std::vector<SystemContact> system_;
  std::vector<Rolling> rolling_;
  std::vector<std::size_t> system_of_body_;  ///< kNoOther: immovable
  std::vector<std::size_t> system_of_contact_;
  std::vector<std::size_t> members_;  ///< bodies of the system being solved

  void find_systems(std::span<const SolverContact> contacts, std::span<const SolverBody> bodies);
  /// Adds a contact to the system, and applies its guessed impulses.
  void add_contact(std::size_t index, const SolverContact& contact, std::span<const SolverBody> bodies);
  void solve_system(std::span<const SolverBody> bodies, double rolling);
  double sweep();
  double accelerate(double before);
  double resist_rolling(std::span<const SolverBody> bodies, double rolling);
};

}  // namespace roomradar
