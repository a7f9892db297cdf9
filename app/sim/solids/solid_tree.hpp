// solid_tree.hpp: bounding volume hierarchy over solids, for distances and ray casts.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "app/sim/solids/solid.hpp"

namespace roomradar {

struct RayHit {
  double range_m = 0.0;  ///< in units of the direction's length
  int solid = -1;        ///< index of the solid
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
};

/// Stores indices only, so a copy of the tree works with a copy of the solids. All calls must pass the solids
/// the tree was built from, unchanged.
class SolidTree {
 public:
  SolidTree() = default;
  explicit SolidTree(const std::vector<Solid>& solids);

  /// Returns the least signed distance over the solids; infinite if there are none.
  [[nodiscard]] double signed_distance_m(const std::vector<Solid>& solids,
                                         const Eigen::Vector3d& p_world) const;
  /// Returns the first surface that the ray enters, within `farthest` lengths of the direction.
  [[nodiscard]] std::optional<RayHit> cast(const std::vector<Solid>& solids,
                                           const Eigen::Vector3d& origin_world,
                                           const Eigen::Vector3d& direction_world, double farthest) const;
  /// Returns true if the segment from a to b enters any solid.
  [[nodiscard]] bool is_blocked(const std::vector<Solid>& solids, const Eigen::Vector3d& a_world,
                                const Eigen::Vector3d& b_world) const;

 private:
  struct Node {
    Eigen::AlignedBox3d bounds_world;
    int solid = -1;  ///< index of a leaf's solid; -1: inner node, its children are the next node and `second`
    int second = -1;
  };
  int build(const std::vector<Solid>& solids, std::vector<int>& order, int begin, int end);
  template <typename Visit>
  bool walk_ray(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world, double& farthest,
                const Visit& visit) const;

  std::vector<Node> nodes_;
};

}  // namespace roomradar
