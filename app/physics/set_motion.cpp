// set_motion.cpp: the queries of bodies that move as one set.
#include "app/physics/set_motion.hpp"

#include <list>

#include "app/physics/contact_queries.hpp"
#include "radar/motion/joint_motion.hpp"

namespace roomradar {
namespace {

constexpr double kKept = 0.5;  // fraction of the margin at which approaching surfaces stop the motion

/// Returns balls that contain the paths of the active bodies.
std::vector<PathBall> paths_of(std::span<const MovingBody> bodies, const std::vector<RigidMotion>& motions,
                               double margin_m) {
  std::vector<PathBall> paths(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_active(bodies[i])) continue;
    const double radius_m = bodies[i].body->mass.radius_m;
    const double speed_mps = motions[i].linear_m_s.norm() + motions[i].angular_rad_s.norm() * radius_m;
    paths[i] = {centre_world(*bodies[i].body), radius_m + speed_mps * bodies[i].left_s + margin_m};
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
    movers_.push_back({.T_world_object = &bodies[i].body->T_world_object,
                       .motion = motions[i],
                       .duration_s = bodies[i].left_s,
                       .path = paths[i],
                       .free_time = [this, k](double duration_s) { return free_time(k, duration_s); },
                       .free_time_beside =
                           [this, k](std::size_t stopped, double duration_s) {
                             return free_time_beside(k, stopped, duration_s);
                           },
                       .moved = bodies[i].moved,
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
  const FreeTime time = moving.probe->free_time(moving.body->T_world_object, motion, duration_s, keep_m_,
                                                moving.left_out, trees);
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
      ->free_time(moving.body->T_world_object, motion, duration_s, keep_m_, ~bit_of(SurfaceKind::kObject),
                  trees)
      .free_s;
}

void MovingSet::end(std::vector<double>& gone_s) {
  for (std::size_t k = 0; k < set_.size(); ++k) {
    gone_s[set_[k]] = movers_[k].gone_s;
    bodies_[set_[k]].limited_by = movers_[k].limited_by;
  }
}

}  // namespace

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

}  // namespace roomradar
