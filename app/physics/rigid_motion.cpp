// rigid_motion.cpp: alternates contact impulses and motion up to the time of impact.
#include "app/physics/rigid_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kTouchingBand = 0.5;  // fraction of the margin by which contacts may exceed it
constexpr double kKept = 0.5;          // fraction of the margin at which approaching surfaces stop the motion
constexpr double kNoTime_s = 1e-12;
constexpr double kNudge_mps = 0.05;  // slower impacts do not wake the body hit

void limit(Vec3& v, double most) {
  const double size = v.norm();
  if (size > most) v *= most / size;
}

Velocity velocity_of(const Body& body) {
  return {body.velocity_world_mps, body.angular_velocity_world_rad_s};
}

/// State of one substep: the body, its contacts, and the time left.
class Piece {
 public:
  Piece(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
        const std::optional<Push>& push, RigidScratch& scratch, StepReport& report)
      : body_(body),
        left_s_(dt_s),
        probe_(probe),
        config_(config),
        push_(push),
        scratch_(scratch),
        report_(report),
        velocity_(velocity_of(body)),
        resting_{config.friction, config.rolling} {
    const double g = config.gravity_world_mps2.norm();
    if (g > 0.0) up_ = -config.gravity_world_mps2 / g;
    if (push) left_out_ = bit_of(SurfaceKind::kDynamic) | bit_of(SurfaceKind::kInferredBack);
  }

  SubstepResult run();

 private:
  bool find_contacts();
  void set_room(double dt_s);
  std::size_t other_on(const ClosestPoint& p);
  void bounce();
  void let_sleepers_lie();
  [[nodiscard]] double energy_of_all() const;
  [[nodiscard]] Velocity held_up_after(Velocity velocity, double dt_s);
  [[nodiscard]] Velocity mean_with(const Velocity& after);
  [[nodiscard]] Velocity lift_back(double dt_s);
  void see_support(SubstepResult& piece);
  void go(const Velocity& after);

  Body& body_;
  double left_s_;
  const CollisionQueries& probe_;
  const PhysicsConfig& config_;
  const std::optional<Push>& push_;
  RigidScratch& scratch_;
  StepReport& report_;
  Velocity velocity_;
  FrictionConfig resting_;
  Vec3 up_ = Vec3::Zero();
  Vec3 centre_ = Vec3::Zero();
  Eigen::Matrix3d inertia_ = Eigen::Matrix3d::Identity();
  ClosestPoint limited_by_;
  SurfaceKindMask left_out_ = 0;
};

/// Finds contacts at the present pose. Returns false if a surface other than the pushing one crosses the
/// body.
bool Piece::find_contacts() {
  const double margin_m = config_.contact_margin_m;
  const double reach_m = (1.0 + kTouchingBand) * margin_m;
  if (probe_.near(body_.T_world_object, std::max(reach_m, 1e-6), left_out_, scratch_.near) != 0) return false;
  centre_ = centre_world(body_);
  inertia_ = inertia_world_m2(body_);
  if (limited_by_.kind != SurfaceKind::kNothing) {
    const bool is_known = std::any_of(scratch_.near.begin(), scratch_.near.end(), [&](const ClosestPoint& p) {
      return (p.point_world - limited_by_.point_world).norm() < margin_m &&
             p.normal_world.dot(limited_by_.normal_world) > 0.99;
    });
    if (!is_known && limited_by_.gap_m <= reach_m) scratch_.near.push_back(limited_by_);
  }
  scratch_.contacts.clear();
  scratch_.kinds.clear();
  scratch_.others.clear();
  scratch_.bodies.clear();
  for (const ClosestPoint& p : scratch_.near) {
    SolverContact& contact = scratch_.contacts.emplace_back();
    contact.contact_offset_m = p.point_world + p.gap_m * p.normal_world - centre_;
    contact.normal = p.normal_world;
    contact.other = other_on(p);
    if (contact.other != kNoOther)
      contact.other_offset_m = p.point_world - centre_world(*scratch_.bodies[contact.other]);
    scratch_.kinds.push_back(p.kind);
  }
  if (push_) {
    SolverContact& contact = scratch_.contacts.emplace_back();
    contact.contact_offset_m = push_->point_world - centre_;
    contact.normal = push_->normal_world;
    scratch_.kinds.push_back(push_->touched);
  }
  return true;
}

/// Returns the index of the body in contact at p, adding it if new; kNoOther for a static surface.
std::size_t Piece::other_on(const ClosestPoint& p) {
  if (p.tree >= probe_.others.size() || probe_.others[p.tree].body == nullptr) return kNoOther;
  const auto& [body, mass_ratio] = probe_.others[p.tree];
  const auto known = std::find(scratch_.bodies.begin(), scratch_.bodies.end(), body);
  if (known != scratch_.bodies.end()) return static_cast<std::size_t>(known - scratch_.bodies.begin());
  scratch_.bodies.push_back(body);
  scratch_.others.push_back({velocity_of(*body), inertia_world_m2(*body).inverse(), mass_ratio});
  return scratch_.bodies.size() - 1;
}

/// Returns the energy of the body and all bodies in contact, per kg of the body.
double Piece::energy_of_all() const {
  double sum = energy(velocity_, inertia_);
  for (std::size_t i = 0; i < scratch_.others.size(); ++i) {
    const SolverBody& other = scratch_.others[i];
    if (other.mass_ratio > 0.0)
      sum += energy(other.velocity, inertia_world_m2(*scratch_.bodies[i])) / other.mass_ratio;
  }
  return sum;
}

/// Keeps sleeping bodies static that are hit more slowly than kNudge_mps.
void Piece::let_sleepers_lie() {
  for (std::size_t i = 0; i < scratch_.others.size(); ++i) {
    if (!scratch_.bodies[i]->asleep || !scratch_.others[i].velocity.linear_mps.isZero()) continue;
    const bool is_woken =
        std::any_of(scratch_.contacts.begin(), scratch_.contacts.end(), [&](const SolverContact& contact) {
          return contact.other == i &&
                 -velocity_at(velocity_, contact.contact_offset_m).dot(contact.normal) > kNudge_mps;
        });
    if (!is_woken) scratch_.others[i].mass_ratio = 0.0;
  }
}

/// Cancels the velocity into contacts that would close within the time left, with restitution for fast
/// impacts.
void Piece::bounce() {
  bool enters = false, is_fast = false;
  let_sleepers_lie();
  set_room(left_s_);
  for (std::size_t i = 0; i < scratch_.contacts.size(); ++i) {
    SolverContact& contact = scratch_.contacts[i];
    const bool is_push = i >= scratch_.near.size();
    const double closing_mps = -slip_at(contact, velocity_, scratch_.others).dot(contact.normal);
    if (!(closing_mps > -contact.leaves_mps + 1e-9)) continue;
    enters = true;
    if (is_push || !(closing_mps > config_.bounce_mps)) continue;
    is_fast = true;
    contact.leaves_mps = config_.restitution * closing_mps;
  }
  if (!enters) return;
  constexpr double kSame = 1.0 + 1e-9;
  const double before = energy_of_all();
  const Velocity entering = velocity_;
  const FrictionConfig rubbing{config_.friction, 0.0};
  solve_contacts(scratch_.contacts, inertia_, rubbing, velocity_, scratch_.others);
  if (is_fast && !push_ && energy_of_all() > kSame * before) {
    // Newton's restitution with friction at several contacts may add energy: repeat without restitution.
    velocity_ = entering;
    for (std::size_t i = 0; i < scratch_.others.size(); ++i)
      scratch_.others[i].velocity = velocity_of(*scratch_.bodies[i]);
    for (SolverContact& contact : scratch_.contacts) contact.leaves_mps = std::min(contact.leaves_mps, 0.0);
    solve_contacts(scratch_.contacts, inertia_, rubbing, velocity_, scratch_.others);
  }
  for (std::size_t i = 0; i < scratch_.others.size(); ++i) {
    scratch_.bodies[i]->velocity_world_mps = scratch_.others[i].velocity.linear_mps;
    scratch_.bodies[i]->angular_velocity_world_rad_s = scratch_.others[i].velocity.angular_rad_s;
  }
  std::array<bool, kSurfaceKinds> is_met{};  // each kind counts once, whatever its number of points
  for (std::size_t i = 0; i < scratch_.contacts.size(); ++i)
    if (scratch_.contacts[i].impulse_mps > 0.0) is_met[static_cast<std::size_t>(scratch_.kinds[i])] = true;
  for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
    if (is_met[kind]) note_contact(static_cast<SurfaceKind>(kind), report_);
}

/// Allows each contact to close its gap, down to the margin, within dt_s.
void Piece::set_room(double dt_s) {
  for (std::size_t i = 0; i < scratch_.contacts.size(); ++i) {
    const bool is_push = i >= scratch_.near.size();
    const double room_m = is_push ? 0.0 : scratch_.near[i].gap_m - config_.contact_margin_m;
    scratch_.contacts[i].leaves_mps = is_push ? push_->speed_mps : -std::max(room_m, 0.0) / dt_s;
  }
}

/// Returns the velocity after dt_s of gravity supported by the contacts; bodies in contact are unaffected.
Velocity Piece::held_up_after(Velocity velocity, double dt_s) {
  velocity.linear_mps += config_.gravity_world_mps2 * dt_s;
  set_room(dt_s);
  for (SolverBody& other : scratch_.others) other.mass_ratio = 0.0;
  solve_contacts(scratch_.contacts, inertia_, resting_, velocity, scratch_.others);
  return velocity;
}

/// Returns a position correction, without momentum, that restores the margin at contacts nearer than it.
Velocity Piece::lift_back(double dt_s) {
  constexpr double kAtOnce = 0.3, kFastest_mps = 0.1, kLeft = 0.05;
  Velocity lift;
  bool is_needed = false;
  for (std::size_t i = 0; i < scratch_.near.size(); ++i) {
    const double missing_m = config_.contact_margin_m - scratch_.near[i].gap_m;
    is_needed |= missing_m > kLeft * config_.contact_margin_m;
    scratch_.contacts[i].leaves_mps =
        missing_m > 0.0 ? std::min(kAtOnce * missing_m / dt_s, kFastest_mps) : missing_m / dt_s;
  }
  if (is_needed) {
    solve_contacts({scratch_.contacts.data(), scratch_.near.size()}, inertia_, {}, lift);
  }
  return lift;
}

void Piece::see_support(SubstepResult& piece) {
  double most = 0.0;
  for (std::size_t i = 0; i < scratch_.contacts.size(); ++i) {
    const SolverContact& contact = scratch_.contacts[i];
    if (!(contact.impulse_mps > most) || contact.normal.dot(up_) < kSupportCosine) continue;
    most = contact.impulse_mps;
    piece.is_held_up = true;
    piece.rests_on = scratch_.kinds[i];
  }
}

/// Returns the mean of the velocities before and after, without motion into other bodies: these keep their
/// pose until they are advanced themselves.
Velocity Piece::mean_with(const Velocity& after) {
  Velocity mean{0.5 * (velocity_.linear_mps + after.linear_mps),
                0.5 * (velocity_.angular_rad_s + after.angular_rad_s)};
  if (scratch_.others.empty()) return mean;
  set_room(left_s_);
  solve_contacts(scratch_.contacts, inertia_, {}, mean);
  return mean;
}

/// Moves with the mean velocity for as long as the motion is free.
void Piece::go(const Velocity& after) {
  const Velocity mean = mean_with(after);
  RigidMotion motion;
  motion.centre_object = body_.mass.centre_object;
  motion.linear_m_s = mean.linear_mps;
  motion.angular_rad_s = mean.angular_rad_s;
  if (scratch_.contacts.empty()) {
    // Free rotation conserves angular momentum, not angular velocity: use the angular velocity half-way.
    const Eigen::Isometry3d T_half = pose_after(body_.T_world_object, motion, 0.5 * left_s_);
    const Eigen::Matrix3d inertia_half =
        T_half.linear() * body_.mass.inertia_m2 * T_half.linear().transpose();
    motion.angular_rad_s = inertia_half.inverse() * (inertia_ * motion.angular_rad_s);
  }
  limit(motion.angular_rad_s, config_.max_angular_rad_s);
  const Velocity lift = lift_back(left_s_);
  motion.linear_m_s += lift.linear_mps;
  motion.angular_rad_s += lift.angular_rad_s;

  const FreeTime free =
      probe_.free_time(body_.T_world_object, motion, left_s_, kKept * config_.contact_margin_m, left_out_);
  const double gone_s = std::clamp(free.free_s, 0.0, left_s_);
  limited_by_ = free.limit;
  if (gone_s > 0.0) {
    body_.T_world_object = pose_after(body_.T_world_object, motion, gone_s);
    make_orthonormal(body_.T_world_object);
  }
  const double part = gone_s / left_s_;
  velocity_.linear_mps += part * (after.linear_mps - velocity_.linear_mps);
  const Vec3 momentum_after =
      inertia_ * (velocity_.angular_rad_s + part * (after.angular_rad_s - velocity_.angular_rad_s));
  velocity_.angular_rad_s = inertia_world_m2(body_).inverse() * momentum_after;
  limit(velocity_.linear_mps, config_.max_speed_mps);
  limit(velocity_.angular_rad_s, config_.max_angular_rad_s);
  left_s_ -= gone_s;
}

SubstepResult Piece::run() {
  SubstepResult piece;
  limit(velocity_.linear_mps, config_.max_speed_mps);
  limit(velocity_.angular_rad_s, config_.max_angular_rad_s);
  const double whole_s = left_s_;
  for (int stop = 0; stop < config_.max_slides && left_s_ > kNoTime_s; ++stop) {
    if (!find_contacts()) {
      piece.crosses = true;
      piece.left_s = left_s_;
      break;
    }
    if (!scratch_.contacts.empty()) {
      bounce();
      if (!piece.is_balanced) {
        const Velocity moved = held_up_after({}, whole_s);
        const double begins_mps = moved.linear_mps.norm() + moved.angular_rad_s.norm() * body_.mass.radius_m;
        piece.is_balanced = begins_mps < 0.05 * config_.gravity_world_mps2.norm() * whole_s;
      }
    }
    const Velocity after = held_up_after(velocity_, left_s_);
    see_support(piece);
    go(after);
  }
  body_.velocity_world_mps = velocity_.linear_mps;
  body_.angular_velocity_world_rad_s = velocity_.angular_rad_s;
  piece.is_balanced = piece.is_balanced && piece.is_held_up;
  return piece;
}

}  // namespace

SubstepResult simulate_substep(Body& body, double dt_s, const CollisionQueries& probe,
                               const PhysicsConfig& config, const std::optional<Push>& push,
                               RigidScratch& scratch, StepReport& report) {
  return Piece(body, dt_s, probe, config, push, scratch, report).run();
}

}  // namespace roomradar
