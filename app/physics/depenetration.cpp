// depenetration.cpp: finds push directions from the vertices of moving surfaces.
#include "app/physics/depenetration.hpp"

#include <algorithm>

#include "radar/geometry/contact.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

}  // namespace

bool is_engulfed(const Body& body, double dt_s, const DistanceQuery& back, const PhysicsConfig& config,
                 std::span<const Eigen::Vector3d> depenetration_directions_world) {
  const double most_m = config.max_depenetration_mps * dt_s + config.wake_overlap_m;
  bool is_deep = false;
  const auto is_shallow = [&](const Vec3& direction) {
    const Contact contact = back(body.T_world_object, direction, config.contact_margin_m);
    if (contact.status != ContactStatus::kOverlap) return false;
    is_deep = true;
    return -contact.contact_distance_m <= most_m;
  };
  const double g = config.gravity_world_mps2.norm();
  if (g > 0.0 && is_shallow(config.gravity_world_mps2 / g)) return false;
  if (std::any_of(depenetration_directions_world.begin(), depenetration_directions_world.end(), is_shallow))
    return false;
  return is_deep;
}

std::vector<Push> push_contacts(const Body& body, const DirectedOverlap& overlap, double push_m, double dt_s,
                                const CollisionQueries& queries, const PhysicsConfig& config) {
  const Push single{overlap.contact.point_world, -overlap.direction_world, push_m / dt_s,
                    overlap.contact.touched};
  const double margin_m = config.contact_margin_m, out_m = overlap.depth_m + margin_m;
  const Vec3 out = -out_m * overlap.direction_world;
  Eigen::Isometry3d T_world_out = body.T_world_object;
  T_world_out.pretranslate(out);
  std::vector<ClosestPoint> points;
  if (queries.near(T_world_out, out_m + margin_m, ~kMovingSurfaces, {}, points) != 0 || points.empty())
    return {single};
  std::vector<Push> pushes;
  for (const ClosestPoint& p : points) {
    const double way_m = p.normal_world.dot(out) - std::max(p.gap_m - margin_m, 0.0);
    const double part = way_m > 0.0 ? push_m / out_m : 1.0;
    pushes.push_back(
        {p.point_world + p.gap_m * p.normal_world - out, p.normal_world, part * way_m / dt_s, p.kind});
  }
  return pushes;
}

PushDirections depenetration_directions(std::initializer_list<const Mesh*> moving_world,
                                        const Eigen::Vector3d& centre_world, double reach_m,
                                        const Eigen::Vector3d& up_world) {
  Vec3 nearest = Vec3::Zero();
  Vec3 sum = Vec3::Zero();
  double nearest_m2 = reach_m * reach_m;
  std::size_t count = 0;
  for (const Mesh* mesh : moving_world) {
    const Vec3 centre = centre_world - mesh->origin;
    for (const Eigen::Vector3f& vertex : mesh->vertices) {
      const Vec3 offset = vertex.cast<double>() - centre;
      const double distance_m2 = offset.squaredNorm();
      if (!(distance_m2 <= reach_m * reach_m)) continue;  // also rejects NaN
      sum += offset;
      ++count;
      if (distance_m2 <= nearest_m2) {
        nearest_m2 = distance_m2;
        nearest = offset;
      }
    }
  }
  PushDirections result;
  if (count == 0) return result;
  for (const Vec3& offset : {nearest, Vec3(sum / static_cast<double>(count))}) {
    const Vec3 level = offset - offset.dot(up_world) * up_world;
    const double length = level.norm();
    if (length < 0.2 * offset.norm() || length < 1e-6)
      continue;  // directly above or below: handled along
                 // gravity
    const Vec3 direction = level / length;
    if (result.count == 1 && direction.dot(result.direction_world[0]) > 0.97) continue;
    result.add(direction);
  }
  return result;
}

}  // namespace roomradar
