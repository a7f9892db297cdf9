// impossible_motion.cpp: poses between which the camera would have moved as no camera moves.
#include "mapping/odometry/impossible_motion.hpp"

#include <algorithm>
#include <cstddef>

namespace roomradar {
namespace {

/// Returns true if the camera would have been accelerated at `now` as no camera is.
bool is_impossible(const TrackedFrame& before, const TrackedFrame& now, const TrackedFrame& after) {
  constexpr double kMost_mps2 = 30.0, kNoise_m = 0.03;
  constexpr double kShortest_s = 1.0 / 60.0;  // stamps may be equal
  const double first_s = std::max(now.stamp_s - before.stamp_s, kShortest_s);
  const double second_s = std::max(after.stamp_s - now.stamp_s, kShortest_s);
  const double mean_s = 0.5 * (first_s + second_s);
  const Eigen::Vector3d p = now.T_world_camera.translation();
  const Eigen::Vector3d change_mps = (after.T_world_camera.translation() - p) / second_s -
                                     (p - before.T_world_camera.translation()) / first_s;
  return change_mps.norm() * mean_s > std::max(kNoise_m, kMost_mps2 * mean_s * mean_s);
}

}  // namespace

std::int64_t distrust_impossible_motion(std::vector<TrackedFrame>& frames) {
  constexpr double kSameEvent_s = 0.2;
  std::vector<std::size_t> trusted;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].trusted) trusted.push_back(i);
  std::vector<std::size_t> impossible;  // positions in `trusted`
  for (std::size_t k = 1; k + 1 < trusted.size(); ++k) {
    const TrackedFrame &before = frames[trusted[k - 1]], &now = frames[trusted[k]],
                       &after = frames[trusted[k + 1]];
    if (before.part == now.part && now.part == after.part && is_impossible(before, now, after))
      impossible.push_back(k);
  }
  std::int64_t count = 0;
  const auto distrust = [&](std::size_t k) {
    count += frames[trusted[k]].trusted ? 1 : 0;
    frames[trusted[k]].trusted = false;
  };
  for (std::size_t n = 0; n < impossible.size(); ++n) {
    distrust(impossible[n]);
    if (n == 0 || frames[trusted[impossible[n]]].part != frames[trusted[impossible[n - 1]]].part) continue;
    const double apart_s =
        frames[trusted[impossible[n]]].stamp_s - frames[trusted[impossible[n - 1]]].stamp_s;
    if (apart_s > kSameEvent_s) continue;
    for (std::size_t k = impossible[n - 1]; k < impossible[n]; ++k) distrust(k);
  }
  return count;
}

}  // namespace roomradar
