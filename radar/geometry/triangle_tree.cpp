// triangle_tree.cpp: copies the usable triangles, and has the tree built over them.
#include "radar/geometry/triangle_tree.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "mapping/types/validity.hpp"
#include "radar/geometry/half_edges.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Returns the triangle beyond each side; kNone unless there is exactly one with consistent orientation.
std::vector<std::uint32_t> neighbours_of(std::size_t triangle_count, const std::vector<HalfEdge>& edges) {
  std::vector<std::uint32_t> beyond(3 * triangle_count, kNone);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].edge == edges[i].edge) ++end;
    if (end - i == 2 && edges[i].sense != edges[i + 1].sense) {
      beyond[edges[i].side] = edges[i + 1].side / 3;
      beyond[edges[i + 1].side] = edges[i].side / 3;
    }
    i = end;
  }
  return beyond;
}

/// Grows flat faces triangle by triangle (region growing).
class FaceFinder {
 public:
  FaceFinder(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
             const std::vector<HalfEdge>& edges, double flat_m)
      : triangles_(triangles),
        vertices_(vertices),
        beyond_(neighbours_of(triangles.size(), edges)),
        flat_m_(flat_m) {}

  /// Returns for each triangle whether it is within a face.
  std::vector<bool> find() {
    face_.assign(triangles_.size(), kNone);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (face_[t] == kNone) grow_from(t);
    std::vector<bool> within(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto is_of_its_face = [&](std::uint32_t next) {
        return next != kNone && face_[next] == face_[t];
      };
      within[t] = std::all_of(&beyond_[3 * t], &beyond_[3 * t] + 3, is_of_its_face);
    }
    return within;
  }

 private:
  /// Area-weighted plane of the triangles so far: the more triangles, the less their rounding tilts it.
  struct Plane {
    Eigen::Vector3d area_m2 = Eigen::Vector3d::Zero(), moment_m3 = Eigen::Vector3d::Zero();
    double weight_m2 = 0.0;

    void add(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& area) {
      const double weight = area.norm();
      area_m2 += area;
      moment_m3 += weight / 3.0 * (corners[0] + corners[1] + corners[2]);
      weight_m2 += weight;
    }
    [[nodiscard]] bool holds(const std::array<Eigen::Vector3d, 3>& corners, double within_m) const {
      const Eigen::Vector3d normal = area_m2.stableNormalized(), middle = moment_m3 / weight_m2;
      return std::all_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& p) {
        return std::abs(normal.dot(p - middle)) <= within_m;
      });
    }
  };

  const std::vector<Triangle>& triangles_;
  const std::vector<Eigen::Vector3f>& vertices_;
  const std::vector<std::uint32_t> beyond_;
  const double flat_m_;
  std::vector<std::uint32_t> face_, taken_;

  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t t) const {
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return vertices_[triangles_[t][i]].cast<double>();
    };
    return {corner(0), corner(1), corner(2)};
  }
  static Eigen::Vector3d area(const std::array<Eigen::Vector3d, 3>& p) {
    return (p[1] - p[0]).cross(p[2] - p[0]);
  }

  void grow_from(std::uint32_t seed) {
    constexpr double kSameWay = 0.99;  // cosine: normals of slivers are rough, normals of folds are opposite
    Plane plane;
    plane.add(corners(seed), area(corners(seed)));
    face_[seed] = seed;
    taken_.assign(1, seed);
    for (std::size_t at = 0; at < taken_.size(); ++at) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t next = beyond_[3 * taken_[at] + i];
        if (next == kNone || face_[next] != kNone) continue;
        const auto p = corners(next);
        const Eigen::Vector3d a = area(p);
        if (!(a.dot(plane.area_m2) > kSameWay * a.norm() * plane.area_m2.norm()) || !plane.holds(p, flat_m_))
          continue;
        plane.add(p, a);
        face_[next] = seed;
        taken_.push_back(next);
      }
    }
    // The plane may have tilted away from the first triangles.
    const bool is_flat = std::all_of(taken_.begin(), taken_.end(),
                                     [&](std::uint32_t t) { return plane.holds(corners(t), 2.0 * flat_m_); });
    if (!is_flat)
      for (const std::uint32_t t : taken_) face_[t] = t;
  }
};

/// Returns, per triangle, true if the triangle and all its neighbours belong to one flat face (see
/// TriangleTree).
/// @param edges   result of half_edges_of() for these triangles
/// @param flat_m  flatness tolerance, m. A triangle joins a face if its vertices are at most flat_m from the
///                plane fitted to the face so far, and its normal is within 8 degrees of the plane's.
///                Vertices of the complete face are at most 2 flat_m from its plane
std::vector<bool> find_within_flat_faces(const std::vector<Triangle>& triangles,
                                         const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<HalfEdge>& edges, double flat_m) {
  return FaceFinder(triangles, vertices, edges, flat_m).find();
}

/// Sets TreeNode::within_faces of all nodes.
/// @param within  result of find_within_flat_faces(), in the tree's order of triangles
/// @param nodes   children must come after their parents
void mark_flat_faces(const std::vector<bool>& within, std::vector<TreeNode>& nodes) {
  for (std::size_t n = nodes.size(); n-- > 0;) {
    TreeNode& node = nodes[n];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      bool is_within = true;
      if (node.count[i] == 0) {
        const TreeNode& child = nodes[node.first[i]];
        is_within = child.within_faces == (1U << child.child_count) - 1U;
      }
      for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t)
        is_within = is_within && within[t];
      if (is_within) node.within_faces |= 1U << i;
    }
  }
}

/// Axis-aligned bounds in float, m; empty by default.
struct FloatBounds {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array3f high = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());
  void extend(const Eigen::Array3f& p) {
    low = low.min(p);
    high = high.max(p);
  }
  void extend(const FloatBounds& b) {
    low = low.min(b.low);
    high = high.max(b.high);
  }
  [[nodiscard]] float area() const {
    const Eigen::Array3f s = high - low;
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
  }
};

/// Returns the bounds of a triangle's vertices, without a margin for rounding.
FloatBounds bounds_of(const Triangle& triangle, const std::vector<Eigen::Vector3f>& vertices) {
  FloatBounds b;
  for (const std::uint32_t v : triangle) b.extend(vertices[v].array());
  return b;
}

/// Frame of the nodes' boxes: boxes are relative to `centre` and enlarged by rounding_m on all sides.
struct NodeFrame {
  Eigen::Array3f centre;  // m
  float rounding_m;
};

constexpr std::uint32_t kLeafTriangles = 2;  // spatial: fewer pair tests than with 4, fewer boxes than with 1
constexpr std::uint32_t kRunTriangles = 4;   // in order: a quarter of the boxes to build

/// Writes boxes into nodes, relative to a centre and enlarged by the rounding.
struct NodeWriter : NodeFrame {
  void put(TreeNode& node, std::uint32_t place, const FloatBounds& b, std::uint32_t first,
           std::uint32_t count) const {
    const Eigen::Array3f middle = 0.5F * (b.low + b.high);
    const Eigen::Array3f half = (b.high - middle).max(middle - b.low) + rounding_m;
    const Eigen::Array3f at = middle - centre;
    node.centre_x[place] = at.x();
    node.centre_y[place] = at.y();
    node.centre_z[place] = at.z();
    node.half_x[place] = half.x();
    node.half_y[place] = half.y();
    node.half_z[place] = half.z();
    node.first[place] = first;
    node.count[place] = count;
  }
  static void close(TreeNode& node, std::uint32_t child_count) {
    node.child_count = child_count;
    for (std::uint32_t i = child_count; i < TreeNode::kWidth; ++i) {
      for (auto* row :
           {&node.centre_x, &node.centre_y, &node.centre_z, &node.half_x, &node.half_y, &node.half_z}) {
        (*row)[i] = (*row)[0];
      }
      node.first[i] = node.first[0];
      node.count[i] = node.count[0];
    }
  }
};

/// Splits by the surface area heuristic over bins of centroids, eight ways per node. Source: Wald, On fast
/// Construction of SAH-based Bounding Volume Hierarchies, RT 2007; Wald, Benthin, Boulos, Getting Rid of
/// Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs, RT 2008.
class SurfaceAreaBuilder {
 public:
  SurfaceAreaBuilder(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
                     const NodeWriter& writer, std::vector<TreeNode>& nodes)
      : writer_(writer), nodes_(nodes), items_(triangles.size()) {
    for (std::size_t i = 0; i < triangles.size(); ++i)
      items_[i] = {bounds_of(triangles[i], vertices), static_cast<std::uint32_t>(i)};
    nodes_.reserve(triangles.size() / kTrianglesANode);
  }

  std::vector<std::uint32_t> build() {
    build_node({0, static_cast<std::uint32_t>(items_.size()), {}});
    std::vector<std::uint32_t> order(items_.size());
    std::transform(items_.begin(), items_.end(), order.begin(),
                   [](const Item& item) { return item.triangle; });
    return order;
  }

 private:
  static constexpr std::size_t kTrianglesANode = 4;  // most meshes have 6 and more
  struct Item {
    FloatBounds box;
    std::uint32_t triangle;

    [[nodiscard]] Eigen::Array3f middle() const { return 0.5F * box.low + 0.5F * box.high; }
  };
  struct Range {
    std::uint32_t first, last;
    FloatBounds box;  ///< of the items; the root's is not needed
    [[nodiscard]] std::uint32_t size() const { return last - first; }
  };
  const NodeWriter& writer_;
  std::vector<TreeNode>& nodes_;
  std::vector<Item> items_;  ///< each node's are consecutive

  [[nodiscard]] Range range_of(std::uint32_t first, std::uint32_t last) const {
    Range range{first, last, {}};
    for (std::uint32_t i = first; i < last; ++i) range.box.extend(items_[i].box);
    return range;
  }

  [[nodiscard]] std::pair<Range, Range> halves_of(const Range& range) const {
    const std::uint32_t half = range.first + range.size() / 2;
    return {range_of(range.first, half), range_of(half, range.last)};
  }

  std::pair<Range, Range> split(const Range& range) {
    FloatBounds middles;
    for (std::uint32_t i = range.first; i < range.last; ++i) middles.extend(items_[i].middle());
    Eigen::Index axis = 0;
    const float size = (middles.high - middles.low).maxCoeff(&axis);
    constexpr int kBins = 16;
    const float scale = static_cast<float>(kBins) / size;
    if (!(size > 0.0F) || !std::isfinite(size) || !std::isfinite(scale))
      return halves_of(range);  // one place
    const float low = middles.low[axis];
    const auto bin_of = [&](const Item& item) {
      const float middle = 0.5F * item.box.low[axis] + 0.5F * item.box.high[axis];
      return std::min(kBins - 1, static_cast<int>((middle - low) * scale));
    };
    std::array<FloatBounds, kBins> bins;
    std::array<std::uint32_t, kBins> counts{};
    for (std::uint32_t i = range.first; i < range.last; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(items_[i]));
      bins[bin].extend(items_[i].box);
      ++counts[bin];
    }
    std::array<FloatBounds, kBins> above;  // of the bins from this one on
    std::array<float, kBins> cost_above{};
    std::uint32_t count = 0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      above[i] = bins[i];
      if (i + 1 < kBins) above[i].extend(above[i + 1]);
      count += counts[i];
      cost_above[i] = count == 0 ? 0.0F : above[i].area() * static_cast<float>(count);
    }
    FloatBounds below, best_below;
    count = 0;
    float best = std::numeric_limits<float>::infinity();
    std::size_t best_bin = 0;
    std::uint32_t best_count = 0;
    for (std::size_t i = 1; i < kBins; ++i) {
      below.extend(bins[i - 1]);
      count += counts[i - 1];
      if (count == 0 || count == range.size()) continue;
      const float cost = below.area() * static_cast<float>(count) + cost_above[i];
      if (cost < best) best = cost, best_bin = i, best_below = below, best_count = count;
    }
    if (best_bin == 0) return halves_of(range);
    std::partition(items_.begin() + range.first, items_.begin() + range.last,
                   [&](const Item& item) { return bin_of(item) < static_cast<int>(best_bin); });
    const std::uint32_t middle = range.first + best_count;
    return {{range.first, middle, best_below}, {middle, range.last, above[best_bin]}};
  }

  std::uint32_t build_node(const Range& range) {
    std::array<Range, TreeNode::kWidth> parts{range};
    std::uint32_t part_count = 1;
    if (range.size() <= kLeafTriangles) parts[0] = range_of(range.first, range.last);  // only the root
    while (part_count < TreeNode::kWidth) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + part_count,
                           [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() <= kLeafTriangles) break;
      std::tie(*largest, parts[part_count]) = split(*largest);
      ++part_count;
    }
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    for (std::uint32_t i = 0; i < part_count; ++i) {
      const bool is_leaf = parts[i].size() <= kLeafTriangles;
      const std::uint32_t first = is_leaf ? parts[i].first : build_node(parts[i]);
      writer_.put(nodes_[place], i, parts[i].box, first, is_leaf ? parts[i].size() : 0);
    }
    NodeWriter::close(nodes_[place], part_count);
    return place;
  }
};

/// Builds nodes with the surface area heuristic; see TriangleTree::build_by_place().
/// @param[out] nodes  the root is first, and children come after their parents
/// @return indices of the triangles, in the order in which the leaves refer to them
std::vector<std::uint32_t> build_nodes_by_place(const std::vector<Triangle>& triangles,
                                                const std::vector<Eigen::Vector3f>& vertices,
                                                const NodeFrame& frame, std::vector<TreeNode>& nodes) {
  const NodeWriter writer{frame};
  return SurfaceAreaBuilder(triangles, vertices, writer, nodes).build();
}

/// Builds nodes over runs of eight leaves, then over runs of eight nodes, and so on; the root is first.
/// Builds nodes over ranges of consecutive triangles; see TriangleTree::build_in_order(). Reuses the memory
/// of `nodes`.
void build_nodes_in_order(const std::vector<Triangle>& triangles,
                          const std::vector<Eigen::Vector3f>& vertices, const NodeFrame& frame,
                          std::vector<TreeNode>& nodes) {
  const NodeWriter writer{frame};
  const auto triangle_count = static_cast<std::uint32_t>(triangles.size());
  constexpr std::uint32_t kWidth = TreeNode::kWidth;
  // Number of nodes per level, leaves' parents first; the root's level has one.
  std::array<std::uint32_t, 16> level_sizes{};
  std::size_t level_count = 0;
  for (std::uint32_t n = (triangle_count + kRunTriangles - 1) / kRunTriangles; level_count == 0 || n > 1;) {
    n = (n + kWidth - 1) / kWidth;
    level_sizes[level_count++] = n;
  }
  std::uint32_t node_count = 0;
  std::array<std::uint32_t, 16> level_first{};
  for (std::size_t level = level_count; level-- > 0;) {
    level_first[level] = node_count;
    node_count += level_sizes[level];
  }
  nodes.resize(node_count);

  const auto bounds_of_node = [&](const TreeNode& node) {
    FloatBounds b;
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const Eigen::Array3f c(node.centre_x[i], node.centre_y[i], node.centre_z[i]);
      const Eigen::Array3f h(node.half_x[i], node.half_y[i], node.half_z[i]);
      b.extend(Eigen::Array3f(c + writer.centre - h));
      b.extend(Eigen::Array3f(c + writer.centre + h));
    }
    return b;
  };
  for (std::size_t level = 0; level < level_count; ++level) {
    const std::uint32_t below =
        level == 0 ? (triangle_count + kRunTriangles - 1) / kRunTriangles : level_sizes[level - 1];
    for (std::uint32_t n = 0; n < level_sizes[level]; ++n) {
      TreeNode& node = nodes[level_first[level] + n];
      const std::uint32_t first_child = n * kWidth;
      const std::uint32_t child_count = std::min(kWidth, below - first_child);
      for (std::uint32_t i = 0; i < child_count; ++i) {
        if (level == 0) {
          const std::uint32_t first = (first_child + i) * kRunTriangles;
          const std::uint32_t count = std::min(kRunTriangles, triangle_count - first);
          FloatBounds b;
          for (std::uint32_t t = first; t < first + count; ++t) b.extend(bounds_of(triangles[t], vertices));
          writer.put(node, i, b, first, count);
        } else {
          const std::uint32_t child = level_first[level - 1] + first_child + i;
          writer.put(node, i, bounds_of_node(nodes[child]), child, 0);
        }
      }
      NodeWriter::close(node, child_count);
    }
  }
}

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
