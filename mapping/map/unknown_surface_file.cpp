// unknown_surface_file.cpp: reads and writes the border of unknown space as one binary file.
//
// All numbers are little-endian. The body is one column of 32-bit words (see compressed_columns.hpp); in
// version 1, it is the words themselves. They are: edge of a cell (f64, m), lowest cell and size of the grid
// (3 i32 each), number of runs (u32), runs of unknown cells: clear cells before the run, then its length (2
// u32 each), with x fastest and z slowest; origin of the mesh (3 f64, m), number of vertices (u32), vertices
// (3 f32 each, m, relative to the origin), number of triangles (u32), triangles (3 u32 each).
#include "mapping/map/unknown_surface_file.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

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
