// scene_boxes.hpp: finds the meshes of a scene that reach a box, without testing each.
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

/// Boxes around the meshes of a scene, in a spatial hierarchy. Rebuilt for every frame; allocates nothing
/// once as many meshes were stored.
class SceneBoxes {
 public:
  /// Builds the hierarchy over a scene's meshes. Skips meshes that are null or empty, and poses that are not
  /// finite.
  void build(std::span<const SceneTree> scene);

  /// The same in three steps for a scene of another type: clear(), add() per mesh with a surface, finish().
  /// @param index        index in scene, passed on by visit(); ascending
  /// @param bounds_mesh  bounding box in the mesh's frame, m
  void clear();
  void add(std::size_t index, const Eigen::AlignedBox3d& bounds_mesh, const Eigen::Isometry3d& T_world_mesh);
  void finish();

  /// Returns true if all poses were finite.
  [[nodiscard]] bool are_finite() const { return are_finite_; }

  /// Calls work(index in scene) for each mesh whose box intersects `around_world`, always in the same order.
  template <typename Work>
  void visit(const Eigen::AlignedBox3d& around_world, const Work& work) const {
    tree_.visit([&](const Eigen::AlignedBox3d& box) { return box.intersects(around_world); },
                [&](std::size_t place) { work(added_[by_code_[place].second].first); });
  }

 private:
  std::vector<std::pair<std::size_t, Eigen::AlignedBox3d>> added_;  // index in scene, box in the world
  std::vector<std::pair<std::uint64_t, std::size_t>> by_code_;      // Morton code, index in added_
  std::vector<Eigen::AlignedBox3d> boxes_;
  BoxTree tree_;
  bool are_finite_ = true;
};

}  // namespace roomradar
