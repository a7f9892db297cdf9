// triangle_tree.cpp: build boxes over triangles, by place or in the order they come.
#include "radar/triangle_tree.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kLeafTriangles =
    2;  // by place: fewer pairs are settled than with 4, fewer boxes than with 1
constexpr std::uint32_t kRunTriangles = 4;  // in order: built in a quarter of the boxes

struct Bounds {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array3f high = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());
  void extend(const Eigen::Array3f& p) {
    low = low.min(p);
    high = high.max(p);
  }
  void extend(const Bounds& b) {
    low = low.min(b.low);
    high = high.max(b.high);
  }
  [[nodiscard]] float area() const {
    const Eigen::Array3f s = high - low;
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
  }
};

Bounds bounds_of(const Triangle& triangle, const std::vector<Eigen::Vector3f>& vertices) {
  Bounds b;
  for (const std::uint32_t v : triangle) b.extend(vertices[v].array());
  return b;
}

/// Writes boxes into nodes, relative to a centre, widened by what rounding may have taken.
struct NodeWriter {
  Eigen::Array3f centre;
  float rounding_m;

  void put(TreeNode& node, std::uint32_t place, const Bounds& b, std::uint32_t first,
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

/// Splits by the surface area heuristic over bins of centroids, eight ways a node.
/// Source: Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, RT 2007; Wald, Benthin,
/// Boulos, Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs, RT 2008.
class PlaceBuilder {
 public:
  PlaceBuilder(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
               const NodeWriter& writer, std::vector<TreeNode>& nodes)
      : writer_(writer), nodes_(nodes), order_(triangles.size()), bounds_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    for (std::size_t i = 0; i < triangles.size(); ++i) bounds_[i] = bounds_of(triangles[i], vertices);
  }

  std::vector<std::uint32_t> build() {
    build_node({0, static_cast<std::uint32_t>(order_.size())});
    return std::move(order_);
  }

 private:
  struct Range {
    std::uint32_t first, last;
    [[nodiscard]] std::uint32_t size() const { return last - first; }
  };
  const NodeWriter& writer_;
  std::vector<TreeNode>& nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<Bounds> bounds_;

  [[nodiscard]] Bounds bounds_in(const Range& range) const {
    Bounds b;
    for (std::uint32_t i = range.first; i < range.last; ++i) b.extend(bounds_[order_[i]]);
    return b;
  }
  [[nodiscard]] Eigen::Array3f middle_of(std::uint32_t triangle) const {
    return 0.5F * bounds_[triangle].low + 0.5F * bounds_[triangle].high;
  }

  std::uint32_t split(const Range& range) {
    Bounds middles;
    for (std::uint32_t i = range.first; i < range.last; ++i) middles.extend(middle_of(order_[i]));
    Eigen::Index axis = 0;
    const float size = (middles.high - middles.low).maxCoeff(&axis);
    const std::uint32_t half = range.first + range.size() / 2;
    constexpr int kBins = 16;
    const float scale = static_cast<float>(kBins) / size;
    if (!(size > 0.0F) || !std::isfinite(size) || !std::isfinite(scale)) return half;  // all at one place
    const auto bin_of = [&](std::uint32_t triangle) {
      return std::min(kBins - 1, static_cast<int>((middle_of(triangle)[axis] - middles.low[axis]) * scale));
    };
    std::array<Bounds, kBins> bins;
    std::array<std::uint32_t, kBins> counts{};
    for (std::uint32_t i = range.first; i < range.last; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(order_[i]));
      bins[bin].extend(bounds_[order_[i]]);
      ++counts[bin];
    }
    std::array<float, kBins> cost_above{};
    Bounds above;
    std::uint32_t count = 0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      above.extend(bins[i]);
      count += counts[i];
      cost_above[i] = count == 0 ? 0.0F : above.area() * static_cast<float>(count);
    }
    Bounds below;
    count = 0;
    float best = std::numeric_limits<float>::infinity();
    std::size_t best_bin = 0;
    for (std::size_t i = 1; i < kBins; ++i) {
      below.extend(bins[i - 1]);
      count += counts[i - 1];
      if (count == 0 || count == range.size()) continue;
      const float cost = below.area() * static_cast<float>(count) + cost_above[i];
      if (cost < best) best = cost, best_bin = i;
    }
    if (best_bin == 0) return half;
    const auto middle =
        std::partition(order_.begin() + range.first, order_.begin() + range.last,
                       [&](std::uint32_t triangle) { return bin_of(triangle) < static_cast<int>(best_bin); });
    return static_cast<std::uint32_t>(middle - order_.begin());
  }

  std::uint32_t build_node(const Range& range) {
    std::array<Range, TreeNode::kWidth> parts{range};
    std::uint32_t part_count = 1;
    while (part_count < TreeNode::kWidth) {
      const auto largest =
          std::max_element(parts.begin(), parts.begin() + part_count,
                           [](const Range& a, const Range& b) { return a.size() < b.size(); });
      if (largest->size() <= kLeafTriangles) break;
      const std::uint32_t at = split(*largest);
      parts[part_count++] = {at, largest->last};
      largest->last = at;
    }
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    for (std::uint32_t i = 0; i < part_count; ++i) {
      const bool is_leaf = parts[i].size() <= kLeafTriangles;
      const Bounds bounds = bounds_in(parts[i]);
      const std::uint32_t first = is_leaf ? parts[i].first : build_node(parts[i]);
      writer_.put(nodes_[place], i, bounds, first, is_leaf ? parts[i].size() : 0);
    }
    NodeWriter::close(nodes_[place], part_count);
    return place;
  }
};

/// Nodes over runs of eight leaves, then over runs of eight nodes, and so on; the root first.
void build_runs(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
                const NodeWriter& writer, std::vector<TreeNode>& nodes) {
  const auto triangle_count = static_cast<std::uint32_t>(triangles.size());
  constexpr std::uint32_t kWidth = TreeNode::kWidth;
  // Nodes of each level, the leaves' level first; the root's level has one.
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
    Bounds b;
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
          Bounds b;
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

/// See TriangleTree::is_closed().
bool encloses_a_volume(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices) {
  // Vertices at one place get one number.
  std::vector<std::uint32_t> by_place(vertices.size());
  std::iota(by_place.begin(), by_place.end(), 0U);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::lexicographical_compare(vertices[a].data(), vertices[a].data() + 3, vertices[b].data(),
                                        vertices[b].data() + 3);
  };
  std::erase_if(by_place, [&](std::uint32_t v) { return !vertices[v].allFinite(); });
  std::sort(by_place.begin(), by_place.end(), before);
  std::vector<std::uint32_t> number(vertices.size(), 0);
  for (std::size_t i = 1; i < by_place.size(); ++i) {
    number[by_place[i]] = number[by_place[i - 1]] + (before(by_place[i - 1], by_place[i]) ? 1U : 0U);
  }
  // Parts that share no vertex are judged one by one: one that is inside out must not hide behind a larger
  // one.
  std::vector<std::uint32_t> part(vertices.size());
  std::iota(part.begin(), part.end(), 0U);
  const auto part_of = [&](std::uint32_t v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  for (const Triangle& t : triangles) {
    part[part_of(number[t[0]])] = part_of(number[t[1]]);
    part[part_of(number[t[1]])] = part_of(number[t[2]]);
  }
  // An edge counts +1 in one sense and -1 in the other.
  std::vector<std::pair<std::uint64_t, int>> edges;
  edges.reserve(triangles.size() * 3);
  std::vector<double> volume_m3(vertices.size(), 0.0);
  const Eigen::Vector3d about = vertices[triangles[0][0]].cast<double>();
  for (const Triangle& t : triangles) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = vertices[t[i]].cast<double>() - about;
      const std::uint64_t a = number[t[i]], b = number[t[(i + 1) % 3]];
      if (a != b) edges.emplace_back(std::min(a, b) << 32U | std::max(a, b), a < b ? 1 : -1);
    }
    volume_m3[part_of(number[t[0]])] += p[0].dot(p[1].cross(p[2]));
  }
  std::sort(edges.begin(), edges.end());
  int balance = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    balance += edges[i].second;
    if (i + 1 < edges.size() && edges[i + 1].first == edges[i].first) continue;
    if (balance != 0) return false;
  }
  bool encloses = false;
  for (const Triangle& t : triangles) {
    const std::uint32_t a = number[t[0]], b = number[t[1]], c = number[t[2]];
    if (a == b || b == c || c == a) continue;  // a point or a line bounds nothing
    if (!(volume_m3[part_of(number[t[0]])] > 0.0)) return false;
    encloses = true;
  }
  return encloses;
}

std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

/// Copies what is usable and sets everything but the nodes.
void TriangleTree::take(const Mesh& mesh) {
  origin_ = mesh.origin;
  vertices_ = mesh.vertices;
  triangles_.clear();
  triangles_.reserve(mesh.triangles.size());
  nodes_.clear();
  is_closed_ = false;
  revision_ = next_revision();
  Bounds all;
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
  // Three roundings of at most half a step of the largest number at hand, doubled.
  const float reach_m = std::max(all.low.abs().maxCoeff(), all.high.abs().maxCoeff());
  rounding_m_ = 6.0F * std::numeric_limits<float>::epsilon() * reach_m + std::numeric_limits<float>::min();
  centre_ = centre.matrix().cast<double>();
  half_size_ = ((all.high - centre).max(centre - all.low) + rounding_m_).matrix();
}

void TriangleTree::build_by_place(const Mesh& mesh) {
  take(mesh);
  if (triangles_.empty()) return;
  const NodeWriter writer{centre_.cast<float>().array(), rounding_m_};
  const std::vector<std::uint32_t> order = PlaceBuilder(triangles_, vertices_, writer, nodes_).build();
  std::vector<Triangle> sorted(triangles_.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = triangles_[order[i]];
  triangles_ = std::move(sorted);
  is_closed_ = encloses_a_volume(triangles_, vertices_);
}

void TriangleTree::build_in_order(const Mesh& mesh) {
  take(mesh);
  if (triangles_.empty()) return;
  build_runs(triangles_, vertices_, {centre_.cast<float>().array(), rounding_m_}, nodes_);
}

}  // namespace roomradar
