// mesh_borders.cpp: links border half-edges to loops, and measures the loops.
#include "mapping/mesh/mesh_borders.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <unordered_map>

#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

// Half-edge 3 t + k runs from corner k of triangle t to corner k + 1.
std::uint32_t next_in_triangle(std::uint32_t half_edge) {
  return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

class HalfEdges {
 public:
  explicit HalfEdges(const Mesh& mesh) : mesh_(mesh) {
    by_ends_.reserve(3 * mesh.triangles.size());
    for (std::uint32_t e = 0; e < 3 * mesh.triangles.size(); ++e) by_ends_.emplace(code(start(e), end(e)), e);
  }

  [[nodiscard]] std::uint32_t start(std::uint32_t half_edge) const {
    return mesh_.triangles[half_edge / 3][half_edge % 3];
  }
  [[nodiscard]] std::uint32_t end(std::uint32_t half_edge) const {
    return start(next_in_triangle(half_edge));
  }
  /// The opposite half-edge in the neighbouring triangle, or kNoEdge.
  [[nodiscard]] std::uint32_t opposite(std::uint32_t half_edge) const {
    const auto found = by_ends_.find(code(end(half_edge), start(half_edge)));
    return found == by_ends_.end() ? kNoEdge : found->second;
  }
  [[nodiscard]] bool is_border(std::uint32_t half_edge) const {
    return by_ends_.at(code(start(half_edge), end(half_edge))) == half_edge && opposite(half_edge) == kNoEdge;
  }
  /// Returns the next border half-edge, found by rotating through the triangles around this one's end.
  /// Returns kNoEdge if the triangle fan has no end, which requires a non-manifold edge.
  [[nodiscard]] std::uint32_t next_on_border(std::uint32_t half_edge) const {
    std::uint32_t candidate = next_in_triangle(half_edge);
    for (std::size_t turns = 0; turns <= mesh_.triangles.size(); ++turns) {
      const std::uint32_t beyond = opposite(candidate);
      if (beyond == kNoEdge) return candidate;
      candidate = next_in_triangle(beyond);
      if (candidate == next_in_triangle(half_edge)) break;
    }
    return kNoEdge;
  }

 private:
  static std::uint64_t code(std::uint32_t from, std::uint32_t to) {
    return static_cast<std::uint64_t>(from) << 32U | to;
  }
  const Mesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> by_ends_;
};

Eigen::Vector3d place(const Mesh& mesh, std::uint32_t vertex) {
  return mesh.origin + mesh.vertices[vertex].cast<double>();
}

Eigen::Vector3d doubled_area(const Mesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  return (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
}

// Extent of the loop along its largest principal axis.
double longest_extent_m(const Mesh& mesh, const BorderLoop& loop) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::uint32_t v : loop.vertices) {
    const Eigen::Vector3d offset = place(mesh, v) - loop.centre_world;
    scatter += offset * offset.transpose();
  }
  const Eigen::Vector3d axis = symmetric_eigen(scatter).vectors.col(2);
  double low = 0.0;
  double high = 0.0;
  for (const std::uint32_t v : loop.vertices) {
    const double along = axis.dot(place(mesh, v) - loop.centre_world);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return high - low;
}

void measure(const Mesh& mesh, const Eigen::Vector3d& area_along_border, BorderLoop& loop) {
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  const std::size_t n = loop.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d a = place(mesh, loop.vertices[i]);
    const Eigen::Vector3d b = place(mesh, loop.vertices[(i + 1) % n]);
    loop.length_m += (b - a).norm();
    weighted += (b - a).norm() * 0.5 * (a + b);
  }
  loop.centre_world =
      loop.length_m > 0.0 ? (weighted / loop.length_m).eval() : place(mesh, loop.vertices.front());
  Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i)
    vector_area += 0.5 * (place(mesh, loop.vertices[i]) - loop.centre_world)
                             .cross(place(mesh, loop.vertices[(i + 1) % n]) - loop.centre_world);
  loop.area_m2 = vector_area.norm();
  loop.outward_world = area_along_border.normalized();
  loop.encloses_surface = vector_area.dot(area_along_border) > 0.0;
  loop.size_m = longest_extent_m(mesh, loop);
}

}  // namespace

std::vector<BorderLoop> border_loops(const Mesh& mesh) {
  const HalfEdges edges(mesh);
  std::vector<bool> walked(3 * mesh.triangles.size(), false);
  std::vector<std::uint32_t> place_on_path(mesh.vertices.size(), kNoEdge);
  std::vector<std::uint32_t> path;  // visited border edges that are not in a loop so far
  std::vector<BorderLoop> loops;
  const auto close_loop = [&](std::size_t from) {
    BorderLoop loop;
    Eigen::Vector3d area_along_border = Eigen::Vector3d::Zero();
    for (std::size_t i = from; i < path.size(); ++i) {
      place_on_path[edges.start(path[i])] = kNoEdge;
      loop.vertices.push_back(edges.start(path[i]));
      area_along_border += doubled_area(mesh, mesh.triangles[path[i] / 3]);
    }
    path.resize(from);
    measure(mesh, area_along_border, loop);
    loops.push_back(std::move(loop));
  };
  for (std::uint32_t first = 0; first < walked.size(); ++first) {
    if (walked[first] || !edges.is_border(first)) continue;
    for (std::uint32_t e = first; e != kNoEdge && !walked[e]; e = edges.next_on_border(e)) {
      // A path that returns to one of its vertices has closed a hole that touches another hole there.
      if (place_on_path[edges.start(e)] != kNoEdge) close_loop(place_on_path[edges.start(e)]);
      place_on_path[edges.start(e)] = static_cast<std::uint32_t>(path.size());
      walked[e] = true;
      path.push_back(e);
    }
    close_loop(0);
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const BorderLoop& a, const BorderLoop& b) { return a.length_m > b.length_m; });
  return loops;
}

}  // namespace roomradar
