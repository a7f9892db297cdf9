// triangle_tree.cpp: copies the usable triangles, and has the tree built over them.
#include "radar/geometry/triangle_tree.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "mapping/types/validity.hpp"
#include "radar/geometry/flat_faces.hpp"
#include "radar/geometry/half_edges.hpp"
#include "radar/geometry/tree_builder.hpp"

namespace roomradar {
namespace {

std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

/// Copies the usable triangles and sets every member except the nodes.
void TriangleTree::take(const Mesh& mesh) {
  origin_ = mesh.origin;
  vertices_ = mesh.vertices;
  triangles_.clear();
  triangles_.reserve(mesh.triangles.size());
  nodes_.clear();
  is_closed_ = false;
  revision_ = next_revision();
  FloatBounds all;
  for (const Triangle& t : mesh.triangles) {
    if (!is_usable(mesh, t)) continue;
    triangles_.push_back(t);
    all.extend(bounds_of(t, vertices_));
  }
  if (!origin_.allFinite()) triangles_.clear();
  dropped_triangles_ = mesh.triangles.size() - triangles_.size();
  if (triangles_.empty()) {
    centre_.setZero();
    half_size_.setZero();
    return;
  }
  const Eigen::Array3f centre = 0.5F * all.low + 0.5F * all.high;
  // Three roundings of at most half a step of the largest number involved, doubled.
  const float reach_m = std::max(all.low.abs().maxCoeff(), all.high.abs().maxCoeff());
  rounding_m_ = 6.0F * std::numeric_limits<float>::epsilon() * reach_m + std::numeric_limits<float>::min();
  centre_ = centre.matrix().cast<double>();
  half_size_ = ((all.high - centre).max(centre - all.low) + rounding_m_).matrix();
}

void TriangleTree::build_by_place(const Mesh& mesh) {
  take(mesh);
  if (triangles_.empty()) return;
  const std::vector<std::uint32_t> order =
      build_nodes_by_place(triangles_, vertices_, {centre_.cast<float>().array(), rounding_m_}, nodes_);
  std::vector<Triangle> sorted(triangles_.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = triangles_[order[i]];
  triangles_ = std::move(sorted);
  if (!may_be_closed(triangles_, vertices_)) return;  // as most rooms
  const std::vector<std::uint32_t> number = numbers_by_place(vertices_);
  const std::vector<HalfEdge> edges = half_edges_of(triangles_, number);
  is_closed_ = encloses_a_volume(triangles_, vertices_, number, edges);
  if (is_closed_)
    mark_flat_faces(find_within_flat_faces(triangles_, vertices_, edges, static_cast<double>(rounding_m_)),
                    nodes_);
}

void TriangleTree::build_in_order(const Mesh& mesh) {
  take(mesh);
  if (triangles_.empty()) return;
  build_nodes_in_order(triangles_, vertices_, {centre_.cast<float>().array(), rounding_m_}, nodes_);
}

}  // namespace roomradar
