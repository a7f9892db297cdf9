// exploration_grid.cpp: samples the rays of keyframes in steps of half a cell.
#include "app/scan/live/exploration_grid.hpp"

#include <algorithm>

namespace roomradar {
namespace {

constexpr int kWidth = 256, kHeight = 96;  // cells
constexpr double kFarthestCell_m = 5.0;
// A Kinect measures between these depths. A ray without depth that crosses a cell between them means that the
// cell cannot be measured from there.
constexpr double kSurelyFrom_m = 0.7, kSurelyTo_m = 2.5;
constexpr std::uint8_t kFreeBit = 1, kOccupiedBit = 2, kOneTry = 4;
constexpr std::uint8_t kManyTries = 24;

}  // namespace

ExplorationGrid::ExplorationGrid(const Eigen::Vector3d& centre_world)
    : first_((centre_world / kCell_m).array().floor().cast<int>().matrix() -
             Eigen::Vector3i(kWidth, kWidth, kHeight) / 2),
      cells_(static_cast<std::size_t>(kWidth * kWidth * kHeight), 0) {}

Eigen::Vector3i ExplorationGrid::cell_of(const Eigen::Vector3d& p_world) const {
  return (p_world / kCell_m).array().floor().cast<int>().matrix() - first_;
}

std::int64_t ExplorationGrid::index_of(const Eigen::Vector3i& cell) {
  if (!(cell.array() >= 0).all() || !(cell.array() < Eigen::Array3i(kWidth, kWidth, kHeight)).all())
    return -1;
  return (static_cast<std::int64_t>(cell.z()) * kWidth + cell.y()) * kWidth + cell.x();
}

void ExplorationGrid::add(const StoredView& view, const Eigen::Isometry3d& T_world_camera) {
  const int step_px = std::max(1, view.camera.width_px / 40);
  const auto mark = [&](const Eigen::Vector3d& ray_world, double from_m, double to_m, const auto& change) {
    for (double depth_m = from_m; depth_m < to_m; depth_m += 0.5 * kCell_m) {
      const Eigen::Vector3i cell = cell_of(T_world_camera.translation() + depth_m * ray_world);
      const std::int64_t index = index_of(cell);
      if (index < 0) continue;
      change(cells_[static_cast<std::size_t>(index)]);
      marked_.extend(cell);
    }
  };
  for (int y = step_px / 2; y < view.camera.height_px; y += step_px)
    for (int x = step_px / 2; x < view.camera.width_px; x += step_px) {
      const Eigen::Vector3d ray_world = T_world_camera.linear() * back_project(view.camera, x, y, 1.0);
      const std::uint16_t inverse = view.inverse_depth.at(x, y);
      if (inverse == 0) {
        mark(ray_world, kSurelyFrom_m, kSurelyTo_m, [](std::uint8_t& cell) {
          if (cell < 256 - kOneTry) cell = static_cast<std::uint8_t>(cell + kOneTry);
        });
        continue;
      }
      const double depth_m = 1.0 / static_cast<double>(static_cast<float>(inverse) * kInverseDepthStep_per_m);
      mark(ray_world, 0.0, std::min(depth_m - kCell_m, kFarthestCell_m),
           [](std::uint8_t& cell) { cell |= kFreeBit; });
      if (depth_m <= kFarthestCell_m)
        mark(ray_world, depth_m, depth_m + 0.25 * kCell_m, [](std::uint8_t& cell) { cell |= kOccupiedBit; });
    }
}

CellState ExplorationGrid::at(const Eigen::Vector3d& p_world) const {
  return state_of(index_of(cell_of(p_world)));
}

CellState ExplorationGrid::state_of(std::int64_t index) const {
  if (index < 0) return CellState::kUnmeasurable;
  const std::uint8_t cell = cells_[static_cast<std::size_t>(index)];
  if ((cell & kOccupiedBit) != 0) return CellState::kOccupied;
  if ((cell & kFreeBit) != 0) return CellState::kFree;
  return cell / kOneTry >= kManyTries ? CellState::kUnmeasurable : CellState::kUnknown;
}

OccupancyCells ExplorationGrid::occupancy() const {
  OccupancyCells grid;
  if (marked_.isEmpty()) return grid;
  grid.cell_m = kCell_m;
  grid.first = first_ + marked_.min();
  grid.size = marked_.sizes() + Eigen::Vector3i::Ones();
  grid.cells.reserve(static_cast<std::size_t>(grid.size.cast<std::int64_t>().prod()));
  for (int z = marked_.min().z(); z <= marked_.max().z(); ++z)
    for (int y = marked_.min().y(); y <= marked_.max().y(); ++y)
      for (int x = marked_.min().x(); x <= marked_.max().x(); ++x) {
        const Eigen::Vector3i cell(x, y, z);
        const CellState state = state_of(index_of(cell));
        grid.cells.push_back(state == CellState::kFree      ? Occupancy::kFree
                             : state == CellState::kUnknown ? Occupancy::kUnknown
                                                            : Occupancy::kOccupied);
        if (state != CellState::kOccupied) continue;
        const Eigen::Vector3d lowest_world = kCell_m * (first_ + cell).cast<double>();
        grid.occupied_world.extend(lowest_world).extend(lowest_world + Eigen::Vector3d::Constant(kCell_m));
      }
  return grid;
}

double moved_fraction(const ExplorationGrid& grid, const Frame& frame,
                      const Eigen::Isometry3d& T_world_camera) {
  constexpr int kStep_px = 8;
  constexpr float kMost_m = 4.0F;
  const auto is_amid_free = [&](const Eigen::Vector3d& p_world) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-ExplorationGrid::kCell_m, 0.0, ExplorationGrid::kCell_m})
        if (grid.at(p_world + side * Eigen::Vector3d::Unit(axis)) != CellState::kFree) return false;
    return true;
  };
  std::size_t pixels = 0, moved = 0;
  for (int y = kStep_px / 2; y < frame.depth_m.height; y += kStep_px)
    for (int x = kStep_px / 2; x < frame.depth_m.width; x += kStep_px) {
      ++pixels;
      const float depth_m = frame.depth_m.at(x, y);
      if (depth_m > 0.0F && depth_m < kMost_m &&
          is_amid_free(T_world_camera * back_project(frame.depth_camera, x, y, static_cast<double>(depth_m))))
        ++moved;
    }
  return pixels > 0 ? static_cast<double>(moved) / static_cast<double>(pixels) : 0.0;
}

ExplorationGrid explored_around(const Eigen::Vector3d& camera_world, const std::vector<Keyframe>& keyframes,
                                const Eigen::Isometry3d& T_grid_world) {
  constexpr std::size_t kMost = 200;
  std::vector<const Keyframe*> nearest;
  for (const Keyframe& keyframe : keyframes) nearest.push_back(&keyframe);
  const auto distance = [&](const Keyframe* keyframe) {
    return (keyframe->T_world_camera.translation() - camera_world).squaredNorm();
  };
  const std::size_t count = std::min(kMost, nearest.size());
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end(),
                    [&](const Keyframe* a, const Keyframe* b) { return distance(a) < distance(b); });
  ExplorationGrid grid(T_grid_world * camera_world);
  for (std::size_t i = 0; i < count; ++i)
    grid.add(unpacked(*nearest[i]->view), T_grid_world * nearest[i]->T_world_camera);
  return grid;
}

}  // namespace roomradar
