// scene_boxes.hpp: which of many meshes in the world reach a box, without asking each.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "radar/box_tree.hpp"
#include "radar/contact.hpp"
#include "radar/gpu_mesh.hpp"
#include "radar/radar_scene.hpp"

namespace roomradar {

/// A mesh that can be touched.
struct SceneMesh {
  MeshInstance instance;
  Touched kind = Touched::kStatic;
};

/// Boxes around the meshes of a scene, by place. Made anew for every frame: allocates nothing once as many
/// meshes were held.
class SceneBoxes {
 public:
  /// Meshes that are null or empty, and poses that are not finite, are left out.
  void build(std::span<const SceneMesh> scene);
  void build(std::span<const SceneTree> scene);

  /// Whether all poses were finite.
  [[nodiscard]] bool are_finite() const { return are_finite_; }

  /// Calls work(index in scene) for each mesh whose box meets `around_world`, always in the same order.
  template <typename Work>
  void visit(const Eigen::AlignedBox3d& around_world, const Work& work) const {
    tree_.visit([&](const Eigen::AlignedBox3d& box) { return box.intersects(around_world); },
                [&](std::size_t place) { work(by_place_[place].second); });
  }

 private:
  std::vector<std::pair<std::uint64_t, std::size_t>> by_place_;  // Morton code, index in scene
  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  bool are_finite_ = true;

  template <typename Instance>
  void build_of(std::span<const Instance> scene);
};

}  // namespace roomradar
