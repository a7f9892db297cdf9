// unknown_surface.cpp: selects the unknown cells that count and are reachable, and meshes their faces.
//
// The file: all numbers are little-endian. The body is one column of 32-bit words (see
// compressed_columns.hpp); in version 1, it is the words themselves. They are: edge of a cell (f64, m),
// lowest cell and size of the grid (3 i32 each), number of runs (u32), runs of unknown cells: clear cells
// before the run, then its length (2 u32 each), with x fastest and z slowest; origin of the mesh (3 f64, m),
// number of vertices (u32), vertices (3 f32 each, m, relative to the origin), number of triangles (u32),
// triangles (3 u32 each).
#include "mapping/surface/unknown/unknown_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/surface/unknown/bit_grid.hpp"
#include "mapping/surface/unknown/blocked_neighbours.hpp"
#include "mapping/surface/unknown/voxel_face_mesh.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3i;

constexpr int kGridsAtOnce = 3;  // bit grids alive at the same time

// State of the map in cells of one voxel, or of several if the map is very large.
struct Known {
  CellGrid grid;
  BitGrid free;     // any voxel of the cell is free
  BitGrid unknown;  // all voxels of the cell are unknown
};

// Bounds of the known space plus a margin, aligned to multiples of `lattice` cells.
CellGrid grid_round(const StaticMap& map, const Eigen::AlignedBox3d& known_world, int margin, int lattice,
                    double max_cells, int& cell_voxels) {
  const auto voxel = [&](const Eigen::Vector3d& p) -> Vector3i {
    return (p / map.resolution_m()).array().round().cast<int>();
  };
  const Vector3i low = voxel(known_world.min()), high = voxel(known_world.max());
  CellGrid grid;
  for (cell_voxels = 1;; ++cell_voxels) {
    grid.cell_m = cell_voxels * map.resolution_m();
    const auto block_of = [&](int v, int away) {
      return floor_div(floor_div(v, cell_voxels) + away, lattice);
    };
    grid.first_cell = low.unaryExpr([&](int v) { return lattice * block_of(v, -margin); });
    grid.size =
        high.unaryExpr([&](int v) { return lattice * (block_of(v - 1, margin) + 1); }) - grid.first_cell;
    if (grid.size.cast<double>().prod() <= max_cells) return grid;
  }
}

/// @param edge  of a cell, voxels
Known known_cells(const StaticMap& map, const CellGrid& grid, int edge) {
  Known known{grid, BitGrid(grid.size, false), BitGrid(grid.size, true)};
  map.visit_leaves([&](const MapLeaf& leaf) {
    const Vector3i from = leaf.lowest_voxel.unaryExpr([&](int v) { return floor_div(v, edge); });
    const Vector3i to =
        leaf.lowest_voxel.unaryExpr([&](int v) { return floor_div(v + leaf.edge_voxels - 1, edge) + 1; });
    known.unknown.set_box(from - known.grid.first_cell, to - known.grid.first_cell, false);
    if (leaf.log_odds < 0.0F)
      known.free.set_box(from - known.grid.first_cell, to - known.grid.first_cell, true);
  });
  return known;
}

// Removes from `unknown` the components of less than pocket_voxels that are surrounded by free space. Uses up
// `known.unknown`.
void leave_out_pockets(Known& known, const std::array<SparseBitGrid, 3>& blocked,
                       const UnknownSurfaceConfig& config, BitGrid& unknown) {
  BitGrid held = std::move(known.unknown);
  (held |= known.free).flip();
  for (int step = 0; step < config.cube_voxels; ++step) held.spread(blocked);
  held.set_box(Vector3i::Zero(), Vector3i::Ones(), true);
  held &= unknown;
  held.flood(unknown, blocked);
  BitGrid unseen = std::move(held.flip());  // not connected to anything occupied or to the margin
  unseen &= unknown;

  std::vector<Vector3i> piece;
  unseen.for_each_set([&](const Vector3i& first) {
    if (!unseen.at(first)) return;
    piece.assign(1, first);
    unseen.set(first, false);
    for (std::size_t done = 0; done < piece.size(); ++done)
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          const Vector3i next = piece[done] + step * Vector3i::Unit(axis);
          if (!unseen.at(next)) continue;
          unseen.set(next, false);
          piece.push_back(next);
        }
    if (piece.size() >= static_cast<std::size_t>(config.pocket_voxels)) return;
    for (const Vector3i& cell : piece) unknown.set(cell, false);
  });
}

// Cells that an object coming from free space can reach: any distance through free voxels, then rim_voxels
// further through anything that does not count as unknown.
BitGrid reachable(BitGrid free, const BitGrid& unknown, const std::array<SparseBitGrid, 3>& blocked,
                  const UnknownSurfaceConfig& config) {
  BitGrid reached = opened(free, config.least_voxels);
  reached.flood(free, blocked);
  free = unknown;
  const BitGrid& passable = free.flip();
  for (int step = 0; step < config.rim_voxels; ++step) reached.spread(passable, blocked);
  return reached;
}

// Meshes the faces of unknown cells towards reached ones, unless a surface separates the two.
Mesh mesh_between(const BitGrid& unknown, const BitGrid& reached, const std::array<SparseBitGrid, 3>& blocked,
                  const CellGrid& grid) {
  VoxelFaceMesher mesher(grid);
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {1, -1}) {
      VoxelFaces faces(axis, step);
      unknown.for_each_set_beside(reached, axis, step, blocked[static_cast<std::size_t>(axis)],
                                  [&](const Vector3i& cell) { faces.add(cell); });
      mesher.add(std::move(faces));
    }
  return mesher.take();
}

constexpr std::string_view kMagic = "RRUNKNWN";
constexpr std::uint32_t kUncompressed = 1, kCompressed = 2;  // versions of the file
constexpr std::size_t kWord_bytes = sizeof(std::uint32_t);
constexpr double kMaxReach_m = 2e5;  // a map reaches at most 32,768 voxels of 1 m, and the grid a margin more

void put_cells(ByteWriter& out, const RunGrid& cells) {
  const std::span<const std::uint32_t> ends = cells.ends();
  out(static_cast<std::uint32_t>(ends.size() / 2));
  std::uint32_t before = 0;
  for (const std::uint32_t end : ends) out(end - std::exchange(before, end));
}

CellGrid take_grid(ByteReader& in) {
  CellGrid grid;
  serialize_finite(in, "edge of a cell", grid.cell_m);
  in(grid.first_cell, grid.size);
  if ((grid.size.array() < 0).any() || grid.size.cast<double>().prod() > kMaxUnknownCells)
    in.fail("a grid of " + std::to_string(grid.size.x()) + " x " + std::to_string(grid.size.y()) + " x " +
            std::to_string(grid.size.z()) + " cells");
  const bool is_empty = grid.size.isZero() && grid.cell_m == 0.0;
  if (!is_empty && (!(grid.cell_m > 0.0) || (grid.size.array() == 0).any()))
    in.fail("a grid with cells of " + format_fixed(grid.cell_m, 6) + " m");
  const Eigen::Array3d low_m = grid.first_cell.cast<double>().array() * grid.cell_m;
  const Eigen::Array3d high_m = low_m + grid.size.cast<double>().array() * grid.cell_m;
  if (!(low_m.abs() <= kMaxReach_m).all() || !(high_m.abs() <= kMaxReach_m).all())
    in.fail("a grid that begins or ends where no map reaches");
  return grid;
}

RunGrid take_cells(ByteReader& in, const Eigen::Vector3i& size) {
  const auto total = static_cast<std::uint64_t>(size.cast<double>().prod());
  const auto count = in.number<std::uint32_t>();
  in.require(count, 2 * sizeof(std::uint32_t));
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * std::size_t{count});
  std::uint64_t next = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto clear = in.number<std::uint32_t>(), length = in.number<std::uint32_t>();
    const std::uint64_t from = next + clear;
    next = from + length;
    if (next > total) in.fail("a run of unknown cells that leaves the grid");
    if (length == 0) continue;
    if (!ends.empty() && ends.back() == from)
      ends.back() = static_cast<std::uint32_t>(next);
    else
      ends.insert(ends.end(), {static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(next)});
  }
  return {size, std::move(ends)};
}

Mesh take_mesh(ByteReader& in) {
  Mesh mesh;
  serialize_finite(in, "origin of the mesh", mesh.origin);
  if ((mesh.origin.array().abs() > kMaxReach_m).any()) in.fail("a mesh where no map reaches");
  const auto vertices = in.number<std::uint32_t>();
  in.require(vertices, 3 * sizeof(float));
  mesh.vertices.resize(vertices);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    in(vertex);
    if (!(vertex.array().abs() <= static_cast<float>(2.0 * kMaxReach_m)).all())
      in.fail("a vertex that is not a number, or where no map reaches");
  }
  const auto triangles = in.number<std::uint32_t>();
  in.require(triangles, sizeof(Triangle));
  mesh.triangles.resize(triangles);
  for (Triangle& triangle : mesh.triangles) {
    triangle = in.number<Triangle>();
    for (const std::uint32_t corner : triangle)
      if (corner >= vertices) in.fail("a triangle without one of its vertices");
  }
  return mesh;
}

std::vector<std::uint32_t> take_words(const BinaryBody& body, const std::filesystem::path& path) {
  ColumnReader in(body.bytes, path.string());
  std::vector<std::uint32_t> words = in.take<std::uint32_t>("words");
  if (in.numbers().left() != 0) in.numbers().fail("bytes after its end");
  return words;
}

}  // namespace

void require_valid(const UnknownSurfaceConfig& config) {
  const ConfigCheck require{"unknown_surface"};
  const auto is_in_1_to_16 = [](int value) { return value >= 1 && value <= 16; };
  require(is_in_1_to_16(config.least_voxels), "least_voxels", config.least_voxels, "in 1..16");
  require(is_in_1_to_16(config.cube_voxels), "cube_voxels", config.cube_voxels, "in 1..16");
  require(is_in_1_to_16(config.rim_voxels), "rim_voxels", config.rim_voxels, "in 1..16");
  require(config.pocket_voxels >= 0 && config.pocket_voxels <= 1'000'000'000, "pocket_voxels",
          config.pocket_voxels, "in 0..10^9");
  require(config.max_cells >= 1e5 && config.max_cells <= kMaxUnknownCells, "max_cells", config.max_cells,
          "in 10^5..2*10^8");
  require(config.rim_voxels >= 3 * (config.cube_voxels - 1), "rim_voxels", config.rim_voxels,
          "at least 3 * (cube_voxels - 1), or some cubes of unknown voxels are out of reach");
}

UnknownSurface unknown_surface(const StaticMap& map, const Mesh& surface_world,
                               const UnknownSurfaceConfig& config) {
  require_valid(config);
  UnknownSurface result;
  const MapCounts counts = map.counts();
  if (counts.free_leaves == 0) return result;
  // Wide enough that all unknown cells of the margin count, independent of the cells in the box.
  const int margin = std::max(config.least_voxels, config.cube_voxels);
  int edge = 1;
  result.grid = grid_round(map, counts.known_world, margin, config.cube_voxels, config.max_cells, edge);
  auto blocking =
      std::async(std::launch::async, [&] { return blocked_neighbours(surface_world, result.grid); });
  Known known = known_cells(map, result.grid, edge);
  BitGrid unknown =
      opened(opened(known.unknown, config.least_voxels), config.cube_voxels, config.cube_voxels);
  const std::array<SparseBitGrid, 3> blocked = blocking.get();
  leave_out_pockets(known, blocked, config, unknown);
  const BitGrid reached = reachable(std::move(known.free), unknown, blocked, config);
  result.mesh_world = mesh_between(unknown, reached, blocked, known.grid);
  result.unknown = RunGrid(unknown);
  result.memory_bytes = kGridsAtOnce * reached.memory_bytes();
  for (const SparseBitGrid& bars : blocked) result.memory_bytes += bars.memory_bytes();
  return result;
}

bool is_unknown(const UnknownSurface& surface, const Eigen::Vector3d& p_world) {
  if (!(surface.grid.cell_m > 0.0)) return false;
  const Eigen::Array3d cell =
      (p_world / surface.grid.cell_m).array().floor() - surface.grid.first_cell.cast<double>().array();
  if (!(cell >= 0.0).all() || !(cell < surface.grid.size.cast<double>().array()).all()) return true;
  return surface.unknown.at(cell.cast<int>());
}

void write_unknown_surface(const UnknownSurface& surface, const std::filesystem::path& path) {
  ByteWriter out;
  out(surface.grid.cell_m, surface.grid.first_cell, surface.grid.size);
  put_cells(out, surface.unknown);
  const Mesh& mesh = surface.mesh_world;
  out(mesh.origin, static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Eigen::Vector3f& vertex : mesh.vertices) out(vertex);
  out(static_cast<std::uint32_t>(mesh.triangles.size()));
  out.raw(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
  std::string body;
  put_column(body, out.bytes.data(), out.bytes.size() / kWord_bytes, kWord_bytes);
  write_binary(path, kMagic, kCompressed, body);
}

UnknownSurface read_unknown_surface(const std::filesystem::path& path) {
  const BinaryBody body = read_binary(path, kMagic, kUncompressed, kCompressed);
  std::vector<std::uint32_t> words;
  if (body.version == kCompressed) words = take_words(body, path);
  ByteReader in(body.version == kCompressed ? std::string_view(reinterpret_cast<const char*>(words.data()),
                                                               words.size() * kWord_bytes)
                                            : std::string_view(body.bytes),
                path.string(), kFileAdvice);
  UnknownSurface surface;
  surface.grid = take_grid(in);
  surface.unknown = take_cells(in, surface.grid.size);
  surface.mesh_world = take_mesh(in);
  if (in.left() != 0) in.fail(std::to_string(in.left()) + " bytes more than the surface takes");
  return surface;
}

}  // namespace roomradar
