// holes_so_far.cpp: closes gaps between rays, and finds the frontier of the remaining unknown space.
#include "app/scan/live/holes_so_far.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "mapping/coverage/frontier.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3i;

/// Makes unknown cells between two known ones known, along any axis.
void close_gaps(OccupancyCells& grid) {
  const OccupancyCells before = grid;
  for (int z = 0; z < grid.size.z(); ++z)
    for (int y = 0; y < grid.size.y(); ++y)
      for (int x = 0; x < grid.size.x(); ++x) {
        const Vector3i cell(x, y, z);
        if (before.at(cell) != Occupancy::kUnknown) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const Occupancy below = before.at(cell - Vector3i::Unit(axis));
          const Occupancy above = before.at(cell + Vector3i::Unit(axis));
          if (below == Occupancy::kUnknown || above == Occupancy::kUnknown) continue;
          grid.cells[grid.index(cell)] = std::max(below, above);  // occupied before free
          break;
        }
      }
}

/// Returns the lowest height at which as much is occupied as a floor takes.
double floor_of(const OccupancyCells& grid) {
  constexpr double kFloor_m2 = 0.5;
  for (int z = 0; z < grid.size.z(); ++z) {
    std::size_t occupied = 0;
    for (int y = 0; y < grid.size.y(); ++y)
      for (int x = 0; x < grid.size.x(); ++x) occupied += grid.at({x, y, z}) == Occupancy::kOccupied ? 1 : 0;
    if (static_cast<double>(occupied) * grid.cell_m * grid.cell_m >= kFloor_m2)
      return grid.centre_world({0, 0, z}).z();
  }
  return grid.occupied_world.min().z();
}

}  // namespace

std::vector<Hole> holes_so_far(const ExplorationGrid& grid) {
  constexpr double kAboveFloor_m = 0.2, kLeast_m2 = 0.15;
  OccupancyCells cells = grid.occupancy();
  if (cells.occupied_world.isEmpty()) return {};
  close_gaps(cells);
  const double lowest_m = floor_of(cells) + kAboveFloor_m;
  std::vector<Hole> holes = find_frontier(cells, {.min_area_m2 = kLeast_m2}).holes;
  std::erase_if(
      holes, [&](const Hole& hole) { return !is_inside_scan(hole) || hole.position_world.z() < lowest_m; });
  if (holes.size() > kMostHolesShown) holes.resize(kMostHolesShown);
  return holes;
}

std::vector<NumberedHole> numbered(const std::vector<Hole>& holes,
                                   std::span<const NumberedHole> shown_before) {
  constexpr double kSame_m = 0.5;
  std::vector<NumberedHole> shown;
  int highest = 0;
  for (const NumberedHole& before : shown_before) highest = std::max(highest, before.number);
  std::vector<bool> taken(holes.size() + static_cast<std::size_t>(highest) + 1, false);
  for (const Hole& hole : holes) {
    int number = 0;  // of the nearest hole before
    double nearest_m = kSame_m;
    for (const NumberedHole& before : shown_before) {
      const double distance_m = (before.hole.position_world - hole.position_world).norm();
      if (distance_m >= nearest_m || taken[static_cast<std::size_t>(before.number)]) continue;
      nearest_m = distance_m;
      number = before.number;
    }
    taken[static_cast<std::size_t>(number)] = true;
    shown.push_back({number, hole});
  }
  taken[0] = true;
  for (NumberedHole& one : shown) {
    if (one.number > 0) continue;
    one.number = static_cast<int>(std::find(taken.begin(), taken.end(), false) - taken.begin());
    taken[static_cast<std::size_t>(one.number)] = true;
  }
  return shown;
}

}  // namespace roomradar
