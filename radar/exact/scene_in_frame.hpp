// scene_in_frame.hpp: all that can be touched, placed in the frame of one motion, looked into step by step.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/exact/depth_blocks.hpp"
#include "radar/exact/object_height_map.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Some of the scene that is not looked into yet, and what it cannot be nearer than.
struct SceneItem {
  enum class Kind : std::uint32_t {
    kNode,      ///< of a tree
    kLeaf,      ///< `count` triangles of a tree
    kBlock,     ///< of a depth image
    kTriangle,  ///< one, of a tree or a depth image; low_m is its box's
    kBounded    ///< one whose low_m is its plane's, pixel by pixel, or would be no more by that
  };
  float low_m;  ///< no way to contact is shorter
  Kind kind;
  std::uint32_t source;  ///< trees first, then depth images
  std::uint32_t first, count;

  [[nodiscard]] bool is_triangle() const { return kind == Kind::kTriangle || kind == Kind::kBounded; }
};

/// How near a box of the scene can be: its least height less the greatest of the object under it. Nothing
/// under the box is nearer, since FrontMap holds for the whole area of each pixel.
struct SceneBound {
  const FrontMap* front = nullptr;
  float behind_m = 0.0F;  ///< scene wholly under this height does not matter
  [[nodiscard]] float low_m(const FrameBox& box) const {
    if (box.z1 < behind_m) return std::numeric_limits<float>::infinity();
    return box.z0 - front->max_under(box.x0, box.x1, box.y0, box.y1);
  }
  /// The same for a triangle, finer: its plane instead of its box.
  [[nodiscard]] float low_m(const FrameTriangle& triangle) const { return front->least_gap_under(triangle); }
  [[nodiscard]] bool is_within_a_pixel(const FrameBox& box) const {
    return std::max(box.x1 - box.x0, box.y1 - box.y0) < static_cast<float>(front->pixel_m());
  }
};

class SceneInFrame {
 public:
  /// The scene must stay while this is used.
  /// @param own_tree  which of scene.trees is left out
  /// @return false if a pose is not finite or a camera cannot be one; then nothing is placed
  bool place(const RadarScene& scene, std::size_t own_tree, const Eigen::Matrix3d& R_frame_world,
             const Eigen::Vector3d& origin_world);
  /// Finds what reaches the volume: trees, and the part of each depth image that projects into it.
  void enter(const Eigen::AlignedBox3d& volume);
  /// Cells of the depth images' grids that may be in the volume.
  [[nodiscard]] std::size_t cell_count() const;
  [[nodiscard]] bool has_trees() const { return !trees_.empty(); }
  /// Appends what can be nearer than limit_m in the volume, whole trees and blocks; items from before are not
  /// to be used any more. After enter(), before expand().
  void begin(const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);
  /// Appends those parts of an item (not a triangle) that can be nearer than limit_m.
  void expand(const SceneItem& item, const SceneBound& bound, float limit_m, std::vector<SceneItem>& items);

  [[nodiscard]] FrameTriangle triangle(const SceneItem& item) const;
  [[nodiscard]] Touched kind(const SceneItem& item) const;

 private:
  struct TreeView {
    const SceneTree* scene;
    Eigen::Matrix3d R_frame_mesh;
    Eigen::Vector3d t_frame_centre;  // of a point relative to the tree's centre
    float slack_m;
  };
  Eigen::Matrix3d R_frame_world_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();
  RadarScene scene_;
  std::size_t own_tree_ = 0;
  std::vector<TreeView> trees_;  // of those that reach the volume
  std::vector<DepthView> views_;
  std::vector<DepthBlock> blocks_;
  std::vector<DepthTriangle> triangles_;
  std::vector<float> scratch_;

  void begin_tree(const SceneTree& tree, const Eigen::AlignedBox3d& volume);
  [[nodiscard]] FrameTriangle tree_triangle(const TreeView& view, std::uint32_t triangle) const;
};

}  // namespace roomradar
