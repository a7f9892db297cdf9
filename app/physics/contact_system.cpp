// contact_system.cpp: contacts of the closest features, and the solver's bodies.
#include "app/physics/contact_system.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "app/physics/contact_queries.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;
constexpr double kCarried = 1e6;  // factor of a carried body's mass: other bodies hardly move the hand

/// Returns the solver's view of a body; set_masses() sets its mass.
SolverBody solver_body(const Body& body) {
  const Eigen::Matrix3d inertia_m2 = inertia_world_m2(body);
  return {0.0, inertia_m2, inertia_m2.inverse()};
}

/// Returns the solver index of a bystander.
std::size_t bystander_index(std::span<const MovingBody> bodies, const SceneBody& scene_body, double mass_kg,
                            ContactSystem& system) {
  for (std::size_t i = 0; i < system.bystanders.size(); ++i)
    if (system.bystanders[i].body == scene_body.body) return bodies.size() + i;
  system.bystanders.push_back({scene_body.body, scene_body.mass_ratio / mass_kg});
  system.bodies.push_back(solver_body(*scene_body.body));
  return system.bodies.size() - 1;
}

/// Returns the plane fitted to the surface about a contact, or about a contact that is a third of the reach
/// away.
const FittedPlane& plane_about(const ClosestPoint& p, double reach_m, MovingBody& moving) {
  constexpr double kSameFacing = 0.9;
  for (const PatchPlane& patch : moving.patches)
    if (patch.tree == p.tree && (patch.point_world - p.point_world).norm() < reach_m / 3.0 &&
        patch.plane.normal_world.dot(p.normal_world) > kSameFacing)
      return patch.plane;
  moving.patches.push_back(
      {p.tree, p.point_world, moving.probe.patch(p.tree, p.point_world, p.normal_world, reach_m)});
  return moving.patches.back().plane;
}

/// Gives a contact with a mapped surface the normal of the plane fitted to the surface about it, if the
/// surface is flat within a map's noise there, and the contact is a facet or bump of this noise: such bumps
/// must not brake the body. A step, an edge or rough ground keeps the normal of the feature that is touched.
/// The impulse acts where a plane would touch a round body, so that it turns the body as little as along the
/// feature's normal. Returns whether the contact was changed.
bool patch_contact(MovingBody& moving, const ClosestPoint& p, const PhysicsConfig& config,
                   SolverContact& contact) {
  constexpr double kSteepest = 0.5;     // cosine of 60 degrees: facets of a few mm may be steep
  constexpr double kHighest = 1.5;      // of the allowed roughness: height of a bump over the plane
  constexpr double kNarrow = 0.25;      // of the reach: too narrow for a plane
  constexpr double kLongest_m = 0.1;    // of a round body's radius
  constexpr double kSame = 1.0 - 1e-9;  // on a flat surface, features keep their normals
  if (p.kind != SurfaceKind::kStatic || !moving.probe.patch || !(config.patch_reach_m > 0.0)) return false;
  const FittedPlane& patch = plane_about(p, config.patch_reach_m, moving);
  const double cosine = patch.normal_world.dot(p.normal_world);
  if (!(cosine > kSteepest) || cosine > kSame) return false;
  if (patch.roughness_m > config.roughness_m || patch.extent_m < kNarrow * config.patch_reach_m) return false;
  if (patch.normal_world.dot(p.point_world - patch.centre_world) > kHighest * config.roughness_m)
    return false;
  const double arm_m = std::clamp(-contact.contact_offset_m.dot(patch.normal_world), 0.0, kLongest_m);
  contact.contact_offset_m += arm_m * (p.normal_world - cosine * patch.normal_world);
  contact.normal = patch.normal_world;
  return true;
}

/// Adds the contacts of one body, except those of pairs that are in the system.
void add_contacts(std::span<MovingBody> bodies, std::size_t index, const std::vector<bool>& is_listed,
                  const PhysicsConfig& config, ContactSystem& system) {
  MovingBody& moving = bodies[index];
  const Vec3 centre = centre_world(moving.body);
  for (const ClosestPoint& p : moving.near) {
    SolverContact contact;
    contact.body = index;
    contact.contact_offset_m = p.point_world + p.gap_m * p.normal_world - centre;
    contact.normal = p.normal_world;
    const BodyMaterial& material = moving.body.material;
    Coefficients coefficients = moving.in.is_carried ? Coefficients{} : on_room(material, config);
    if (const Body* other = body_of(moving.probe.others, p)) {
      contact.other = member_of(moving, p);
      if (contact.other == kNoOther)
        contact.other = bystander_index(bodies, moving.probe.others[p.tree], moving.in.mass_kg, system);
      // Bodies are listed upwards, moving ones before sleeping ones; a sleeping body's features may be older.
      const bool is_limit = p.point_world == moving.limited_by.point_world;  // known to be in no other list
      if (contact.other < bodies.size() && is_listed[contact.other] && !is_limit) continue;
      contact.other_offset_m = p.point_world - centre_world(*other);
      // The hand that carries an object has no friction of its own.
      if (!moving.in.is_carried || (contact.other < bodies.size() && !bodies[contact.other].in.is_carried))
        coefficients = between(material, other->material, config);
    }
    contact.friction = coefficients.friction;
    contact.restitution = coefficients.restitution;
    Feature& feature = system.features.emplace_back(Feature{contact.normal, contact.contact_offset_m});
    feature.is_on_patch = patch_contact(moving, p, config, contact);
    feature.patch_normal = contact.normal;
    system.contacts.push_back(contact);
    system.gap_m.push_back(p.gap_m);
    system.kinds.push_back(p.kind);
    system.push.push_back(nullptr);
  }
  for (const Push& push : moving.pushes) {
    SolverContact& contact = system.contacts.emplace_back();
    contact.body = index;
    contact.contact_offset_m = push.point_world - centre;
    contact.normal = push.normal_world;
    contact.friction = on_room(moving.body.material, config).friction;
    system.features.push_back({contact.normal, contact.contact_offset_m});
    system.gap_m.push_back(0.0);
    system.kinds.push_back(push.touched);
    system.push.push_back(&push);
  }
}

double inverse_mass_per_kg(const MovingBody& moving) {
  return 1.0 / ((moving.in.is_carried ? kCarried : 1.0) * moving.in.mass_kg);
}

/// Returns true if something hits the body of this solver index faster than kNudge_mps.
bool is_hit(std::size_t index, std::span<const Velocity> velocities, const ContactSystem& system) {
  constexpr double kNudge_mps = 0.05;
  return std::any_of(system.contacts.begin(), system.contacts.end(), [&](const SolverContact& contact) {
    return (contact.other == index || contact.body == index) &&
           -slip_at(contact, velocities).dot(contact.normal) > kNudge_mps;
  });
}

}  // namespace

bool recall_contacts(std::span<const SleeperContacts> known, const Body& body,
                     std::span<const SceneBody> others, std::vector<ClosestPoint>& near) {
  const auto own =
      std::find_if(known.begin(), known.end(), [&](const SleeperContacts& one) { return one.body == &body; });
  if (own == known.end() || own->T_world_object.matrix() != body.T_world_object.matrix()) return false;
  near = own->near;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const SleeperContacts::ContactBody& contact = own->bodies[i];
    const auto other = std::find_if(others.begin(), others.end(),
                                    [&](const SceneBody& one) { return one.body == contact.body; });
    near[i].tree = static_cast<std::uint32_t>(other - others.begin());  // beyond the end: no body
    if (contact.body == nullptr) continue;
    if (other == others.end() || other->body->T_world_object.matrix() != contact.T_world_body.matrix())
      return false;
  }
  return true;
}

void remember_contacts(std::vector<SleeperContacts>& known, const Body& body,
                       std::span<const SceneBody> others, const std::vector<ClosestPoint>& near) {
  auto own =
      std::find_if(known.begin(), known.end(), [&](const SleeperContacts& one) { return one.body == &body; });
  if (own == known.end()) own = known.insert(own, SleeperContacts{});
  own->body = &body;
  own->T_world_object = body.T_world_object;
  own->near = near;
  own->bodies.clear();
  for (const ClosestPoint& p : near) {
    const Body* other = body_of(others, p);
    own->bodies.push_back({other, other != nullptr ? other->T_world_object : Eigen::Isometry3d::Identity()});
  }
}

WorkerThread* worker_for(std::size_t queried_bodies, ContactSystem& system) {
  constexpr std::size_t kFewest = 8;  // waking the worker takes some 0.1 ms
  if (queried_bodies < kFewest || system.is_one_thread) return nullptr;
  if (!system.worker) system.worker = std::make_unique<WorkerThread>();
  return system.worker.get();
}

void find_contacts(std::span<MovingBody> bodies, const PhysicsConfig& config, const Eigen::Vector3d& up_world,
                   ContactSystem& system) {
  system.contacts.clear();
  system.features.clear();
  system.gap_m.clear();
  system.kinds.clear();
  system.push.clear();
  system.bodies.clear();
  system.bystanders.clear();
  for (const MovingBody& moving : bodies) system.bodies.push_back(solver_body(moving.body));
  // Upwards, so that one sweep of the solver carries weight down to the lowest body.
  system.upwards.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) system.upwards[i] = i;
  std::stable_sort(system.upwards.begin(), system.upwards.end(), [&](std::size_t a, std::size_t b) {
    return centre_world(bodies[a].body).dot(up_world) < centre_world(bodies[b].body).dot(up_world);
  });
  const std::vector<bool> is_reached = query_contacts(bodies, config, system);
  std::vector<bool> is_listed(bodies.size());
  for (const bool lists_sleeping : {false, true})
    for (const std::size_t i : system.upwards) {
      const bool is_known_sleeper = bodies[i].body.asleep && is_reached[i] && bodies[i].contacts_known;
      if (lists_sleeping ? !is_known_sleeper : !is_active(bodies[i])) continue;
      add_contacts(bodies, i, is_listed, config, system);
      is_listed[i] = true;
    }
}

double left_s(std::span<const MovingBody> bodies, const SolverContact& contact) {
  double left_s = bodies[contact.body].left_s;
  if (contact.other < bodies.size()) left_s = std::max(left_s, bodies[contact.other].left_s);
  return left_s > 0.0 ? left_s : bodies[contact.body].dt_s;
}

void set_masses(std::span<const MovingBody> bodies, Movable movable, ContactSystem& system) {
  for (SolverBody& body : system.bodies) body.inverse_mass_per_kg = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool is_known_sleeper = bodies[i].body.asleep && bodies[i].contacts_known;
    if (is_active(bodies[i]) || (movable == Movable::kActiveAndKnownSleepers && is_known_sleeper))
      system.bodies[i].inverse_mass_per_kg = inverse_mass_per_kg(bodies[i]);
  }
}

void set_masses_for_impacts(std::span<const MovingBody> bodies, std::span<const Velocity> velocities,
                            ContactSystem& system) {
  const auto takes_part = [&](const Body& body, std::size_t index) {
    return !body.asleep || is_hit(index, velocities, system);
  };
  for (std::size_t i = 0; i < bodies.size(); ++i)
    system.bodies[i].inverse_mass_per_kg =
        takes_part(bodies[i].body, i) ? inverse_mass_per_kg(bodies[i]) : 0.0;
  for (std::size_t i = 0; i < system.bystanders.size(); ++i) {
    const Bystander& bystander = system.bystanders[i];
    const std::size_t index = bodies.size() + i;
    system.bodies[index].inverse_mass_per_kg =
        takes_part(*bystander.body, index) ? bystander.inverse_mass_per_kg : 0.0;
  }
}

void allow_closing_gaps(std::span<const MovingBody> bodies, double margin_m, ContactSystem& system) {
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    SolverContact& contact = system.contacts[i];
    contact.leaves_mps = system.push[i] != nullptr
                             ? system.push[i]->speed_mps
                             : -std::max(system.gap_m[i] - margin_m, 0.0) / left_s(bodies, contact);
  }
}

void clear_impulses(ContactSystem& system) {
  for (SolverContact& contact : system.contacts) {
    contact.impulse_Ns = 0.0;
    contact.friction_impulse_Ns.setZero();
  }
}

void guess_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system) {
  constexpr double kSame_m = 0.01;
  std::vector<bool> is_used(system.past.size());
  for (SolverContact& contact : system.contacts) {
    contact.impulse_Ns = 0.0;
    contact.friction_impulse_Ns.setZero();
    if (contact.other != kNoOther && contact.other >= bodies.size()) continue;
    const Body* body = &bodies[contact.body].body;
    const Body* other = contact.other == kNoOther ? nullptr : &bodies[contact.other].body;
    const Vec3 point_world = centre_world(*body) + contact.contact_offset_m;
    std::size_t nearest = system.past.size();
    double nearest_m = kSame_m;
    for (std::size_t i = 0; i < system.past.size(); ++i) {
      const PastContact& past = system.past[i];
      if (is_used[i] || past.body != body || past.other != other) continue;
      const double apart_m = (past.point_world - point_world).norm();
      if (apart_m >= nearest_m || past.normal_world.dot(contact.normal) < 0.95) continue;
      nearest_m = apart_m;
      nearest = i;
    }
    if (nearest == system.past.size()) continue;
    is_used[nearest] = true;
    contact.impulse_Ns = scale * system.past[nearest].impulse_Ns;
    const Vec3& friction_Ns = system.past[nearest].friction_impulse_Ns;
    contact.friction_impulse_Ns = scale * (friction_Ns - friction_Ns.dot(contact.normal) * contact.normal);
    if (!(contact.friction > 0.0)) contact.friction_impulse_Ns.setZero();
  }
}

void keep_impulses(std::span<const MovingBody> bodies, double scale, ContactSystem& system) {
  system.past.clear();
  for (const SolverContact& contact : system.contacts) {
    if (!(contact.impulse_Ns > 0.0) || (contact.other != kNoOther && contact.other >= bodies.size()))
      continue;
    const Body* body = &bodies[contact.body].body;
    system.past.push_back({body, contact.other == kNoOther ? nullptr : &bodies[contact.other].body,
                           centre_world(*body) + contact.contact_offset_m, contact.normal,
                           scale * contact.impulse_Ns, scale * contact.friction_impulse_Ns});
  }
}

}  // namespace roomradar
