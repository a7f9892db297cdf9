// surface.cpp: surface nets over the signed distances, then specks out, then fewer triangles.
#include "mapping/surface.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/mesh_simplify.hpp"
#include "mapping/sample_bricks.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

// Corner i of a cell stands at its lowest voxel + (bit 0, bit 1, bit 2).
constexpr std::array<std::array<int, 2>, 12> kCellEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

struct Cell {
  std::array<const BrickSample*, 8> corners{};
};

// False if a corner is unknown or all lie on one side.
bool crosses(const Cell& cell) {
  int inside = 0;
  for (const BrickSample* corner : cell.corners) {
    if (!corner || !corner->known) return false;
    inside += corner->distance_m < 0.0F ? 1 : 0;
  }
  return inside > 0 && inside < 8;
}

Eigen::Vector3f corner_position(int corner) {
  return {static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
          static_cast<float>(corner >> 2 & 1)};
}

struct CellVertex {
  Eigen::Vector3f position;  // in the cell, 0..1
  Eigen::Vector3f normal;
  Rgb colour;
};

// Mean of the zero crossings; the normal is the gradient of the trilinear distance there.
CellVertex place_vertex(const Cell& cell) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Vector3f colour_sum = Eigen::Vector3f::Zero();
  float colour_weight = 0.0F;
  int crossings = 0;
  for (const auto& [a, b] : kCellEdges) {
    const BrickSample& from = *cell.corners[static_cast<std::size_t>(a)];
    const BrickSample& to = *cell.corners[static_cast<std::size_t>(b)];
    if ((from.distance_m < 0.0F) == (to.distance_m < 0.0F)) continue;
    const float t = from.distance_m / (from.distance_m - to.distance_m);
    sum += corner_position(a) + t * (corner_position(b) - corner_position(a));
    ++crossings;
    for (const auto& [sample, share] : {std::pair{&from, 1.0F - t}, std::pair{&to, t}}) {
      if (!sample->has_colour) continue;
      colour_sum += (share + 1e-3F) * Eigen::Vector3f(sample->colour.r, sample->colour.g, sample->colour.b);
      colour_weight += share + 1e-3F;
    }
  }
  CellVertex vertex;
  vertex.position = sum / static_cast<float>(crossings);
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f towards = corner_position(corner);
    const Eigen::Vector3f share = towards.array() * vertex.position.array() +
                                  (1.0F - towards.array()) * (1.0F - vertex.position.array());
    const Eigen::Vector3f sign = 2.0F * towards - Eigen::Vector3f::Ones();
    gradient += cell.corners[static_cast<std::size_t>(corner)]->distance_m *
                Eigen::Vector3f(sign.x() * share.y() * share.z(), share.x() * sign.y() * share.z(),
                                share.x() * share.y() * sign.z());
  }
  vertex.normal = gradient.normalized();  // all-zero only if the distances cancel; Eigen keeps zero then
  if (colour_weight > 0.0F) {
    const Eigen::Vector3f mean = colour_sum / colour_weight;
    const auto channel = [](float value) { return static_cast<std::uint8_t>(std::lround(value)); };
    vertex.colour = {channel(mean.x()), channel(mean.y()), channel(mean.z())};
  } else {
    vertex.colour = {128, 128, 128};
  }
  return vertex;
}

// One vertex for each crossed cell, and the cell's place beside it.
class Net {
 public:
  Net(const SampleBricks& bricks, double resolution_m) : bricks_(bricks), resolution_m_(resolution_m) {
    vertex_of_cell_.resize(bricks.bricks().size());
    if (bricks.bricks().empty()) return;
    mesh_.origin = bricks.bricks().front().first.cast<double>() * resolution_m;
    for (std::size_t b = 0; b < bricks.bricks().size(); ++b) place_vertices(b);
    for (std::size_t b = 0; b < bricks.bricks().size(); ++b) span_quads(b);
  }
  Mesh take() { return std::move(mesh_); }

 private:
  template <typename Visit>
  static void for_each_voxel(const Visit& visit) {
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) visit(Eigen::Vector3i(x, y, z));
  }

  [[nodiscard]] const BrickSample* sample(const BrickNeighbourhood& around,
                                          const Eigen::Vector3i& voxel) const {
    const auto [brick, offset] = around.place(voxel);
    if (brick == SampleBricks::kNone) return nullptr;
    const BrickSample& found = bricks_.bricks()[brick].samples[offset];
    return found.known ? &found : nullptr;
  }

  void place_vertices(std::size_t b) {
    vertex_of_cell_[b].fill(kNoVertex);
    const BrickNeighbourhood around(bricks_, b);
    for_each_voxel([&](const Eigen::Vector3i& voxel) {
      if (!bricks_.bricks()[b].samples[brick_offset(voxel)].known) return;
      Cell cell;
      for (int i = 0; i < 8; ++i)
        cell.corners[static_cast<std::size_t>(i)] =
            sample(around, voxel + Eigen::Vector3i(i & 1, i >> 1 & 1, i >> 2 & 1));
      if (!crosses(cell)) return;
      const CellVertex vertex = place_vertex(cell);
      // A sample speaks for its voxel's centre.
      const Eigen::Vector3d voxels = (bricks_.bricks()[b].first + voxel).cast<double>() +
                                     vertex.position.cast<double>() + Eigen::Vector3d::Constant(0.5);
      vertex_of_cell_[b][brick_offset(voxel)] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.emplace_back((voxels * resolution_m_ - mesh_.origin).cast<float>());
      mesh_.normals.push_back(vertex.normal);
      mesh_.colours.push_back(vertex.colour);
    });
  }

  void span_quads(std::size_t b) {
    const BrickNeighbourhood around(bricks_, b);
    for_each_voxel([&](const Eigen::Vector3i& voxel) {
      const BrickSample& from = bricks_.bricks()[b].samples[brick_offset(voxel)];
      if (!from.known) return;
      for (int axis = 0; axis < 3; ++axis) {
        const BrickSample* to = sample(around, voxel + Eigen::Vector3i::Unit(axis));
        if (!to || (from.distance_m < 0.0F) == (to->distance_m < 0.0F)) continue;
        // The four cells round the edge, counter-clockwise seen from its far end.
        const Eigen::Vector3i second = Eigen::Vector3i::Unit((axis + 1) % 3);
        const Eigen::Vector3i third = Eigen::Vector3i::Unit((axis + 2) % 3);
        std::array<std::uint32_t, 4> quad = {vertex(around, voxel - second - third),
                                             vertex(around, voxel - third), vertex(around, voxel),
                                             vertex(around, voxel - second)};
        if (to->distance_m < 0.0F) std::swap(quad[1], quad[3]);  // the free side is the near end
        add_quad(quad);
      }
    });
  }

  [[nodiscard]] std::uint32_t vertex(const BrickNeighbourhood& around, const Eigen::Vector3i& voxel) const {
    const auto [brick, offset] = around.place(voxel);
    return brick == SampleBricks::kNone ? kNoVertex : vertex_of_cell_[brick][offset];
  }

  // Cut along the shorter diagonal.
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

  const SampleBricks& bricks_;
  double resolution_m_;
  std::vector<std::array<std::uint32_t, kBrickEdge * kBrickEdge * kBrickEdge>> vertex_of_cell_;  // by brick
  Mesh mesh_;
};

void require_valid(const SurfaceConfig& config) {
  const auto require = [](const char* field, float value) {
    if (!(std::isfinite(value) && value >= 0.0F))
      throw Error(std::string("surface.") + field + " = " + std::to_string(value) +
                  ": must be finite and >= 0");
  };
  require("min_weight", config.min_weight);
  require("min_component_area_m2", config.min_component_area_m2);
  require("max_deviation_m", config.max_deviation_m);
}

}  // namespace

Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config) {
  require_valid(config);
  const SampleBricks bricks(map, config.min_weight);
  const Mesh whole = Net(bricks, map.resolution_m()).take();
  Mesh mesh = without_specks(whole, config.min_component_area_m2);
  return config.max_deviation_m > 0.0F ? simplified(mesh, config.max_deviation_m) : mesh;
}

}  // namespace roomradar
