// scene_in_frame.cpp: boxes of tree nodes and depth blocks in the frame, with their bounds.
#include "radar/exact/scene_in_frame.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/validity.hpp"
#include "radar/exact/scene_boxes.hpp"

namespace roomradar {
namespace {

constexpr float kPixelRounding = 16.0F * std::numeric_limits<float>::epsilon();

bool is_finite(const SceneTree& s) {
  return s.instance.tree == nullptr || s.instance.tree->empty() ||
         s.instance.T_world_mesh.matrix().allFinite();
}
bool has_surface(const SceneDepth& s) { return s.depth_m != nullptr && !s.depth_m->empty(); }

bool is_usable(const SceneDepth& s) {
  const bool has_mask =
      s.mask == nullptr || (s.mask->width == s.depth_m->width && s.mask->height == s.depth_m->height);
  const bool has_rule = s.max_jump_m >= 0.0F && s.max_jump_slope >= 0.0F;  // false for NaN too
  return can_project(s.camera) && has_mask && has_rule && s.stride_px >= 1 &&
         s.T_world_camera.matrix().allFinite();
}

}  // namespace

bool SceneInFrame::place(const RadarScene& scene, std::size_t own_tree, const Eigen::Matrix3d& R_frame_world,
                         const Eigen::Vector3d& origin_world) {
  scene_ = scene;
  own_tree_ = own_tree;
  R_frame_world_ = R_frame_world;
  origin_world_ = origin_world;
  trees_.clear();
  views_.clear();
  const bool are_finite = scene.boxes != nullptr
                              ? scene.boxes->are_finite()
                              : std::all_of(scene.trees.begin(), scene.trees.end(), is_finite);
  return are_finite && std::all_of(scene.depths.begin(), scene.depths.end(),
                                   [](const SceneDepth& s) { return !has_surface(s) || is_usable(s); });
}

/// Keeps a tree if its bounding sphere reaches the volume; most of many objects do not.
void SceneInFrame::begin_tree(const SceneTree& s, const Eigen::AlignedBox3d& volume) {
  const TriangleTree& tree = *s.instance.tree;
  const Eigen::Vector3d centre_world = s.instance.T_world_mesh * (tree.origin() + tree.centre());
  const Eigen::Vector3d t = R_frame_world_ * (centre_world - origin_world_);
  const float slack_m = kPixelRounding * (static_cast<float>(t.cwiseAbs().sum()) + tree.half_size().sum());
  const double reach_m = tree.half_size().cast<double>().norm() + slack_m;
  if (volume.squaredExteriorDistance(t) > reach_m * reach_m) return;
  trees_.push_back({&s, R_frame_world_ * s.instance.T_world_mesh.linear(), t, slack_m});
}

void SceneInFrame::enter(const Eigen::AlignedBox3d& volume) {
  trees_.clear();
  const auto begin_at = [&](std::size_t i) {
    if (i != own_tree_ && has_surface(scene_.trees[i])) begin_tree(scene_.trees[i], volume);
  };
  if (scene_.boxes != nullptr) {
    const Eigen::Vector3d centre_world = origin_world_ + R_frame_world_.transpose() * volume.center();
    const Eigen::Vector3d half = R_frame_world_.transpose().cwiseAbs() * (0.5 * volume.sizes());
    scene_.boxes->visit({centre_world - half, centre_world + half}, begin_at);
  } else {
    for (std::size_t i = 0; i < scene_.trees.size(); ++i) begin_at(i);
  }
  views_.clear();
  for (const SceneDepth& s : scene_.depths) {
    DepthView view;
    if (has_surface(s) && place_depth(s, R_frame_world_, origin_world_, volume, view)) views_.push_back(view);
  }
}

std::size_t SceneInFrame::cell_count() const {
  std::size_t count = 0;
  for (const DepthView& v : views_) count += static_cast<std::size_t>(v.i1 - v.i0) * (v.j1 - v.j0);
  return count;
}

void SceneInFrame::begin(const SceneBound& bound, float limit_m, std::vector<SceneItem>& items) {
  for (std::uint32_t i = 0; i < trees_.size(); ++i) {
    expand({-std::numeric_limits<float>::infinity(), SceneItem::Kind::kNode, i, 0, 0}, bound, limit_m, items);
  }
  blocks_.clear();
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const std::size_t first = blocks_.size();
    append_blocks(views_[v], scratch_, blocks_);
    for (std::size_t b = first; b < blocks_.size(); ++b) {
      const float low_m = bound.low_m(blocks_[b].box);
      if (!(low_m < limit_m)) continue;
      items.push_back({low_m, SceneItem::Kind::kBlock, static_cast<std::uint32_t>(trees_.size() + v),
                       static_cast<std::uint32_t>(b), 0});
    }
  }
}

void SceneInFrame::expand(const SceneItem& item, const SceneBound& bound, float limit_m,
                          std::vector<SceneItem>& items) {
  // The object is no higher under a part of a block than under the whole block.
  float most_m = std::numeric_limits<float>::infinity();
  if (item.kind == SceneItem::Kind::kBlock) {
    const float z0 = blocks_[item.first].box.z0;
    most_m = z0 - item.low_m + kPixelRounding * (std::abs(z0) + std::abs(item.low_m));
  }
  const auto put = [&](const FrameBox& box, SceneItem::Kind kind, std::uint32_t first, std::uint32_t count) {
    if (box.z0 - most_m >= limit_m) return;
    const float low_m = std::max(bound.low_m(box), item.low_m);
    if (!(low_m < limit_m)) return;
    // Within a pixel, the plane's bound is hardly tighter than the box's.
    const bool is_bounded = kind == SceneItem::Kind::kTriangle && bound.is_within_a_pixel(box);
    items.push_back({low_m, is_bounded ? SceneItem::Kind::kBounded : kind, item.source, first, count});
  };
  if (item.kind == SceneItem::Kind::kBlock) {
    triangles_.clear();
    append_triangles(views_[item.source - trees_.size()], blocks_[item.first], triangles_);
    for (const DepthTriangle& t : triangles_) put(t.box, SceneItem::Kind::kTriangle, t.id, 1);
    return;
  }
  const TreeView& view = trees_[item.source];
  const TriangleTree& tree = *view.scene->instance.tree;
  if (item.kind == SceneItem::Kind::kLeaf) {
    for (std::uint32_t i = item.first; i < item.first + item.count; ++i) {
      const FrameTriangle t = tree_triangle(view, i);
      const Eigen::Vector3d low = t.corners[0].cwiseMin(t.corners[1]).cwiseMin(t.corners[2]);
      const Eigen::Vector3d high = t.corners[0].cwiseMax(t.corners[1]).cwiseMax(t.corners[2]);
      const float s = view.slack_m;
      const Eigen::Array3f l = low.cast<float>().array() - s, h = high.cast<float>().array() + s;
      put({l.x(), h.x(), l.y(), h.y(), l.z(), h.z()}, SceneItem::Kind::kTriangle, i, 1);
    }
    return;
  }
  const TreeNode& node = tree.nodes()[item.first];
  const Eigen::Matrix3f R = view.R_frame_mesh.cast<float>();
  LinearOverBoxes x, y, z;
  linear_over_boxes(node, R.row(0), x);
  linear_over_boxes(node, R.row(1), y);
  linear_over_boxes(node, R.row(2), z);
  const Eigen::Vector3f t = view.t_frame_centre.cast<float>();
  for (std::uint32_t i = 0; i < node.child_count; ++i) {
    const float s = view.slack_m;
    const float cx = x.value[i] + t.x(), cy = y.value[i] + t.y(), cz = z.value[i] + t.z();
    const FrameBox box{cx - x.reach[i] - s, cx + x.reach[i] + s, cy - y.reach[i] - s,
                       cy + y.reach[i] + s, cz - z.reach[i] - s, cz + z.reach[i] + s};
    put(box, node.count[i] > 0 ? SceneItem::Kind::kLeaf : SceneItem::Kind::kNode, node.first[i],
        node.count[i]);
  }
}

FrameTriangle SceneInFrame::tree_triangle(const TreeView& view, std::uint32_t triangle) const {
  const TriangleTree& tree = *view.scene->instance.tree;
  const Triangle& t = tree.triangles()[triangle];
  FrameTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.corners[i] =
        view.R_frame_mesh * (tree.vertices()[t[i]].cast<double>() - tree.centre()) + view.t_frame_centre;
  }
  set_normal(result);
  return result;
}

FrameTriangle SceneInFrame::triangle(const SceneItem& item) const {
  if (item.source < trees_.size()) return tree_triangle(trees_[item.source], item.first);
  return depth_triangle(views_[item.source - trees_.size()], item.first);
}

SurfaceKind SceneInFrame::kind(const SceneItem& item) const {
  if (item.source < trees_.size()) return trees_[item.source].scene->kind;
  return views_[item.source - trees_.size()].scene->kind;
}

}  // namespace roomradar
