// contact_solver.cpp: projected Gauss-Seidel with conjugate gradients, one system of connected bodies at a
// time.
#include "app/physics/contact_solver.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr int kMaxSweeps = 200;
constexpr double kSettled_mps = 1e-8;

bool is_movable(std::span<const SolverBody> bodies, std::size_t body) {
  return body < bodies.size() && bodies[body].inverse_mass_per_kg > 0.0;
}

Eigen::Vector4d with_zero(const Vec3& v) { return {v.x(), v.y(), v.z(), 0.0}; }

}  // namespace

double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2) {
  return 0.5 * (velocity.linear_mps.squaredNorm() +
                velocity.angular_rad_s.dot(inertia_m2 * velocity.angular_rad_s));
}

double energy(std::span<const SolverBody> bodies, std::span<const Velocity> velocities) {
  double sum_J = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].inverse_mass_per_kg > 0.0)
      sum_J += energy(velocities[i], bodies[i].inertia_m2) / bodies[i].inverse_mass_per_kg;
  return sum_J;
}

Eigen::Vector3d slip_at(const SolverContact& contact, std::span<const Velocity> velocities) {
  const Vec3 own = velocity_at(velocities[contact.body], contact.contact_offset_m);
  if (contact.other >= velocities.size()) return own;
  return own - velocity_at(velocities[contact.other], contact.other_offset_m);
}

/// Returns the velocity along a row of the body relative to the other one.
inline double ContactSolver::SystemContact::slip_mps(int row, const Twist& own, const Twist& others) const {
  const Row& r = rows[static_cast<std::size_t>(row)];
  return ((own.linear_mps - others.linear_mps).cwiseProduct(r.direction) +
          own.angular_rad_s.cwiseProduct(r.lever) - others.angular_rad_s.cwiseProduct(r.other_lever))
      .sum();
}

inline void ContactSolver::SystemContact::apply(int row, double impulse_Ns, Twist& own, Twist& others) const {
  const Row& r = rows[static_cast<std::size_t>(row)];
  own.linear_mps += impulse_Ns * inverse_mass_per_kg * r.direction;
  own.angular_rad_s += impulse_Ns * r.turns;
  others.linear_mps -= impulse_Ns * other_inverse_mass_per_kg * r.direction;
  others.angular_rad_s -= impulse_Ns * r.other_turns;
}

/// Joins movable bodies that touch, and sets each contact's system. A contact between immovable bodies has
/// none.
void ContactSolver::find_systems(std::span<const SolverContact> contacts,
                                 std::span<const SolverBody> bodies) {
  DisjointSets<std::size_t> connected(bodies.size());
  for (const SolverContact& contact : contacts)
    if (is_movable(bodies, contact.body) && is_movable(bodies, contact.other))
      connected.join(contact.body, contact.other);
  system_of_body_.assign(bodies.size(), kNoOther);
  for (std::size_t body = 0; body < bodies.size(); ++body)
    if (is_movable(bodies, body)) system_of_body_[body] = connected.find(body);
  system_of_contact_.assign(contacts.size(), kNoOther);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (const std::size_t body : {contacts[i].body, contacts[i].other})
      if (is_movable(bodies, body)) system_of_contact_[i] = system_of_body_[body];
}

std::vector<Velocity> ContactSolver::solve(std::span<SolverContact> contacts,
                                           std::span<const SolverBody> bodies,
                                           std::vector<Velocity> velocities, double rolling) {
  if (contacts.empty()) return velocities;
  find_systems(contacts, bodies);
  rolling_.assign(bodies.size(), {Vec3::Zero(), 0.0});
  twists_.clear();
  for (const Velocity& velocity : velocities)
    twists_.push_back({with_zero(velocity.linear_mps), with_zero(velocity.angular_rad_s)});
  twists_.emplace_back();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (system_of_contact_[i] != kNoOther) continue;
    contacts[i].impulse_Ns = 0.0;
    contacts[i].friction_impulse_Ns.setZero();
  }
  for (std::size_t system = 0; system < bodies.size(); ++system) {
    if (system_of_body_[system] != system) continue;
    system_.clear();
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (system_of_contact_[i] == system) add_contact(i, contacts[i], bodies);
    if (system_.empty()) continue;
    members_.clear();
    for (std::size_t body = 0; body < bodies.size(); ++body)
      if (system_of_body_[body] == system) members_.push_back(body);
    solve_system(bodies, rolling);
    for (const SystemContact& solved : system_) {
      SolverContact& contact = contacts[solved.index];
      contact.impulse_Ns = solved.impulses_Ns.x();
      contact.friction_impulse_Ns = (solved.impulses_Ns.y() * solved.rows[1].direction +
                                     solved.impulses_Ns.z() * solved.rows[2].direction)
                                        .head<3>();
    }
    for (const std::size_t member : members_) {
      velocities[member].linear_mps = twists_[member].linear_mps.head<3>();
      velocities[member].angular_rad_s = twists_[member].angular_rad_s.head<3>();
    }
  }
  return velocities;
}

void ContactSolver::add_contact(std::size_t index, const SolverContact& contact,
                                std::span<const SolverBody> bodies) {
  const SolverBody& body = bodies[contact.body];
  const SolverBody* other = contact.other < bodies.size() ? &bodies[contact.other] : nullptr;
  const auto row_along = [&](const Vec3& direction) {
    Row row;
    const Vec3 lever = contact.contact_offset_m.cross(direction);
    const Vec3 turns = body.inverse_mass_per_kg * (body.inverse_inertia_m2 * lever);
    double yields = body.inverse_mass_per_kg + lever.dot(turns);
    row.direction = with_zero(direction);
    row.lever = with_zero(lever);
    row.turns = with_zero(turns);
    row.other_lever.setZero();
    row.other_turns.setZero();
    if (other != nullptr) {
      const Vec3 other_lever = contact.other_offset_m.cross(direction);
      const Vec3 other_turns = other->inverse_mass_per_kg * (other->inverse_inertia_m2 * other_lever);
      yields += other->inverse_mass_per_kg + other_lever.dot(other_turns);
      row.other_lever = with_zero(other_lever);
      row.other_turns = with_zero(other_turns);
    }
    row.effective_mass_kg = 1.0 / yields;
    row.inverse_effective_mass_per_kg = yields;
    return row;
  };
  const Vec3 x = contact.normal.unitOrthogonal(), y = contact.normal.cross(x);
  const SystemContact& added = system_.emplace_back(
      SystemContact{.rows = {row_along(contact.normal), row_along(x), row_along(y)},
                    .impulses_Ns = {contact.impulse_Ns, contact.friction_impulse_Ns.dot(x),
                                    contact.friction_impulse_Ns.dot(y)},
                    .impulses_before_Ns = Vec3::Zero(),
                    .search_Ns = Vec3::Zero(),
                    .index = index,
                    .body = contact.body,
                    .other = other != nullptr ? contact.other : bodies.size(),
                    .inverse_mass_per_kg = body.inverse_mass_per_kg,
                    .other_inverse_mass_per_kg = other != nullptr ? other->inverse_mass_per_kg : 0.0,
                    .leaves_mps = contact.leaves_mps,
                    .friction = contact.friction,
                    .arm_m = std::abs(contact.contact_offset_m.dot(contact.normal)),
                    .other_arm_m = std::abs(contact.other_offset_m.dot(contact.normal))});
  for (int row = 0; row < 3; ++row)
    if (const double guess_Ns = added.impulses_Ns[row]; guess_Ns != 0.0)
      added.apply(row, guess_Ns, twists_[added.body], twists_[added.other]);
}

void ContactSolver::solve_system(std::span<const SolverBody> bodies, double rolling) {
  double before = 0.0;  // squared norm of the change by the last sweep
  for (int sweeps = 0; sweeps < kMaxSweeps; ++sweeps) {
    for (SystemContact& contact : system_) contact.impulses_before_Ns = contact.impulses_Ns;
    const double turned_mps = rolling > 0.0 ? resist_rolling(bodies, rolling) : 0.0;
    const double change_mps = sweep();
    if (std::max(change_mps, turned_mps) < kSettled_mps || sweeps + 1 == kMaxSweeps) return;
    before = accelerate(before);
  }
}

/// Continues the changes of the past sweeps: conjugate gradients of Fletcher and Reeves, with restarts. The
/// next sweep restores feasible impulses. Returns the squared norm of the last sweep's change.
double ContactSolver::accelerate(double before) {
  double now = 0.0;
  for (const SystemContact& contact : system_)
    for (int row = 0; row < 3; ++row) {
      const double change_Ns = contact.impulses_Ns[row] - contact.impulses_before_Ns[row];
      now +=
          change_Ns * change_Ns * contact.rows[static_cast<std::size_t>(row)].inverse_effective_mass_per_kg;
    }
  const bool restarts = !(before > 0.0) || now > before;
  const double kept = restarts ? 0.0 : now / before;
  for (SystemContact& contact : system_) {
    const Vec3 change_Ns = contact.impulses_Ns - contact.impulses_before_Ns;
    const Vec3 more_Ns = kept * contact.search_Ns;
    contact.search_Ns = more_Ns + change_Ns;
    if (restarts || more_Ns.isZero(0.0)) continue;
    Twist own = twists_[contact.body], others = twists_[contact.other];
    for (int row = 0; row < 3; ++row) contact.apply(row, more_Ns[row], own, others);
    twists_[contact.body] = own;
    twists_[contact.other] = others;
    contact.impulses_Ns += more_Ns;
  }
  return now;
}

/// Applies rolling resistance; returns the greatest change of a body's angular momentum per kg and m.
double ContactSolver::resist_rolling(std::span<const SolverBody> bodies, double rolling) {
  for (const std::size_t i : members_) rolling_[i].limit_m2_rad_s = 0.0;
  for (const SystemContact& contact : system_) {
    rolling_[contact.body].limit_m2_rad_s += contact.impulses_Ns.x() * contact.arm_m;
    if (contact.other < bodies.size())
      rolling_[contact.other].limit_m2_rad_s += contact.impulses_Ns.x() * contact.other_arm_m;
  }
  double most = 0.0;
  for (const std::size_t i : members_) {
    const SolverBody& body = bodies[i];
    Twist& twist = twists_[i];
    Rolling& resistance = rolling_[i];
    const double limit = rolling * resistance.limit_m2_rad_s * body.inverse_mass_per_kg;
    Vec3 wanted = resistance.held_m2_rad_s - body.inertia_m2 * twist.angular_rad_s.head<3>();
    const double size = wanted.norm();
    if (size > limit) wanted *= limit / size;
    const Vec3 more = wanted - resistance.held_m2_rad_s;
    twist.angular_rad_s.head<3>() += body.inverse_inertia_m2 * more;
    resistance.held_m2_rad_s = wanted;
    most = std::max(most, more.lpNorm<Eigen::Infinity>());
  }
  return most;
}

/// Solves each contact of the system once; returns the greatest change of a velocity.
double ContactSolver::sweep() {
  double change_mps = 0.0;
  for (SystemContact& contact : system_) {
    Twist own = twists_[contact.body], others = twists_[contact.other];
    const auto change = [&](int row, double impulse_Ns) {
      const double more_Ns = impulse_Ns - contact.impulses_Ns[row];
      contact.apply(row, more_Ns, own, others);
      contact.impulses_Ns[row] = impulse_Ns;
      const Row& r = contact.rows[static_cast<std::size_t>(row)];
      change_mps = std::max(change_mps, std::abs(more_Ns) * r.inverse_effective_mass_per_kg);
    };
    /// The impulse along a row that ends the motion below a speed.
    const auto impulse_for = [&](int row, double speed_mps) {
      const double missing_mps = speed_mps - contact.slip_mps(row, own, others);
      return contact.impulses_Ns[row] +
             contact.rows[static_cast<std::size_t>(row)].effective_mass_kg * missing_mps;
    };
    change(0, std::max(impulse_for(0, contact.leaves_mps), 0.0));
    if (contact.friction > 0.0) {
      double x_Ns = impulse_for(1, 0.0);
      double y_Ns = impulse_for(2, 0.0);
      const double most_Ns = contact.friction * contact.impulses_Ns.x();
      const double size_Ns = std::sqrt(x_Ns * x_Ns + y_Ns * y_Ns);
      if (size_Ns > most_Ns) {
        x_Ns *= most_Ns / size_Ns;
        y_Ns *= most_Ns / size_Ns;
      }
      change(1, x_Ns);
      change(2, y_Ns);
    }
    twists_[contact.body] = own;
    twists_[contact.other] = others;
  }
  return change_mps;
}

}  // namespace roomradar
