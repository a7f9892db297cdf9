// scene_boxes.cpp: a tree over the boxes in Morton order of their middles.
#include "radar/scene_boxes.hpp"

#include <algorithm>

#include "mapping/types/morton.hpp"

namespace roomradar {
namespace {

Eigen::AlignedBox3d bounds_world(const MeshInstance& instance) {
  const Eigen::AlignedBox3d bounds = instance.mesh->bounds();
  const Eigen::Vector3d centre = instance.T_world_mesh * bounds.center();
  const Eigen::Vector3d half = instance.T_world_mesh.linear().cwiseAbs() * (0.5 * bounds.sizes());
  return {centre - half, centre + half};
}

}  // namespace

void SceneBoxes::build(std::span<const SceneMesh> scene) {
  by_place_.clear();
  boxes_.clear();
  const auto is_there = [](const SceneMesh& s) {
    return s.instance.mesh != nullptr && s.instance.mesh->triangle_count() > 0;
  };
  Eigen::AlignedBox3d middles;
  for (const SceneMesh& s : scene) {
    if (is_there(s)) middles.extend(bounds_world(s.instance).center());
  }
  const double longest_m = middles.isEmpty() ? 0.0 : middles.sizes().maxCoeff();
  const double scale = longest_m > 0.0 ? 1023.0 / longest_m : 0.0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!is_there(scene[i])) continue;
    const Eigen::Vector3d cell = (bounds_world(scene[i].instance).center() - middles.min()) * scale;
    by_place_.emplace_back(
        morton_code(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                    static_cast<std::uint32_t>(cell.z())),
        i);
  }
  std::sort(by_place_.begin(), by_place_.end());
  for (const auto& [code, i] : by_place_) boxes_.push_back(bounds_world(scene[i].instance));
  tree_.build(boxes_);
}

}  // namespace roomradar
