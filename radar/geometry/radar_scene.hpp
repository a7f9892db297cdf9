// radar_scene.hpp: what can be touched: meshes under a tree, and depth images that need no mesh.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A mesh somewhere in the world. The tree is not owned and must stay while this is used.
struct TreeInstance {
  const TriangleTree* tree = nullptr;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

struct SceneTree {
  TreeInstance instance;
  Touched kind = Touched::kStatic;
};
inline bool has_surface(const SceneTree& s) {
  return s.instance.tree != nullptr && !s.instance.tree->empty();
}

/// The surface through a depth image's pixels, never meshed as a whole: only where a volume projects into the
/// image. Images are not owned.
///
/// Vertices: every stride-th pixel of every stride-th row that is measured (depth finite and > 0; mask, where
/// given, not 0), back_project()ed and rounded to float in the camera frame. Of each cell of the grid (a top
/// left, b top right, c bottom left, d bottom right) the triangles a, c, d and a, d, b, counter-clockwise
/// seen from the camera, each where its corners' depths differ by at most max_jump_m + max_jump_slope * the
/// least of them.
struct SceneDepth {
  const DepthImage* depth_m = nullptr;
  const MaskImage* mask = nullptr;  ///< same size as depth_m; null: all pixels
  Intrinsics camera;                ///< its focal lengths and principal point are used, in depth_m's pixels
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  int stride_px = 1;
  float max_jump_m = 0.05F;
  float max_jump_slope = 0.0F;
  Touched kind = Touched::kDynamic;
};

class SceneBoxes;

/// Instances with a null or empty mesh, and images that are null or empty, are left out.
struct RadarScene {
  std::span<const SceneTree> trees;
  std::span<const SceneDepth> depths;
  /// Built of these trees as they stand now, so that a query asks only those near it; null: asks all. Pays
  /// from some tens of trees on, where many queries share it.
  const SceneBoxes* boxes = nullptr;
};

}  // namespace roomradar
