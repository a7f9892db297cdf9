// dual_marching_cubes.cpp: dual marching cubes over both grids of samples.
#include "mapping/surface/dual_marching_cubes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "mapping/surface/tsdf_bricks.hpp"
#include "mapping/types/disjoint_sets.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

/// Edge 4 a + k of a cell runs along axis a. Corner i is at (bit 0, bit 1, bit 2) of i.
constexpr std::array<std::array<unsigned, 2>, 12> kCellEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

// The four corners of a face, in cyclic order. Face 2 a + s is side s of axis a.
std::array<unsigned, 4> face_corners(unsigned face) {
  const unsigned axis = face / 2;
  const unsigned second = 1U << (axis + 1) % 3;
  const unsigned third = 1U << (axis + 2) % 3;
  const unsigned base = (face & 1U) << axis;
  return {base, base | second, base | second | third, base | third};
}

bool is_inside(unsigned signs, unsigned corner) { return (signs >> corner & 1U) != 0; }

/// Returns the edge between two corners; 12 if there is none.
unsigned edge_between(unsigned a, unsigned b) {
  for (unsigned e = 0; e < kCellEdges.size(); ++e)
    if (kCellEdges[e] == std::array{a, b} || kCellEdges[e] == std::array{b, a}) return e;
  return 12;
}

/// Maps each crossed edge of a cell to its surface sheet.
struct Sheets {
  std::array<std::uint8_t, 12> of_edge{};
  int count = 0;
  unsigned joined_faces = 0;  ///< bit mask: ambiguous faces whose four crossings are one sheet
};

/// Groups the zero crossings on the edges of a cell into surface sheets (connected pieces of surface). A face
/// is ambiguous if its corners have equal signs on each diagonal.
/// @param signs  bit i: corner i is inside
/// @param outsides_parted  bit mask of faces that, if ambiguous, separate their outside corners. Face 2 a + s
///                         is side s of axis a
Sheets sheets_of(unsigned signs, unsigned outsides_parted) {
  std::array<unsigned, 12> parent{};
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](unsigned e) {
    return find_root(e, [&](unsigned of) -> unsigned& { return parent[of]; });
  };
  const auto is_diagonal = [&](const std::array<unsigned, 4>& c) {
    return is_inside(signs, c[0]) != is_inside(signs, c[1]) &&
           is_inside(signs, c[0]) == is_inside(signs, c[2]) &&
           is_inside(signs, c[1]) == is_inside(signs, c[3]);
  };
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corner = face_corners(face);
    const auto edge = [&](unsigned i) { return edge_between(corner[i % 4], corner[(i + 1) % 4]); };
    if (is_diagonal(corner)) {
      const bool part_inside = (outsides_parted >> face & 1U) == 0;
      for (unsigned i = 0; i < 4; ++i)
        if (is_inside(signs, corner[i]) == part_inside) parent[root(edge(i + 3))] = root(edge(i));
    } else {
      unsigned first = 12;
      for (unsigned i = 0; i < 4; ++i) {
        if (is_inside(signs, corner[i]) == is_inside(signs, corner[(i + 1) % 4])) continue;
        if (first == 12) first = edge(i);
        parent[root(edge(i))] = root(first);
      }
    }
  }
  Sheets sheets;
  std::array<int, 12> number{};
  number.fill(-1);
  for (unsigned e = 0; e < 12; ++e) {
    if (is_inside(signs, kCellEdges[e][0]) == is_inside(signs, kCellEdges[e][1])) continue;
    int& own = number[root(e)];
    if (own < 0) own = sheets.count++;
    sheets.of_edge[e] = static_cast<std::uint8_t>(own);
  }
  for (unsigned face = 0; face < 6; ++face) {
    const std::array<unsigned, 4> corner = face_corners(face);
    if (!is_diagonal(corner)) continue;
    bool joined = true;
    for (unsigned i = 0; i < 4; ++i)
      joined &=
          root(edge_between(corner[i], corner[(i + 1) % 4])) == root(edge_between(corner[0], corner[1]));
    if (joined) sheets.joined_faces |= 1U << face;
  }
  return sheets;
}

/// Returns sheets_of(signs, 0) from a table.
const Sheets& default_sheets(unsigned signs) {
  static const std::array<Sheets, 256> table = [] {
    std::array<Sheets, 256> made;
    for (unsigned i = 0; i < 256; ++i) made[i] = sheets_of(i, 0);
    return made;
  }();
  return table[signs];
}

/// The eight samples of a dual cell. A mirrored corner of the voxels' grid has the sample of its coarse cell.
struct CellCorners {
  std::array<const TsdfSample*, 8> samples;
  /// Positions of the samples in the cell, 0..1. Coarse samples may be outside.
  std::array<Eigen::Vector3f, 8> positions;
};

struct SheetVertex {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< in the cell, 0..1
  Rgb colour{128, 128, 128};                           ///< grey if no sample has a colour
};

// Weight of an extrapolated crossing in a vertex's position. Above 0, so two cells that share their only
// measured crossing get distinct vertices along the surface.
constexpr float kOfGuess = 0.05F;

bool is_measured_crossing(const TsdfSample& from, const TsdfSample& to) {
  return !from.extrapolated && !to.extrapolated && (from.distance_m < 0.0F) != (to.distance_m < 0.0F);
}

/// Returns the position of a corner in a cell: coordinates of 0 or 1.
Eigen::Vector3f corner_position(unsigned corner) {
  return {static_cast<float>(corner & 1U), static_cast<float>(corner >> 1U & 1U),
          static_cast<float>(corner >> 2U & 1U)};
}

/// Returns the weighted mean of a sheet's zero crossings on the edges of a cell, with their mean colour. A
/// crossing beside an extrapolated sample has a weight of 0.05 instead of 1.
SheetVertex place_vertex(const CellCorners& corners, const Sheets& sheets, int sheet) {
  SheetVertex vertex;
  Eigen::Vector3f colour_sum = Eigen::Vector3f::Zero();
  float colour_weight = 0.0F;
  float crossings = 0.0F;
  for (unsigned e = 0; e < 12; ++e) {
    const auto [a, b] = kCellEdges[e];
    const TsdfSample& from = *corners.samples[a];
    const TsdfSample& to = *corners.samples[b];
    if ((from.distance_m < 0.0F) == (to.distance_m < 0.0F) || sheets.of_edge[e] != sheet) continue;
    const float weight = is_measured_crossing(from, to) ? 1.0F : kOfGuess;
    const float t = from.distance_m / (from.distance_m - to.distance_m);
    vertex.position += weight * (corners.positions[a] + t * (corners.positions[b] - corners.positions[a]));
    crossings += weight;
    for (const auto& [sample, share] : {std::pair{&from, 1.0F - t}, std::pair{&to, t}}) {
      if (!sample->has_colour) continue;
      colour_sum += (share + 1e-3F) * Eigen::Vector3f(sample->colour.r, sample->colour.g, sample->colour.b);
      colour_weight += share + 1e-3F;
    }
  }
  vertex.position /= crossings;
  if (colour_weight > 0.0F) {
    const Eigen::Vector3f mean = colour_sum / colour_weight;
    const auto channel = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
    vertex.colour = {channel(mean.x()), channel(mean.y()), channel(mean.z())};
  }
  return vertex;
}

/// Returns the unit gradient of the trilinear distance at a position in the cell (0..1); zero if the
/// distances cancel.
Eigen::Vector3f normal_at(const std::array<const TsdfSample*, 8>& corners, const Eigen::Vector3f& position) {
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f towards = corner_position(corner);
    const Eigen::Vector3f share =
        towards.array() * position.array() + (1.0F - towards.array()) * (1.0F - position.array());
    const Eigen::Vector3f sign = 2.0F * towards - Eigen::Vector3f::Ones();
    gradient += corners[corner]->distance_m * Eigen::Vector3f(sign.x() * share.y() * share.z(),
                                                              share.x() * sign.y() * share.z(),
                                                              share.x() * share.y() * sign.z());
  }
  return gradient.normalized();  // Eigen keeps zero
}

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

// Vertices and origin are at multiples of this. Hence a vertex is the same in two meshes of different origin,
// and no bit is lost within 128 m of the origin.
constexpr double kVertexStep_m = 1.0 / (1 << 17);

Eigen::Vector3d on_vertex_grid(const Eigen::Vector3d& p_world) {
  return (p_world.array() / kVertexStep_m).round().matrix() * kVertexStep_m;
}

class Net {
 public:
  Net(const TsdfBricks& voxels, const TsdfBricks& coarse, double resolution_m)
      : grids_{Grid{voxels, 1, {}}, Grid{coarse, kCoarseEdge, {}}}, resolution_m_(resolution_m) {
    for (Grid& grid : grids_) grid.cells.resize(grid.bricks.bricks().size());
    for (const Grid& grid : grids_)
      if (!grid.cells.empty()) {
        mesh_.origin =
            on_vertex_grid(grid.edge * grid.bricks.bricks().front().first.cast<double>() * resolution_m);
        break;
      }
    // Each step needs what the one before found in neighbouring bricks.
    for_each_brick([this](Grid& grid, std::size_t b) { find_states(grid, b); });
    for_each_brick([this](Grid& grid, std::size_t b) { find_signs(grid, b); });
    for_each_brick([this](Grid& grid, std::size_t b) { count_vertices(grid, b); });
    number_vertices();
    for_each_brick([this](Grid& grid, std::size_t b) { place_vertices(grid, b); });
    span_polygons();
  }
  Mesh take() { return std::move(mesh_); }

 private:
  // Properties of a sample that decide which cells and polygons exist, one bit each.
  enum State : std::uint8_t { kKnown = 1, kMirrored = 2, kNegative = 4, kExtrapolated = 8 };
  // The dual cells whose lowest sample is in one brick.
  struct BrickCells {
    std::array<std::uint8_t, kBrickSize> states{};   // of the samples; 0: unknown
    std::array<std::uint8_t, kBrickSize> signs{};    // 0: not crossed, or a corner is unknown
    std::array<std::uint16_t, kBrickSize> vertex{};  // the cell's first vertex, relative to first_vertex
    std::uint32_t first_vertex = 0;
    std::uint32_t vertices = 0;
    [[nodiscard]] std::uint32_t first_of(std::size_t offset) const { return first_vertex + vertex[offset]; }
  };
  struct Grid {
    const TsdfBricks& bricks;
    int edge;                       // of its cells, in voxels
    std::vector<BrickCells> cells;  // one per brick
  };
  // `value` and `near` differ for a mirrored voxel: `value` is its coarse cell's sample, `near` the distance
  // interpolated at the voxel. Both are null if it is unknown.
  struct CornerSample {
    const TsdfSample* value = nullptr;
    const TsdfSample* near = nullptr;
  };
  // States of a brick's samples plus one on the upper side of each axis.
  static constexpr int kWindow = kBrickEdge + 1;
  static constexpr std::size_t kWindowSize = std::size_t{kWindow} * kWindow * kWindow;
  using Window = std::array<std::uint8_t, kWindowSize>;

  static std::size_t in_window(const Eigen::Vector3i& at) {
    return static_cast<std::size_t>((at.z() * kWindow + at.y()) * kWindow + at.x());
  }
  template <typename Visit>
  static void for_each_cell(const Visit& visit) {
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) visit(Eigen::Vector3i(x, y, z));
  }
  // Calls visit(grid, brick) for each brick, on all cores.
  template <typename Visit>
  void for_each_brick(const Visit& visit) {
    for (Grid& grid : grids_)
      parallel_ranges(grid.cells.size(), kBricksAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) visit(grid, b);
      });
  }
  [[nodiscard]] bool is_of_voxels(const Grid& grid) const { return &grid == &grids_.front(); }

  [[nodiscard]] CornerSample corner_sample(const Grid& grid, const TsdfSample& sample,
                                           const VoxelIndex& cell) const {
    if (!sample.known()) return {};
    if (!sample.mirrored || !is_of_voxels(grid)) return {&sample, &sample};
    static_assert(kCoarseEdge == 2);
    const TsdfSample* coarse = sample_in(grids_.back().bricks, cell.unaryExpr([](int v) { return v >> 1; }));
    return {coarse, coarse != nullptr ? &sample : nullptr};
  }

  void find_states(Grid& grid, std::size_t b) {
    const Brick& brick = grid.bricks.bricks()[b];
    for_each_cell([&](const Eigen::Vector3i& at) {
      const TsdfSample& sample = brick.samples[brick_offset(at)];
      const TsdfSample* value = corner_sample(grid, sample, brick.first + at).value;
      if (value == nullptr) return;
      grid.cells[b].states[brick_offset(at)] = static_cast<std::uint8_t>(
          kKnown | (sample.mirrored ? kMirrored : 0) | (value->distance_m < 0.0F ? kNegative : 0) |
          (value->extrapolated ? kExtrapolated : 0));
    });
  }

  static Window window_of(const Grid& grid, const BrickNeighbourhood& around) {
    Window window{};
    for (int z = 0; z < kWindow; ++z)
      for (int y = 0; y < kWindow; ++y)
        for (const int x : {0, kBrickEdge}) {
          const auto [brick, offset] = around.index_of({x, y, z});
          if (brick == TsdfBricks::kNone) continue;
          const auto from = grid.cells[brick].states.begin() + static_cast<std::ptrdiff_t>(offset);
          std::copy_n(from, x == 0 ? kBrickEdge : 1,
                      window.begin() + static_cast<std::ptrdiff_t>(in_window({x, y, z})));
        }
    return window;
  }
  static Eigen::Vector3i corner_offset(unsigned i) {
    return {static_cast<int>(i & 1U), static_cast<int>(i >> 1U & 1U), static_cast<int>(i >> 2U & 1U)};
  }

  // A cell exists in a grid if all its samples are known. In the voxels' grid, at least one corner must be a
  // voxel; in the coarse cells' grid, all corners must be coarse cells.
  void find_signs(Grid& grid, std::size_t b) {
    const Window window = window_of(grid, BrickNeighbourhood(grid.bricks, b));
    for_each_cell([&](const Eigen::Vector3i& at) {
      unsigned all = 0xFF, any = 0, signs = 0;
      for (unsigned i = 0; i < 8; ++i) {
        const unsigned state = window[in_window(at) + in_window(corner_offset(i))];
        all &= state;
        any |= state;
        signs |= (state & kNegative ? 1U : 0U) << i;
      }
      const bool is_cell = (all & kKnown) != 0 && ((is_of_voxels(grid) ? all : any) & kMirrored) == 0;
      if (is_cell && signs != 255) grid.cells[b].signs[brick_offset(at)] = static_cast<std::uint8_t>(signs);
    });
  }

  static unsigned signs_at(const Grid& grid, const BrickNeighbourhood& around, const Eigen::Vector3i& cell) {
    const auto [brick, offset] = around.index_of(cell);
    return brick == TsdfBricks::kNone ? 0U : grid.cells[brick].signs[offset];
  }

  // Sheets of a cell, with those faces switched that would otherwise give an edge four polygons. `cell` is
  // relative to the brick's lowest sample.
  static Sheets sheets_at(const Grid& grid, const BrickNeighbourhood& around, const Eigen::Vector3i& cell,
                          unsigned signs) {
    const Sheets& defaults = default_sheets(signs);
    unsigned turned = 0;
    for (unsigned face = 0; face < 6 && defaults.joined_faces != 0; ++face) {
      if ((defaults.joined_faces >> face & 1U) == 0) continue;
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(face / 2) * ((face & 1U) != 0 ? 1 : -1);
      const unsigned beyond = signs_at(grid, around, cell + step);
      if ((default_sheets(beyond).joined_faces >> (face ^ 1U) & 1U) != 0) turned |= 1U << face;
    }
    return turned == 0 ? defaults : sheets_of(signs, turned);
  }

  // Calls visit(cell, signs) for each crossed cell of a brick.
  template <typename Visit>
  static void for_each_crossed_cell(const BrickCells& cells, const Visit& visit) {
    for_each_cell([&](const Eigen::Vector3i& at) {
      if (const unsigned signs = cells.signs[brick_offset(at)]; signs != 0) visit(at, signs);
    });
  }

  void count_vertices(Grid& grid, std::size_t b) {
    const BrickNeighbourhood around(grid.bricks, b);
    BrickCells& cells = grid.cells[b];
    for_each_crossed_cell(cells, [&](const Eigen::Vector3i& at, unsigned signs) {
      cells.vertex[brick_offset(at)] = static_cast<std::uint16_t>(cells.vertices);
      cells.vertices += static_cast<std::uint32_t>(sheets_at(grid, around, at, signs).count);
    });
  }
  void number_vertices() {
    std::uint32_t vertices = 0;
    for (Grid& grid : grids_)
      for (BrickCells& brick : grid.cells) {
        brick.first_vertex = vertices;
        vertices += brick.vertices;
      }
    mesh_.vertices.resize(vertices);
    mesh_.normals.resize(vertices);
    mesh_.colours.resize(vertices);
  }

  void place_vertices(Grid& grid, std::size_t b) {
    const BrickNeighbourhood around(grid.bricks, b);
    for_each_crossed_cell(grid.cells[b], [&](const Eigen::Vector3i& at, unsigned signs) {
      const VoxelIndex lowest = grid.bricks.bricks()[b].first + at;
      CellCorners corners;
      std::array<const TsdfSample*, 8> near{};
      for (unsigned i = 0; i < 8; ++i) {
        const auto [brick, offset] = around.index_of(at + corner_offset(i));
        const TsdfSample& sample = grid.bricks.bricks()[brick].samples[offset];
        const CornerSample corner = corner_sample(grid, sample, lowest + corner_offset(i));
        corners.samples[i] = corner.value;
        near[i] = corner.near;
        corners.positions[i] = corner_position(i);
        if (sample.mirrored)  // the centre of the coarse cell is half a voxel beside the voxel's
          corners.positions[i] += (lowest + corner_offset(i))
                                      .unaryExpr([](int v) { return (v & 1) != 0 ? -1 : 1; })
                                      .cast<float>() *
                                  0.5F;
      }
      const Sheets sheets = sheets_at(grid, around, at, signs);
      std::size_t v = grid.cells[b].first_of(brick_offset(at));
      for (int sheet = 0; sheet < sheets.count; ++sheet, ++v) {
        const SheetVertex vertex = place_vertex(corners, sheets, sheet);
        // Samples are at the centres of cells, hence + 0.5.
        const Eigen::Vector3d voxels = grid.edge * (lowest.cast<double>() + vertex.position.cast<double>() +
                                                    Eigen::Vector3d::Constant(0.5));
        mesh_.vertices[v] = (on_vertex_grid(voxels * resolution_m_) - mesh_.origin).cast<float>();
        mesh_.normals[v] = normal_at(near, vertex.position);
        mesh_.colours[v] = vertex.colour;
      }
    });
  }

  // Adds the polygons of all bricks, in the order of the bricks.
  void span_polygons() {
    for (Grid& grid : grids_) {
      std::vector<std::vector<Triangle>> triangles((grid.cells.size() + kBricksAtOnce - 1) / kBricksAtOnce);
      parallel_ranges(grid.cells.size(), kBricksAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) span_polygons(grid, b, triangles[begin / kBricksAtOnce]);
      });
      std::size_t count = mesh_.triangles.size();
      for (const std::vector<Triangle>& some : triangles) count += some.size();
      mesh_.triangles.reserve(count);
      for (std::vector<Triangle>& some : triangles) {
        mesh_.triangles.insert(mesh_.triangles.end(), some.begin(), some.end());
        some = {};  // else all triangles would be there twice
      }
    }
  }

  // Adds a polygon around each measured crossing between two neighbouring samples. In the voxels' grid, one
  // of the samples must be a voxel; in the coarse cells' grid, both must be coarse.
  void span_polygons(const Grid& grid, std::size_t b, std::vector<Triangle>& triangles) const {
    const BrickNeighbourhood around(grid.bricks, b);
    const Window window = window_of(grid, around);
    std::vector<std::uint32_t> polygon;
    for_each_cell([&](const Eigen::Vector3i& at) {
      const unsigned from = window[in_window(at)];
      if ((from & kKnown) == 0) return;
      for (int axis = 0; axis < 3; ++axis) {
        const unsigned to = window[in_window(at + Eigen::Vector3i::Unit(axis))];
        if ((to & kKnown) == 0 || ((from | to) & kExtrapolated) != 0 || ((from ^ to) & kNegative) == 0)
          continue;
        if (((is_of_voxels(grid) ? from & to : from | to) & kMirrored) != 0) continue;
        polygon.clear();
        // The four cells around the edge, counter-clockwise seen from its far end.
        const Eigen::Vector3i second = Eigen::Vector3i::Unit((axis + 1) % 3),
                              third = Eigen::Vector3i::Unit((axis + 2) % 3);
        constexpr std::array<std::array<int, 2>, 4> kBack{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
        for (std::size_t i = 0; i < 4; ++i) {
          const Eigen::Vector3i back = kBack[i][0] * second + kBack[i][1] * third;
          const Eigen::Vector3i next = kBack[(i + 1) % 4][0] * second + kBack[(i + 1) % 4][1] * third;
          std::uint32_t corner = vertex_across(grid, around, at - back, back, axis);
          if (!is_of_voxels(grid)) {
            const VoxelIndex cell = grid.bricks.bricks()[b].first + at;
            // Where the coarse grid has no cell, one of the voxels' may touch both samples.
            if (corner == kNoVertex) corner = vertex_of_voxels(2 * (cell - back), back, axis);
            polygon.push_back(corner);
            // So may a cell half way to the next corner.
            const Eigen::Vector3i both = back.cwiseMin(next), half = (back - next).cwiseAbs();
            const std::uint32_t between = vertex_of_voxels(2 * (cell - both) - half, both, axis);
            if (between != kNoVertex) polygon.push_back(between);
          } else {
            polygon.push_back(corner);
          }
        }
        if ((to & kNegative) != 0)  // the free side is at `from`
          std::reverse(polygon.begin() + 1, polygon.end());
        add_polygon(polygon, triangles);
      }
    });
  }

  // Vertex of the cell's sheet that crosses the edge along `axis` starting at corner `from`.
  static std::uint32_t vertex_across(const Grid& grid, const BrickNeighbourhood& around,
                                     const Eigen::Vector3i& cell, const Eigen::Vector3i& from, int axis) {
    const auto [brick, offset] = around.index_of(cell);
    if (brick == TsdfBricks::kNone) return kNoVertex;
    const unsigned signs = grid.cells[brick].signs[offset];
    if (signs == 0) return kNoVertex;
    const Sheets& defaults = default_sheets(signs);
    if (defaults.count == 1 && defaults.joined_faces == 0) return grid.cells[brick].first_of(offset);
    const auto corner = static_cast<unsigned>(from.x() | from.y() << 1 | from.z() << 2);
    const unsigned edge = edge_between(corner, corner | 1U << axis);
    return grid.cells[brick].first_of(offset) + sheets_at(grid, around, cell, signs).of_edge[edge];
  }
  // The same for the cell of the voxels' grid whose lowest voxel is at `even` + (1, 1, 1).
  [[nodiscard]] std::uint32_t vertex_of_voxels(const VoxelIndex& even, const Eigen::Vector3i& from,
                                               int axis) const {
    const Grid& grid = grids_.front();
    const VoxelIndex voxel = even + VoxelIndex::Ones(), first = brick_of(voxel);
    const std::size_t brick = grid.bricks.find(first);
    if (brick == TsdfBricks::kNone || grid.cells[brick].signs[brick_offset(voxel - first)] == 0)
      return kNoVertex;
    return vertex_across(grid, BrickNeighbourhood(grid.bricks, brick), voxel - first, from, axis);
  }

  // Splits a polygon of four corners along its shorter diagonal, others into a fan.
  void add_polygon(const std::vector<std::uint32_t>& p, std::vector<Triangle>& triangles) const {
    for (const std::uint32_t v : p)
      if (v == kNoVertex) return;
    const auto& v = mesh_.vertices;
    const bool from_second =
        p.size() == 4 && (v[p[0]] - v[p[2]]).squaredNorm() > (v[p[1]] - v[p[3]]).squaredNorm();
    if (from_second) {
      triangles.push_back({p[0], p[1], p[3]});
      triangles.push_back({p[1], p[2], p[3]});
    } else {
      for (std::size_t i = 2; i < p.size(); ++i) triangles.push_back({p[0], p[i - 1], p[i]});
    }
  }

  std::array<Grid, 2> grids_;  // voxels, coarse cells
  double resolution_m_;
  Mesh mesh_;
};

}  // namespace

Mesh dual_marching_cubes(const TsdfLevels& levels, double resolution_m) {
  return Net(levels.voxels, levels.coarse, resolution_m).take();
}

}  // namespace roomradar
