// dual_marching_cubes.cpp: dual marching cubes over bricks of samples.
#include "mapping/surface/dual_marching_cubes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace roomradar {
namespace {

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};
// Weight of an extrapolated crossing in a vertex's position. Above 0, so two cells that share their only
// measured crossing get distinct vertices along the surface.
constexpr float kOfGuess = 0.05F;

// Corner i of a cell is at its lowest voxel + (bit 0, bit 1, bit 2); edge 4 a + k runs along axis a.
constexpr std::array<std::array<unsigned, 2>, 12> kCellEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

unsigned edge_between(unsigned a, unsigned b) {
  for (unsigned e = 0; e < kCellEdges.size(); ++e)
    if (kCellEdges[e] == std::array{a, b} || kCellEdges[e] == std::array{b, a}) return e;
  return 12;
}

// The four corners of a face, in cyclic order. Face 2 a + s is side s of axis a.
std::array<unsigned, 4> face_corners(unsigned face) {
  const unsigned axis = face / 2;
  const unsigned second = 1U << (axis + 1) % 3;
  const unsigned third = 1U << (axis + 2) % 3;
  const unsigned base = (face & 1U) << axis;
  return {base, base | second, base | second | third, base | third};
}

bool is_inside(unsigned signs, unsigned corner) { return (signs >> corner & 1U) != 0; }

// Maps each crossed edge of a cell to its surface sheet.
struct Sheets {
  std::array<std::uint8_t, 12> of_edge{};
  int count = 0;
  unsigned joined_faces = 0;  // bit mask: ambiguous faces whose four crossings are one sheet
};

// @param signs  bit i: corner i is inside
// @param outsides_parted  bit mask of faces that, if ambiguous, separate their outside corners
Sheets sheets_of(unsigned signs, unsigned outsides_parted) {
  std::array<unsigned, 12> parent{};
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](unsigned e) {
    while (parent[e] != e) e = parent[e];
    return e;
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

const std::array<Sheets, 256>& sheet_table() {
  static const std::array<Sheets, 256> table = [] {
    std::array<Sheets, 256> made;
    for (unsigned signs = 0; signs < 256; ++signs) made[signs] = sheets_of(signs, 0);
    return made;
  }();
  return table;
}

using CellCorners = std::array<const TsdfSample*, 8>;

Eigen::Vector3f corner_position(unsigned corner) {
  return {static_cast<float>(corner & 1U), static_cast<float>(corner >> 1U & 1U),
          static_cast<float>(corner >> 2U & 1U)};
}

// Unit gradient of the trilinear distance at a position in the cell (0..1).
Eigen::Vector3f normal_at(const CellCorners& corners, const Eigen::Vector3f& position) {
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
    const TsdfSample& from = *corners[a];
    const TsdfSample& to = *corners[b];
    if ((from.distance_m < 0.0F) == (to.distance_m < 0.0F) || sheets.of_edge[e] != sheet) continue;
    const float weight = is_measured_crossing(from, to) ? 1.0F : kOfGuess;
    const float t = from.distance_m / (from.distance_m - to.distance_m);
    vertex.position += weight * (corner_position(a) + t * (corner_position(b) - corner_position(a)));
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
  Net(const TsdfBricks& bricks, double resolution_m)
      : bricks_(bricks), resolution_m_(resolution_m), cells_(bricks.bricks().size()) {
    if (bricks.bricks().empty()) return;
    mesh_.origin = bricks.bricks().front().first.cast<double>() * resolution_m;
    for (std::size_t b = 0; b < cells_.size(); ++b) find_signs(b);
    reserve();
    for (std::size_t b = 0; b < cells_.size(); ++b) place_vertices(b);
    for (std::size_t b = 0; b < cells_.size(); ++b) span_quads(b);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  // The cells whose lowest voxel is in one brick.
  struct BrickCells {
    std::array<std::uint8_t, kBrickSize> signs{};    // 0: not crossed, or a corner is unknown
    std::array<std::uint16_t, kBrickSize> vertex{};  // the cell's first vertex, relative to first_vertex
    std::uint32_t first_vertex = 0;
    [[nodiscard]] std::uint32_t first_of(std::size_t offset) const { return first_vertex + vertex[offset]; }
  };
  // Samples (or cells) of a brick plus one voxel on one side of each axis.
  static constexpr int kWindow = kBrickEdge + 1;
  using SampleWindow = std::array<const TsdfSample*, kWindow * kWindow * kWindow>;

  static std::size_t in_window(int x, int y, int z) {
    return static_cast<std::size_t>((z * kWindow + y) * kWindow + x);
  }
  template <typename Visit>
  static void for_each_voxel(const Visit& visit) {
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) visit(x, y, z);
  }

  // Collects the brick's samples and those one voxel beyond its upper sides; null if unknown.
  void fill_window(std::size_t b, SampleWindow& window) const {
    const BrickNeighbourhood around(bricks_, b);
    for (int z = 0; z < kWindow; ++z)
      for (int y = 0; y < kWindow; ++y)
        for (int x = 0; x < kWindow; ++x) {
          const auto [brick, offset] = around.place({x, y, z});
          const TsdfSample* sample =
              brick == TsdfBricks::kNone ? nullptr : &bricks_.bricks()[brick].samples[offset];
          window[in_window(x, y, z)] = sample && sample->known() ? sample : nullptr;
        }
  }
  static bool corners_of(const SampleWindow& window, int x, int y, int z, CellCorners& corners) {
    for (unsigned i = 0; i < 8; ++i) {
      corners[i] = window[in_window(x + static_cast<int>(i & 1U), y + static_cast<int>(i >> 1U & 1U),
                                    z + static_cast<int>(i >> 2U & 1U))];
      if (!corners[i]) return false;
    }
    return true;
  }

  void find_signs(std::size_t b) {
    fill_window(b, window_);
    for_each_voxel([&](int x, int y, int z) {
      CellCorners corners;
      if (!corners_of(window_, x, y, z, corners)) return;
      unsigned signs = 0;
      for (unsigned i = 0; i < 8; ++i) signs |= (corners[i]->distance_m < 0.0F ? 1U : 0U) << i;
      cells_[b].signs[brick_offset({x, y, z})] = static_cast<std::uint8_t>(signs == 255 ? 0 : signs);
    });
  }

  // One vertex per crossed cell and two triangles per vertex, rarely more. A growing vector would temporarily
  // hold its content twice.
  void reserve() {
    std::size_t crossed = 0;
    for (const BrickCells& brick : cells_)
      crossed += kBrickSize - static_cast<std::size_t>(std::count(brick.signs.begin(), brick.signs.end(), 0));
    mesh_.vertices.reserve(crossed);
    mesh_.normals.reserve(crossed);
    mesh_.colours.reserve(crossed);
    mesh_.triangles.reserve(2 * crossed);
  }

  [[nodiscard]] unsigned signs_at(const BrickNeighbourhood& around, const Eigen::Vector3i& cell) const {
    const auto [brick, offset] = around.place(cell);
    return brick == TsdfBricks::kNone ? 0U : cells_[brick].signs[offset];
  }

  // Sheets of a cell, with those faces switched that would otherwise give an edge four quads. `cell` is
  // relative to the brick's lowest voxel.
  [[nodiscard]] Sheets sheets_at(const BrickNeighbourhood& around, const Eigen::Vector3i& cell,
                                 unsigned signs) const {
    const Sheets& defaults = sheet_table()[signs];
    unsigned turned = 0;
    for (unsigned face = 0; face < 6 && defaults.joined_faces != 0; ++face) {
      if ((defaults.joined_faces >> face & 1U) == 0) continue;
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(face / 2) * ((face & 1U) != 0 ? 1 : -1);
      const unsigned beyond = signs_at(around, cell + step);
      if ((sheet_table()[beyond].joined_faces >> (face ^ 1U) & 1U) != 0) turned |= 1U << face;
    }
    return turned == 0 ? defaults : sheets_of(signs, turned);
  }

  void place_vertices(std::size_t b) {
    fill_window(b, window_);
    const BrickNeighbourhood around(bricks_, b);
    cells_[b].first_vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    for_each_voxel([&](int x, int y, int z) {
      const Eigen::Vector3i voxel(x, y, z);
      const unsigned signs = cells_[b].signs[brick_offset(voxel)];
      CellCorners corners;
      if (signs == 0 || !corners_of(window_, x, y, z, corners)) return;
      const Sheets sheets = sheets_at(around, voxel, signs);
      cells_[b].vertex[brick_offset(voxel)] =
          static_cast<std::uint16_t>(mesh_.vertices.size() - cells_[b].first_vertex);
      for (int sheet = 0; sheet < sheets.count; ++sheet) {
        const SheetVertex vertex = place_vertex(corners, sheets, sheet);
        // Samples are at voxel centres, hence + 0.5.
        const Eigen::Vector3d voxels = (bricks_.bricks()[b].first + voxel).cast<double>() +
                                       vertex.position.cast<double>() + Eigen::Vector3d::Constant(0.5);
        mesh_.vertices.emplace_back((voxels * resolution_m_ - mesh_.origin).cast<float>());
        mesh_.normals.push_back(normal_at(corners, vertex.position));
        mesh_.colours.push_back(vertex.colour);
      }
    });
  }

  void span_quads(std::size_t b) {
    fill_window(b, window_);
    const BrickNeighbourhood around(bricks_, b);
    for_each_voxel([&](int x, int y, int z) {
      const TsdfSample* from = window_[in_window(x, y, z)];
      if (!from) return;
      const Eigen::Vector3i voxel(x, y, z);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3i end = voxel + Eigen::Vector3i::Unit(axis);
        const TsdfSample* to = window_[in_window(end.x(), end.y(), end.z())];
        if (!to || !is_measured_crossing(*from, *to)) continue;
        // The four cells around the edge, counter-clockwise seen from its far end.
        const int second = (axis + 1) % 3;
        const int third = (axis + 2) % 3;
        std::array<std::uint32_t, 4> quad{};
        constexpr std::array<std::array<int, 2>, 4> kBack{{{1, 1}, {0, 1}, {0, 0}, {1, 0}}};
        for (std::size_t i = 0; i < 4; ++i) {
          const Eigen::Vector3i back =
              kBack[i][0] * Eigen::Vector3i::Unit(second) + kBack[i][1] * Eigen::Vector3i::Unit(third);
          quad[i] = vertex_across(around, voxel - back, back, axis);
        }
        if (to->distance_m < 0.0F) std::swap(quad[1], quad[3]);  // the free side is at `from`
        add_quad(quad);
      }
    });
  }

  // Vertex of the cell's sheet that crosses the edge along `axis` starting at corner `from`.
  [[nodiscard]] std::uint32_t vertex_across(const BrickNeighbourhood& around, const Eigen::Vector3i& cell,
                                            const Eigen::Vector3i& from, int axis) const {
    const auto [brick, offset] = around.place(cell);
    if (brick == TsdfBricks::kNone) return kNoVertex;
    const unsigned signs = cells_[brick].signs[offset];
    if (signs == 0) return kNoVertex;
    const Sheets& defaults = sheet_table()[signs];
    if (defaults.count == 1 && defaults.joined_faces == 0) return cells_[brick].first_of(offset);
    const auto corner = static_cast<unsigned>(from.x() | from.y() << 1 | from.z() << 2);
    const unsigned edge = edge_between(corner, corner | 1U << axis);
    return cells_[brick].first_of(offset) + sheets_at(around, cell, signs).of_edge[edge];
  }

  // Splits the quad along its shorter diagonal.
  void add_quad(const std::array<std::uint32_t, 4>& q) {
    for (const std::uint32_t v : q)
      if (v == kNoVertex) return;
    const auto& v = mesh_.vertices;
    if ((v[q[0]] - v[q[2]]).squaredNorm() <= (v[q[1]] - v[q[3]]).squaredNorm()) {
      mesh_.triangles.push_back({q[0], q[1], q[2]});
      mesh_.triangles.push_back({q[0], q[2], q[3]});
    } else {
      mesh_.triangles.push_back({q[0], q[1], q[3]});
      mesh_.triangles.push_back({q[1], q[2], q[3]});
    }
  }

  const TsdfBricks& bricks_;
  double resolution_m_;
  std::vector<BrickCells> cells_;  // one per brick
  SampleWindow window_{};
  Mesh mesh_;
};

}  // namespace

Mesh dual_marching_cubes(const TsdfBricks& bricks, double resolution_m) {
  return Net(bricks, resolution_m).take();
}

}  // namespace roomradar
