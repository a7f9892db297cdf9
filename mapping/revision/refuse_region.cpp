// refuse_region.cpp: masks the frames, erases the samples that they contradict, and fuses the frames.
#include "mapping/revision/refuse_region.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

// Background uncovered by a removed object is part of the change up to this distance from the region; a wall
// far behind is left to a later scan.
constexpr double kNewSurface_m = 1.0;

Eigen::Vector3i cell_of(const Eigen::Vector3d& p_world, double cell_m) {
  return (p_world / cell_m).array().floor().cast<int>();
}

// Copies of the frames with only the pixels that concern the region.
std::vector<Frame> masked(const WorldRegion& region, std::span<const RegionView> views) {
  std::vector<Frame> frames;
  for (const RegionView& view : views) {
    Frame frame = view.frame;
    const auto is_in = [&](int x, int y, float depth_m) {
      return depth_m > 0.0F &&
             region.contains(view.T_world_camera * back_project(frame.depth_camera, x, y, depth_m));
    };
    for (int y = 0; y < frame.depth_m.height; ++y)
      for (int x = 0; x < frame.depth_m.width; ++x) {
        float& depth_m = frame.depth_m.at(x, y);
        const float expected_m = view.expected_depth_m.at(x, y);
        // A measurement in front of the expected surface is another object passing by.
        const bool sees_past = depth_m > expected_m && is_in(x, y, expected_m);
        if (depth_m > 0.0F && !sees_past && !is_in(x, y, depth_m)) depth_m = 0.0F;
      }
    frames.push_back(std::move(frame));
  }
  return frames;
}

// Nearest depth at a pixel or its neighbours; 0 if none has depth.
float nearest_round(const DepthImage& depth_m, int x, int y) {
  float nearest = 0.0F;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width - 1); ++u) {
      const float depth = depth_m.at(u, v);
      if (depth > 0.0F && (nearest == 0.0F || depth < nearest)) nearest = depth;
    }
  return nearest;
}

// Votes of the masked frames on a point.
struct Votes {
  int through = 0;  // frames that clearly see past it
  int at = 0;       // frames that see surface at it or right in front of it
};

class Voters {
 public:
  Voters(const std::vector<Frame>& frames, std::span<const RegionView> views, double reach_m)
      : frames_(frames), reach_m_(reach_m) {
    for (const RegionView& view : views) T_camera_world_.push_back(view.T_world_camera.inverse());
  }

  [[nodiscard]] Votes about(const Eigen::Vector3d& p_world) const {
    Votes votes;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const Eigen::Vector3d p_camera = T_camera_world_[i] * p_world;
      if (!(p_camera.z() > 0.1)) continue;
      const Eigen::Vector2d px = project(frames_[i].depth_camera, p_camera);
      const DepthImage& depth_m = frames_[i].depth_m;
      if (!(px.x() > -0.5 && px.y() > -0.5 && px.x() < depth_m.width - 0.5 && px.y() < depth_m.height - 0.5))
        continue;
      const int x = static_cast<int>(px.x() + 0.5), y = static_cast<int>(px.y() + 0.5);
      if (depth_m.at(x, y) == 0.0F) continue;
      const double beyond_m = static_cast<double>(nearest_round(depth_m, x, y)) - p_camera.z();
      votes.through += beyond_m > reach_m_ ? 1 : 0;
      votes.at += std::abs(beyond_m) <= reach_m_ ? 1 : 0;
    }
    return votes;
  }

 private:
  const std::vector<Frame>& frames_;
  std::vector<Eigen::Isometry3d> T_camera_world_;
  double reach_m_;
};

// Bounds of the region and of all points near it that the masked pixels measure.
Eigen::AlignedBox3d seen_box(const std::vector<Frame>& frames, std::span<const RegionView> views,
                             const Eigen::AlignedBox3d& region_world) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kNewSurface_m);
  const Eigen::AlignedBox3d within(region_world.min() - reach, region_world.max() + reach);
  Eigen::AlignedBox3d box = region_world;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    for (int y = 0; y < frame.depth_m.height; ++y)
      for (int x = 0; x < frame.depth_m.width; ++x) {
        if (frame.depth_m.at(x, y) == 0.0F) continue;
        const Eigen::Vector3d p_world =
            views[i].T_world_camera * back_project(frame.depth_camera, x, y, frame.depth_m.at(x, y));
        if (within.contains(p_world)) box.extend(p_world);
      }
  }
  return box;
}

}  // namespace

WorldRegion::WorldRegion(std::span<const Eigen::Vector3d> points_world, double cell_m) : cell_m_(cell_m) {
  for (const Eigen::Vector3d& p_world : points_world)
    for (int n = 0; n < kCellsRound; ++n) {
      const Eigen::Vector3i cell = cell_of(p_world, cell_m) + neighbour_offset(n);
      if (!cells_.insert(voxel_key(cell)).second) continue;
      box_world_.extend(cell.cast<double>() * cell_m);
      box_world_.extend((cell + Eigen::Vector3i::Ones()).cast<double>() * cell_m);
    }
}

bool WorldRegion::contains(const Eigen::Vector3d& p_world) const {
  return box_world_.contains(p_world) && cells_.contains(voxel_key(cell_of(p_world, cell_m_)));
}

Eigen::AlignedBox3d refuse_region(StaticMap& map, const WorldRegion& region,
                                  std::span<const RegionView> views) {
  if (views.empty() || region.box_world().isEmpty()) return {};
  const std::vector<Frame> frames = masked(region, views);
  const double voxel_m = map.resolution_m();
  const double reach_m = map.config().truncation_voxels * voxel_m;
  const Voters voters(frames, views, reach_m);
  const Eigen::AlignedBox3d box_world = seen_box(frames, views, region.box_world());
  bool changed = false;
  map.revise_samples(box_world, [&](const SurfaceSample& sample) {
    const Eigen::Vector3d centre_world = (sample.voxel.cast<double>().array() + 0.5).matrix() * voxel_m;
    const Votes votes = voters.about(centre_world);
    SampleAction fate = SampleAction::kKeep;
    if (votes.through > votes.at)
      fate = SampleAction::kFree;
    else if (votes.at > 0 && region.contains(centre_world))
      fate = SampleAction::kEraseSample;
    changed |= fate != SampleAction::kKeep;
    return fate;
  });
  for (std::size_t i = 0; i < frames.size(); ++i)
    changed |= map.fuse(frames[i], views[i].T_world_camera) == FuseStatus::kFused;
  if (!changed) return {};
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(reach_m + 2.0 * voxel_m);
  return {box_world.min() - margin, box_world.max() + margin};
}

}  // namespace roomradar
