// support.cpp: adds up the impulses of a body's contacts.
#include "app/physics/support.hpp"

#include <algorithm>
#include <array>

#include "app/physics/sliding.hpp"

namespace roomradar {
namespace {

struct Load {
  double support_Ns = 0.0, any_Ns = 0.0;  // greatest of a supporting contact, of any contact
  double lift_Ns = 0.0;                   // of all contacts
  SurfaceKind any_kind = SurfaceKind::kNothing;
};

}  // namespace

void note_support(std::span<const MovingBody> bodies, const PhysicsConfig& config,
                  const Eigen::Vector3d& up_world, const ContactSystem& system,
                  std::vector<SubstepResult>& results) {
  const double g = config.gravity_world_mps2.norm();
  std::vector<Load> loads(bodies.size());
  const auto note = [&](std::size_t body, const Body* other, const SolverContact& contact, double sign,
                        SurfaceKind kind) {
    if (body >= bodies.size() || !is_active(bodies[body])) return;
    SubstepResult& result = results[body];
    if (other != nullptr &&
        std::find(result.touches.begin(), result.touches.end(), other) == result.touches.end())
      result.touches.push_back(other);
    Load& load = loads[body];
    load.lift_Ns += sign * (contact.impulse_Ns * contact.normal + contact.friction_impulse_Ns).dot(up_world);
    if (contact.impulse_Ns > load.any_Ns) {
      load.any_Ns = contact.impulse_Ns;
      load.any_kind = kind;
    }
    if (!(contact.impulse_Ns > load.support_Ns) || sign * contact.normal.dot(up_world) < kSupportCosine)
      return;
    load.support_Ns = contact.impulse_Ns;
    result.is_held_up = true;
    result.rests_on = kind;
  };
  const auto body_at = [&](std::size_t index) -> const Body* {
    if (index == kNoOther) return nullptr;
    return index < bodies.size() ? bodies[index].body : system.bystanders[index - bodies.size()].body;
  };
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const SolverContact& contact = system.contacts[i];
    note(contact.body, body_at(contact.other), contact, 1.0, system.kinds[i]);
    note(contact.other, body_at(contact.body), contact, -1.0, SurfaceKind::kObject);
  }
  constexpr double kBorne = 0.9;  // fraction of the weight
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double weight_Ns = bodies[i].mass_kg * g * bodies[i].left_s;
    if (results[i].is_held_up || !(loads[i].lift_Ns > kBorne * weight_Ns) || !(weight_Ns > 0.0)) continue;
    results[i].is_held_up = true;
    results[i].rests_on = loads[i].any_kind;
  }
}

void count_impacts(std::span<const MovingBody> bodies, const ContactSystem& system) {
  std::vector<std::array<bool, kSurfaceKinds>> is_met(bodies.size());
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const SolverContact& contact = system.contacts[i];
    if (!(contact.impulse_Ns > 0.0)) continue;
    is_met[contact.body][static_cast<std::size_t>(system.kinds[i])] = true;
    if (contact.other < bodies.size())
      is_met[contact.other][static_cast<std::size_t>(SurfaceKind::kObject)] = true;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
      if (is_met[i][kind]) note_contact(static_cast<SurfaceKind>(kind), *bodies[i].report);
}

}  // namespace roomradar
