// joint_motion.cpp: conservative advancement of a set of bodies; queries only the body whose bound ends.
#include "radar/motion/joint_motion.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {

void make_orthonormal(Eigen::Isometry3d& T) {
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
}

namespace {

struct Progress {
  Eigen::Isometry3d T_world_start;
  double free_until_s = 0.0;
  bool stops = false;  ///< at free_until_s
  std::size_t meets = kNoMover;
  int queries = 0;
};

/// Moves the body to its pose after time_s. Computes with local copies: with AVX, Eigen's sums may depend on
/// the alignment of their operands, which differs from run to run in a vector.
void move_to(JointMover& mover, const Progress& progress, double time_s) {
  const RigidMotion motion = mover.motion;
  const Eigen::Isometry3d T_world_start = progress.T_world_start;
  Eigen::Isometry3d T = pose_after(T_world_start, motion, time_s);
  make_orthonormal(T);
  *mover.T_world_object = T;
  for (TreeInstance* seen : mover.seen_as) seen->T_world_mesh = T;
}

/// Computes the time until which a mover is free of contact, and whether its motion ends then.
void bound_free_time(JointMover& mover, double now_s, Progress& progress) {
  constexpr double kGained = 0.02;  // fraction of the duration
  constexpr int kMaxQueries = 12;   // per body
  const double left_s = mover.duration_s - now_s;
  const JointMover::Free free = mover.free_time(left_s);
  const double gained_s = std::clamp(free.time.free_s, 0.0, left_s);
  const bool gains_little = gained_s < kGained * mover.duration_s && (now_s > 0.0 || gained_s == 0.0);
  const bool is_all_free = gained_s == left_s;
  progress.free_until_s = is_all_free ? mover.duration_s : now_s + gained_s;
  progress.stops = is_all_free || gains_little || ++progress.queries > kMaxQueries;
  if (is_all_free || !progress.stops) return;
  mover.limited_by = free.time.limit;
  progress.meets = free.limited_by;
}

/// Stops the movers whose motion ends now, and those that they meet. Returns the indices of both.
std::vector<std::size_t> stop_at(double now_s, std::span<JointMover> movers,
                                 std::span<const Progress> progress) {
  std::vector<std::size_t> stopped;
  const auto stop = [&](std::size_t i) {
    if (movers[i].has_stopped) return;
    movers[i].has_stopped = true;
    stopped.push_back(i);
  };
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (movers[i].has_stopped || !progress[i].stops || progress[i].free_until_s > now_s) continue;
    stop(i);
    if (progress[i].meets != kNoMover) stop(progress[i].meets);
  }
  return stopped;
}

bool overlap(const PathBall& a, const PathBall& b) {
  return (a.centre_world - b.centre_world).norm() < a.radius_m + b.radius_m;
}

/// Moves the bodies of a set. Their free times at the start are known.
void advance_set(std::span<JointMover> movers, std::span<Progress> progress) {
  double now_s = 0.0;
  for (bool is_known = true;; is_known = false) {
    double next_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < movers.size(); ++i) {
      if (movers[i].has_stopped) continue;
      if (!is_known && progress[i].free_until_s <= now_s) bound_free_time(movers[i], now_s, progress[i]);
      next_s = std::min(next_s, progress[i].free_until_s);
    }
    if (next_s == std::numeric_limits<double>::infinity()) return;  // all have stopped
    now_s = next_s;
    for (std::size_t i = 0; i < movers.size(); ++i) {
      if (movers[i].has_stopped) continue;
      movers[i].gone_s = now_s;
      if (now_s > 0.0) move_to(movers[i], progress[i], now_s);
    }
    for (const std::size_t at_rest : stop_at(now_s, movers, progress))
      for (std::size_t i = 0; i < movers.size(); ++i) {
        if (movers[i].has_stopped || !overlap(movers[i].path, movers[at_rest].path)) continue;
        const double free_s = movers[i].free_time_beside(at_rest, movers[i].duration_s - now_s);
        const double until_s = now_s + std::max(free_s, 0.0);
        if (until_s >= progress[i].free_until_s) continue;
        progress[i].free_until_s = until_s;
        progress[i].stops = false;
        progress[i].meets = kNoMover;
        movers[i].limited_by = {};
      }
  }
}

}  // namespace

void move_to_contact(std::span<const std::span<JointMover>> sets, WorkerThread* worker) {
  std::vector<std::vector<Progress>> progress(sets.size());
  std::vector<std::pair<std::size_t, std::size_t>> all;  // set and mover
  for (std::size_t set = 0; set < sets.size(); ++set)
    for (std::size_t i = 0; i < sets[set].size(); ++i) {
      JointMover& mover = sets[set][i];
      progress[set].push_back({.T_world_start = *mover.T_world_object});
      mover.gone_s = 0.0;
      mover.has_stopped = false;
      mover.limited_by = {};
      all.emplace_back(set, i);
    }
  run_each(worker, all.size(), [&](std::size_t k) {
    const auto [set, i] = all[k];
    bound_free_time(sets[set][i], 0.0, progress[set][i]);
  });
  run_each(worker, sets.size(), [&](std::size_t set) { advance_set(sets[set], progress[set]); });
}

void move_to_contact(std::span<JointMover> movers) { move_to_contact({&movers, 1}, nullptr); }

std::vector<std::vector<std::size_t>> sets_that_meet(std::span<const PathBall> paths) {
  DisjointSets<std::size_t> meeting(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (paths[i].radius_m > 0.0 && paths[k].radius_m > 0.0 && overlap(paths[i], paths[k]))
        meeting.join(i, k);
    }
  std::vector<std::vector<std::size_t>> of_root(paths.size()), sets;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (paths[i].radius_m > 0.0) of_root[meeting.find(i)].push_back(i);
  for (std::vector<std::size_t>& set : of_root)
    if (!set.empty()) sets.push_back(std::move(set));
  return sets;
}

}  // namespace roomradar
