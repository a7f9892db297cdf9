// joint_motion.cpp: conservative advancement of a set of bodies; queries only the body whose bound ends.
#include "radar/motion/joint_motion.hpp"

#include <algorithm>
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
  if (mover.moved != nullptr && *mover.moved) (*mover.moved)();
}

}  // namespace

double move_to_contact(std::span<JointMover> movers, double duration_s) {
  constexpr double kGained = 0.02;  // fraction of the duration
  constexpr int kMaxQueries = 12;   // per body
  std::vector<Progress> progress;
  for (JointMover& mover : movers) {
    progress.push_back({.T_world_start = *mover.T_world_object});
    mover.limited_by = {};
  }
  double now_s = 0.0;
  for (bool is_stopped = false; !is_stopped && now_s < duration_s;) {
    double next_s = duration_s;
    for (std::size_t i = 0; i < movers.size(); ++i) {
      auto& [T_world_start, free_until_s, queries] = progress[i];
      if (free_until_s <= now_s) {
        const FreeTime free = movers[i].free_time(duration_s - now_s);
        const double gained_s = std::clamp(free.free_s, 0.0, duration_s - now_s);
        free_until_s = now_s + gained_s;
        const bool gains_little = gained_s < kGained * duration_s && (now_s > 0.0 || gained_s == 0.0);
        if (free_until_s < duration_s && (gains_little || ++queries > kMaxQueries)) {
          movers[i].limited_by = free.limit;
          is_stopped = true;
        }
      }
      next_s = std::min(next_s, free_until_s);
    }
    now_s = next_s;
    if (now_s > 0.0)
      for (std::size_t i = 0; i < movers.size(); ++i) move_to(movers[i], progress[i], now_s);
  }
  return now_s;
}

std::vector<std::vector<std::size_t>> sets_that_meet(std::span<const PathBall> paths) {
  DisjointSets<std::size_t> meeting(paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      if (!(paths[i].radius_m > 0.0 && paths[k].radius_m > 0.0)) continue;
      const double apart_m = (paths[i].centre_world - paths[k].centre_world).norm();
      if (apart_m < paths[i].radius_m + paths[k].radius_m) meeting.join(i, k);
    }
  std::vector<std::vector<std::size_t>> of_root(paths.size()), sets;
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (paths[i].radius_m > 0.0) of_root[meeting.find(i)].push_back(i);
  for (std::vector<std::size_t>& set : of_root)
    if (!set.empty()) sets.push_back(std::move(set));
  return sets;
}

}  // namespace roomradar
