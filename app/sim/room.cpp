// room.cpp: rooms by name, and exact distances and rays in them.
#include "app/sim/room.hpp"

#include <algorithm>
#include <limits>

#include "app/sim/rooms.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {

const std::vector<std::string>& room_names() {
  static const std::vector<std::string> names{"table", "shelf", "wall"};
  return names;
}

Room make_room(std::string_view name) {
  if (name == "table") return make_table_room();
  if (name == "shelf") return make_shelf_room();
  if (name == "wall") return make_wall_room();
  std::string known;
  for (const std::string& one : room_names()) known.append(known.empty() ? "" : ", ").append(one);
  throw Error("no simulated room is called '" + std::string(name) + "'; known are: " + known);
}

double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Solid& solid : room.solids) {
    const double centre_m = (p_world - solid.T_world_solid.translation()).norm();
    if (centre_m - bounds_half_m(solid).norm() > std::max(nearest_m, 0.0)) continue;  // cannot be nearer
    nearest_m = std::min(nearest_m, signed_distance_m(solid, p_world));
  }
  return nearest_m;
}

std::optional<RayHit> cast_ray(const std::vector<Solid>& solids, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world) {
  RayHit hit;
  hit.range_m = std::numeric_limits<double>::infinity();
  const double squared_length = direction_world.squaredNorm();
  Eigen::Vector3d p_hit_local = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid& solid = solids[i];
    const Eigen::Vector3d to_origin = origin_world - solid.T_world_solid.translation();
    const double along = -to_origin.dot(direction_world) / squared_length;
    const double radius_m = bounds_half_m(solid).norm();
    if ((to_origin + along * direction_world).squaredNorm() > radius_m * radius_m) continue;
    const Eigen::Vector3d o = solid.T_world_solid.linear().transpose() * to_origin;
    const Eigen::Vector3d d = solid.T_world_solid.linear().transpose() * direction_world;
    const double t = ray_entry_local(solid, o, d);
    if (t <= 0.0 || t >= hit.range_m) continue;
    hit.range_m = t;
    hit.solid = static_cast<int>(i);
    p_hit_local = o + t * d;
  }
  if (hit.solid < 0) return std::nullopt;
  const Solid& solid = solids[static_cast<std::size_t>(hit.solid)];
  hit.normal_world = solid.T_world_solid.linear() * normal_local(solid, p_hit_local);
  return hit;
}

}  // namespace roomradar
