// physics.cpp: moves virtual objects by radar queries.
#include "app/physics/physics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "app/physics/depenetration.hpp"
#include "app/physics/rigid_motion.hpp"
#include "app/physics/sliding.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kDoubtful_m = 0.003;  // deeper overlap along gravity: sideways exits are tested too

bool is_finite(const Body& body) {
  return body.T_world_object.matrix().allFinite() && body.velocity_world_mps.allFinite() &&
         body.angular_velocity_world_rad_s.allFinite() && body.mass.centre_object.allFinite() &&
         body.mass.inertia_m2.allFinite();
}

/// Returns the physics of one body: with its material, and the speed of the surfaces that push it. A carried
/// body has no gravity, friction and restitution, so that it slides along surfaces.
PhysicsConfig physics_of(const AdvancedBody& advanced, PhysicsConfig config) {
  if (advanced.is_carried) config.gravity_world_mps2.setZero();
  const Coefficients own = advanced.is_carried ? Coefficients{} : on_room(advanced.body->material, config);
  config.max_depenetration_mps = max_push_mps(advanced, config);
  config.friction = own.friction;
  config.restitution = own.restitution;
  return config;
}

/// Returns true if a query of the body gave no usable result; query_travel() says so in the report.
bool has_failed(const AdvancedBody& advanced) { return advanced.report.status == StepStatus::kHeld; }

void wake_up(AdvancedBody& advanced) {
  advanced.report.woke |= advanced.body->asleep;
  advanced.body->asleep = false;
}

DirectedOverlap overlap_in(const Contact& contact, const Vec3& direction) {
  if (contact.status != ContactStatus::kOverlap) return {};
  return {std::max(-contact.contact_distance_m, 0.0), direction, contact};
}

/// What is around a body before it moves.
struct Around {
  Contact below;        ///< along gravity; no contact without gravity
  DirectedOverlap way;  ///< the least overlap along gravity and AdvancedBody::depenetration_directions_world
};

/// Queries what is around a body; see has_failed().
Around look_around(AdvancedBody& advanced, const Vec3& down, const PhysicsConfig& physics) {
  Around around;
  std::optional<SurfaceKindMask> crossed;  // kinds that cross the body, once queried
  // A surface between the body's parts, as in a handle, that crosses none of them is not an overlap.
  const auto is_in_a_hollow = [&](const DirectedOverlap& way) {
    const SurfaceKind kind = way.contact.touched;
    if (way.depth_m <= physics.overlap_allowed_m || is_moving_surface(kind) || is_one_sided(kind))
      return false;
    std::vector<ClosestPoint> unused;
    if (!crossed) crossed = advanced.probe->near(advanced.body->T_world_object, kTouching_m, 0, {}, unused);
    return (*crossed & bit_of(kind)) == 0;
  };
  DirectedOverlap& way = around.way;
  const auto consider = [&](const DirectedOverlap& other) {
    if (!(other.depth_m > 0.0) || (way.depth_m > 0.0 && other.depth_m >= way.depth_m)) return;
    if (!is_in_a_hollow(other)) way = other;
  };
  const auto ask = [&](const Vec3& direction, double distance_m) {
    return query_travel(*advanced.body, direction, distance_m, *advanced.probe, advanced.report);
  };
  const auto look = [&](const Vec3& direction) {
    if (!has_failed(advanced)) consider(overlap_in(ask(direction, physics.contact_margin_m), direction));
  };
  if (!down.isZero()) {
    around.below = ask(down, physics.wake_gap_m + 2.0 * physics.contact_margin_m);
    consider(overlap_in(around.below, down));
  }
  for (const Vec3& direction : advanced.depenetration_directions_world)
    if (direction.allFinite() && direction.norm() > 0.5) look(direction.normalized());
  // A wall that grazes the body's side overlaps deeply along gravity: test sideways before lifting the body
  // onto it.
  if (way.depth_m > kDoubtful_m && way.direction_world == down) {
    const Vec3 across = down.unitOrthogonal();
    const Vec3 other_across = down.cross(across);
    for (const Vec3& direction : {across, Vec3(-across), other_across, Vec3(-other_across)}) look(direction);
  }
  return around;
}

/// Returns the depth of overlap that is allowed to remain. A sleeping body does not wait for a surface that
/// would be deeper in it than wake_overlap_m by the next call.
double allowed_overlap_m(const MovingBody& moving, const DirectedOverlap& way, const PhysicsConfig& config) {
  if (!moving.body.asleep) return config.overlap_allowed_m;
  const double grows_m =
      is_moving_surface(way.contact.touched) ? moving.in.surface_speed_mps * moving.dt_s : 0.0;
  return std::max(config.wake_overlap_m - grows_m, config.overlap_allowed_m);
}

/// Moves a body out of the surface that overlaps it, at once or by pushes; see has_failed().
void leave_overlap(MovingBody& moving, const DirectedOverlap& way, const Vec3& down,
                   const PhysicsConfig& physics) {
  Body& body = moving.body;
  StepReport& report = moving.in.report;
  report.deepest_overlap_m = std::max(report.deepest_overlap_m, way.depth_m);
  if (way.contact.touched == SurfaceKind::kStatic)
    report.deepest_static_overlap_m = std::max(report.deepest_static_overlap_m, way.depth_m);
  if (way.depth_m <= allowed_overlap_m(moving, way, physics)) return;

  wake_up(moving.in);
  const double push_m =
      std::min(way.depth_m + physics.contact_margin_m, physics.max_depenetration_mps * moving.dt_s);
  if (is_moving_surface(way.contact.touched)) {
    if (moving.in.is_gripped) return;
    const bool is_out_at_once = way.direction_world == down && way.depth_m <= push_m;
    if (!is_out_at_once) moving.pushes = push_contacts(body, way, push_m, moving.dt_s, moving.probe, physics);
    if (way.direction_world != down) return;
  }
  // A surface behind the body limits the push: the body stays squeezed until the next call.
  const Contact behind =
      query_travel(body, -way.direction_world, push_m + physics.contact_margin_m, moving.probe, report);
  if (has_failed(moving.in)) return;
  double free_m = push_m;
  if (behind.status == ContactStatus::kContact)
    free_m = std::max(behind.lower_m - physics.contact_margin_m, 0.0);
  if (behind.status == ContactStatus::kOverlap)  // hides surfaces farther along
    free_m = behind.touched == SurfaceKind::kStatic
                 ? 0.0
                 : free_past_overlaps_m(body, -way.direction_world, push_m,
                                        bit_of(way.contact.touched) | bit_of(behind.touched), moving.probe,
                                        physics);
  body.T_world_object.translation() -= std::min(push_m, free_m) * way.direction_world;
  show(moving);
  const double inward_mps = body.velocity_world_mps.dot(way.direction_world);
  if (inward_mps > 0.0) body.velocity_world_mps -= inward_mps * way.direction_world;
}

/// Returns true if a body in contact when this one fell asleep has moved or disappeared.
bool has_lost_a_neighbour(const MovingBody& moving, const PhysicsConfig& config) {
  const std::span<const SceneBody> others = moving.probe.others;
  return std::any_of(moving.body.supporting_bodies.begin(), moving.body.supporting_bodies.end(),
                     [&](const Body::SupportingBody& leant) {
                       const bool is_there =
                           std::any_of(others.begin(), others.end(),
                                       [&](const SceneBody& other) { return other.body == leant.on; });
                       return !is_there || strayed_m(*leant.on, leant.T_world_other) > config.wake_moved_m;
                     });
}

/// Moves a body out of surfaces that entered it, along the least overlap, and wakes it unless it can stay
/// asleep; see has_failed().
void begin_step(MovingBody& moving, const PhysicsConfig& config) {
  AdvancedBody& in = moving.in;
  const PhysicsConfig physics = physics_of(in, config);
  const double g = physics.gravity_world_mps2.norm();
  const Vec3 down = g > 0.0 ? Vec3(physics.gravity_world_mps2 / g) : Vec3::Zero();
  bool is_held_up = true;  // by the surface below, within noise
  if (!in.is_undisturbed) {
    const Around around = look_around(in, down, physics);
    if (!has_failed(in) && around.way.depth_m > 0.0) leave_overlap(moving, around.way, down, physics);
    if (has_failed(in)) return;
    is_held_up = down.isZero() ||
                 (around.below && around.below.lower_m <= physics.wake_gap_m + physics.contact_margin_m);
  }
  const bool is_still =
      moving.body.velocity_world_mps.isZero() && moving.body.angular_velocity_world_rad_s.isZero();
  const bool stays_asleep =
      moving.body.asleep && is_still && is_held_up && !has_lost_a_neighbour(moving, config);
  if (!stays_asleep) wake_up(in);
  if (!moving.pushes.empty() || in.is_gripped) moving.left_out = kMovingSurfaces;
}

/// Advances the sleep timer of a supported body, and puts it to sleep when it expires. An unbalanced body
/// takes longer, since it may be about to tip.
void update_sleep(MovingBody& moving, bool is_balanced, const PhysicsConfig& config) {
  constexpr double kLongerUnbalanced = 4.0;
  Body& body = moving.body;
  if (body.sleep_timer_s <= 0.0 || !(strayed_m(body, body.sleep_pose_candidate) <= config.sleep_drift_m)) {
    body.sleep_pose_candidate = body.T_world_object;
    body.sleep_timer_s = 0.0;
  }
  body.sleep_timer_s += moving.dt_s;
  if (body.sleep_timer_s < config.sleep_after_s * (is_balanced ? 1.0 : kLongerUnbalanced)) return;
  body.asleep = true;
  body.supporting_bodies.clear();
  for (const Body* other : moving.result.touches)
    body.supporting_bodies.push_back({other, other->T_world_object});
  body.sleep_timer_s = 0.0;  // the timer restarts when the body is set in motion again
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
}

/// Ends the substep of a body that was awake: moves it if a surface crosses it, and may put it to sleep;
/// see has_failed().
void end_substep(MovingBody& moving, const PhysicsConfig& config) {
  moving.in.near = moving.near;
  if (moving.crosses) {
    const PhysicsConfig physics = physics_of(moving.in, config);
    if (slide(moving.body, moving.left_s, moving.probe, physics, moving.in.report))
      update_sleep(moving, true, config);
    show(moving);
    return;
  }
  moving.body.rests_on = moving.result.is_held_up ? moving.result.rests_on : SurfaceKind::kNothing;
  if (moving.result.is_held_up && moving.pushes.empty())
    update_sleep(moving, moving.result.is_balanced, config);
}

using BodyIndex = std::unordered_map<const Body*, std::size_t>;

/// Returns, per body, its trees in the scenes of the others.
std::vector<std::vector<TreeInstance*>> seen_in_scenes(std::span<const AdvancedBody> bodies) {
  BodyIndex index_of;
  for (std::size_t i = 0; i < bodies.size(); ++i) index_of.emplace(bodies[i].body, i);
  std::vector<std::vector<TreeInstance*>> seen_as(bodies.size());
  for (const AdvancedBody& viewer : bodies) {
    const std::span<const SceneBody> others = viewer.probe->others;
    for (std::size_t tree = 0; tree < std::min(viewer.scene.size(), others.size()); ++tree)
      if (const auto seen = index_of.find(others[tree].body); seen != index_of.end())
        seen_as[seen->second].push_back(&viewer.scene[tree].instance);
  }
  return seen_as;
}

/// Sets MovingBody::member_of_tree.
void find_members(std::span<MovingBody> bodies) {
  BodyIndex index_of;
  for (std::size_t i = 0; i < bodies.size(); ++i) index_of.emplace(&bodies[i].body, i);
  for (MovingBody& moving : bodies)
    for (const SceneBody& other : moving.probe.others) {
      const auto member = index_of.find(other.body);
      moving.member_of_tree.push_back(member == index_of.end() ? kNoOther : member->second);
    }
}

}  // namespace

double max_push_mps(const AdvancedBody& advanced, const PhysicsConfig& config) {
  constexpr double kFaster = 1.5;  // a push also makes up for what earlier ones left
  return std::max(config.max_depenetration_mps, kFaster * advanced.surface_speed_mps);
}

void advance_together(std::span<AdvancedBody> bodies, const PhysicsConfig& config, ContactSystem& system) {
  std::vector<std::vector<TreeInstance*>> seen_as = seen_in_scenes(bodies);
  std::vector<MovingBody> moving;
  moving.reserve(bodies.size());
  double longest_s = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    AdvancedBody& in = bodies[i];
    in.report = {};
    const bool is_valid = std::isfinite(in.dt_s) && in.dt_s >= 0.0 && is_finite(*in.body);
    if (!is_valid) in.report.status = StepStatus::kInvalid;
    if (!is_valid || in.dt_s == 0.0) continue;
    const double dt_s = std::min(in.dt_s, config.max_advance_s);
    moving.push_back({.in = in, .dt_s = dt_s, .seen_as = std::move(seen_as[i])});
    begin_step(moving.back(), config);
    if (has_failed(in))
      moving.pop_back();
    else
      longest_s = std::max(longest_s, dt_s);
  }
  find_members(moving);
  constexpr double kOver = 0.05;  // a Kinect's 33.37 ms are two substeps of 1/60 s, not three
  const int pieces = std::max(static_cast<int>(std::ceil(longest_s / config.max_step_s - kOver)), 1);
  for (MovingBody& one : moving) one.dt_s /= pieces;
  const auto is_any_awake = [&] {
    return std::any_of(moving.begin(), moving.end(), [](const MovingBody& one) { return !one.body.asleep; });
  };
  for (int piece = 0; piece < pieces && is_any_awake(); ++piece) {
    simulate_substep(moving, config, system);
    for (MovingBody& one : moving) {
      if (!one.was_asleep) end_substep(one, config);
      if (has_failed(one.in)) one.dt_s = 0.0;  // stays where it is
    }
  }
}

StepReport advance(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> depenetration_directions_world) {
  ContactSystem system;
  AdvancedBody advanced{.body = &body,
                        .probe = &probe,
                        .dt_s = dt_s,
                        .depenetration_directions_world = depenetration_directions_world};
  advance_together({&advanced, 1}, config, system);
  return advanced.report;
}

}  // namespace roomradar
