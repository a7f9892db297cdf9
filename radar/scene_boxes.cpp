// scene_boxes.cpp: a tree over the boxes in Morton order of their middles.
#include "radar/scene_boxes.hpp"

#include <algorithm>

#include "mapping/types/morton.hpp"

namespace roomradar {
namespace {

Eigen::AlignedBox3d moved(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& T) {
  const Eigen::Vector3d centre = T * box.center();
  const Eigen::Vector3d half = T.linear().cwiseAbs() * (0.5 * box.sizes());
  return {centre - half, centre + half};
}

bool has_surface(const SceneMesh& s) {
  return s.instance.mesh != nullptr && s.instance.mesh->triangle_count() > 0;
}

Eigen::AlignedBox3d bounds_world(const SceneMesh& s) {
  return moved(s.instance.mesh->bounds(), s.instance.T_world_mesh);
}
Eigen::AlignedBox3d bounds_world(const SceneTree& s) {
  const TriangleTree& tree = *s.instance.tree;
  const Eigen::Vector3d centre = tree.origin() + tree.centre(), half = tree.half_size().cast<double>();
  return moved({centre - half, centre + half}, s.instance.T_world_mesh);
}

}  // namespace

template <typename Instance>
void SceneBoxes::build_of(std::span<const Instance> scene) {
  by_place_.clear();
  boxes_.clear();
  are_finite_ = true;
  const auto is_there = [](const Instance& s) {
    return has_surface(s) && s.instance.T_world_mesh.matrix().allFinite();
  };
  Eigen::AlignedBox3d middles;
  for (const Instance& s : scene) {
    if (is_there(s)) {
      middles.extend(bounds_world(s).center());
    } else {
      are_finite_ = are_finite_ && !has_surface(s);
    }
  }
  const double longest_m = middles.isEmpty() ? 0.0 : middles.sizes().maxCoeff();
  const double scale = longest_m > 0.0 ? 1023.0 / longest_m : 0.0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!is_there(scene[i])) continue;
    const Eigen::Vector3d cell = (bounds_world(scene[i]).center() - middles.min()) * scale;
    by_place_.emplace_back(
        morton_code(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                    static_cast<std::uint32_t>(cell.z())),
        i);
  }
  std::sort(by_place_.begin(), by_place_.end());
  for (const auto& [code, i] : by_place_) boxes_.push_back(bounds_world(scene[i]));
  tree_.build(boxes_);
}

void SceneBoxes::build(std::span<const SceneMesh> scene) { build_of(scene); }
void SceneBoxes::build(std::span<const SceneTree> scene) { build_of(scene); }

}  // namespace roomradar
