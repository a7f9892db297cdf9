// solid_tree.cpp: builds by median splits, and traverses with pruning.
#include "app/sim/solids/solid_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace roomradar {
namespace {

using Eigen::Vector3d;

constexpr int kDeepest = 64;  // median splits of fewer than 2^63 solids

Eigen::AlignedBox3d bounds_of(const Solid& solid) {
  const Vector3d reach = solid.T_world_solid.linear().cwiseAbs() * bounds_half_m(solid);
  return {solid.T_world_solid.translation() - reach, solid.T_world_solid.translation() + reach};
}

double entry_of(const Solid& solid, const Vector3d& origin_world, const Vector3d& direction_world) {
  const auto R_solid_world = solid.T_world_solid.linear().transpose();
  return ray_entry_local(solid, R_solid_world * (origin_world - solid.T_world_solid.translation()),
                         R_solid_world * direction_world);
}

}  // namespace

SolidTree::SolidTree(const std::vector<Solid>& solids) {
  std::vector<int> order(solids.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  nodes_.reserve(2 * solids.size());
  if (!solids.empty()) build(solids, order, 0, static_cast<int>(order.size()));
}

int SolidTree::build(const std::vector<Solid>& solids, std::vector<int>& order, int begin, int end) {
  const auto index = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d bounds;
  Eigen::AlignedBox3d centres;
  for (int i = begin; i < end; ++i) {
    const Solid& solid = solids[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    bounds.extend(bounds_of(solid));
    centres.extend(solid.T_world_solid.translation());
  }
  nodes_[index].bounds_world = bounds;
  if (end - begin == 1) {
    nodes_[index].solid = order[static_cast<std::size_t>(begin)];
    return static_cast<int>(index);
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
    return solids[static_cast<std::size_t>(a)].T_world_solid.translation()[axis] <
           solids[static_cast<std::size_t>(b)].T_world_solid.translation()[axis];
  });
  build(solids, order, begin, middle);
  nodes_[index].second = build(solids, order, middle, end);
  return static_cast<int>(index);
}

double SolidTree::signed_distance_m(const std::vector<Solid>& solids, const Vector3d& p_world) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return nearest_m;
  std::array<int, kDeepest> waiting;
  int count = 0;
  waiting[0] = 0;
  for (count = 1; count > 0;) {
    const int index = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    // Inside a box the solid's distance may be anything down to minus its size; outside it is at least the
    // box's.
    const double box_m = node.bounds_world.exteriorDistance(p_world);
    if (box_m > 0.0 && box_m >= nearest_m) continue;
    if (node.solid >= 0) {
      nearest_m = std::min(
          nearest_m, roomradar::signed_distance_m(solids[static_cast<std::size_t>(node.solid)], p_world));
      continue;
    }
    const double first_m =
        nodes_[static_cast<std::size_t>(index) + 1].bounds_world.squaredExteriorDistance(p_world);
    const double second_m =
        nodes_[static_cast<std::size_t>(node.second)].bounds_world.squaredExteriorDistance(p_world);
    const bool first_is_nearer = first_m <= second_m;
    waiting[static_cast<std::size_t>(count++)] = first_is_nearer ? node.second : index + 1;
    waiting[static_cast<std::size_t>(count++)] = first_is_nearer ? index + 1 : node.second;
  }
  return nearest_m;
}

template <typename Visit>
bool SolidTree::walk_ray(const Vector3d& origin_world, const Vector3d& direction_world, double& farthest,
                         const Visit& visit) const {
  if (nodes_.empty()) return false;
  const Vector3d inverse = (direction_world.array() + 0.0).inverse();  // turns -0 into 0
  // Slab test. Zeros in the direction give infinities of the correct order; a ray within a face's plane
  // counts as a hit.
  const auto meets = [&](const Eigen::AlignedBox3d& bounds) {
    double t_in = 0.0, t_out = farthest;
    for (int axis = 0; axis < 3; ++axis) {
      double low = (bounds.min()[axis] - origin_world[axis]) * inverse[axis];
      double high = (bounds.max()[axis] - origin_world[axis]) * inverse[axis];
      if (low > high) std::swap(low, high);
      if (low > t_in) t_in = low;
      if (high < t_out) t_out = high;
    }
    return t_in <= t_out;
  };
  std::array<int, kDeepest> waiting;
  waiting[0] = 0;
  for (int count = 1; count > 0;) {
    const int index = waiting[static_cast<std::size_t>(--count)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!meets(node.bounds_world)) continue;
    if (node.solid >= 0) {
      if (visit(node.solid)) return true;
      continue;
    }
    waiting[static_cast<std::size_t>(count++)] = node.second;
    waiting[static_cast<std::size_t>(count++)] = index + 1;
  }
  return false;
}

std::optional<RayHit> SolidTree::cast(const std::vector<Solid>& solids, const Vector3d& origin_world,
                                      const Vector3d& direction_world, double farthest) const {
  RayHit hit;
  walk_ray(origin_world, direction_world, farthest, [&](int index) {
    const double t = entry_of(solids[static_cast<std::size_t>(index)], origin_world, direction_world);
    if (t > 0.0 && t < farthest) {
      hit.range_m = farthest = t;
      hit.solid = index;
    }
    return false;
  });
  if (hit.solid < 0) return std::nullopt;
  const Solid& solid = solids[static_cast<std::size_t>(hit.solid)];
  const Vector3d p_solid = solid.T_world_solid.linear().transpose() *
                           (origin_world + hit.range_m * direction_world - solid.T_world_solid.translation());
  hit.normal_world = solid.T_world_solid.linear() * normal_local(solid, p_solid);
  return hit;
}

bool SolidTree::is_blocked(const std::vector<Solid>& solids, const Vector3d& a_world,
                           const Vector3d& b_world) const {
  double farthest = 1.0;
  const Vector3d way = b_world - a_world;
  return walk_ray(a_world, way, farthest, [&](int index) {
    const double t = entry_of(solids[static_cast<std::size_t>(index)], a_world, way);
    return t > 0.0 && t < 1.0;
  });
}

}  // namespace roomradar
