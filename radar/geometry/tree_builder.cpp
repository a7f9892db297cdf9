// tree_builder.cpp: surface area heuristic over bins of centroids, and runs of consecutive triangles.
#include "radar/geometry/tree_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace roomradar {
namespace {

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

}  // namespace

FloatBounds bounds_of(const Triangle& triangle, const std::vector<Eigen::Vector3f>& vertices) {
  FloatBounds b;
  for (const std::uint32_t v : triangle) b.extend(vertices[v].array());
  return b;
}

std::vector<std::uint32_t> build_nodes_by_place(const std::vector<Triangle>& triangles,
                                                const std::vector<Eigen::Vector3f>& vertices,
                                                const NodeFrame& frame, std::vector<TreeNode>& nodes) {
  const NodeWriter writer{frame};
  return SurfaceAreaBuilder(triangles, vertices, writer, nodes).build();
}

/// Builds nodes over runs of eight leaves, then over runs of eight nodes, and so on; the root is first.
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

}  // namespace roomradar
