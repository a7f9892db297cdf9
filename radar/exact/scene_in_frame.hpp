// scene_in_frame.hpp: the scene in the frame of one motion, subdivided step by step.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/exact/depth_blocks.hpp"
#include "radar/exact/object_height_map.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// A part of the scene that is not examined further yet, and a lower bound of its distance to contact.
struct SceneItem {
  enum class Kind : std::uint32_t {
    kNode,      ///< node of a tree
    kLeaf,      ///< `count` triangles of a tree
    kBlock,     ///< block of a depth image
    kTriangle,  ///< triangle of a tree or depth image; low_m is from its box
    kBounded    ///< triangle; low_m is from its plane in each pixel, or its box is within a pixel
  };
  float low_m;  ///< lower bound of the distance to contact
  Kind kind;
  std::uint32_t source;  ///< index, trees first, then depth images
  std::uint32_t first, count;

  [[nodiscard]] bool is_triangle() const { return kind == Kind::kTriangle || kind == Kind::kBounded; }
};

/// Lower bound of the distance to a box of the scene: its least height minus the object's greatest height
/// under it. It holds for everything in the box, since ObjectHeightMap covers the whole area of each pixel.
struct SceneBound {
  const ObjectHeightMap* front = nullptr;
  float behind_m = 0.0F;  ///< scene wholly below this height is ignored
  [[nodiscard]] float low_m(const FrameBox& box) const {
    if (box.z1 < behind_m) return std::numeric_limits<float>::infinity();
    return box.z0 - front->max_under(box.x0, box.x1, box.y0, box.y1);
  }
  /// Tighter bound for a triangle, from its plane instead of its box.
  [[nodiscard]] float low_m(const FrameTriangle& triangle) const { return front->least_gap_under(triangle); }
  [[nodiscard]] bool is_within_a_pixel(const FrameBox& box) const {
    return std::max(box.x1 - box.x0, box.y1 - box.y0) < static_cast<float>(front->pixel_m());
  }
};

class SceneInFrame {
 public:
  /// The scene must not change while this object is used.
  /// @param own_tree  index in scene.trees of a tree to skip
  /// @return false if a pose is not finite or a depth image is unusable (camera, mask size, stride,
  ///         jump limits)
  bool place(const RadarScene& scene, std::size_t own_tree, const Eigen::Matrix3d& R_frame_world,
             const Eigen::Vector3d& origin_world);
  /// Finds the trees that reach the volume, and the part of each depth image that projects into it.
  void enter(const Eigen::AlignedBox3d& volume);
  /// Number of depth image cells that may be in the volume.
  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] bool has_trees() const { return !trees_.empty(); }
  /// Appends the parts of trees and the blocks that can be nearer than limit_m in the volume. Call after
  /// enter() and before expand(). Items of earlier calls become invalid.
  void begin(const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);
  /// Appends the parts of an item (not a triangle) that can be nearer than limit_m.
  void expand(const SceneItem& item, const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);

  [[nodiscard]] FrameTriangle triangle(const SceneItem& item) const;
  [[nodiscard]] SurfaceKind kind(const SceneItem& item) const;

 private:
  struct TreeView {
    const SceneTree* scene;
    Eigen::Matrix3d R_frame_mesh;
    Eigen::Vector3d t_frame_centre;  // position of the tree's centre
    float slack_m;
  };
  Eigen::Matrix3d R_frame_world_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();
  RadarScene scene_;
  std::size_t own_tree_ = 0;
  std::vector<TreeView> trees_;  // trees that reach the volume
  std::vector<DepthView> views_;
  std::vector<DepthBlock> blocks_;
  std::vector<DepthTriangle> triangles_;
  std::vector<float> scratch_;

  void begin_tree(const SceneTree& tree, const Eigen::AlignedBox3d& volume);
  [[nodiscard]] FrameTriangle tree_triangle(const TreeView& view, std::uint32_t triangle) const;
};

}  // namespace roomradar
