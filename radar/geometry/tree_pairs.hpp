// tree_pairs.hpp: simultaneous traversal of two triangle trees, down to pairs of leaves.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_gap.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Box of a node of one of the two trees, in the common frame of the TreePair, m.
struct PairBox {
  Eigen::Vector3f centre, half;
  std::uint32_t first, count;  ///< as in TreeNode; count 0 means an inner node
  bool is_within_faces;        ///< true if all triangles in the box lie within flat faces (TriangleTree)
};
struct PendingPair {
  PairBox object, scene;
};
/// Order in which pairs of boxes are visited.
enum class PairOrder {
  kAny,  ///< last in, first out: keeps the number of pending pairs small
  /// Smallest key first. Once a leaf has lowered the bound, pairs with keys above the bound are never opened.
  kLeastFirst,
};

/// Pairs of boxes still to be visited: scratch memory of visit_pairs().
struct PendingPairs {
  /// Entry of the queue, which may be a heap. Small, because a heap moves its entries often.
  struct Entry {
    float key;
    std::uint32_t pair;  ///< index into `pairs`
  };
  std::vector<Entry> queue;
  std::vector<PendingPair> pairs;
  std::vector<std::uint32_t> unused;  ///< indices into `pairs`

  void clear() {
    queue.clear();
    pairs.clear();
    unused.clear();
  }
  /// Adds a pair.
  template <PairOrder order>
  void push(float key, const PairBox& object, const PairBox& scene) {
    auto place = static_cast<std::uint32_t>(pairs.size());
    if (unused.empty()) {
      pairs.push_back({object, scene});
    } else {
      place = unused.back();
      unused.pop_back();
      pairs[place] = {object, scene};
    }
    queue.push_back({key, place});
    if constexpr (order == PairOrder::kLeastFirst) std::push_heap(queue.begin(), queue.end(), is_later);
  }
  /// Removes the next entry of the queue, which must not be empty. Its pair stays until take().
  template <PairOrder order>
  Entry pop() {
    if constexpr (order == PairOrder::kLeastFirst) std::pop_heap(queue.begin(), queue.end(), is_later);
    const Entry next = queue.back();
    queue.pop_back();
    return next;
  }
  /// Removes and returns the pair of an entry.
  PendingPair take(const Entry& entry) {
    unused.push_back(entry.pair);
    return pairs[entry.pair];
  }

 private:
  static constexpr auto is_later = [](const Entry& a, const Entry& b) { return a.key > b.key; };
};

inline constexpr std::size_t kLeafTriangles = 4;  // max triangles per leaf of a TriangleTree

inline bool is_usable(const TreeInstance& instance) {
  return instance.tree != nullptr && !instance.tree->empty() && instance.T_world_mesh.matrix().allFinite();
}

/// Returns true if the bounding spheres of the two trees, and thus the trees, are farther apart than
/// `than_m`.
inline bool are_farther_apart(const TreeInstance& one, const TreeInstance& other, double than_m) {
  constexpr double kRounding = 1.0 + 1e-5;  // covers the rounding of half_size() to float
  const auto middle_world = [](const TreeInstance& instance) -> Eigen::Vector3d {
    return instance.T_world_mesh * (instance.tree->origin() + instance.tree->centre());
  };
  const auto radius_m = [](const TreeInstance& instance) {
    return kRounding * instance.tree->half_size().cast<double>().norm();
  };
  const double reached_m = radius_m(one) + radius_m(other) + than_m;
  return (middle_world(one) - middle_world(other)).squaredNorm() > reached_m * reached_m;
}

/// Direct-mapped cache of the triangles of recently visited leaves. Successive pairs often share a leaf.
class LeafTriangles {
 public:
  /// Returns the leaf's triangles; valid until the next call.
  /// @param triangle  callable that returns triangle i of the tree; called only if the leaf is not cached
  template <typename MakeTriangle>
  std::span<const FrameTriangle> of(const PairBox& leaf, const MakeTriangle& triangle) {
    assert(leaf.count <= kLeafTriangles);
    const std::size_t slot = leaf.first / kLeafTriangles % kSlots;
    if (leaf.first != first_[slot] || leaf.count != count_[slot]) {
      first_[slot] = leaf.first;
      count_[slot] = leaf.count;
      for (std::uint32_t i = 0; i < leaf.count; ++i) triangles_[slot][i] = triangle(leaf.first + i);
    }
    return {triangles_[slot].data(), leaf.count};
  }

 private:
  static constexpr std::size_t kSlots = 32;  // 12 KB of triangles
  std::array<std::uint32_t, kSlots> first_{}, count_{};
  std::array<std::array<FrameTriangle, kLeafTriangles>, kSlots> triangles_;
};

/// An object's tree and one of the scene's trees, in a common frame. The frame has the scene mesh's axes, and
/// its origin is the centre of the scene's tree.
class TreePair {
 public:
  const TriangleTree& object;
  const TriangleTree& scene;
  Eigen::Isometry3d T_world_frame;
  /// Transforms points of the object's mesh, relative to the centre of the object's tree, into the common
  /// frame.
  Eigen::Isometry3d T_frame_object;

  TreePair(const TreeInstance& o, const TreeInstance& s)
      : object(*o.tree),
        scene(*s.tree),
        T_world_frame(s.T_world_mesh * Eigen::Translation3d(scene.origin() + scene.centre())),
        T_frame_object(T_world_frame.inverse() * o.T_world_mesh *
                       Eigen::Translation3d(object.origin() + object.centre())) {}

  /// Returns the triangles of a leaf of the object's tree, in the common frame; valid until the next call of
  /// of_object().
  [[nodiscard]] std::span<const FrameTriangle> of_object(const PairBox& leaf) {
    return object_leaf_.of(leaf, [this](std::uint32_t i) { return object_triangle(i); });
  }
  [[nodiscard]] std::span<const FrameTriangle> of_scene(const PairBox& leaf) {
    return scene_leaf_.of(leaf, [this](std::uint32_t i) { return scene_triangle(i); });
  }

 private:
  LeafTriangles object_leaf_, scene_leaf_;

  [[nodiscard]] FrameTriangle object_triangle(std::uint32_t i) const {
    FrameTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& vertex = object.vertices()[object.triangles()[i][k]];
      t.corners[k] = T_frame_object * Eigen::Vector3d(vertex.cast<double>() - object.centre());
    }
    set_normal(t);
    return t;
  }
  [[nodiscard]] FrameTriangle scene_triangle(std::uint32_t i) const {
    FrameTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      t.corners[k] = scene.vertices()[scene.triangles()[i][k]].cast<double>() - scene.centre();
    }
    set_normal(t);
    return t;
  }
};

/// Returns true if the box `leaf` is a leaf and more than twice as large as the box `other`. The leaf's
/// triangles may then bound the distance to `other` more tightly than the leaf's box does.
inline bool are_large_against(const PairBox& leaf, const PairBox& other) {
  return leaf.count > 0 && leaf.half.maxCoeff() > 2.0F * other.half.maxCoeff();
}

/// Returns true if the whole box is behind the triangle's plane.
inline bool is_behind(const FrameTriangle& t, const PairBox& box) {
  constexpr double kTouching_m = 1e-9;
  return t.normal.dot(box.centre.cast<double>() - t.corners[0]) +
             t.normal.cwiseAbs().dot(box.half.cast<double>()) <
         -kTouching_m;
}

/// Calls leaf(object box, scene box) for pairs of leaves. Skips a pair if key(object box, scene box) is
/// infinite for it or for an enclosing pair of boxes. Also skips a pair if both its boxes lie within flat
/// faces (see TriangleTree). Stops when leaf() returns -infinity. With PairOrder::kLeastFirst, also stops
/// once all pending keys are at least the value that leaf() returned last.
template <PairOrder order, typename Key, typename Leaf>
void visit_pairs(const TreePair& trees, PendingPairs& pending, const Key& key, const Leaf& leaf) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const TriangleTree& object = trees.object;
  const TriangleTree& scene = trees.scene;
  // Boxes are enlarged by the rounding error of transforming them in float.
  const Eigen::Matrix3f R = trees.T_frame_object.linear().cast<float>();
  const Eigen::Matrix3f R_abs = R.cwiseAbs();
  const Eigen::Vector3f t = trees.T_frame_object.translation().cast<float>();
  const float slack_m = 16.0F * std::numeric_limits<float>::epsilon() *
                        (t.lpNorm<Eigen::Infinity>() + object.half_size().norm() + scene.half_size().norm());
  const auto push = [&](const PairBox& o, const PairBox& s) {
    if (o.is_within_faces && s.is_within_faces) return;
    const float k = key(o, s);
    if (k < kNone) pending.push<order>(k, o, s);
  };
  pending.clear();
  const Eigen::Vector3f slack = Eigen::Vector3f::Constant(slack_m);
  push({t, R_abs * object.half_size() + slack, 0, 0, false},
       {Eigen::Vector3f::Zero(), scene.half_size() + slack, 0, 0, false});
  float bound = kNone;
  while (!pending.queue.empty()) {
    const PendingPairs::Entry next = pending.pop<order>();
    if (order == PairOrder::kLeastFirst && !(next.key < bound)) return;
    const PendingPair pair = pending.take(next);
    if (pair.object.count > 0 && pair.scene.count > 0) {
      bound = leaf(pair.object, pair.scene);
      if (bound == -kNone) return;
      continue;
    }
    const bool opens_object =
        pair.scene.count > 0 ||
        (pair.object.count == 0 && pair.object.half.maxCoeff() > pair.scene.half.maxCoeff());
    const TreeNode& node = opens_object ? object.nodes()[pair.object.first] : scene.nodes()[pair.scene.first];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      PairBox box{{node.centre_x[i], node.centre_y[i], node.centre_z[i]},
                  {node.half_x[i], node.half_y[i], node.half_z[i]},
                  node.first[i],
                  node.count[i],
                  (node.within_faces >> i & 1U) != 0};
      if (opens_object) {
        box.centre = R * box.centre + t;
        box.half = R_abs * box.half;
      }
      box.half += slack;
      opens_object ? push(box, pair.scene) : push(pair.object, box);
    }
  }
}

}  // namespace roomradar
