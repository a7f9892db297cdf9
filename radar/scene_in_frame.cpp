// scene_in_frame.cpp: boxes of tree nodes and depth blocks in the frame, with their bounds.
#include "radar/scene_in_frame.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();

bool has_surface(const SceneTree& s) { return s.instance.tree != nullptr && !s.instance.tree->empty(); }
bool has_surface(const SceneDepth& s) { return s.depth_m != nullptr && !s.depth_m->empty(); }

bool is_usable(const SceneDepth& s) {
  const Intrinsics& c = s.camera;
  const bool has_camera = std::isfinite(c.fx_px) && c.fx_px > 0.0 && std::isfinite(c.fy_px) &&
                          c.fy_px > 0.0 && std::isfinite(c.cx_px) && std::isfinite(c.cy_px);
  const bool has_mask =
      s.mask == nullptr || (s.mask->width == s.depth_m->width && s.mask->height == s.depth_m->height);
  const bool has_rule = s.max_jump_m >= 0.0F && s.max_jump_slope >= 0.0F;  // NaN is no rule either
  return has_camera && has_mask && has_rule && s.stride_px >= 1 && s.T_world_camera.matrix().allFinite();
}

}  // namespace

bool SceneInFrame::place(const RadarScene& scene, const Eigen::Matrix3d& R_frame_world,
                         const Eigen::Vector3d& origin_world) {
  R_frame_world_ = R_frame_world;
  origin_world_ = origin_world;
  trees_.clear();
  depths_.clear();
  for (const SceneTree& s : scene.trees) {
    if (!has_surface(s)) continue;
    const TriangleTree& tree = *s.instance.tree;
    if (!s.instance.T_world_mesh.matrix().allFinite()) return false;
    const Eigen::Vector3d centre_world = s.instance.T_world_mesh * (tree.origin() + tree.centre());
    const Eigen::Vector3d t = R_frame_world * (centre_world - origin_world);
    const auto reach_m = static_cast<float>(t.cwiseAbs().sum()) + tree.half_size().sum();
    trees_.push_back({&s, R_frame_world * s.instance.T_world_mesh.linear(), t, kRounding * reach_m});
  }
  for (const SceneDepth& s : scene.depths) {
    if (!has_surface(s)) continue;
    if (!is_usable(s)) return false;
    depths_.push_back(&s);
  }
  return true;
}

/// Whether the ball around an instance reaches into the volume: of many objects most do not.
bool SceneInFrame::reaches(const TreeView& view, const Eigen::AlignedBox3d& volume) {
  const double reach_m = view.scene->instance.tree->half_size().cast<double>().norm() + view.slack_m;
  return volume.squaredExteriorDistance(view.t_frame_centre) <= reach_m * reach_m;
}

void SceneInFrame::begin(const Eigen::AlignedBox3d& volume, const SceneBound& bound, float limit_m,
                         std::vector<SceneItem>& items) {
  for (std::uint32_t i = 0; i < trees_.size(); ++i) {
    if (!reaches(trees_[i], volume)) continue;
    const SceneItem root{-std::numeric_limits<float>::infinity(), SceneItem::Kind::kNode, i, 0, 0};
    expand(root, bound, limit_m, items);
  }
  blocks_.clear();
  views_.clear();
  for (const SceneDepth* s : depths_) {
    const auto source = static_cast<std::uint32_t>(trees_.size() + views_.size());
    DepthView& view = views_.emplace_back();
    const std::size_t first = blocks_.size();
    if (place_depth(*s, R_frame_world_, origin_world_, volume, view)) append_blocks(view, scratch_, blocks_);
    for (std::size_t b = first; b < blocks_.size(); ++b) {
      const float low_m = bound.low_m(blocks_[b].box);
      if (!(low_m < limit_m)) continue;
      items.push_back({low_m, SceneItem::Kind::kBlock, source, static_cast<std::uint32_t>(b), 0});
    }
  }
}

void SceneInFrame::expand(const SceneItem& item, const SceneBound& bound, float limit_m,
                          std::vector<SceneItem>& items) {
  const auto put = [&](const FrameBox& box, SceneItem::Kind kind, std::uint32_t first, std::uint32_t count) {
    const float low_m = std::max(bound.low_m(box), item.low_m);
    if (low_m < limit_m) items.push_back({low_m, kind, item.source, first, count});
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

Touched SceneInFrame::kind(const SceneItem& item) const {
  if (item.source < trees_.size()) return trees_[item.source].scene->kind;
  return depths_[item.source - trees_.size()]->kind;
}

}  // namespace roomradar
