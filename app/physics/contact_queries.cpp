// contact_queries.cpp: proximity queries of bodies that touch each other, each pair once.
#include "app/physics/contact_queries.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

/// Sets `near` of a body to all features. Returns the kinds of surfaces that intersect the body.
SurfaceKindMask query_near(MovingBody& moving, double reach_m, const TreeStates& trees) {
  return moving.probe.near(moving.body.T_world_object, reach_m, moving.left_out, trees, moving.near);
}

/// Updates `near` of a body that has not moved: queries only the bodies that have moved.
SurfaceKindMask query_moved(MovingBody& moving, double reach_m, const std::vector<bool>& has_moved,
                            TreeStates& trees) {
  moving.near.resize(moving.near_found);
  std::erase_if(moving.near, [&](const ClosestPoint& p) {
    const std::size_t other = member_of(moving, p);
    return other != kNoOther && has_moved[other];
  });
  bool is_any = false;
  for (std::size_t tree = 0; tree < moving.member_of_tree.size(); ++tree) {
    const std::size_t other = moving.member_of_tree[tree];
    if (other == kNoOther || !has_moved[other]) trees.left_out[tree] = true;
    is_any |= !trees.left_out[tree];
  }
  if (!is_any) return 0;
  std::vector<ClosestPoint> found;
  const SurfaceKindMask crossed =
      moving.probe.near(moving.body.T_world_object, reach_m, moving.left_out, trees, found);
  moving.near.insert(moving.near.end(), found.begin(), found.end());
  return crossed;
}

/// Returns true if the features of the body, and those of it for others, must be queried again: it has moved,
/// or became active or inactive.
bool must_be_queried(const MovingBody& moving, double margin_m) {
  constexpr double kKeptWithin = 0.25;  // of the margin
  if (!is_active(moving)) return moving.T_world_near.has_value();
  return !moving.T_world_near || strayed_m(moving.body, *moving.T_world_near) > kKeptWithin * margin_m;
}

/// Returns true if one of the points equals the point, within rounding. A contact nearby is not enough: while
/// bodies turn about it, they may approach here.
bool is_among(const std::vector<ClosestPoint>& points, const ClosestPoint& sought, double margin_m) {
  return std::any_of(points.begin(), points.end(), [&](const ClosestPoint& p) {
    return (p.point_world - sought.point_world).norm() < 1e-3 * margin_m &&
           p.normal_world.dot(sought.normal_world) > 1.0 - 1e-6;
  });
}

/// Adds the feature that ended the body's last motion, unless it is among the features found.
void add_limit(std::span<MovingBody> bodies, MovingBody& moving, double margin_m, double reach_m) {
  const ClosestPoint& limit = moving.limited_by;
  if (limit.kind == SurfaceKind::kNothing || limit.gap_m > reach_m) return;
  if (is_among(moving.near, limit, margin_m)) return;
  // The pair may have been queried from the other body.
  const std::size_t other = member_of(moving, limit);
  ClosestPoint reversed = limit;
  reversed.point_world += limit.gap_m * limit.normal_world;
  reversed.normal_world = -limit.normal_world;
  if (other == kNoOther || !is_among(bodies[other].near, reversed, margin_m)) moving.near.push_back(limit);
}

/// Makes the contacts of a sleeping body known. Returns false if they are not reliable: its support is not a
/// surface at rest, or a surface intersects it. Such a body does not move by the weight of others.
bool know_contacts(MovingBody& sleeper, double reach_m, ContactSystem& system) {
  if (is_moving_surface(sleeper.body.rests_on)) return false;
  const Body& body = sleeper.body;
  const std::span<const SceneBody> others = sleeper.probe.others;
  if (sleeper.in.is_undisturbed && recall_contacts(system.sleepers, body, others, sleeper.near)) return true;
  if (query_near(sleeper, reach_m, {}) != 0) return false;
  remember_contacts(system.sleepers, body, others, sleeper.near);
  return true;
}

/// Queries the features of all active bodies. Sets `near`, `near_found`, `crosses` and T_world_near.
/// @return the active bodies, from the lowest up; some of them may cross a surface now
std::vector<std::size_t> query_active(std::span<MovingBody> bodies, double margin_m, double reach_m,
                                      ContactSystem& system) {
  std::vector<bool> has_moved(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) has_moved[i] = must_be_queried(bodies[i], margin_m);
  std::vector<std::size_t> active, rank(bodies.size(), kNoOther);
  for (const std::size_t i : system.upwards) {
    if (!is_active(bodies[i])) continue;
    rank[i] = active.size();
    active.push_back(i);
  }
  // A pair of active bodies is queried from the lower one, unless a surface crosses it.
  const auto query = [&](std::size_t k, bool knows_crossings) {
    MovingBody& moving = bodies[active[k]];
    TreeStates trees;
    for (const std::size_t other : moving.member_of_tree)
      trees.left_out.push_back(other != kNoOther && rank[other] < k &&
                               !(knows_crossings && bodies[other].crosses));
    moving.crosses = (has_moved[active[k]] ? query_near(moving, reach_m, trees)
                                           : query_moved(moving, reach_m, has_moved, trees)) != 0;
    moving.near_found = moving.near.size();
  };
  run_each(worker_for(active.size(), system), active.size(), [&](std::size_t k) { query(k, false); });
  const auto crossing =
      std::find_if(active.begin(), active.end(), [&](std::size_t i) { return bodies[i].crosses; });
  if (crossing != active.end())
    for (auto k = static_cast<std::size_t>(crossing - active.begin()) + 1; k < active.size(); ++k)
      query(k, true);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_active(bodies[i]))
      bodies[i].T_world_near.reset();
    else if (has_moved[i])
      bodies[i].T_world_near = bodies[i].body.T_world_object;
  }
  return active;
}

}  // namespace

std::vector<bool> query_contacts(std::span<MovingBody> bodies, const PhysicsConfig& config,
                                 ContactSystem& system) {
  constexpr double kTouchingBand = 0.5;  // fraction of the margin by which contacts may exceed it
  const double margin_m = config.contact_margin_m;
  const double reach_m = std::max((1.0 + kTouchingBand) * margin_m, 1e-6);
  const std::vector<std::size_t> active = query_active(bodies, margin_m, reach_m, system);
  std::vector<bool> is_reached(bodies.size());
  std::vector<std::size_t> reached;
  const auto reach_others_of = [&](const MovingBody& moving) {
    for (const ClosestPoint& p : moving.near) {
      const std::size_t other = member_of(moving, p);
      if (other == kNoOther || !bodies[other].body.asleep || is_reached[other]) continue;
      is_reached[other] = true;
      reached.push_back(other);
    }
  };
  for (const std::size_t i : active) {
    if (bodies[i].crosses) continue;
    add_limit(bodies, bodies[i], margin_m, reach_m);
    reach_others_of(bodies[i]);
  }
  for (std::size_t k = 0; k < reached.size(); ++k) {
    MovingBody& sleeper = bodies[reached[k]];
    if (!sleeper.contacts_known && !know_contacts(sleeper, reach_m, system)) continue;
    sleeper.contacts_known = true;
    reach_others_of(sleeper);
  }
  return is_reached;
}

}  // namespace roomradar
