// rigid_motion.cpp: alternates contact impulses and motion up to the time of impact.
#include "app/physics/rigid_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "app/physics/contact_queries.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/sliding.hpp"
#include "radar/motion/joint_motion.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {
namespace {

constexpr double kKept = 0.5;  // fraction of the margin at which approaching surfaces stop the motion

/// Returns balls that contain the paths of the active bodies.
std::vector<PathBall> paths_of(std::span<const MovingBody> bodies, const std::vector<RigidMotion>& motions,
                               double margin_m) {
  std::vector<PathBall> paths(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_active(bodies[i])) continue;
    const double radius_m = bodies[i].body.mass.radius_m;
    const double speed_mps = motions[i].linear_m_s.norm() + motions[i].angular_rad_s.norm() * radius_m;
    paths[i] = {centre_world(bodies[i].body), radius_m + speed_mps * bodies[i].left_s + margin_m};
  }
  return paths;
}

/// Bodies that move at the same time.
class MovingSet {
 public:
  /// @param set  indices of the bodies
  MovingSet(std::span<MovingBody> bodies, std::span<const std::size_t> set,
            const std::vector<RigidMotion>& motions, const std::vector<PathBall>& paths, double margin_m);
  MovingSet(const MovingSet&) = delete;
  MovingSet& operator=(const MovingSet&) = delete;

  [[nodiscard]] std::span<JointMover> movers() { return movers_; }
  /// Takes over how far the bodies have moved.
  void end(std::vector<double>& gone_s);

 private:
  std::span<MovingBody> bodies_;
  std::span<const std::size_t> set_;
  double keep_m_;
  std::vector<JointMover> movers_;     // in the order of the set
  std::vector<std::size_t> mover_of_;  // per body; kNoMover if it is not in the set

  [[nodiscard]] JointMover::Free free_time(std::size_t mover, double duration_s) const;
  [[nodiscard]] double free_time_beside(std::size_t mover, std::size_t stopped, double duration_s) const;
};

MovingSet::MovingSet(std::span<MovingBody> bodies, std::span<const std::size_t> set,
                     const std::vector<RigidMotion>& motions, const std::vector<PathBall>& paths,
                     double margin_m)
    : bodies_(bodies), set_(set), keep_m_(kKept * margin_m), mover_of_(bodies.size(), kNoMover) {
  for (std::size_t k = 0; k < set.size(); ++k) {
    const std::size_t i = set[k];
    mover_of_[i] = k;
    movers_.push_back({.T_world_object = &bodies[i].body.T_world_object,
                       .motion = motions[i],
                       .duration_s = bodies[i].left_s,
                       .path = paths[i],
                       .free_time = [this, k](double duration_s) { return free_time(k, duration_s); },
                       .free_time_beside =
                           [this, k](std::size_t stopped, double duration_s) {
                             return free_time_beside(k, stopped, duration_s);
                           },
                       .seen_as = bodies[i].seen_as,
                       .limited_by = {}});
  }
}

/// Returns how long a body moves free of contact with surfaces, bodies at rest, and members of its set. Each
/// pair of members is tested once, from the body that spins faster: the bounds are tighter relative to the
/// slower one.
JointMover::Free MovingSet::free_time(std::size_t mover, double duration_s) const {
  TreeStates trees;
  const MovingBody& moving = bodies_[set_[mover]];
  const RigidMotion motion = movers_[mover].motion;  // a copy: the same alignment in every run
  const double spins = motion.angular_rad_s.squaredNorm();
  trees.left_out.assign(moving.member_of_tree.size(), false);
  trees.motions.assign(moving.member_of_tree.size(), {});
  for (std::size_t tree = 0; tree < moving.member_of_tree.size(); ++tree) {
    const std::size_t other = moving.member_of_tree[tree];
    if (other == kNoOther || !is_active(bodies_[other])) continue;
    if (mover_of_[other] == kNoMover) {  // their paths cannot intersect
      trees.left_out[tree] = true;
      continue;
    }
    const JointMover& beside = movers_[mover_of_[other]];
    if (beside.has_stopped) continue;
    const double other_spins = beside.motion.angular_rad_s.squaredNorm();
    trees.left_out[tree] = other_spins > spins || (other_spins == spins && mover_of_[other] < mover);
    trees.motions[tree] = beside.motion;
  }
  const FreeTime time =
      moving.probe.free_time(moving.body.T_world_object, motion, duration_s, keep_m_, moving.left_out, trees);
  const std::size_t limit =
      time.limit.kind == SurfaceKind::kNothing ? kNoOther : member_of(moving, time.limit);
  return {time, limit == kNoOther ? kNoMover : mover_of_[limit]};
}

/// Returns how long a body moves free of contact with a member that has stopped.
double MovingSet::free_time_beside(std::size_t mover, std::size_t stopped, double duration_s) const {
  TreeStates trees;
  const MovingBody& moving = bodies_[set_[mover]];
  const RigidMotion motion = movers_[mover].motion;  // as above
  trees.left_out.resize(moving.member_of_tree.size());
  for (std::size_t tree = 0; tree < moving.member_of_tree.size(); ++tree)
    trees.left_out[tree] = moving.member_of_tree[tree] != set_[stopped];
  return moving.probe
      .free_time(moving.body.T_world_object, motion, duration_s, keep_m_, ~bit_of(SurfaceKind::kObject),
                 trees)
      .free_s;
}

void MovingSet::end(std::vector<double>& gone_s) {
  for (std::size_t k = 0; k < set_.size(); ++k) {
    gone_s[set_[k]] = movers_[k].gone_s;
    bodies_[set_[k]].limited_by = movers_[k].limited_by;
  }
}

/// Moves the active bodies simultaneously, each until its first contact or for the rest of its substep
/// (MovingBody::left_s). Bodies that touch each other stop at the time of impact. The other bodies continue,
/// with the stopped bodies as obstacles at rest. Bodies whose paths cannot intersect are independent. A
/// body's motion also ends when a query extends its contact-free time by less than 2 % of left_s, or after 13
/// queries; see move_to_contact(). Sets MovingBody::limited_by.
/// @param motions   one per body; only those of active bodies are used
/// @param margin_m  contact margin; approaching surfaces stop at half of it
/// @param worker    runs some of the queries on a second thread; results are the same without it; may be null
/// @return duration of each body's motion, s; 0 for an inactive body
std::vector<double> move_active(std::span<MovingBody> bodies, const std::vector<RigidMotion>& motions,
                                double margin_m, WorkerThread* worker) {
  std::vector<double> gone_s(bodies.size());
  const std::vector<PathBall> paths = paths_of(bodies, motions, margin_m);
  const std::vector<std::vector<std::size_t>> members = sets_that_meet(paths);
  std::list<MovingSet> sets;
  std::vector<std::span<JointMover>> movers;
  for (const std::vector<std::size_t>& set : members)
    movers.push_back(sets.emplace_back(bodies, set, motions, paths, margin_m).movers());
  move_to_contact(movers, worker);
  for (MovingSet& set : sets) set.end(gone_s);
  return gone_s;
}

struct Load {
  double support_Ns = 0.0, any_Ns = 0.0;  // greatest of a supporting contact, of any contact
  double lift_Ns = 0.0;                   // of all contacts
  SurfaceKind any_kind = SurfaceKind::kNothing;
};

/// Sets the result of each active body, except is_balanced, from the impulses of the support solve. A body
/// is held up by surfaces within 60 degrees of level. A body is also held up if all contacts together bear at
/// least 90 % of its weight, as at a keystone.
/// @param up_world  unit, against gravity. Zero without gravity; then nothing is held up
void note_support(std::span<MovingBody> bodies, const PhysicsConfig& config, const Eigen::Vector3d& up_world,
                  const ContactSystem& system) {
  const double g = config.gravity_world_mps2.norm();
  std::vector<Load> loads(bodies.size());
  const auto note = [&](std::size_t body, const Body* other, const SolverContact& contact, double sign,
                        SurfaceKind kind) {
    if (body >= bodies.size() || !is_active(bodies[body])) return;
    SubstepResult& result = bodies[body].result;
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
    return index < bodies.size() ? &bodies[index].body : system.bystanders[index - bodies.size()].body;
  };
  for (std::size_t i = 0; i < system.contacts.size(); ++i) {
    const SolverContact& contact = system.contacts[i];
    note(contact.body, body_at(contact.other), contact, 1.0, system.kinds[i]);
    note(contact.other, body_at(contact.body), contact, -1.0, SurfaceKind::kObject);
  }
  constexpr double kBorne = 0.9;  // fraction of the weight
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double weight_Ns = bodies[i].in.mass_kg * g * bodies[i].left_s;
    SubstepResult& result = bodies[i].result;
    if (result.is_held_up || !(loads[i].lift_Ns > kBorne * weight_Ns) || !(weight_Ns > 0.0)) continue;
    result.is_held_up = true;
    result.rests_on = loads[i].any_kind;
  }
}

/// Adds the impacts of the last solve to the bodies' reports. Simultaneous impacts of a body on one kind of
/// surface count once.
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
      if (is_met[i][kind]) note_contact(static_cast<SurfaceKind>(kind), bodies[i].in.report);
}

using Vec3 = Eigen::Vector3d;

/// Fraction of gravity's acceleration below which a body counts as balanced. A body whose support is 5 %
/// short of its load starts with more; rounding and the solver's tolerance with less.
constexpr double kUnbalanced = 0.004;

void limit(Vec3& v, double most) {
  if (const double size = v.norm(); size > most) v *= most / size;
}

void limit(Velocity& velocity, const PhysicsConfig& config) {
  limit(velocity.linear_mps, config.max_speed_mps);
  limit(velocity.angular_rad_s, config.max_angular_rad_s);
}

Velocity velocity_of(const Body& body) {
  return {body.velocity_world_mps, body.angular_velocity_world_rad_s};
}

void set_velocity(Body& body, const Velocity& velocity) {
  body.velocity_world_mps = velocity.linear_mps;
  body.angular_velocity_world_rad_s = velocity.angular_rad_s;
}

/// Upper bound of the speed of the body's points.
double speed_of(const Body& body, const Velocity& velocity) {
  return velocity.linear_mps.norm() + velocity.angular_rad_s.norm() * body.mass.radius_m;
}

void wake(MovingBody& sleeper) {
  sleeper.body.asleep = false;
  sleeper.body.unbalanced_s = 0.0;
  sleeper.in.report.woke = true;
}

/// Velocities of the solver's bodies: of the substep's bodies, then of the bystanders.
using Velocities = std::vector<Velocity>;

/// Simulation of one substep. Its solves take velocities and return velocities; only set_velocities() gives
/// them to the bodies. The functions set the bounds, guesses and masses of the system's contacts and bodies
/// before they solve.
class Substep {
 public:
  Substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system)
      : bodies_(bodies), config_(config), system_(system) {}

  void run();

 private:
  std::span<MovingBody> bodies_;
  const PhysicsConfig& config_;
  ContactSystem& system_;
  const Vec3 up_ = -config_.gravity_world_mps2.stableNormalized();  // zero without gravity

  [[nodiscard]] bool is_movable(std::size_t solver_index) const {
    return system_.bodies[solver_index].inverse_mass_per_kg > 0.0;
  }
  [[nodiscard]] Velocities at_rest() const { return Velocities(system_.bodies.size()); }
  [[nodiscard]] Velocities solved(Velocities velocities, double rolling) {
    return system_.solver.solve(system_.contacts, system_.bodies, std::move(velocities), rolling);
  }

  void begin();
  [[nodiscard]] Velocities velocities() const;
  void set_velocities(const Velocities& velocities) const;
  [[nodiscard]] std::optional<Velocities> bounce(const Velocities& velocities);
  [[nodiscard]] bool wake_hit_sleepers();
  [[nodiscard]] Velocities hold_up(Velocities velocities, bool keeps_impulses);
  void wake_unbalanced_sleepers(const Velocities& after);
  void find_balanced(const Velocities& velocities);
  [[nodiscard]] Velocities mean_velocities(const Velocities& before, const Velocities& after);
  void follow_features();
  [[nodiscard]] Velocities rises(const Velocities& means);
  [[nodiscard]] Velocities corrections();
  [[nodiscard]] std::vector<RigidMotion> motions(const Velocities& means, const Velocities& rises,
                                                 const Velocities& lifts) const;
  [[nodiscard]] std::vector<Eigen::Matrix3d> inertias_m2() const;
  [[nodiscard]] std::vector<double> move(const std::vector<RigidMotion>& planned);
  [[nodiscard]] Velocities velocities_after(const std::vector<double>& gone_s,
                                            const std::vector<Eigen::Matrix3d>& inertias_m2,
                                            Velocities velocities, const Velocities& after) const;
  void use_time(const std::vector<double>& gone_s);
  void settle(const Velocities& rises, const std::vector<double>& gone_s) const;
};

/// Resets what the bodies keep of the last substep, and limits their velocities.
void Substep::begin() {
  for (MovingBody& moving : bodies_) {
    Velocity velocity = velocity_of(moving.body);
    limit(velocity, config_);
    set_velocity(moving.body, velocity);
    moving.was_asleep = moving.body.asleep;
    moving.left_s = moving.was_asleep ? 0.0 : moving.dt_s;
    moving.crosses = false;
    moving.stops_in_place = 0;
    moving.limited_by = {};
    moving.T_world_near.reset();
    moving.result = {};
  }
}

/// Returns the velocities of the solver's bodies.
Velocities Substep::velocities() const {
  Velocities velocities;
  for (const MovingBody& moving : bodies_) velocities.push_back(velocity_of(moving.body));
  for (const Bystander& bystander : system_.bystanders) velocities.push_back(velocity_of(*bystander.body));
  return velocities;
}

/// Sets the velocities of the solver's bodies.
void Substep::set_velocities(const Velocities& velocities) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) set_velocity(bodies_[i].body, velocities[i]);
  for (std::size_t i = 0; i < system_.bystanders.size(); ++i)
    set_velocity(*system_.bystanders[i].body, velocities[bodies_.size() + i]);
}

/// Cancels the velocity into contacts that would close within the time left, with restitution for fast
/// impacts. Returns the velocities after the impacts; none if no contact would close.
std::optional<Velocities> Substep::bounce(const Velocities& velocities) {
  allow_closing_gaps(bodies_, config_.contact_margin_m, system_);
  bool enters = false, is_fast = false, is_pushed = false;
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    SolverContact& contact = system_.contacts[i];
    is_pushed |= system_.push[i] != nullptr;
    const double closing_mps = -slip_at(contact, velocities).dot(contact.normal);
    if (!(closing_mps > -contact.leaves_mps + 1e-9)) continue;
    enters = true;
    const bool is_carried = bodies_[contact.body].in.is_carried && contact.other == kNoOther;
    if (system_.push[i] != nullptr || is_carried || !(closing_mps > config_.bounce_mps)) continue;
    is_fast = true;
    contact.leaves_mps = contact.restitution * closing_mps;
  }
  if (!enters) return std::nullopt;
  set_masses_for_impacts(bodies_, velocities, system_);
  clear_impulses(system_);
  constexpr double kSame = 1.0 + 1e-9;
  Velocities after = solved(velocities, 0.0);
  if (is_fast && !is_pushed && energy(system_.bodies, after) > kSame * energy(system_.bodies, velocities)) {
    // Newton's restitution with friction at several contacts may add energy: repeat without restitution.
    for (SolverContact& contact : system_.contacts) contact.leaves_mps = std::min(contact.leaves_mps, 0.0);
    clear_impulses(system_);
    after = solved(velocities, 0.0);
  }
  return after;
}

/// Wakes the sleeping bodies that bounce() moved. Returns true if there are any: their contacts are not in
/// the system.
bool Substep::wake_hit_sleepers() {
  bool woke = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    MovingBody& moving = bodies_[i];
    if (!is_movable(i) || !moving.body.asleep) continue;
    wake(moving);
    woke = true;
    moving.left_s = moving.dt_s;
  }
  return woke;
}

/// Returns the velocities after the time left, with gravity, support and friction. The weight of a body acts
/// on all bodies below it, sleeping ones included.
/// @param keeps_impulses  keeps them as guesses for the next substep
Velocities Substep::hold_up(Velocities velocities, bool keeps_impulses) {
  set_masses(bodies_, Movable::kActiveAndKnownSleepers, system_);
  double scale = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const MovingBody& moving = bodies_[i];
    if (moving.in.is_carried || !is_movable(i)) continue;
    const double left_s = moving.body.asleep ? moving.dt_s : moving.left_s;
    velocities[i].linear_mps += config_.gravity_world_mps2 * left_s;
    scale = std::max(scale, left_s);
  }
  allow_closing_gaps(bodies_, config_.contact_margin_m, system_);
  guess_impulses(bodies_, scale, system_);
  Velocities after = solved(std::move(velocities), config_.rolling);
  if (keeps_impulses && scale > 0.0) keep_impulses(bodies_, 1.0 / scale, system_);  // as forces
  return after;
}

/// Wakes sleeping bodies that the weight on them would set in motion: slowly, if it lasts; fast, at once. A
/// body that still jiggles on a heap does not keep the heap awake. Needs the masses of hold_up().
/// @param after  result of hold_up()
void Substep::wake_unbalanced_sleepers(const Velocities& after) {
  constexpr double kFast = 0.05, kSlow = 1.5 * kUnbalanced;  // fractions of gravity's acceleration
  constexpr double kLasts_s = 0.04;
  const double g = config_.gravity_world_mps2.norm();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    MovingBody& moving = bodies_[i];
    if (!moving.body.asleep) continue;
    const double begins_mps2 = is_movable(i) ? speed_of(moving.body, after[i]) / moving.dt_s : 0.0;
    double& unbalanced_s = moving.body.unbalanced_s;
    unbalanced_s = begins_mps2 < kSlow * g ? 0.0 : unbalanced_s + moving.dt_s;
    if (unbalanced_s >= kLasts_s || begins_mps2 >= kFast * g) wake(moving);  // moves from the next substep on
  }
}

/// Sets is_balanced of the active bodies that would stay at rest if all were at rest. Returns without a solve
/// if no body is slow. Needs the masses of hold_up().
/// @param velocities  before hold_up()
void Substep::find_balanced(const Velocities& velocities) {
  constexpr double kSlow_mps = 0.3;
  bool is_any_slow = false;
  for (std::size_t i = 0; i < bodies_.size() && !is_any_slow; ++i)
    is_any_slow = is_active(bodies_[i]) && speed_of(bodies_[i].body, velocities[i]) < kSlow_mps;
  if (!is_any_slow) return;
  Velocities falling = at_rest();
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (!bodies_[i].in.is_carried && is_movable(i))
      falling[i].linear_mps = config_.gravity_world_mps2 * bodies_[i].dt_s;
  for (std::size_t i = 0; i < system_.contacts.size(); ++i)
    system_.contacts[i].leaves_mps = system_.push[i] != nullptr ? system_.push[i]->speed_mps : 0.0;
  guess_impulses(bodies_, bodies_.front().dt_s, system_);
  const Velocities held = solved(std::move(falling), config_.rolling);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!is_active(bodies_[i])) continue;
    const double begins_mps2 = speed_of(bodies_[i].body, held[i]) / bodies_[i].dt_s;
    bodies_[i].result.is_balanced = begins_mps2 < kUnbalanced * config_.gravity_world_mps2.norm();
  }
}

/// Returns the means of the velocities before and after, without motion into bodies that do not move now.
/// Bodies that do not move have zero.
Velocities Substep::mean_velocities(const Velocities& before, const Velocities& after) {
  Velocities means = at_rest();
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (is_active(bodies_[i]))
      means[i] = {0.5 * (before[i].linear_mps + after[i].linear_mps),
                  0.5 * (before[i].angular_rad_s + after[i].angular_rad_s)};
  const bool meets_others = std::any_of(system_.contacts.begin(), system_.contacts.end(),
                                        [](const auto& contact) { return contact.other != kNoOther; });
  if (!meets_others) return means;
  set_masses(bodies_, Movable::kActive, system_);
  allow_closing_gaps(bodies_, config_.contact_margin_m, system_);
  for (SolverContact& contact : system_.contacts) contact.friction = 0.0;
  clear_impulses(system_);
  return solved(std::move(means), 0.0);
}

/// Gives the contacts the normals of their features and no friction, for changes of position without
/// momentum.
void Substep::follow_features() {
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    SolverContact& contact = system_.contacts[i];
    contact.normal = system_.features[i].normal;
    contact.contact_offset_m = system_.features[i].offset_m;
    contact.friction = 0.0;
  }
}

/// Returns what must be added to motions along a plane, without momentum, so that they do not enter the bumps
/// of the surface itself. Empty: nothing.
Velocities Substep::rises(const Velocities& means) {
  constexpr double kLeast_mps = 1e-6;
  const bool is_any_bumpy = std::any_of(system_.features.begin(), system_.features.end(),
                                        [](const Feature& feature) { return feature.is_on_patch; });
  if (!is_any_bumpy) return {};
  allow_closing_gaps(bodies_, config_.contact_margin_m, system_);
  bool is_needed = false;
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    SolverContact& contact = system_.contacts[i];
    const Vec3 slip_mps = slip_at(contact, means);
    if (!system_.features[i].is_on_patch) {
      contact.leaves_mps -= slip_mps.dot(contact.normal);
      continue;
    }
    // Its rotation rolls a round body over a bump, not into it: that part keeps to the plane.
    const Vec3& along_mps = means[contact.body].linear_mps;
    contact.leaves_mps -=
        along_mps.dot(contact.normal) + (slip_mps - along_mps).dot(system_.features[i].patch_normal);
    is_needed |= contact.leaves_mps > kLeast_mps;
  }
  if (!is_needed) return {};
  set_masses(bodies_, Movable::kActive, system_);
  clear_impulses(system_);
  return solved(at_rest(), 0.0);
}

/// Returns position corrections, without momentum, that restore the margin at contacts nearer than it.
Velocities Substep::corrections() {
  constexpr double kAtOnce = 0.3, kFastest_mps = 0.1, kLeft = 0.05;
  bool is_needed = false;
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    SolverContact& contact = system_.contacts[i];
    const double missing_m = system_.push[i] != nullptr ? -1.0 : config_.contact_margin_m - system_.gap_m[i];
    is_needed |= missing_m > kLeft * config_.contact_margin_m;
    const double left = left_s(bodies_, contact);
    contact.leaves_mps =
        missing_m > 0.0 ? std::min(kAtOnce * missing_m / left, kFastest_mps) : missing_m / left;
  }
  if (!is_needed) return at_rest();
  set_masses(bodies_, Movable::kActive, system_);
  clear_impulses(system_);
  return solved(at_rest(), 0.0);
}

/// Returns the motions of the active bodies; zero for others.
std::vector<RigidMotion> Substep::motions(const Velocities& means, const Velocities& rises,
                                          const Velocities& lifts) const {
  std::vector<RigidMotion> motions(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const MovingBody& moving = bodies_[i];
    if (!is_active(moving)) continue;
    const Body& body = moving.body;
    RigidMotion motion;
    motion.centre_object = body.mass.centre_object;
    // A body that spins too fast moves slower as a whole: a contact that does not close then does not,
    // either.
    const double spin_rad_s = means[i].angular_rad_s.norm();
    const double slower =
        spin_rad_s > config_.max_angular_rad_s ? config_.max_angular_rad_s / spin_rad_s : 1.0;
    motion.linear_m_s = slower * means[i].linear_mps;
    motion.angular_rad_s = mean_free_spin(body, slower * means[i].angular_rad_s, moving.left_s);
    motion.linear_m_s += lifts[i].linear_mps;
    motion.angular_rad_s += lifts[i].angular_rad_s;
    if (!rises.empty()) {
      motion.linear_m_s += rises[i].linear_mps;
      motion.angular_rad_s += rises[i].angular_rad_s;
    }
    motions[i] = motion;
  }
  return motions;
}

std::vector<Eigen::Matrix3d> Substep::inertias_m2() const {
  std::vector<Eigen::Matrix3d> inertias_m2;
  for (const MovingBody& moving : bodies_) inertias_m2.push_back(inertia_world_m2(moving.body));
  return inertias_m2;
}

/// Moves the active bodies. Returns the durations of their motions, s.
std::vector<double> Substep::move(const std::vector<RigidMotion>& planned) {
  const auto active = static_cast<std::size_t>(std::count_if(bodies_.begin(), bodies_.end(), is_active));
  return move_active(bodies_, planned, config_.contact_margin_m, worker_for(active, system_));
}

/// Returns the angular velocity after a motion: with the angular momentum before it. The path of a body in
/// contact is not that of free rotation, and this momentum could have more energy on it: there the body turns
/// more slowly.
/// @param inertia_m2  before the motion
Vec3 spin_after(const Body& body, const Eigen::Matrix3d& inertia_m2, const Vec3& spin_rad_s,
                bool is_touched) {
  const Vec3 momentum_m2_rad_s = inertia_m2 * spin_rad_s;
  Vec3 after_rad_s = inertia_world_m2(body).inverse() * momentum_m2_rad_s;
  const double energy_before = spin_rad_s.dot(momentum_m2_rad_s);
  const double energy_after = after_rad_s.dot(momentum_m2_rad_s);
  if (is_touched && energy_after > energy_before) after_rad_s *= std::sqrt(energy_before / energy_after);
  return after_rad_s;
}

/// Returns the velocities after motions that took the fraction gone_s of the time left.
/// @param inertias_m2  before the motions
/// @param velocities   before hold_up()
/// @param after        result of hold_up(), at the end of the time left
Velocities Substep::velocities_after(const std::vector<double>& gone_s,
                                     const std::vector<Eigen::Matrix3d>& inertias_m2, Velocities velocities,
                                     const Velocities& after) const {
  std::vector<bool> is_touched(system_.bodies.size());
  for (const SolverContact& contact : system_.contacts) {
    is_touched[contact.body] = true;
    if (contact.other < is_touched.size()) is_touched[contact.other] = true;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const MovingBody& moving = bodies_[i];
    if (!is_active(moving)) continue;
    const Eigen::Matrix3d inertia_m2 = inertias_m2[i];  // a copy: the same alignment in every run
    const double part = gone_s[i] / moving.left_s;
    Velocity& velocity = velocities[i];
    velocity.linear_mps += part * (after[i].linear_mps - velocity.linear_mps);
    velocity.angular_rad_s += part * (after[i].angular_rad_s - velocity.angular_rad_s);
    velocity.angular_rad_s = spin_after(moving.body, inertia_m2, velocity.angular_rad_s, is_touched[i]);
    limit(velocity, config_);
  }
  return velocities;
}

/// Subtracts the durations of the motions from the time left. A body that gets no further, jammed between
/// others, stays for the rest of the substep.
void Substep::use_time(const std::vector<double>& gone_s) {
  constexpr double kProgress = 1e-3;  // fraction of the substep
  constexpr int kMaxStopsInPlace = 4;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    MovingBody& moving = bodies_[i];
    if (!is_active(moving)) continue;
    moving.left_s -= gone_s[i];
    if (gone_s[i] > kProgress * moving.dt_s) continue;
    if (++moving.stops_in_place == kMaxStopsInPlace) moving.left_s = 0.0;
  }
}

/// Takes the bodies that were lifted over bumps back down, as far as the bumps leave the margin.
/// @param rises  those of the motions, of which gone_s were carried out; may be empty
void Substep::settle(const Velocities& rises, const std::vector<double>& gone_s) const {
  if (rises.empty()) return;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Velocity& rise = rises[i];
    if (!(gone_s[i] > 0.0) || (rise.linear_mps.isZero(0.0) && rise.angular_rad_s.isZero(0.0))) continue;
    const MovingBody& moving = bodies_[i];
    Eigen::Isometry3d& T_world_object = moving.body.T_world_object;
    const RigidMotion back{-rise.linear_mps, -rise.angular_rad_s, moving.body.mass.centre_object};
    const double margin_m = config_.contact_margin_m, keep_m = 0.5 * margin_m;
    const auto [free_s, limit] =
        moving.probe.free_time(T_world_object, back, gone_s[i], keep_m, moving.left_out, {});
    double back_s = free_s;
    if (limit.kind != SurfaceKind::kNothing)
      back_s *= std::max(limit.gap_m - margin_m, 0.0) / (limit.gap_m - keep_m);
    if (!(back_s > 0.0)) continue;
    T_world_object = pose_after(T_world_object, back, back_s);
    make_orthonormal(T_world_object);
    show(moving);
  }
}

void Substep::run() {
  begin();
  const auto is_any_active = [&] { return std::any_of(bodies_.begin(), bodies_.end(), is_active); };
  for (int stop = 0; stop < config_.max_contact_events && is_any_active(); ++stop) {
    find_contacts(bodies_, config_, up_, system_);

    if (const std::optional<Velocities> bounced = bounce(velocities())) {
      set_velocities(*bounced);
      const bool woke = wake_hit_sleepers();
      count_impacts(bodies_, system_);
      if (woke) continue;
    }

    const Velocities before = velocities();
    const Velocities after = hold_up(before, stop == 0);
    if (stop == 0) wake_unbalanced_sleepers(after);
    note_support(bodies_, config_, up_, system_);
    if (stop == 0) find_balanced(before);

    const Velocities means = mean_velocities(before, after);
    follow_features();
    const Velocities rising = rises(means);
    const Velocities lifts = corrections();
    const std::vector<Eigen::Matrix3d> inertias_before_m2 = inertias_m2();
    const std::vector<double> gone_s = move(motions(means, rising, lifts));
    set_velocities(velocities_after(gone_s, inertias_before_m2, before, after));
    use_time(gone_s);
    settle(rising, gone_s);
  }
  for (MovingBody& moving : bodies_) moving.result.is_balanced &= moving.result.is_held_up;
}

}  // namespace

void simulate_substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system) {
  Substep(bodies, config, system).run();
}

}  // namespace roomradar
