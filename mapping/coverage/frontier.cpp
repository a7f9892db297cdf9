// frontier.cpp: finds border cells of known space, tests whether they are enclosed, and groups them into
// holes.
#include "mapping/coverage/frontier.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "mapping/types/system/config_check.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr std::array<std::array<int, 3>, 6> kFaces = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

struct BorderCell {
  Vector3i cell;
  Vector3d normal = Vector3d::Zero();  // unit, from free space into the unknown
  double area_m2 = 0.0;
  bool enclosed = false;
  int patch = -1;
};

constexpr std::int32_t kNoBorder = -1;

struct Border {
  std::vector<BorderCell> cells;
  std::vector<std::int32_t> position;  // index in `cells` per grid cell
};

Border find_border(const OccupancyCells& grid) {
  Border border;
  const Vector3i size = grid.size;
  border.position.assign(static_cast<std::size_t>(size.cast<std::int64_t>().prod()), kNoBorder);
  std::vector<Vector3d> faces;  // per border cell: sum of the unit vectors from its free neighbours to it
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const Vector3i cell(x, y, z);
        if (grid.at(cell) != Occupancy::kUnknown) continue;
        bool is_border = false;
        Vector3d sum = Vector3d::Zero();
        for (const auto& face : kFaces) {
          const Vector3i step(face[0], face[1], face[2]);
          if (grid.at(cell + step) != Occupancy::kFree) continue;
          is_border = true;
          sum -= step.cast<double>();
        }
        if (!is_border) continue;
        border.position[grid.index(cell)] = static_cast<std::int32_t>(border.cells.size());
        border.cells.push_back({cell});
        faces.push_back(sum);
      }
  const double face_m2 = grid.cell_m * grid.cell_m;
  for (std::size_t i = 0; i < border.cells.size(); ++i) {
    BorderCell& own = border.cells[i];
    Vector3d sum = Vector3d::Zero();
    for (int n = 0; n < kCellsRound; ++n) {
      const Vector3i near = own.cell + neighbour_offset(n);
      if (!grid.contains(near)) continue;
      const std::int32_t at = border.position[grid.index(near)];
      if (at != kNoBorder) sum += faces[static_cast<std::size_t>(at)];
    }
    if (!(sum.norm() > 1e-9)) sum = faces[i];
    if (!(sum.norm() > 1e-9)) sum = Vector3d::UnitZ();  // a slit, free on opposite sides
    own.normal = sum.normalized();
    for (const auto& face : kFaces) {
      const Vector3i step(face[0], face[1], face[2]);
      if (grid.at(own.cell + step) == Occupancy::kFree)
        own.area_m2 += face_m2 * std::max(-own.normal.dot(step.cast<double>()), 0.0);
    }
  }
  return border;
}

// Returns the fraction of rays into the unknown that end at a surface.
double enclosed_part(const OccupancyCells& grid, const BorderCell& from) {
  int ways = 0, ended = 0;
  for (int n = 0; n < kCellsRound; ++n) {
    if (n == kOwnCell) continue;
    const Vector3i step = neighbour_offset(n);
    if (step.cast<double>().normalized().dot(from.normal) < 0.3) continue;
    ++ways;
    for (Vector3i cell = from.cell + step; grid.contains(cell); cell += step)
      if (grid.at(cell) == Occupancy::kOccupied) {
        ++ended;
        break;
      }
  }
  return ways > 0 ? static_cast<double>(ended) / ways : 0.0;
}

// Labels connected cells of the same kind; returns the number of labels. A patch extends at most max_size_m
// from its first cell; an infinite size gives connected components.
int number_patches(const OccupancyCells& grid, Border& border, double max_size_m) {
  for (BorderCell& cell : border.cells) cell.patch = -1;
  int patches = 0;
  std::vector<std::size_t> reached;
  for (std::size_t seed = 0; seed < border.cells.size(); ++seed) {
    if (border.cells[seed].patch >= 0) continue;
    border.cells[seed].patch = patches;
    reached.assign(1, seed);
    for (std::size_t done = 0; done < reached.size(); ++done) {
      const Vector3i cell = border.cells[reached[done]].cell;
      for (int n = 0; n < kCellsRound; ++n) {
        const Vector3i near = cell + neighbour_offset(n);
        if (!grid.contains(near)) continue;
        const std::int32_t at = border.position[grid.index(near)];
        if (at == kNoBorder) continue;
        BorderCell& next = border.cells[static_cast<std::size_t>(at)];
        if (next.patch >= 0 || next.enclosed != border.cells[seed].enclosed) continue;
        if ((next.cell - border.cells[seed].cell).cast<double>().norm() * grid.cell_m > max_size_m) continue;
        next.patch = patches;
        reached.push_back(static_cast<std::size_t>(at));
      }
    }
    ++patches;
  }
  return patches;
}

// Returns the best free place with a free line of sight to the hole: 0.5 to 1.8 m away, near the hole's axis,
// and at a height where a person can hold a camera.
std::optional<Vector3d> find_viewpoint(const OccupancyCells& grid, const Vector3d& hole_world,
                                       const Vector3d& look, double floor_m) {
  constexpr double kNearest_m = 0.5, kFarthest_m = 1.8, kStep_m = 0.2;
  std::optional<Vector3d> best_world;
  double best = -1.0;
  for (int azimuth = 0; azimuth < 16; ++azimuth)
    for (int elevation = -3; elevation <= 3; ++elevation) {
      const double a = azimuth * 0.3927, e = elevation * 0.35;
      const Vector3d way(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      const double straight = way.dot(-look);
      if (straight < 0.4) continue;
      // Stop at the first cell that is not free; the first two cells may be the hole's own edge.
      double reach_m = 0.0;
      for (double t = 0.0; t <= kFarthest_m; t += 0.5 * grid.cell_m) {
        const bool is_free = grid.at(grid.cell_of(hole_world + t * way)) == Occupancy::kFree;
        if (!is_free && t > 2.5 * grid.cell_m) break;
        reach_m = t;
      }
      for (double t = kNearest_m; t <= reach_m; t += kStep_m) {
        const Vector3d place = hole_world + t * way;
        const double height_m = place.z() - floor_m;
        const double handy = height_m > 0.9 && height_m < 1.8   ? 0.5
                             : height_m > 0.5 && height_m < 2.0 ? 0.2
                                                                : 0.0;
        const double score = straight + handy - 0.1 * std::abs(t - 1.2);
        if (score > best) {
          best = score;
          best_world = place;
        }
      }
    }
  return best_world;
}

// Marks small open components as enclosed, so that a corner that was left out counts as inside. occupied_m:
// size of the bounds of all occupied leaves.
void enclose_small_components(const OccupancyCells& grid, const Vector3d& occupied_m,
                              const FrontierConfig& config, Border& border) {
  const Vector3d extent_m = occupied_m.cwiseMax(Vector3d::Constant(grid.cell_m));
  struct Sum {
    double area_m2 = 0.0;
    Vector3d normal = Vector3d::Zero();
  };
  std::vector<Sum> sums(
      static_cast<std::size_t>(number_patches(grid, border, std::numeric_limits<double>::infinity())));
  for (const BorderCell& cell : border.cells) {
    Sum& sum = sums[static_cast<std::size_t>(cell.patch)];
    sum.area_m2 += cell.area_m2;
    sum.normal += cell.area_m2 * cell.normal.cwiseAbs();
  }
  for (BorderCell& cell : border.cells) {
    const Sum& sum = sums[static_cast<std::size_t>(cell.patch)];
    const Vector3d facing = sum.normal / std::max(sum.normal.norm(), 1e-12);
    const double section_m2 = facing.x() * extent_m.y() * extent_m.z() +
                              facing.y() * extent_m.x() * extent_m.z() +
                              facing.z() * extent_m.x() * extent_m.y();
    if (sum.area_m2 <= config.max_open_part * section_m2) cell.enclosed = true;
  }
}

// Returns the hole of one patch of the border; nullopt if its area is 0 or below min_area_m2.
std::optional<Hole> hole_at(const OccupancyCells& grid, const std::vector<const BorderCell*>& patch,
                            double min_area_m2, double floor_m) {
  Hole hole;
  hole.kind = patch.front()->enclosed ? HoleKind::kUnknownSpace : HoleKind::kOuterBorder;
  Vector3d middle = Vector3d::Zero(), look = Vector3d::Zero();
  Eigen::AlignedBox3d bounds;
  for (const BorderCell* cell : patch) {
    hole.area_m2 += cell->area_m2;
    middle += cell->area_m2 * grid.centre_world(cell->cell);
    look += cell->area_m2 * cell->normal;
    bounds.extend(grid.centre_world(cell->cell));
  }
  if (!(hole.area_m2 >= min_area_m2) || !(hole.area_m2 > 0.0)) return std::nullopt;
  middle /= hole.area_m2;
  // The border cell nearest to the centre: the centre of a bent border may lie in free space.
  const BorderCell& nearest =
      **std::min_element(patch.begin(), patch.end(), [&](const auto* a, const auto* b) {
        return (grid.centre_world(a->cell) - middle).squaredNorm() <
               (grid.centre_world(b->cell) - middle).squaredNorm();
      });
  hole.position_world = grid.centre_world(nearest.cell);
  hole.size_m = bounds.diagonal().norm() + grid.cell_m;
  hole.look_direction_world = look.norm() > 0.1 * hole.area_m2 ? Vector3d(look.normalized()) : nearest.normal;
  hole.viewpoint_world = find_viewpoint(grid, hole.position_world, hole.look_direction_world, floor_m);
  if (hole.viewpoint_world)
    hole.look_direction_world = (hole.position_world - *hole.viewpoint_world).normalized();
  return hole;
}

}  // namespace

void require_valid(const FrontierConfig& c) {
  const ConfigCheck require{"frontier"};
  require(c.cell_m > 0.0 && c.cell_m <= 1.0, "cell_m", c.cell_m, "in 0..1 m");
  require(c.min_area_m2 >= 0.0 && std::isfinite(c.min_area_m2), "min_area_m2", c.min_area_m2, ">= 0");
  require(c.max_size_m > 0.0, "max_size_m", c.max_size_m, "> 0");
  require(c.min_enclosed >= 0.0 && c.min_enclosed <= 1.0, "min_enclosed", c.min_enclosed, "in 0..1");
  require(c.max_open_part >= 0.0 && c.max_open_part <= 1.0, "max_open_part", c.max_open_part, "in 0..1");
}

Frontier find_frontier(const StaticMap& map, const FrontierConfig& config) {
  require_valid(config);
  return find_frontier(occupancy_cells(map, std::max(config.cell_m, map.resolution_m())), config);
}

Frontier find_frontier(const OccupancyCells& grid, const FrontierConfig& config) {
  require_valid(config);
  if (grid.cells.empty()) return {};
  Border border = find_border(grid);
  for (BorderCell& cell : border.cells) cell.enclosed = enclosed_part(grid, cell) >= config.min_enclosed;

  const Eigen::AlignedBox3d& occupied_world = grid.occupied_world;
  if (occupied_world.isEmpty()) return {};
  enclose_small_components(grid, occupied_world.sizes(), config, border);

  const int patches = number_patches(grid, border, config.max_size_m);
  std::vector<std::vector<const BorderCell*>> members(static_cast<std::size_t>(patches));
  for (const BorderCell& cell : border.cells) members[static_cast<std::size_t>(cell.patch)].push_back(&cell);
  const double floor_m = occupied_world.min().z();
  struct Found {
    Hole hole;
    const std::vector<const BorderCell*>* patch = nullptr;
  };
  std::vector<Found> found;
  for (const std::vector<const BorderCell*>& patch : members) {
    std::optional<Hole> hole = hole_at(grid, patch, config.min_area_m2, floor_m);
    if (hole) found.push_back({std::move(*hole), &patch});
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.hole.kind != b.hole.kind ? a.hole.kind < b.hole.kind : a.hole.area_m2 > b.hole.area_m2;
  });
  std::vector<int> hole_of(members.size(), -1);
  Frontier frontier{.cell_m = grid.cell_m, .holes = {}, .cells = {}};
  for (Found& one : found) {
    hole_of[static_cast<std::size_t>(one.patch->front()->patch)] = static_cast<int>(frontier.holes.size());
    frontier.holes.push_back(std::move(one.hole));
  }
  for (const BorderCell& cell : border.cells)
    frontier.cells.push_back({grid.centre_world(cell.cell), hole_of[static_cast<std::size_t>(cell.patch)]});
  return frontier;
}

}  // namespace roomradar
