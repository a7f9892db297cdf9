// physics.cpp: moves a virtual object by radar queries.
#include "app/physics/physics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "app/physics/rigid_motion.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kShortest_m = 1e-13;  // shorter moves count as none
constexpr double kGrazing = 0.05;      // min cosine that converts the margin to a distance along the motion
constexpr double kDoubtful_m = 0.003;  // deeper overlap along gravity: sideways exits are tested too

bool is_finite(const Body& body) {
  return body.T_world_object.matrix().allFinite() && body.velocity_world_mps.allFinite() &&
         body.angular_velocity_world_rad_s.allFinite() && body.mass.centre_object.allFinite() &&
         body.mass.inertia_m2.allFinite();
}

/// Returns false if the radar's result is unusable. Replaces a normal that is missing or does not face the
/// object by -direction.
bool make_usable(Contact& contact, const Vec3& direction) {
  if (contact.status == ContactStatus::kInvalidInput || contact.status == ContactStatus::kNoAnswer)
    return false;
  if (!contact) return true;
  // lower_m of an overlap may be -infinity: deeper than the radar searched.
  const bool has_lower = std::isfinite(contact.lower_m) || contact.status == ContactStatus::kOverlap;
  if (!std::isfinite(contact.contact_distance_m) || !has_lower) return false;
  const double length = contact.normal_world.norm();
  const bool faces_object =
      std::isfinite(length) && length > 0.5 && contact.normal_world.dot(direction) < -1e-3 * length;
  contact.normal_world = faces_object ? Vec3(contact.normal_world / length) : Vec3(-direction);
  return true;
}

/// State of one call of advance().
class Stepper {
 public:
  Stepper(Body& body, const CollisionQueries& probe, const PhysicsConfig& config, StepReport& report)
      : body_(body), probe_(probe), config_(config), report_(report) {
    const double g = config.gravity_world_mps2.norm();
    if (g > 0.0) down_ = config.gravity_world_mps2 / g;
  }

  /// Queries below the body, and moves it out of surfaces that entered it, along the shortest of gravity and
  /// the given directions.
  void leave_overlaps(double dt_s, std::span<const Vec3> depenetration_directions_world);

  /// Returns true if the support found by leave_overlaps() still holds the body, within noise.
  [[nodiscard]] bool is_held_up() const;
  /// Returns true if a body in contact when this one fell asleep has moved or disappeared.
  [[nodiscard]] bool has_lost_a_neighbour() const;

  /// Simulates one substep, and may put the body to sleep.
  void move(double dt_s);

  void wake();
  [[nodiscard]] bool failed() const { return report_.status == StepStatus::kHeld; }

 private:
  struct Way {
    double depth_m = 0.0;  // 0: no overlap
    Vec3 direction = Vec3::Zero();
    Contact contact;
  };

  /// Moves without rotation, by radar queries along the path. Returns true if a surface supported the body.
  bool slide(double dt_s);
  Contact ask(const Vec3& direction, double distance_m);
  /// Returns true if the overlap is only a surface between the body's parts, as in a handle, that crosses
  /// none of them.
  [[nodiscard]] bool is_in_a_hollow(const Way& way);
  static Way overlap_in(const Contact& contact, const Vec3& direction);
  void hold();
  void collide(const Contact& contact, Vec3& remaining);
  void update_sleep(double dt_s, bool is_balanced);

  Body& body_;
  const CollisionQueries& probe_;
  const PhysicsConfig& config_;
  StepReport& report_;
  Vec3 down_ = Vec3::Zero();
  Contact below_;                           // along gravity, before any motion
  std::optional<SurfaceKindMask> crossed_;  // kinds that cross the body before any motion, once queried
  std::optional<Push> push_;
  RigidScratch scratch_;
  std::array<Vec3, 2> met_normals_;
  int met_count_ = 0;
};

Contact Stepper::ask(const Vec3& direction, double distance_m) {
  ++report_.queries;
  Contact contact = probe_.travel(body_.T_world_object, direction, distance_m);
  if (!make_usable(contact, direction)) hold();
  return contact;
}

void Stepper::hold() {
  report_.status = StepStatus::kHeld;
  body_.velocity_world_mps.setZero();
  body_.angular_velocity_world_rad_s.setZero();
}

void Stepper::wake() {
  if (!body_.asleep) return;
  report_.woke = true;
  body_.asleep = false;
}

Stepper::Way Stepper::overlap_in(const Contact& contact, const Vec3& direction) {
  if (contact.status != ContactStatus::kOverlap) return {};
  return {std::max(-contact.contact_distance_m, 0.0), direction, contact};
}

bool Stepper::is_in_a_hollow(const Way& way) {
  constexpr double kTouching_m = 1e-6;
  const SurfaceKind kind = way.contact.touched;
  if (way.depth_m <= config_.overlap_allowed_m || is_moving_surface(kind) || is_one_sided(kind)) return false;
  if (!crossed_) crossed_ = probe_.near(body_.T_world_object, kTouching_m, 0, scratch_.near);
  return (*crossed_ & bit_of(kind)) == 0;
}

void Stepper::leave_overlaps(double dt_s, std::span<const Vec3> depenetration_directions_world) {
  Way way;
  const auto consider = [&](const Way& other) {
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
  if (way.depth_m > kDoubtful_m && way.direction == down_) {
    const Vec3 across = down_.unitOrthogonal();
    const Vec3 other_across = down_.cross(across);
    for (const Vec3& direction : {across, Vec3(-across), other_across, Vec3(-other_across)}) look(direction);
  }
  if (failed() || way.depth_m <= 0.0) return;

  report_.deepest_overlap_m = std::max(report_.deepest_overlap_m, way.depth_m);
  if (way.contact.touched == SurfaceKind::kStatic)
    report_.deepest_static_overlap_m = std::max(report_.deepest_static_overlap_m, way.depth_m);
  if (way.depth_m <= (body_.asleep ? config_.wake_overlap_m : config_.overlap_allowed_m)) return;

  wake();
  const double push_m =
      std::min(way.depth_m + config_.contact_margin_m, config_.max_depenetration_mps * dt_s);
  if (is_moving_surface(way.contact.touched)) {
    const bool is_out_at_once = way.direction == down_ && way.depth_m <= push_m;
    if (!is_out_at_once)
      push_ = Push{way.contact.point_world, -way.direction, push_m / dt_s, way.contact.touched};
    if (way.direction != down_) return;
  }
  // A surface behind the body limits the push: the body stays squeezed until the next call.
  const Contact behind = ask(-way.direction, push_m + config_.contact_margin_m);
  if (failed()) return;
  double free_m = push_m;
  if (behind.status == ContactStatus::kContact)
    free_m = std::max(behind.lower_m - config_.contact_margin_m, 0.0);
  if (behind.status == ContactStatus::kOverlap && behind.touched == SurfaceKind::kStatic) free_m = 0.0;
  body_.T_world_object.translation() -= std::min(push_m, free_m) * way.direction;
  const double inward_mps = body_.velocity_world_mps.dot(way.direction);
  if (inward_mps > 0.0) body_.velocity_world_mps -= inward_mps * way.direction;
}

bool Stepper::is_held_up() const {
  if (down_.isZero()) return true;
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

/// Removes the velocity into the surface (with restitution and friction), and the remaining motion into it.
/// With two surfaces, the motion continues along their crease; with three, it ends.
void Stepper::collide(const Contact& contact, Vec3& remaining) {
  const Vec3& normal = contact.normal_world;
  Vec3& velocity = body_.velocity_world_mps;
  const double into_mps = -velocity.dot(normal);
  Vec3 along = velocity + into_mps * normal;
  double kept = 1.0;
  if (into_mps > 0.0) {
    const double speed = along.norm();
    kept = speed > 0.0 ? std::max(1.0 - config_.friction * into_mps / speed, 0.0) : 0.0;
    const double back_mps = into_mps > config_.bounce_mps ? config_.restitution * into_mps : 0.0;
    along *= kept;
    velocity = along + back_mps * normal;
  }
  remaining -= std::min(remaining.dot(normal), 0.0) * normal;
  remaining *= kept;

  for (int i = 0; i < met_count_; ++i) {
    const Vec3& other = met_normals_[static_cast<std::size_t>(i)];
    if (remaining.dot(other) >= -1e-9) continue;
    const Vec3 crease = other.cross(normal);
    const double length2 = crease.squaredNorm();
    const bool is_corner = met_count_ == 2 || length2 < 1e-6;
    const auto on_crease = [&](const Vec3& v) -> Vec3 {
      return is_corner ? Vec3::Zero() : Vec3(crease * (crease.dot(v) / length2));
    };
    remaining = on_crease(remaining);
    if (velocity.dot(other) < 0.0) velocity = on_crease(velocity);
    break;
  }
  if (met_count_ < 2) met_normals_[static_cast<std::size_t>(met_count_++)] = normal;
  note_contact(contact.touched, report_);
}

/// Advances the sleep timer of a supported body, and puts it to sleep when it expires. An unbalanced body
/// takes longer, since it may be about to tip.
void Stepper::update_sleep(double dt_s, bool is_balanced) {
  constexpr double kLongerUnbalanced = 4.0;
  if (body_.sleep_timer_s <= 0.0 ||
      !(strayed_m(body_, body_.sleep_pose_candidate) <= config_.sleep_drift_m)) {
    body_.sleep_pose_candidate = body_.T_world_object;
    body_.sleep_timer_s = 0.0;
  }
  body_.sleep_timer_s += dt_s;
  if (body_.sleep_timer_s < config_.sleep_after_s * (is_balanced ? 1.0 : kLongerUnbalanced)) return;
  body_.asleep = true;
  body_.supporting_bodies.clear();
  for (const Body* other : scratch_.bodies) body_.supporting_bodies.push_back({other, other->T_world_object});
  body_.sleep_timer_s = 0.0;  // the timer restarts when the body is set in motion again
  body_.velocity_world_mps.setZero();
  body_.angular_velocity_world_rad_s.setZero();
}

void Stepper::move(double dt_s) {
  const SubstepResult piece = simulate_substep(body_, dt_s, probe_, config_, push_, scratch_, report_);
  if (piece.crosses) {
    if (slide(piece.left_s)) update_sleep(dt_s, /*is_balanced=*/true);
    return;
  }
  if (piece.is_held_up) {
    body_.rests_on = piece.rests_on;
    if (!push_) update_sleep(dt_s, piece.is_balanced);
  } else {
    body_.rests_on = SurfaceKind::kNothing;
  }
}

bool Stepper::slide(double dt_s) {
  body_.angular_velocity_world_rad_s.setZero();
  body_.velocity_world_mps += config_.gravity_world_mps2 * dt_s;
  const double speed_mps = body_.velocity_world_mps.norm();
  if (speed_mps > config_.max_speed_mps) body_.velocity_world_mps *= config_.max_speed_mps / speed_mps;

  auto position = body_.T_world_object.translation();
  Vec3 remaining = body_.velocity_world_mps * dt_s;
  bool is_supported = false;
  body_.rests_on = SurfaceKind::kNothing;
  met_count_ = 0;
  for (int slide = 0; slide < config_.max_slides; ++slide) {
    const double distance_m = remaining.norm();
    if (distance_m < kShortest_m) break;
    const Vec3 direction = remaining / distance_m;
    const Contact contact = ask(direction, distance_m + config_.contact_margin_m / kGrazing);
    if (failed()) return false;
    // The gap is kept perpendicular to the surface; along a grazing motion it is longer.
    const double steepness = std::max(-contact.normal_world.dot(direction), kGrazing);
    const double free_m = contact ? contact.lower_m - config_.contact_margin_m / steepness : contact.lower_m;
    if (free_m >= distance_m) {
      position += remaining;
      break;
    }
    const Vec3 moved = std::max(free_m, 0.0) * direction;
    position += moved;
    if (!contact) break;  // limited by the radar's search distance
    remaining -= moved;
    if (contact.normal_world.dot(down_) < -kSupportCosine) {
      is_supported = true;
      body_.rests_on = contact.touched;
    }
    collide(contact, remaining);
  }
  return is_supported;
}

}  // namespace

StepReport advance(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> depenetration_directions_world) {
  StepReport report;
  if (!std::isfinite(dt_s) || dt_s < 0.0 || !is_finite(body)) {
    report.status = StepStatus::kInvalid;
    return report;
  }
  if (dt_s == 0.0) return report;
  dt_s = std::min(dt_s, config.max_advance_s);

  Stepper stepper(body, probe, config, report);
  stepper.leave_overlaps(dt_s, depenetration_directions_world);
  if (stepper.failed()) return report;
  const bool is_still = body.velocity_world_mps.isZero() && body.angular_velocity_world_rad_s.isZero();
  if (body.asleep && is_still && stepper.is_held_up() && !stepper.has_lost_a_neighbour()) return report;
  stepper.wake();

  constexpr double kOver = 0.05;  // a Kinect's 33.37 ms are two substeps of 1/60 s, not three
  const int pieces = std::max(static_cast<int>(std::ceil(dt_s / config.max_step_s - kOver)), 1);
  for (int piece = 0; piece < pieces && !body.asleep && !stepper.failed(); ++piece)
    stepper.move(dt_s / pieces);
  return report;
}

}  // namespace roomradar
