// scene_boxes.hpp: which of many meshes in the world reach a box, without asking each.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "radar/geometry/box_tree.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Boxes around the meshes of a scene, by place. Made anew for every frame: allocates nothing once as many
/// meshes were held.
class SceneBoxes {
 public:
  /// Builds the tree over the boxes of a scene's meshes. Null or empty meshes and poses that are not finite
  /// are left out.
  void build(std::span<const SceneTree> scene);

  /// The same in three steps for a scene of another type: clear(), add() per mesh with a surface, finish().
  /// @param index        index in scene, as visit() passes it on; ascending
  /// @param bounds_mesh  bounding box in the mesh's frame, m
  void clear();
  void add(std::size_t index, const Eigen::AlignedBox3d& bounds_mesh, const Eigen::Isometry3d& T_world_mesh);
  void finish();

  /// Whether all poses were finite.
  [[nodiscard]] bool are_finite() const { return are_finite_; }

  /// Calls work(index in scene) for each mesh whose box meets `around_world`, always in the same order.
  template <typename Work>
  void visit(const Eigen::AlignedBox3d& around_world, const Work& work) const {
    tree_.visit([&](const Eigen::AlignedBox3d& box) { return box.intersects(around_world); },
                [&](std::size_t place) { work(added_[by_place_[place].second].first); });
  }

 private:
  std::vector<std::pair<std::size_t, Eigen::AlignedBox3d>> added_;  // index in scene, box in the world
  std::vector<std::pair<std::uint64_t, std::size_t>> by_place_;     // Morton code, index in added_
  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  bool are_finite_ = true;
};

}  // namespace roomradar
