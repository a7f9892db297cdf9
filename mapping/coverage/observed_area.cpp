// observed_area.cpp: inserts a frame's points into a set of coarse cells.
#include "mapping/coverage/observed_area.hpp"

#include <cmath>
#include <cstdio>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr double kCell_m = 0.1;
constexpr int kStep_px = 16;
constexpr float kFarthest_m = 4.0F;

std::uint64_t code_of(const Eigen::Vector3d& p_world) {
  const auto cell = [](double coordinate_m) {
    return static_cast<std::int64_t>(std::floor(coordinate_m / kCell_m));
  };
  return voxel_key(cell(p_world.x()), cell(p_world.y()), cell(p_world.z()));
}

}  // namespace

void ObservedArea::add(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  const std::size_t before = cells_.size();
  for (int y = kStep_px / 2; y < frame.depth_m.height; y += kStep_px)
    for (int x = kStep_px / 2; x < frame.depth_m.width; x += kStep_px) {
      const float depth_m = frame.depth_m.at(x, y);
      if (depth_m > 0.0F && depth_m <= kFarthest_m)
        cells_.insert(
            code_of(T_world_camera * back_project(frame.depth_camera, x, y, static_cast<double>(depth_m))));
    }
  last_second_.push_back({frame.stamp_s, cells_.size() - before});
  while (frame.stamp_s - last_second_.front().stamp_s >= 1.0) last_second_.pop_front();
}

std::string describe(const ObservedArea& seen) {
  char text[80];
  format_classic(text, sizeof(text), "%.1f m2 seen, %.2f of it in the last second", seen.total_m2(),
                 seen.last_second_m2());
  return text;
}

double ObservedArea::total_m2() const { return static_cast<double>(cells_.size()) * kCell_m * kCell_m; }

double ObservedArea::last_second_m2() const {
  std::size_t cells = 0;
  for (const Gain& gain : last_second_) cells += gain.cells;
  return static_cast<double>(cells) * kCell_m * kCell_m;
}

}  // namespace roomradar
