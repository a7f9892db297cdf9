// table_tops.cpp: finds the cells of the level surfaces above the floor, and the gaps between them.
#include "app/scan/live/table_tops.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kCell_m = KnowledgeGrid::kCell_m;
constexpr int kWidestGap = 10;  // cells

Vector3i cell_of(const Vector3d& p) { return (p / kCell_m).array().floor().cast<int>(); }

/// Calls visit(p_level) for each column of cells whose centre is on the triangle, seen from above.
template <typename Visit>
void visit_columns(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Visit& visit) {
  const Vector3i low = cell_of(a.cwiseMin(b).cwiseMin(c)), high = cell_of(a.cwiseMax(b).cwiseMax(c));
  Eigen::Matrix2d sides;
  sides << (b - a).head<2>(), (c - a).head<2>();
  const Eigen::Matrix2d inverse = sides.inverse();
  if (!inverse.allFinite()) return;
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x) {
      const Eigen::Vector2d centre(kCell_m * (x + 0.5), kCell_m * (y + 0.5));
      const Eigen::Vector2d share = inverse * (centre - a.head<2>());
      if (share.minCoeff() >= 0.0 && share.sum() <= 1.0)
        visit(Vector3d(a + share.x() * (b - a) + share.y() * (c - a)));
    }
}

/// Returns a point in each column of cells of each surface that faces up.
std::vector<Vector3d> level_points(const std::vector<LiveModelPart>& parts, const AnchorPoses& T_world_anchor,
                                   const Eigen::Isometry3d& T_level_world) {
  constexpr float kLevel = 0.94F;  // cosine of 20 degrees
  std::vector<Vector3d> points;
  for (const LiveModelPart& part : parts) {
    if (part.anchor >= T_world_anchor.size() || !T_world_anchor[part.anchor]) continue;
    const Mesh& mesh = *part.mesh_anchor;
    const Eigen::Isometry3d T_level_mesh =
        T_level_world * *T_world_anchor[part.anchor] * Eigen::Translation3d(mesh.origin);
    const Eigen::Vector3f up_mesh = T_level_mesh.linear().row(2).transpose().cast<float>();
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const Eigen::Vector3f normal = (b - a).cross(c - a);
      if (!(normal.dot(up_mesh) > kLevel * normal.norm())) continue;
      visit_columns(T_level_mesh * a.cast<double>(), T_level_mesh * b.cast<double>(),
                    T_level_mesh * c.cast<double>(), [&](const Vector3d& p) { points.push_back(p); });
    }
  }
  return points;
}

/// Returns the lowest height with a floor's area; nullopt if there is none.
std::optional<double> floor_of(const std::vector<Vector3d>& points_level) {
  constexpr double kFloor_m2 = 0.3;
  std::map<int, std::size_t> count;  // by height in cells
  for (const Vector3d& point : points_level) ++count[cell_of(point).z()];
  for (const auto& [height, columns] : count)
    if (static_cast<double>(columns) * kCell_m * kCell_m >= kFloor_m2) return kCell_m * height;
  return std::nullopt;
}

using Tops = std::unordered_map<std::uint64_t, bool>;  // by cell: whether it is known well

/// Returns true if the tops have a cell there, up to one cell higher or lower.
bool has(const Tops& tops, const Vector3i& cell) {
  for (const int higher : {0, 1, -1})
    if (tops.contains(voxel_key(cell.x(), cell.y(), cell.z() + higher))) return true;
  return false;
}

/// Adds the cells without a top between two tops in a row along an axis.
void add_gaps(int axis, const Tops& tops, const std::vector<Vector3i>& cells,
              std::unordered_set<std::uint64_t>& gaps) {
  const Vector3i step = Vector3i::Unit(axis);
  for (const Vector3i& cell : cells) {
    int wide = 0;  // cells of the gap that begins behind the cell
    while (wide <= kWidestGap && !has(tops, cell + (wide + 1) * step)) ++wide;
    if (wide > kWidestGap) continue;
    for (int i = 1; i <= wide; ++i) gaps.insert(voxel_key((cell + i * step).eval()));
  }
}

/// Returns true if no ray met or crossed a cell, and no object stands on it. An object is recognised by its
/// upper side; its inside is not seen.
bool is_missing(const Vector3i& cell, const ExplorationGrid& grid_level) {
  constexpr double kHighest_m = 0.6;
  const Vector3d p_level = kCell_m * (cell.cast<double>().array() + 0.5).matrix();
  if (grid_level.at(p_level) != CellState::kUnknown) return false;
  for (double above_m = ExplorationGrid::kCell_m; above_m <= kHighest_m; above_m += ExplorationGrid::kCell_m)
    if (grid_level.at(p_level + above_m * Vector3d::UnitZ()) == CellState::kOccupied) return false;
  return true;
}

}  // namespace

std::optional<double> table_tops_known(const std::vector<LiveModelPart>& parts,
                                       const AnchorPoses& T_world_anchor,
                                       const Eigen::Isometry3d& T_level_world, const KnowledgeGrid& knowledge,
                                       const ExplorationGrid& grid_level) {
  constexpr double kLowest_m = 0.25, kHighest_m = 1.4, kLeast_m2 = 0.1;
  const Eigen::Isometry3d T_world_level = T_level_world.inverse();
  const std::vector<Vector3d> points = level_points(parts, T_world_anchor, T_level_world);
  const std::optional<double> floor_m = floor_of(points);
  if (!floor_m) return std::nullopt;
  Tops tops;
  std::vector<Vector3i> cells;
  for (const Vector3d& p_level : points) {
    const double height_m = p_level.z() - *floor_m;
    if (height_m < kLowest_m || height_m > kHighest_m) continue;
    const Vector3i cell = cell_of(p_level);
    const auto [top, is_new] = tops.try_emplace(voxel_key(cell), false);
    if (is_new) cells.push_back(cell);
    top->second = top->second || knowledge.at(T_world_level * p_level) == Knowledge::kWell;
  }
  if (static_cast<double>(tops.size()) * kCell_m * kCell_m < kLeast_m2) return std::nullopt;
  std::size_t well = 0, all = tops.size();
  for (const auto& [cell, is_well] : tops) well += is_well ? 1 : 0;
  std::unordered_set<std::uint64_t> gaps;
  for (const int axis : {0, 1}) add_gaps(axis, tops, cells, gaps);
  for (const std::uint64_t gap : gaps) all += is_missing(voxel_of(gap), grid_level) ? 1 : 0;
  return static_cast<double>(well) / static_cast<double>(all);
}

}  // namespace roomradar
