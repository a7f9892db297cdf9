// radar_scene.hpp: surfaces that can be touched, given as meshes with trees or as depth images.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A mesh with a pose in the world. Does not own the tree, which must outlive it.
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

/// The surface through a depth image's pixels, triangulated only where a volume projects into the image. Does
/// not own the images.
///
/// Vertices: every stride-th pixel of every stride-th row that is measured (depth finite and > 0; mask, if
/// given, not 0), back_project()ed and rounded to float in the camera frame. Each cell of the grid has
/// corners a (top left), b (top right), c (bottom left) and d (bottom right). Its triangles are a, c, d and
/// a, d, b, counter-clockwise seen from the camera. A triangle exists if its corners' depths differ by at
/// most max_jump_m + max_jump_slope * (least depth).
struct SceneDepth {
  const DepthImage* depth_m = nullptr;
  const MaskImage* mask = nullptr;  ///< same size as depth_m; null: all pixels
  Intrinsics camera;                ///< only focal lengths and principal point are used, in depth_m's pixels
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int stride_px = 1;
  float max_jump_m = 0.05F;
  float max_jump_slope = 0.0F;
  SurfaceKind kind = SurfaceKind::kDynamic;
};

class SceneBoxes;

/// Instances with a null or empty mesh, and images that are null or empty, are skipped.
struct RadarScene {
  std::span<const SceneTree> trees;
  std::span<const SceneDepth> depths;
  /// Built from these trees at their present poses, so a query visits only the trees near it; null: visits
  /// all. Pays from some tens of trees on, if many queries share it.
  const SceneBoxes* boxes = nullptr;
};

}  // namespace roomradar
