// radar_scene.hpp: a scene of triangle trees with poses and of depth images.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A triangle tree with a pose in the world. Does not own the tree, which must outlive the instance.
struct TreeInstance {
  const TriangleTree* tree = nullptr;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

struct SceneTree {
  TreeInstance instance;
  SurfaceKind kind = SurfaceKind::kStatic;
};
inline bool has_surface(const SceneTree& s) {
  return s.instance.tree != nullptr && !s.instance.tree->empty();
}

/// Surface of a depth image, triangulated only inside the query's volume. Does not own the images.
///
/// Vertices are the measured pixels of every stride_px-th row and column. A pixel is measured if its depth is
/// finite and > 0 and, if a mask is given, its mask is not 0. Each vertex is back-projected (back_project())
/// and rounded to float in the camera frame. Each cell of the grid has corners a (top left), b (top right), c
/// (bottom left) and d (bottom right). Its triangles are a, c, d and a, d, b, counter-clockwise seen from the
/// camera. A triangle exists if its vertices' depths differ by at most max_jump_m + max_jump_slope *
/// (smallest of the three depths).
struct SceneDepth {
  const DepthImage* depth_m = nullptr;
  const MaskImage* mask = nullptr;  ///< same size as depth_m; null: no pixel is masked out
  /// Only focal lengths and principal point are used, in pixels of depth_m.
  Intrinsics camera;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int stride_px = 1;
  float max_jump_m = 0.05F;
  float max_jump_slope = 0.0F;
  SurfaceKind kind = SurfaceKind::kDynamic;
};

class SceneBoxes;

/// All surfaces of a query. Instances with a null or empty tree, and images that are null or empty, are
/// skipped.
struct RadarScene {
  std::span<const SceneTree> trees;
  std::span<const SceneDepth> depths;
  /// Optional hierarchy of the bounding boxes of `trees` at their present poses. A query then visits only the
  /// trees near its volume. Null: a query visits all trees. The hierarchy saves time if many queries share it
  /// and the scene has more than a few tens of trees.
  const SceneBoxes* boxes = nullptr;
};

}  // namespace roomradar
