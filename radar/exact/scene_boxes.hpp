// scene_boxes.hpp: bounding volume hierarchy over the meshes of a scene.
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

/// Hierarchy over the bounding boxes of a scene's meshes, to be rebuilt for every frame. Allocates nothing
/// once this many meshes have been stored.
class SceneBoxes {
 public:
  /// Builds the hierarchy over a scene's meshes. Skips meshes that are null or empty, and meshes whose poses
  /// are not finite.
  void build(std::span<const SceneTree> scene);

  /// Empties the hierarchy. For a scene that is not a span of SceneTree, call clear(), then add() for each
  /// mesh with a surface, then finish().
  void clear();
  /// Adds a mesh.
  /// @param index        index of the mesh in the scene, for the callback of visit(). Must increase from call
  ///                     to call
  /// @param bounds_mesh  bounding box in the mesh's frame, m
  void add(std::size_t index, const Eigen::AlignedBox3d& bounds_mesh, const Eigen::Isometry3d& T_world_mesh);
  /// Builds the hierarchy over the meshes added since clear().
  void finish();

  /// Returns true if the poses of all meshes were finite.
  [[nodiscard]] bool are_finite() const { return are_finite_; }

  /// Calls work(index in the scene) for each mesh whose bounding box intersects `around_world`. The order is
  /// always the same.
  template <typename Work>
  void visit(const Eigen::AlignedBox3d& around_world, const Work& work) const {
    tree_.visit([&](const Eigen::AlignedBox3d& box) { return box.intersects(around_world); },
                [&](std::size_t place) { work(added_[by_code_[place].second].first); });
  }

 private:
  // Per mesh: its index in the scene, and its bounding box in the world.
  std::vector<std::pair<std::size_t, Eigen::AlignedBox3d>> added_;
  // Morton code of each box's centre, and index in added_; sorted.
  std::vector<std::pair<std::uint64_t, std::size_t>> by_code_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  bool are_finite_ = true;
};

}  // namespace roomradar
