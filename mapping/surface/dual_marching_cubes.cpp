// dual_marching_cubes.cpp: dual marching cubes over both grids of samples.
#include "mapping/surface/dual_marching_cubes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "mapping/surface/cell_sheets.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};
// Weight of an extrapolated crossing in a vertex's position. Above 0, so two cells that share their only
// measured crossing get distinct vertices along the surface.
constexpr float kOfGuess = 0.05F;

// Vertices and origin are at multiples of this. Hence a vertex is the same in two meshes of different origin,
// and no bit is lost within 128 m of the origin.
constexpr double kVertexStep_m = 1.0 / (1 << 17);

Eigen::Vector3d on_vertex_grid(const Eigen::Vector3d& p_world) {
  return (p_world.array() / kVertexStep_m).round().matrix() * kVertexStep_m;
}

// The eight samples of a dual cell. A mirrored corner of the voxels' grid has the sample of its coarse cell.
struct CellCorners {
  std::array<const TsdfSample*, 8> samples;
  std::array<Eigen::Vector3f, 8> positions;  // in the cell, 0..1; those of coarse samples may be outside
};

Eigen::Vector3f corner_position(unsigned corner) {
  return {static_cast<float>(corner & 1U), static_cast<float>(corner >> 1U & 1U),
          static_cast<float>(corner >> 2U & 1U)};
}

// Unit gradient of the trilinear distance at a position in the cell (0..1).
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
  return gradient.normalized();  // zero only if the distances cancel; Eigen then keeps zero
}

struct SheetVertex {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // in the cell, 0..1
  Rgb colour{128, 128, 128};
};

bool is_measured_crossing(const TsdfSample& from, const TsdfSample& to) {
  return !from.extrapolated && !to.extrapolated && (from.distance_m < 0.0F) != (to.distance_m < 0.0F);
}

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
    for_each_brick([this](Grid& grid, std::size_t b) { find_signs(grid, b); });
    reserve();
    for_each_brick([this](Grid& grid, std::size_t b) { place_vertices(grid, b); });
    for_each_brick([this](Grid& grid, std::size_t b) { span_polygons(grid, b); });
  }
  Mesh take() { return std::move(mesh_); }

 private:
  // The dual cells whose lowest sample is in one brick.
  struct BrickCells {
    std::array<std::uint8_t, kBrickSize> signs{};    // 0: not crossed, or a corner is unknown
    std::array<std::uint16_t, kBrickSize> vertex{};  // the cell's first vertex, relative to first_vertex
    std::uint32_t first_vertex = 0;
    [[nodiscard]] std::uint32_t first_of(std::size_t offset) const { return first_vertex + vertex[offset]; }
  };
  struct Grid {
    const TsdfBricks& bricks;
    int edge;                       // of its cells, in voxels
    std::vector<BrickCells> cells;  // one per brick
  };
  // A sample of the window around a brick. `value` and `near` differ for a mirrored voxel: `value` is its
  // coarse cell's sample, `near` the distance interpolated at the voxel.
  struct WindowSample {
    const TsdfSample* value = nullptr;  // null: unknown
    const TsdfSample* near = nullptr;
    bool mirrored = false;
  };
  // Samples of a brick plus one on the upper side of each axis.
  static constexpr int kWindow = kBrickEdge + 1;

  static std::size_t in_window(const Eigen::Vector3i& at) {
    return static_cast<std::size_t>((at.z() * kWindow + at.y()) * kWindow + at.x());
  }
  template <typename Visit>
  static void for_each_cell(const Visit& visit) {
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) visit(Eigen::Vector3i(x, y, z));
  }
  template <typename Visit>
  void for_each_brick(const Visit& visit) {
    for (Grid& grid : grids_)
      for (std::size_t b = 0; b < grid.cells.size(); ++b) visit(grid, b);
  }
  [[nodiscard]] bool is_of_voxels(const Grid& grid) const { return &grid == &grids_.front(); }

  void fill_window(const Grid& grid, std::size_t b) {
    const BrickNeighbourhood around(grid.bricks, b);
    const VoxelIndex& first = grid.bricks.bricks()[b].first;
    for (int z = 0; z < kWindow; ++z)
      for (int y = 0; y < kWindow; ++y)
        for (int x = 0; x < kWindow; ++x) {
          const Eigen::Vector3i at(x, y, z);
          const auto [brick, offset] = around.index_of(at);
          const TsdfSample* sample =
              brick == TsdfBricks::kNone ? nullptr : &grid.bricks.bricks()[brick].samples[offset];
          WindowSample& own = window_[in_window(at)];
          own = {};
          if (!sample || !sample->known()) continue;
          own = {sample, sample, sample->mirrored};
          if (!sample->mirrored || !is_of_voxels(grid)) continue;
          const VoxelIndex coarse = (first + at).unaryExpr([](int v) { return v >> 1; });
          static_assert(kCoarseEdge == 2);
          own.value = sample_in(grids_.back().bricks, coarse);
        }
  }

  // Returns true if the cell exists in this grid, and all its samples are known. In the voxels' grid, at
  // least one corner must be a voxel; in the coarse cells' grid, all corners must be coarse cells.
  [[nodiscard]] bool is_cell(const Grid& grid, const Eigen::Vector3i& at) const {
    unsigned mirrored = 0;
    for (unsigned i = 0; i < 8; ++i) {
      const WindowSample& sample = window_[in_window(at + corner_offset(i))];
      if (!sample.value) return false;
      mirrored += sample.mirrored ? 1U : 0U;
    }
    return is_of_voxels(grid) ? mirrored < 8 : mirrored == 0;
  }
  static Eigen::Vector3i corner_offset(unsigned i) {
    return {static_cast<int>(i & 1U), static_cast<int>(i >> 1U & 1U), static_cast<int>(i >> 2U & 1U)};
  }

  void find_signs(Grid& grid, std::size_t b) {
    fill_window(grid, b);
    for_each_cell([&](const Eigen::Vector3i& at) {
      if (!is_cell(grid, at)) return;
      unsigned signs = 0;
      for (unsigned i = 0; i < 8; ++i)
        signs |= (window_[in_window(at + corner_offset(i))].value->distance_m < 0.0F ? 1U : 0U) << i;
      grid.cells[b].signs[brick_offset(at)] = static_cast<std::uint8_t>(signs == 255 ? 0 : signs);
    });
  }

  // One vertex per crossed cell and two triangles per vertex, rarely more. A growing vector would temporarily
  // hold its content twice.
  void reserve() {
    std::size_t crossed = 0;
    for (const Grid& grid : grids_)
      for (const BrickCells& brick : grid.cells)
        crossed +=
            kBrickSize - static_cast<std::size_t>(std::count(brick.signs.begin(), brick.signs.end(), 0));
    mesh_.vertices.reserve(crossed);
    mesh_.normals.reserve(crossed);
    mesh_.colours.reserve(crossed);
    mesh_.triangles.reserve(2 * crossed);
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

  void place_vertices(Grid& grid, std::size_t b) {
    fill_window(grid, b);
    const BrickNeighbourhood around(grid.bricks, b);
    BrickCells& cells = grid.cells[b];
    cells.first_vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    for_each_cell([&](const Eigen::Vector3i& at) {
      const unsigned signs = cells.signs[brick_offset(at)];
      if (signs == 0) return;
      const VoxelIndex lowest = grid.bricks.bricks()[b].first + at;
      CellCorners corners;
      std::array<const TsdfSample*, 8> near{};
      for (unsigned i = 0; i < 8; ++i) {
        const WindowSample& sample = window_[in_window(at + corner_offset(i))];
        corners.samples[i] = sample.value;
        near[i] = sample.near;
        corners.positions[i] = corner_position(i);
        if (sample.mirrored)  // the centre of the coarse cell is half a voxel beside the voxel's
          corners.positions[i] += (lowest + corner_offset(i))
                                      .unaryExpr([](int v) { return (v & 1) != 0 ? -1 : 1; })
                                      .cast<float>() *
                                  0.5F;
      }
      const Sheets sheets = sheets_at(grid, around, at, signs);
      cells.vertex[brick_offset(at)] = static_cast<std::uint16_t>(mesh_.vertices.size() - cells.first_vertex);
      for (int sheet = 0; sheet < sheets.count; ++sheet) {
        const SheetVertex vertex = place_vertex(corners, sheets, sheet);
        // Samples are at the centres of cells, hence + 0.5.
        const Eigen::Vector3d voxels = grid.edge * (lowest.cast<double>() + vertex.position.cast<double>() +
                                                    Eigen::Vector3d::Constant(0.5));
        mesh_.vertices.emplace_back((on_vertex_grid(voxels * resolution_m_) - mesh_.origin).cast<float>());
        mesh_.normals.push_back(normal_at(near, vertex.position));
        mesh_.colours.push_back(vertex.colour);
      }
    });
  }

  // Adds a polygon around each measured crossing between two neighbouring samples. In the voxels' grid, one
  // of the samples must be a voxel; in the coarse cells' grid, both must be coarse.
  void span_polygons(Grid& grid, std::size_t b) {
    fill_window(grid, b);
    const BrickNeighbourhood around(grid.bricks, b);
    for_each_cell([&](const Eigen::Vector3i& at) {
      const WindowSample& from = window_[in_window(at)];
      if (!from.value) return;
      for (int axis = 0; axis < 3; ++axis) {
        const WindowSample& to = window_[in_window(at + Eigen::Vector3i::Unit(axis))];
        if (!to.value || !is_measured_crossing(*from.value, *to.value)) continue;
        if (is_of_voxels(grid) ? from.mirrored && to.mirrored : from.mirrored || to.mirrored) continue;
        polygon_.clear();
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
            polygon_.push_back(corner);
            // So may a cell half way to the next corner.
            const Eigen::Vector3i both = back.cwiseMin(next), half = (back - next).cwiseAbs();
            const std::uint32_t between = vertex_of_voxels(2 * (cell - both) - half, both, axis);
            if (between != kNoVertex) polygon_.push_back(between);
          } else {
            polygon_.push_back(corner);
          }
        }
        if (to.value->distance_m < 0.0F)  // the free side is at `from`
          std::reverse(polygon_.begin() + 1, polygon_.end());
        add_polygon();
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
  void add_polygon() {
    const auto& p = polygon_;
    for (const std::uint32_t v : p)
      if (v == kNoVertex) return;
    const auto& v = mesh_.vertices;
    const bool from_second =
        p.size() == 4 && (v[p[0]] - v[p[2]]).squaredNorm() > (v[p[1]] - v[p[3]]).squaredNorm();
    if (from_second) {
      mesh_.triangles.push_back({p[0], p[1], p[3]});
      mesh_.triangles.push_back({p[1], p[2], p[3]});
    } else {
      for (std::size_t i = 2; i < p.size(); ++i) mesh_.triangles.push_back({p[0], p[i - 1], p[i]});
    }
  }

  std::array<Grid, 2> grids_;  // voxels, coarse cells
  double resolution_m_;
  std::array<WindowSample, kWindow * kWindow * kWindow> window_{};
  std::vector<std::uint32_t> polygon_;
  Mesh mesh_;
};

}  // namespace

Mesh dual_marching_cubes(const TsdfLevels& levels, double resolution_m) {
  return Net(levels.voxels, levels.coarse, resolution_m).take();
}

}  // namespace roomradar
