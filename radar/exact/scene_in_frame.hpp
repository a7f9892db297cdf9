// scene_in_frame.hpp: the scene in the frame of a motion (z is the direction of motion), subdivided on
// demand; priority queue of its items that are left to examine.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "radar/exact/depth_blocks.hpp"
#include "radar/exact/object_height_map.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// A part of the scene, and a lower bound of its distance to contact. SceneInFrame::expand() subdivides it.
struct SceneItem {
  enum class Kind : std::uint32_t {
    /// Node of a triangle tree.
    kNode,
    /// Leaf with `count` triangles of a triangle tree.
    kLeaf,
    /// Block of a depth image.
    kBlock,
    /// Triangle of a tree or a depth image; low_m is computed from its box.
    kTriangle,
    /// Triangle whose low_m is computed from its plane in each pixel, or whose box is within one pixel.
    kBounded
  };
  /// Lower bound of the distance to contact, m.
  float low_m;
  Kind kind;
  /// Index of the tree. For a depth image: number of trees + index of the image.
  std::uint32_t source;
  /// Index of the first node, triangle or block, and number of triangles (kLeaf only).
  std::uint32_t first, count;

  [[nodiscard]] bool is_triangle() const { return kind == Kind::kTriangle || kind == Kind::kBounded; }
};

/// Computes lower bounds of the distance to contact. A box's bound is the box's least height minus the
/// object's greatest height under the box. The bound holds for all surfaces in the box, since ObjectHeightMap
/// is an upper bound over the whole area of each pixel.
struct SceneBound {
  /// Height map of the object.
  const ObjectHeightMap* front = nullptr;
  /// Scene boxes wholly below this height are ignored, m.
  float behind_m = 0.0F;
  [[nodiscard]] float low_m(const FrameBox& box) const {
    if (box.z1 < behind_m) return std::numeric_limits<float>::infinity();
    return box.z0 - front->max_under(box.x0, box.x1, box.y0, box.y1);
  }
  /// Returns a tighter bound for a triangle, computed from its plane instead of its box.
  [[nodiscard]] float low_m(const FrameTriangle& triangle) const { return front->least_gap_under(triangle); }
  [[nodiscard]] bool is_within_a_pixel(const FrameBox& box) const {
    return std::max(box.x1 - box.x0, box.y1 - box.y0) < static_cast<float>(front->pixel_m());
  }
};

/// Expands a scene's trees and depth images into smaller and smaller parts, on demand.
class SceneInFrame {
 public:
  /// Sets the scene and the frame. The scene must not change while this object is used.
  /// @param own_tree  index in scene.trees of a tree to skip
  /// @return false if a pose is not finite or a depth image is unusable (invalid camera, mask size, stride or
  ///         jump limits)
  bool place(const RadarScene& scene, std::size_t own_tree, const Eigen::Matrix3d& R_frame_world,
             const Eigen::Vector3d& origin_world);
  /// Finds the trees whose bounding spheres intersect the volume, and in each depth image the rectangle into
  /// which the volume projects.
  void enter(const Eigen::AlignedBox3d& volume);
  /// Returns the number of depth image cells that may be in the volume.
  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] bool has_trees() const { return !trees_.empty(); }
  /// Appends those nodes of trees and blocks of depth images in the volume that can be nearer than limit_m.
  /// Call after enter() and before expand(). Items of earlier calls become invalid.
  void begin(const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);
  /// Subdivides an item, and appends those of its parts that can be nearer than limit_m. The item must not be
  /// a triangle.
  void expand(const SceneItem& item, const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);

  [[nodiscard]] FrameTriangle triangle(const SceneItem& item) const;
  [[nodiscard]] SurfaceKind kind(const SceneItem& item) const;

 private:
  struct TreeView {
    const SceneTree* scene;
    Eigen::Matrix3d R_frame_mesh;
    // Position of the tree's centre, in the frame, m.
    Eigen::Vector3d t_frame_centre;
    /// Max rounding error of a coordinate, m.
    float slack_m;
  };
  Eigen::Matrix3d R_frame_world_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();
  RadarScene scene_;
  std::size_t own_tree_ = 0;
  // Trees that may intersect the volume.
  std::vector<TreeView> trees_;
  std::vector<DepthView> views_;
  std::vector<DepthBlock> blocks_;
  std::vector<DepthTriangle> triangles_;
  std::vector<float> scratch_;

  void begin_tree(const SceneTree& tree, const Eigen::AlignedBox3d& volume);
  [[nodiscard]] FrameTriangle tree_triangle(const TreeView& view, std::uint32_t triangle) const;
};

/// A binary heap of scene items. The item with the least SceneItem::low_m is popped first. Keeps its memory
/// when cleared.
class SceneQueue {
 public:
  void clear() { items_.clear(); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// Returns the items, for appending many at once. A call of arrange() must follow.
  [[nodiscard]] std::vector<SceneItem>& items() { return items_; }
  /// Restores the heap order.
  void arrange() { std::make_heap(items_.begin(), items_.end(), is_farther); }

  /// Returns the item with the least bound. Requires at least one item.
  [[nodiscard]] const SceneItem& least() const { return items_.front(); }
  SceneItem pop() {
    std::pop_heap(items_.begin(), items_.end(), is_farther);
    const SceneItem item = items_.back();
    items_.pop_back();
    return item;
  }
  void push(const SceneItem& item) {
    items_.push_back(item);
    std::push_heap(items_.begin(), items_.end(), is_farther);
  }
  /// Removes all items with a negative bound, since these may be behind the object's leading surface.
  void drop_below_zero() {
    std::erase_if(items_, [](const SceneItem& item) { return item.low_m < 0.0F; });
    arrange();
  }

 private:
  static bool is_farther(const SceneItem& a, const SceneItem& b) { return a.low_m > b.low_m; }
  std::vector<SceneItem> items_;
};

}  // namespace roomradar
