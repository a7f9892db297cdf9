// physics.cpp: moves virtual objects by radar queries.
#include "app/physics/physics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

/// The part of advance_together() that concerns a single body.
class Stepper {
 public:
  Stepper(AdvancedBody& advanced, const PhysicsConfig& config)
      : advanced_(advanced),
        body_(*advanced.body),
        probe_(*advanced.probe),
        config_(physics_of(advanced, config)),
        report_(advanced.report) {
    const double g = config_.gravity_world_mps2.norm();
    if (g > 0.0) down_ = config_.gravity_world_mps2 / g;
  }

  /// Queries below the body, and moves it out of surfaces that entered it, along the shortest of gravity and
  /// the given directions.
  void leave_overlaps(double dt_s, std::span<const Vec3> depenetration_directions_world);

  /// Returns true if the support found by leave_overlaps() still holds the body, within noise.
  [[nodiscard]] bool is_held_up() const;
  /// Returns true if a body in contact when this one fell asleep has moved or disappeared.
  [[nodiscard]] bool has_lost_a_neighbour() const;

  /// Wakes the body unless it can stay asleep.
  void wake_if_due();
  /// Ends a substep: moves a body that a surface crosses, and may put the body to sleep.
  void end_substep(const MovingBody& moved, const SubstepResult& result);

  void wake();
  [[nodiscard]] bool failed() const { return report_.status == StepStatus::kHeld; }
  [[nodiscard]] const std::vector<Push>& pushes() const { return pushes_; }

 private:
  Contact ask(const Vec3& direction, double distance_m) {
    return query_travel(body_, direction, distance_m, probe_, report_);
  }
  /// Returns the kinds of surfaces that crossed the body before any motion.
  SurfaceKindMask crossed_before();
  /// Returns true if the overlap is only a surface between the body's parts, as in a handle, that crosses
  /// none of them.
  [[nodiscard]] bool is_in_a_hollow(const DirectedOverlap& way);
  /// Returns the depth of overlap that is allowed to remain. A sleeping body does not wait for a surface that
  /// would be deeper in it than wake_overlap_m by the next call.
  [[nodiscard]] double allowed_overlap_m(const DirectedOverlap& way, double dt_s) const;
  static DirectedOverlap overlap_in(const Contact& contact, const Vec3& direction);
  void update_sleep(double dt_s, const SubstepResult& result);
  void tell_moved() const {
    if (advanced_.moved) advanced_.moved();
  }

  AdvancedBody& advanced_;
  Body& body_;
  const CollisionQueries& probe_;
  const PhysicsConfig config_;
  StepReport& report_;
  Vec3 down_ = Vec3::Zero();
  Contact below_;                           // along gravity, before any motion
  std::optional<SurfaceKindMask> crossed_;  // kinds that cross the body before any motion, once queried
  std::vector<Push> pushes_;
  std::vector<ClosestPoint> near_;
};

void Stepper::wake() {
  if (!body_.asleep) return;
  report_.woke = true;
  body_.asleep = false;
}

DirectedOverlap Stepper::overlap_in(const Contact& contact, const Vec3& direction) {
  if (contact.status != ContactStatus::kOverlap) return {};
  return {std::max(-contact.contact_distance_m, 0.0), direction, contact};
}

bool Stepper::is_in_a_hollow(const DirectedOverlap& way) {
  const SurfaceKind kind = way.contact.touched;
  if (way.depth_m <= config_.overlap_allowed_m || is_moving_surface(kind) || is_one_sided(kind)) return false;
  return (crossed_before() & bit_of(kind)) == 0;
}

SurfaceKindMask Stepper::crossed_before() {
  if (!crossed_) crossed_ = probe_.near(body_.T_world_object, kTouching_m, 0, {}, near_);
  return *crossed_;
}

double Stepper::allowed_overlap_m(const DirectedOverlap& way, double dt_s) const {
  if (!body_.asleep) return config_.overlap_allowed_m;
  const double grows_m = is_moving_surface(way.contact.touched) ? advanced_.surface_speed_mps * dt_s : 0.0;
  return std::max(config_.wake_overlap_m - grows_m, config_.overlap_allowed_m);
}

void Stepper::leave_overlaps(double dt_s, std::span<const Vec3> depenetration_directions_world) {
  DirectedOverlap way;
  const auto consider = [&](const DirectedOverlap& other) {
    if (!(other.depth_m > 0.0) || (way.depth_m > 0.0 && other.depth_m >= way.depth_m)) return;
    if (!is_in_a_hollow(other)) way = other;
  };
  const auto look = [&](const Vec3& direction) {
    if (!failed()) consider(overlap_in(ask(direction, config_.contact_margin_m), direction));
  };
  if (!down_.isZero()) {
    below_ = ask(down_, config_.wake_gap_m + 2.0 * config_.contact_margin_m);
    consider(overlap_in(below_, down_));
  }
  for (const Vec3& direction : depenetration_directions_world)
    if (direction.allFinite() && direction.norm() > 0.5) look(direction.normalized());
  // A wall that grazes the body's side overlaps deeply along gravity: test sideways before lifting the body
  // onto it.
  if (way.depth_m > kDoubtful_m && way.direction_world == down_) {
    const Vec3 across = down_.unitOrthogonal();
    const Vec3 other_across = down_.cross(across);
    for (const Vec3& direction : {across, Vec3(-across), other_across, Vec3(-other_across)}) look(direction);
  }
  if (failed() || way.depth_m <= 0.0) return;

  report_.deepest_overlap_m = std::max(report_.deepest_overlap_m, way.depth_m);
  if (way.contact.touched == SurfaceKind::kStatic)
    report_.deepest_static_overlap_m = std::max(report_.deepest_static_overlap_m, way.depth_m);
  if (way.depth_m <= allowed_overlap_m(way, dt_s)) return;

  wake();
  const double push_m =
      std::min(way.depth_m + config_.contact_margin_m, config_.max_depenetration_mps * dt_s);
  if (is_moving_surface(way.contact.touched)) {
    if (advanced_.is_gripped) return;
    const bool is_out_at_once = way.direction_world == down_ && way.depth_m <= push_m;
    if (!is_out_at_once) pushes_ = push_contacts(body_, way, push_m, dt_s, probe_, config_);
    if (way.direction_world != down_) return;
  }
  // A surface behind the body limits the push: the body stays squeezed until the next call.
  const Contact behind = ask(-way.direction_world, push_m + config_.contact_margin_m);
  if (failed()) return;
  double free_m = push_m;
  if (behind.status == ContactStatus::kContact)
    free_m = std::max(behind.lower_m - config_.contact_margin_m, 0.0);
  if (behind.status == ContactStatus::kOverlap)  // hides surfaces farther along
    free_m =
        behind.touched == SurfaceKind::kStatic
            ? 0.0
            : free_past_overlaps_m(body_, -way.direction_world, push_m,
                                   bit_of(way.contact.touched) | bit_of(behind.touched), probe_, config_);
  body_.T_world_object.translation() -= std::min(push_m, free_m) * way.direction_world;
  tell_moved();
  const double inward_mps = body_.velocity_world_mps.dot(way.direction_world);
  if (inward_mps > 0.0) body_.velocity_world_mps -= inward_mps * way.direction_world;
}

bool Stepper::is_held_up() const {
  if (down_.isZero() || advanced_.is_undisturbed) return true;
  return below_ && below_.lower_m <= config_.wake_gap_m + config_.contact_margin_m;
}

bool Stepper::has_lost_a_neighbour() const {
  return std::any_of(
      body_.supporting_bodies.begin(), body_.supporting_bodies.end(), [&](const Body::SupportingBody& leant) {
        const bool is_there = std::any_of(probe_.others.begin(), probe_.others.end(),
                                          [&](const SceneBody& other) { return other.body == leant.on; });
        return !is_there || strayed_m(*leant.on, leant.T_world_other) > config_.wake_moved_m;
      });
}

/// Advances the sleep timer of a supported body, and puts it to sleep when it expires. An unbalanced body
/// takes longer, since it may be about to tip.
void Stepper::update_sleep(double dt_s, const SubstepResult& result) {
  constexpr double kLongerUnbalanced = 4.0;
  if (body_.sleep_timer_s <= 0.0 ||
      !(strayed_m(body_, body_.sleep_pose_candidate) <= config_.sleep_drift_m)) {
    body_.sleep_pose_candidate = body_.T_world_object;
    body_.sleep_timer_s = 0.0;
  }
  body_.sleep_timer_s += dt_s;
  if (body_.sleep_timer_s < config_.sleep_after_s * (result.is_balanced ? 1.0 : kLongerUnbalanced)) return;
  body_.asleep = true;
  body_.supporting_bodies.clear();
  for (const Body* other : result.touches) body_.supporting_bodies.push_back({other, other->T_world_object});
  body_.sleep_timer_s = 0.0;  // the timer restarts when the body is set in motion again
  body_.velocity_world_mps.setZero();
  body_.angular_velocity_world_rad_s.setZero();
}

void Stepper::wake_if_due() {
  const bool is_still = body_.velocity_world_mps.isZero() && body_.angular_velocity_world_rad_s.isZero();
  if (!(body_.asleep && is_still && is_held_up() && !has_lost_a_neighbour())) wake();
}

void Stepper::end_substep(const MovingBody& moved, const SubstepResult& result) {
  advanced_.near = moved.near;
  if (moved.crosses) {
    SubstepResult supported = result;
    supported.is_balanced = true;
    if (slide(body_, moved.left_s, probe_, config_, report_)) update_sleep(moved.dt_s, supported);
    tell_moved();
    return;
  }
  if (result.is_held_up) {
    body_.rests_on = result.rests_on;
    if (pushes_.empty()) update_sleep(moved.dt_s, result);
  } else {
    body_.rests_on = SurfaceKind::kNothing;
  }
}

}  // namespace

double max_push_mps(const AdvancedBody& advanced, const PhysicsConfig& config) {
  constexpr double kFaster = 1.5;  // a push also makes up for what earlier ones left
  return std::max(config.max_depenetration_mps, kFaster * advanced.surface_speed_mps);
}

void advance_together(std::span<AdvancedBody> bodies, const PhysicsConfig& config, ContactSystem& system) {
  std::vector<Stepper> steppers;
  steppers.reserve(bodies.size());
  std::vector<MovingBody> moving;
  double longest_s = 0.0;
  for (AdvancedBody& advanced : bodies) {
    advanced.report = {};
    if (!std::isfinite(advanced.dt_s) || advanced.dt_s < 0.0 || !is_finite(*advanced.body)) {
      advanced.report.status = StepStatus::kInvalid;
      continue;
    }
    if (advanced.dt_s == 0.0) continue;
    const double dt_s = std::min(advanced.dt_s, config.max_advance_s);
    Stepper& stepper = steppers.emplace_back(advanced, config);
    if (!advanced.is_undisturbed) stepper.leave_overlaps(dt_s, advanced.depenetration_directions_world);
    if (stepper.failed()) {
      steppers.pop_back();
      continue;
    }
    stepper.wake_if_due();
    longest_s = std::max(longest_s, dt_s);
    moving.push_back(
        {.body = advanced.body,
         .probe = advanced.probe,
         .mass_kg = advanced.mass_kg,
         .is_carried = advanced.is_carried,
         .pushes = stepper.pushes(),
         .left_out = !stepper.pushes().empty() || advanced.is_gripped ? kMovingSurfaces : SurfaceKindMask{0},
         .report = &advanced.report,
         .dt_s = dt_s,
         .moved = &advanced.moved,
         .is_undisturbed = advanced.is_undisturbed});
  }
  for (MovingBody& one : moving)
    for (const SceneBody& other : one.probe->others) {
      const auto member = std::find_if(moving.begin(), moving.end(),
                                       [&](const MovingBody& two) { return two.body == other.body; });
      one.member_of_tree.push_back(
          member == moving.end() ? kNoOther : static_cast<std::size_t>(member - moving.begin()));
    }
  constexpr double kOver = 0.05;  // a Kinect's 33.37 ms are two substeps of 1/60 s, not three
  const int pieces = std::max(static_cast<int>(std::ceil(longest_s / config.max_step_s - kOver)), 1);
  for (MovingBody& body : moving) body.dt_s /= pieces;
  std::vector<SubstepResult> results;
  for (int piece = 0; piece < pieces; ++piece) {
    if (std::none_of(moving.begin(), moving.end(), [](const MovingBody& m) { return !m.body->asleep; }))
      return;
    std::vector<bool> was_asleep;
    for (const MovingBody& body : moving) was_asleep.push_back(body.body->asleep);
    simulate_substep(moving, config, system, results);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      if (!was_asleep[i]) steppers[i].end_substep(moving[i], results[i]);
      if (steppers[i].failed()) moving[i].dt_s = 0.0;  // stays where it is
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
