// change_clusters.cpp: connected components of cells by hash table and union-find.
#include "dynamic/foreground/change_clusters.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr int kAllRound = 7;  // neighbours of an interior cell, of eight in a flat surface

/// Returns the slot of a cell in the hash table, or the empty slot where it belongs.
std::uint32_t find_cell(const ChangeClusters& clusters, std::uint64_t code) {
  const std::size_t mask = clusters.table.size() - 1;
  for (std::size_t at = (code * 0x9E37'79B9'7F4A'7C15U) >> 32U & mask;; at = (at + 1) & mask)
    if (clusters.table[at] == kNone || clusters.cells[clusters.table[at]].code == code)
      return static_cast<std::uint32_t>(at);
}

/// Returns the root cell of a cell's object.
std::uint32_t object_of(std::vector<ChangeCell>& cells, std::uint32_t cell) {
  while (cells[cell].joined_to != cell) {
    cells[cell].joined_to = cells[cells[cell].joined_to].joined_to;
    cell = cells[cell].joined_to;
  }
  return cell;
}

}  // namespace

std::string_view to_string(LastingKind kind) { return kind == LastingKind::kCame ? "came" : "went"; }

Eigen::AlignedBox3d LastingChange::box_world() const {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points_world) box.extend(p);
  return box;
}

void reserve(std::size_t max_points, ChangeClusters& clusters) {
  clusters.cell_of.reserve(max_points);
  clusters.cells.reserve(max_points);
  clusters.objects.reserve(max_points);
  clusters.table.reserve(4 * max_points);
}

void sort_into_cells(std::span<const ChangePoint> points, LastingKind kind, float seconds, float link_m,
                     ChangeClusters& clusters) {
  std::size_t places = 64;
  while (places < 2 * points.size()) places *= 2;
  clusters.table.assign(places, kNone);
  clusters.cells.clear();
  clusters.cell_of.assign(points.size(), kNone);
  const auto index_of = [&](float x) { return static_cast<std::int64_t>(std::floor(x / link_m)); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ChangePoint& point = points[i];
    if (point.kind != kind) continue;
    const std::uint64_t code =
        voxel_key(index_of(point.position.x()), index_of(point.position.y()), index_of(point.position.z()));
    const std::uint32_t at = find_cell(clusters, code);
    if (clusters.table[at] == kNone) {
      clusters.table[at] = static_cast<std::uint32_t>(clusters.cells.size());
      clusters.cells.push_back({.code = code, .joined_to = clusters.table[at], .steady = false});
    }
    clusters.cell_of[i] = clusters.table[at];
    clusters.cells[clusters.table[at]].steady |= point.steady_s >= seconds;
  }
  const std::uint64_t zero = voxel_key(0, 0, 0);
  for (std::uint32_t cell = 0; cell < clusters.cells.size(); ++cell) {
    for (int n = 0; n < kCellsRound / 2; ++n) {  // the neighbour's own loop covers the other half
      const std::uint32_t beside =
          clusters
              .table[find_cell(clusters, clusters.cells[cell].code + voxel_key(neighbour_offset(n)) - zero)];
      if (beside == kNone) continue;
      ++clusters.cells[cell].neighbours;
      ++clusters.cells[beside].neighbours;
      const std::uint32_t a = object_of(clusters.cells, cell), b = object_of(clusters.cells, beside);
      clusters.cells[std::max(a, b)].joined_to = std::min(a, b);
    }
  }
}

void add_objects(std::span<const ChangePoint> points, LastingKind kind, const Eigen::Vector3d& origin_world,
                 const ChangeTrackerConfig& config, ChangeClusters& clusters,
                 std::vector<LastingChange>& changes) {
  clusters.objects.assign(clusters.cells.size(), {});
  for (std::uint32_t cell = 0; cell < clusters.cells.size(); ++cell) {
    ChangeObject& object = clusters.objects[object_of(clusters.cells, cell)];
    ++object.cells;
    object.steady_cells += clusters.cells[cell].steady ? 1 : 0;
    object.core_cells += clusters.cells[cell].neighbours >= kAllRound ? 1 : 0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clusters.cell_of[i] == kNone) continue;
    ChangeObject& object = clusters.objects[object_of(clusters.cells, clusters.cell_of[i])];
    ++object.points;
    object.seen_points += points[i].as_it_was ? 1 : 0;
    object.known_points += points[i].before_map ? 1 : 0;
  }
  const float min_core = kind == LastingKind::kWent ? config.min_core_fraction : 0.0F;
  const float min_known = kind == LastingKind::kCame ? config.min_known_fraction : 0.0F;
  for (ChangeObject& object : clusters.objects) {
    if (object.cells < config.min_cells ||
        static_cast<float>(object.core_cells) < min_core * static_cast<float>(object.cells) ||
        static_cast<float>(object.steady_cells) <
            config.min_steady_fraction * static_cast<float>(object.cells) ||
        static_cast<float>(object.seen_points) <
            config.min_seen_fraction * static_cast<float>(object.points) ||
        static_cast<float>(object.known_points) < min_known * static_cast<float>(object.points))
      continue;
    changes.push_back({.kind = kind, .points_world = {}, .ids = {}});
    object.change = changes.size();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (clusters.cell_of[i] == kNone) continue;
    const std::size_t change = clusters.objects[object_of(clusters.cells, clusters.cell_of[i])].change;
    if (change == 0) continue;
    changes[change - 1].points_world.emplace_back(origin_world + points[i].position.cast<double>());
    changes[change - 1].ids.push_back(points[i].id);
  }
}

}  // namespace roomradar
