// contact_solver.cpp: projected Gauss-Seidel with conjugate gradients, one system of connected bodies at a
// time.
#include "app/physics/contact_solver.hpp"

#include <algorithm>
#include <array>
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

void apply(const SolverContact& contact, std::span<SolverBody> bodies, const Vec3& direction,
           const Vec3& turns, const Vec3& other_turns, double impulse_Ns) {
  SolverBody& body = bodies[contact.body];
  body.velocity.linear_mps += impulse_Ns * body.inverse_mass_per_kg * direction;
  body.velocity.angular_rad_s += impulse_Ns * turns;
  if (contact.other >= bodies.size()) return;
  SolverBody& other = bodies[contact.other];
  other.velocity.linear_mps -= impulse_Ns * other.inverse_mass_per_kg * direction;
  other.velocity.angular_rad_s -= impulse_Ns * other_turns;
}

}  // namespace

double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2) {
  return 0.5 * (velocity.linear_mps.squaredNorm() +
                velocity.angular_rad_s.dot(inertia_m2 * velocity.angular_rad_s));
}

double energy(std::span<const SolverBody> bodies) {
  double sum_J = 0.0;
  for (const SolverBody& body : bodies)
    if (body.inverse_mass_per_kg > 0.0)
      sum_J += energy(body.velocity, body.inertia_m2) / body.inverse_mass_per_kg;
  return sum_J;
}

Eigen::Vector3d slip_at(const SolverContact& contact, std::span<const SolverBody> bodies) {
  const Vec3 own = velocity_at(bodies[contact.body].velocity, contact.contact_offset_m);
  if (contact.other >= bodies.size()) return own;
  return own - velocity_at(bodies[contact.other].velocity, contact.other_offset_m);
}

Eigen::Vector3d ContactSolver::impulses_of(const SolverContact& contact, const Rows& rows) {
  return {contact.impulse_Ns, contact.friction_impulse_Ns.dot(rows.x.direction),
          contact.friction_impulse_Ns.dot(rows.y.direction)};
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

void ContactSolver::solve(std::span<SolverContact> contacts, std::span<SolverBody> bodies, double rolling) {
  if (contacts.empty()) return;
  find_systems(contacts, bodies);
  rows_.resize(contacts.size());
  rolling_.assign(bodies.size(), {Vec3::Zero(), 0.0});
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (system_of_contact_[i] != kNoOther) continue;
    contacts[i].impulse_Ns = 0.0;
    contacts[i].friction_impulse_Ns.setZero();
  }
  for (std::size_t system = 0; system < bodies.size(); ++system) {
    if (system_of_body_[system] != system) continue;
    order_.clear();
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (system_of_contact_[i] == system) order_.push_back(i);
    if (order_.empty()) continue;
    members_.clear();
    for (std::size_t body = 0; body < bodies.size(); ++body)
      if (system_of_body_[body] == system) members_.push_back(body);
    solve_system(contacts, bodies, rolling);
  }
}

void ContactSolver::solve_system(std::span<SolverContact> contacts, std::span<SolverBody> bodies,
                                 double rolling) {
  for (const std::size_t i : order_) {
    SolverContact& contact = contacts[i];
    const SolverBody& body = bodies[contact.body];
    const SolverBody* other = contact.other < bodies.size() ? &bodies[contact.other] : nullptr;
    const auto row_along = [&](const Vec3& direction) {
      Row row;
      row.direction = direction;
      row.lever = contact.contact_offset_m.cross(direction);
      row.turns = body.inverse_mass_per_kg * (body.inverse_inertia_m2 * row.lever);
      double yields = body.inverse_mass_per_kg + row.lever.dot(row.turns);
      row.other_lever.setZero();
      row.other_turns.setZero();
      if (other != nullptr) {
        row.other_lever = contact.other_offset_m.cross(direction);
        row.other_turns = other->inverse_mass_per_kg * (other->inverse_inertia_m2 * row.other_lever);
        yields += other->inverse_mass_per_kg + row.other_lever.dot(row.other_turns);
      }
      row.effective_mass_kg = 1.0 / yields;
      return row;
    };
    const Vec3 x = contact.normal.unitOrthogonal();
    Rows& rows = rows_[i];
    rows = {row_along(contact.normal), row_along(x), row_along(contact.normal.cross(x))};
    for (const Row* row : {&rows.normal, &rows.x, &rows.y}) {
      const double guess_Ns =
          row == &rows.normal ? contact.impulse_Ns : contact.friction_impulse_Ns.dot(row->direction);
      if (guess_Ns != 0.0) apply(contact, bodies, row->direction, row->turns, row->other_turns, guess_Ns);
    }
  }
  double before = 0.0;  // squared norm of the change by the last sweep
  search_.assign(order_.size(), Vec3::Zero());
  for (int sweeps = 0; sweeps < kMaxSweeps; ++sweeps) {
    impulses_before_.clear();
    for (const std::size_t i : order_) impulses_before_.push_back(impulses_of(contacts[i], rows_[i]));
    const double turned_mps = rolling > 0.0 ? resist_rolling(contacts, bodies, rolling) : 0.0;
    const double change_mps = sweep(contacts, bodies);
    if (std::max(change_mps, turned_mps) < kSettled_mps || sweeps + 1 == kMaxSweeps) return;
    before = accelerate(contacts, bodies, before);
  }
}

/// Continues the changes of the past sweeps: conjugate gradients of Fletcher and Reeves, with restarts. The
/// next sweep restores feasible impulses. Returns the squared norm of the last sweep's change.
double ContactSolver::accelerate(std::span<SolverContact> contacts, std::span<SolverBody> bodies,
                                 double before) {
  double now = 0.0;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const SolverContact& contact = contacts[order_[k]];
    const Rows& rows = rows_[order_[k]];
    Vec3& change = impulses_before_[k];
    change = impulses_of(contact, rows) - change;
    now += change.x() * change.x() / rows.normal.effective_mass_kg +
           change.y() * change.y() / rows.x.effective_mass_kg +
           change.z() * change.z() / rows.y.effective_mass_kg;
  }
  const bool restarts = !(before > 0.0) || now > before;
  const double kept = restarts ? 0.0 : now / before;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const Vec3 more_Ns = kept * search_[k];
    search_[k] = more_Ns + impulses_before_[k];
    if (restarts || more_Ns.isZero(0.0)) continue;
    SolverContact& contact = contacts[order_[k]];
    const Rows& rows = rows_[order_[k]];
    const std::array<const Row*, 3> all = {&rows.normal, &rows.x, &rows.y};
    for (int axis = 0; axis < 3; ++axis)
      apply(contact, bodies, all[axis]->direction, all[axis]->turns, all[axis]->other_turns, more_Ns[axis]);
    contact.impulse_Ns += more_Ns.x();
    contact.friction_impulse_Ns += more_Ns.y() * rows.x.direction + more_Ns.z() * rows.y.direction;
  }
  return now;
}

/// Applies rolling resistance; returns the greatest change of a body's angular momentum per kg and m.
double ContactSolver::resist_rolling(std::span<const SolverContact> contacts, std::span<SolverBody> bodies,
                                     double rolling) {
  for (const std::size_t i : members_) rolling_[i].limit_m2_rad_s = 0.0;
  for (const std::size_t i : order_) {
    const SolverContact& contact = contacts[i];
    rolling_[contact.body].limit_m2_rad_s +=
        contact.impulse_Ns * std::abs(contact.contact_offset_m.dot(contact.normal));
    if (contact.other < bodies.size())
      rolling_[contact.other].limit_m2_rad_s +=
          contact.impulse_Ns * std::abs(contact.other_offset_m.dot(contact.normal));
  }
  double most = 0.0;
  for (const std::size_t i : members_) {
    SolverBody& body = bodies[i];
    Rolling& resistance = rolling_[i];
    const double limit = rolling * resistance.limit_m2_rad_s * body.inverse_mass_per_kg;
    Vec3 wanted = resistance.held_m2_rad_s - body.inertia_m2 * body.velocity.angular_rad_s;
    const double size = wanted.norm();
    if (size > limit) wanted *= limit / size;
    const Vec3 more = wanted - resistance.held_m2_rad_s;
    body.velocity.angular_rad_s += body.inverse_inertia_m2 * more;
    resistance.held_m2_rad_s = wanted;
    most = std::max(most, more.lpNorm<Eigen::Infinity>());
  }
  return most;
}

/// Solves each contact of the system once; returns the greatest change of a velocity.
double ContactSolver::sweep(std::span<SolverContact> contacts, std::span<SolverBody> bodies) {
  double change_mps = 0.0;
  const auto slip_along = [&](const SolverContact& contact, const Row& row) {
    const Velocity& own = bodies[contact.body].velocity;
    double slip_mps = own.linear_mps.dot(row.direction) + own.angular_rad_s.dot(row.lever);
    if (contact.other < bodies.size()) {
      const Velocity& other = bodies[contact.other].velocity;
      slip_mps -= other.linear_mps.dot(row.direction) + other.angular_rad_s.dot(row.other_lever);
    }
    return slip_mps;
  };
  for (const std::size_t i : order_) {
    SolverContact& contact = contacts[i];
    const Rows& rows = rows_[i];
    const auto change = [&](const Row& row, double more_Ns) {
      apply(contact, bodies, row.direction, row.turns, row.other_turns, more_Ns);
      change_mps = std::max(change_mps, std::abs(more_Ns) / row.effective_mass_kg);
    };
    const double enters_mps = contact.leaves_mps - slip_along(contact, rows.normal);
    const double impulse_Ns = std::max(contact.impulse_Ns + rows.normal.effective_mass_kg * enters_mps, 0.0);
    change(rows.normal, impulse_Ns - contact.impulse_Ns);
    contact.impulse_Ns = impulse_Ns;
    if (!(contact.friction > 0.0)) continue;

    const double before_x = contact.friction_impulse_Ns.dot(rows.x.direction);
    const double before_y = contact.friction_impulse_Ns.dot(rows.y.direction);
    double x_Ns = before_x - rows.x.effective_mass_kg * slip_along(contact, rows.x);
    double y_Ns = before_y - rows.y.effective_mass_kg * slip_along(contact, rows.y);
    const double most_Ns = contact.friction * impulse_Ns;
    const double size_Ns = std::sqrt(x_Ns * x_Ns + y_Ns * y_Ns);
    if (size_Ns > most_Ns) {
      x_Ns *= most_Ns / size_Ns;
      y_Ns *= most_Ns / size_Ns;
    }
    change(rows.x, x_Ns - before_x);
    change(rows.y, y_Ns - before_y);
    contact.friction_impulse_Ns = x_Ns * rows.x.direction + y_Ns * rows.y.direction;
  }
  return change_mps;
}

}  // namespace roomradar
