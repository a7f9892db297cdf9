// fusion_selection.cpp: leaves out frames whose view hardly differs from the last chosen one's.
#include "mapping/fusion_selection.hpp"

#include <Eigen/Geometry>
#include <numeric>

namespace roomradar {
namespace {

constexpr double kStep_m = 0.005, kStep_rad = 0.005;
constexpr double kFewer = 1.25;  // factor on n if too many frames are left

std::vector<std::size_t> chosen_with(std::span<const TimedPose> poses, double n) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!chosen.empty() && static_cast<double>(i - chosen.back()) < n) {
      const Eigen::Isometry3d moved = poses[chosen.back()].T_world_camera.inverse() * poses[i].T_world_camera;
      if (moved.translation().norm() < n * kStep_m &&
          Eigen::AngleAxisd(moved.linear()).angle() < n * kStep_rad)
        continue;
    }
    chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

std::vector<std::size_t> choose_frames_to_fuse(std::span<const TimedPose> poses, std::size_t max_frames) {
  std::vector<std::size_t> chosen(poses.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (max_frames == 0) return chosen;
  // Ends at the latest when n reaches the number of frames and spans the octree.
  for (double n = kFewer; chosen.size() > max_frames; n *= kFewer) chosen = chosen_with(poses, n);
  return chosen;
}

}  // namespace roomradar
