// frontier.cpp: coarse occupancy grid, and the patches of its border with unknown space.
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

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

constexpr std::array<std::array<int, 3>, 6> kFaces = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

// Occupancy in cells of a whole number of voxels. Everything outside the grid is unknown.
class Grid {
 public:
  Grid(const StaticMap& map, double cell_m) {
    Vector3i low = Vector3i::Constant(std::numeric_limits<int>::max());
    Vector3i high = Vector3i::Constant(std::numeric_limits<int>::min());
    map.visit_leaves([&](const MapLeaf& leaf) {
      if (leaf.log_odds == 0.0F) return;
      low = low.cwiseMin(leaf.lowest_voxel);
      high = high.cwiseMax(leaf.lowest_voxel + Vector3i::Constant(leaf.edge_voxels));
    });
    if ((low.array() >= high.array()).any()) return;
    constexpr double kMostCells = 16e6;
    edge_voxels_ = std::max(1, static_cast<int>(std::lround(cell_m / map.resolution_m())));
    while (((high - low).cast<double>() / edge_voxels_).prod() > kMostCells) ++edge_voxels_;
    cell_m_ = edge_voxels_ * map.resolution_m();
    first_ = low.unaryExpr([&](int v) { return floor_div(v, edge_voxels_); });
    size_ = high.unaryExpr([&](int v) { return floor_div(v - 1, edge_voxels_); }) - first_ + Vector3i::Ones();
    cells_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()), CellState::kUnknown);
    std::vector<std::int64_t> free_voxels(cells_.size(), 0);
    map.visit_leaves([&](const MapLeaf& leaf) {
      if (leaf.log_odds == 0.0F) return;
      const Vector3i end = leaf.lowest_voxel + Vector3i::Constant(leaf.edge_voxels);
      const Vector3i from = leaf.lowest_voxel.unaryExpr([&](int v) { return floor_div(v, edge_voxels_); });
      const Vector3i to = end.unaryExpr([&](int v) { return floor_div(v - 1, edge_voxels_); });
      for (int z = from.z(); z <= to.z(); ++z)
        for (int y = from.y(); y <= to.y(); ++y)
          for (int x = from.x(); x <= to.x(); ++x) {
            const Vector3i cell(x, y, z);
            const std::size_t i = index(cell - first_);
            if (leaf.log_odds > 0.0F) {
              cells_[i] = CellState::kOccupied;
              continue;
            }
            const Vector3i shared = end.cwiseMin((cell + Vector3i::Ones()) * edge_voxels_) -
                                    leaf.lowest_voxel.cwiseMax(cell * edge_voxels_);
            free_voxels[i] += shared.cast<std::int64_t>().prod();
          }
    });
    const std::int64_t half = static_cast<std::int64_t>(edge_voxels_) * edge_voxels_ * edge_voxels_;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (cells_[i] == CellState::kUnknown && 2 * free_voxels[i] >= half) cells_[i] = CellState::kFree;
  }

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] double cell_m() const { return cell_m_; }
  [[nodiscard]] Vector3i size() const { return size_; }
  [[nodiscard]] bool contains(const Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
  }
  [[nodiscard]] std::size_t index(const Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(cell.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(cell.x());
  }
  [[nodiscard]] CellState at(const Vector3i& cell) const {
    return contains(cell) ? cells_[index(cell)] : CellState::kUnknown;
  }
  [[nodiscard]] Vector3d centre_world(const Vector3i& cell) const {
    return ((first_ + cell).cast<double>().array() + 0.5).matrix() * cell_m_;
  }
  [[nodiscard]] Vector3i cell_of(const Vector3d& p_world) const {
    return (p_world / cell_m_).array().floor().cast<int>().matrix() - first_;
  }

 private:
  int edge_voxels_ = 1;
  double cell_m_ = 0.0;
  Vector3i first_ = Vector3i::Zero();  // in cells
  Vector3i size_ = Vector3i::Zero();
  std::vector<CellState> cells_;
};

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

Border find_border(const Grid& grid) {
  Border border;
  const Vector3i size = grid.size();
  border.position.assign(static_cast<std::size_t>(size.cast<std::int64_t>().prod()), kNoBorder);
  std::vector<Vector3d> faces;  // per border cell: sum of the unit vectors from its free neighbours to it
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y)
      for (int x = 0; x < size.x(); ++x) {
        const Vector3i cell(x, y, z);
        if (grid.at(cell) != CellState::kUnknown) continue;
        bool is_border = false;
        Vector3d sum = Vector3d::Zero();
        for (const auto& face : kFaces) {
          const Vector3i step(face[0], face[1], face[2]);
          if (grid.at(cell + step) != CellState::kFree) continue;
          is_border = true;
          sum -= step.cast<double>();
        }
        if (!is_border) continue;
        border.position[grid.index(cell)] = static_cast<std::int32_t>(border.cells.size());
        border.cells.push_back({cell});
        faces.push_back(sum);
      }
  const double face_m2 = grid.cell_m() * grid.cell_m();
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
      if (grid.at(own.cell + step) == CellState::kFree)
        own.area_m2 += face_m2 * std::max(-own.normal.dot(step.cast<double>()), 0.0);
    }
  }
  return border;
}

// Returns the fraction of rays into the unknown that end at a surface.
double enclosed_part(const Grid& grid, const BorderCell& from) {
  int ways = 0, ended = 0;
  for (int n = 0; n < kCellsRound; ++n) {
    if (n == kOwnCell) continue;
    const Vector3i step = neighbour_offset(n);
    if (step.cast<double>().normalized().dot(from.normal) < 0.3) continue;
    ++ways;
    for (Vector3i cell = from.cell + step; grid.contains(cell); cell += step)
      if (grid.at(cell) == CellState::kOccupied) {
        ++ended;
        break;
      }
  }
  return ways > 0 ? static_cast<double>(ended) / ways : 0.0;
}

// Labels connected cells of the same kind; returns the number of labels. A patch extends at most max_size_m
// from its first cell; an infinite size gives connected components.
int number_patches(const Grid& grid, Border& border, double max_size_m) {
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
        if ((next.cell - border.cells[seed].cell).cast<double>().norm() * grid.cell_m() > max_size_m)
          continue;
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
std::optional<Vector3d> find_viewpoint(const Grid& grid, const Vector3d& hole_world, const Vector3d& look,
                                       double floor_m) {
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
      for (double t = 0.0; t <= kFarthest_m; t += 0.5 * grid.cell_m()) {
        const bool is_free = grid.at(grid.cell_of(hole_world + t * way)) == CellState::kFree;
        if (!is_free && t > 2.5 * grid.cell_m()) break;
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

// Marks small open components as enclosed: a corner that was left out counts as inside.
// occupied_m: size of the bounds of all occupied leaves.
void enclose_small_components(const Grid& grid, const Vector3d& occupied_m, const FrontierConfig& config,
                              Border& border) {
  const Vector3d extent_m = occupied_m.cwiseMax(Vector3d::Constant(grid.cell_m()));
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
std::optional<Hole> hole_at(const Grid& grid, const std::vector<const BorderCell*>& patch, double min_area_m2,
                            double floor_m) {
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
  hole.size_m = bounds.diagonal().norm() + grid.cell_m();
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
  const Grid grid(map, std::max(config.cell_m, map.resolution_m()));
  if (grid.empty()) return {};
  Border border = find_border(grid);
  for (BorderCell& cell : border.cells) cell.enclosed = enclosed_part(grid, cell) >= config.min_enclosed;

  const Eigen::AlignedBox3d occupied_world = map.counts().occupied_world;
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
  Frontier frontier{.cell_m = grid.cell_m(), .holes = {}, .cells = {}};
  for (Found& one : found) {
    hole_of[static_cast<std::size_t>(one.patch->front()->patch)] = static_cast<int>(frontier.holes.size());
    frontier.holes.push_back(std::move(one.hole));
  }
  for (const BorderCell& cell : border.cells)
    frontier.cells.push_back({grid.centre_world(cell.cell), hole_of[static_cast<std::size_t>(cell.patch)]});
  return frontier;
}

}  // namespace roomradar
