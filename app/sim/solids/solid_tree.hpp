// solid_tree.hpp: a tree of boxes round solids, so that a distance or a ray looks at few of them.
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

/// Refers to solids by index: a copy of the tree serves a copy of the solids. They must stay as they were
/// given.
class SolidTree {
 public:
  SolidTree() = default;
  explicit SolidTree(const std::vector<Solid>& solids);

  /// Least of the solids' signed distances; infinite for none.
  [[nodiscard]] double signed_distance_m(const std::vector<Solid>& solids,
                                         const Eigen::Vector3d& p_world) const;
  /// First surface that the ray enters, within `farthest` lengths of the direction.
  [[nodiscard]] std::optional<RayHit> cast(const std::vector<Solid>& solids,
                                           const Eigen::Vector3d& origin_world,
                                           const Eigen::Vector3d& direction_world, double farthest) const;
  /// Whether the way from a to b enters any solid.
  [[nodiscard]] bool is_blocked(const std::vector<Solid>& solids, const Eigen::Vector3d& a_world,
                                const Eigen::Vector3d& b_world) const;

 private:
  struct Node {
    Eigen::AlignedBox3d bounds_world;
    int solid = -1;  ///< a leaf's; -1: inner, its children are the next node and `second`
    int second = -1;
  };
  int build(const std::vector<Solid>& solids, std::vector<int>& order, int begin, int end);
  template <typename Visit>
  bool walk_ray(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world, double& farthest,
                const Visit& visit) const;

  std::vector<Node> nodes_;
};

}  // namespace roomradar
