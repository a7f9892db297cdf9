// solid_tree.hpp: bounding volume hierarchy over solids, for distances and ray casts.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

struct RayHit {
  /// Distance to the hit, in units of the direction's length.
  double range_m = 0.0;
  /// Index of the solid.
  int solid = -1;
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
};

/// Stores only indices of solids. A copy of the tree thus works with a copy of the solids. All calls must
/// pass the unchanged solids from which the tree was built, or a copy.
class SolidTree {
 public:
  SolidTree() = default;
  explicit SolidTree(const std::vector<Solid>& solids);

  /// Returns the least signed distance over the solids, m; infinity if there are none.
  [[nodiscard]] double signed_distance_m(const std::vector<Solid>& solids,
                                         const Eigen::Vector3d& p_world) const;
  /// Returns the first intersection at which the ray enters a solid.
  /// @param farthest  max distance, in units of the direction's length
  [[nodiscard]] std::optional<RayHit> cast(const std::vector<Solid>& solids,
                                           const Eigen::Vector3d& origin_world,
                                           const Eigen::Vector3d& direction_world, double farthest) const;
  /// Returns true if the segment from a to b enters any solid.
  [[nodiscard]] bool is_blocked(const std::vector<Solid>& solids, const Eigen::Vector3d& a_world,
                                const Eigen::Vector3d& b_world) const;

 private:
  struct Node {
    Eigen::AlignedBox3d bounds_world;
    /// Index of a leaf's solid; -1 for an inner node. An inner node's children are the next node and node
    /// `second`.
    int solid = -1;
    int second = -1;
  };
  int build(const std::vector<Solid>& solids, std::vector<int>& order, int begin, int end);
  template <typename Visit>
  bool walk_ray(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world, double& farthest,
                const Visit& visit) const;

  std::vector<Node> nodes_;
};

}  // namespace roomradar
