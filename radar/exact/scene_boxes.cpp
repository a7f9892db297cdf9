// scene_boxes.cpp: a tree over the boxes in Morton order of their centres.
#include "radar/exact/scene_boxes.hpp"

#include <algorithm>

#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

Eigen::AlignedBox3d moved(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& T) {
  const Eigen::Vector3d centre = T * box.center();
  const Eigen::Vector3d half = T.linear().cwiseAbs() * (0.5 * box.sizes());
  return {centre - half, centre + half};
}

}  // namespace

void SceneBoxes::clear() {
  added_.clear();
  are_finite_ = true;
}

void SceneBoxes::add(std::size_t index, const Eigen::AlignedBox3d& bounds_mesh,
                     const Eigen::Isometry3d& T_world_mesh) {
  if (T_world_mesh.matrix().allFinite()) {
    added_.emplace_back(index, moved(bounds_mesh, T_world_mesh));
  } else {
    are_finite_ = false;
  }
}

void SceneBoxes::finish() {
  by_code_.clear();
  boxes_.clear();
  Eigen::AlignedBox3d middles;
  for (const auto& [index, box] : added_) middles.extend(box.center());
  const double longest_m = middles.isEmpty() ? 0.0 : middles.sizes().maxCoeff();
  const double scale = longest_m > 0.0 ? 1023.0 / longest_m : 0.0;
  for (std::size_t i = 0; i < added_.size(); ++i) {
    const Eigen::Vector3d cell = (added_[i].second.center() - middles.min()) * scale;
    by_code_.emplace_back(
        morton_code(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                    static_cast<std::uint32_t>(cell.z())),
        i);
  }
  std::sort(by_code_.begin(), by_code_.end());
  for (const auto& [code, i] : by_code_) boxes_.push_back(added_[i].second);
  tree_.build(boxes_);
}

void SceneBoxes::build(std::span<const SceneTree> scene) {
  clear();
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!has_surface(scene[i])) continue;
    const TriangleTree& tree = *scene[i].instance.tree;
    const Eigen::Vector3d centre = tree.origin() + tree.centre(), half = tree.half_size().cast<double>();
    add(i, {centre - half, centre + half}, scene[i].instance.T_world_mesh);
  }
  finish();
}

}  // namespace roomradar
