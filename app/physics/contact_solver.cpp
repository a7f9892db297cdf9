// contact_solver.cpp: projected Gauss-Seidel over a body's contacts with static surfaces and other bodies.
#include "app/physics/contact_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr int kMaxIterations = 80;
constexpr double kSettled_mps = 1e-9;
constexpr std::size_t kMaxContacts = 32;

struct Effective {
  Vec3 x, y;                        // tangents
  double normal, along_x, along_y;  // effective masses, per kg of the body
};

/// Returns the tangents and effective masses of a contact.
/// @param inverse  inverse inertia of the body, 1/m^2, in world axes
Effective effective_masses(const SolverContact& contact, const Eigen::Matrix3d& inverse,
                           std::span<const SolverBody> others) {
  const auto mass_along = [&](const Vec3& direction) {
    const Vec3 lever = contact.contact_offset_m.cross(direction);
    double yields = 1.0 + lever.dot(inverse * lever);
    if (contact.other < others.size()) {
      const SolverBody& other = others[contact.other];
      const Vec3 other_lever = contact.other_offset_m.cross(direction);
      yields += other.mass_ratio * (1.0 + other_lever.dot(other.inverse_inertia_m2 * other_lever));
    }
    return 1.0 / yields;
  };
  Effective e;
  e.x = contact.normal.unitOrthogonal();
  e.y = contact.normal.cross(e.x);
  e.normal = mass_along(contact.normal);
  e.along_x = mass_along(e.x);
  e.along_y = mass_along(e.y);
  return e;
}

}  // namespace

double energy(const Velocity& velocity, const Eigen::Matrix3d& inertia_m2) {
  return 0.5 * (velocity.linear_mps.squaredNorm() +
                velocity.angular_rad_s.dot(inertia_m2 * velocity.angular_rad_s));
}

Eigen::Vector3d slip_at(const SolverContact& contact, const Velocity& velocity,
                        std::span<const SolverBody> others) {
  const Vec3 own = velocity_at(velocity, contact.contact_offset_m);
  if (contact.other >= others.size()) return own;
  return own - velocity_at(others[contact.other].velocity, contact.other_offset_m);
}

void solve_contacts(std::span<SolverContact> contacts, const Eigen::Matrix3d& inertia_m2,
                    const FrictionConfig& rubbing, Velocity& velocity, std::span<SolverBody> others) {
  contacts = contacts.first(std::min(contacts.size(), kMaxContacts));
  if (contacts.empty()) return;
  const Eigen::Matrix3d inverse = inertia_m2.inverse();
  std::array<Effective, kMaxContacts> effective;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].impulse_mps = 0.0;
    contacts[i].friction_impulse_mps.setZero();
    effective[i] = effective_masses(contacts[i], inverse, others);
  }
  const auto apply = [&](const SolverContact& contact, const Vec3& impulse) {
    velocity.linear_mps += impulse;
    velocity.angular_rad_s += inverse * contact.contact_offset_m.cross(impulse);
    if (contact.other >= others.size()) return;
    SolverBody& other = others[contact.other];
    other.velocity.linear_mps -= other.mass_ratio * impulse;
    other.velocity.angular_rad_s -=
        other.mass_ratio * other.inverse_inertia_m2 * contact.other_offset_m.cross(impulse);
  };
  Vec3 held_back = Vec3::Zero();  // angular impulse of rolling resistance
  for (int round = 0; round < kMaxIterations; ++round) {
    double change_mps = 0.0;
    if (rubbing.rolling > 0.0) {
      double limit = 0.0;
      for (const SolverContact& contact : contacts)
        limit += contact.impulse_mps * contact.contact_offset_m.norm();
      limit *= rubbing.rolling;
      Vec3 wanted = held_back - inertia_m2 * velocity.angular_rad_s;
      const double size = wanted.norm();
      if (size > limit) wanted *= limit / size;
      velocity.angular_rad_s += inverse * (wanted - held_back);
      held_back = wanted;
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      SolverContact& contact = contacts[i];
      const Effective& e = effective[i];
      const double enters_mps = contact.leaves_mps - slip_at(contact, velocity, others).dot(contact.normal);
      const double impulse = std::max(contact.impulse_mps + e.normal * enters_mps, 0.0);
      const double more = impulse - contact.impulse_mps;
      contact.impulse_mps = impulse;
      apply(contact, more * contact.normal);

      const Vec3 slip = slip_at(contact, velocity, others);
      Vec3 friction_impulse =
          contact.friction_impulse_mps - e.along_x * slip.dot(e.x) * e.x - e.along_y * slip.dot(e.y) * e.y;
      const double most = rubbing.friction * contact.impulse_mps;
      const double size = friction_impulse.norm();
      if (size > most) friction_impulse *= most / size;
      const Vec3 more_friction = friction_impulse - contact.friction_impulse_mps;
      contact.friction_impulse_mps = friction_impulse;
      apply(contact, more_friction);
      change_mps = std::max({change_mps, std::abs(more), more_friction.lpNorm<Eigen::Infinity>()});
    }
    if (change_mps < kSettled_mps) return;
  }
}

}  // namespace roomradar
