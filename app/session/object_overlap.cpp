// object_overlap.cpp: raises an object until the radar reports no overlap.
#include "app/session/object_overlap.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace roomradar {
namespace {

constexpr double kTouching_m = 1e-6;

bool overlap(CyberRadar& radar, ProximityQuery& field, const TreeInstance& a, const TreeInstance& b) {
  const SceneTree a_of_scene{a, SurfaceKind::kObject}, b_of_scene{b, SurfaceKind::kObject};
  const RadarScene scene_a{{&a_of_scene, 1}, {}}, scene_b{{&b_of_scene, 1}, {}};
  const auto has_inside = [&](const TreeInstance& object, const RadarScene& scene) {
    const RadarQuery query{object, -Eigen::Vector3d::UnitZ(), kTouching_m};
    return radar.query(query, scene).status == ContactStatus::kOverlap;
  };
  std::vector<ClosestPoint> unused;
  return field.near(a, scene_b, kTouching_m, 0, unused) != 0 || has_inside(a, scene_b) ||
         has_inside(b, scene_a);
}

/// Returns true if two bodies overlap by more than a shift by shift_m resolves. Bodies that only touch are
/// separated by one of the two shifts. Bodies at exactly the same place have no crossing surfaces until
/// shifted.
bool share_space(CyberRadar& radar, ProximityQuery& field, const TreeInstance& a, const TreeInstance& b,
                 double shift_m) {
  const auto overlap_shifted = [&](double by_m) {
    TreeInstance shifted = a;
    // unlikely to be parallel to an edge
    shifted.T_world_mesh.translation() += by_m * Eigen::Vector3d(0.31, 0.53, 0.79);
    return overlap(radar, field, shifted, b);
  };
  return overlap_shifted(shift_m) && overlap_shifted(-shift_m);
}

}  // namespace

void raise_over_others(VirtualObject& object, std::span<const std::unique_ptr<VirtualObject>> objects,
                       std::span<const SceneTree> room, double margin_m, CyberRadar& radar,
                       ProximityQuery& proximity) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const TriangleTree& tree = object.model->shape.touched;
  const Eigen::Isometry3d T_world_asked = object.body.T_world_object;
  Eigen::Isometry3d T_world_raised = T_world_asked;
  for (std::size_t round = 0; round < objects.size(); ++round) {
    std::vector<SceneTree> shared;  // objects that overlap it
    double top_m = -std::numeric_limits<double>::infinity();
    for (const auto& other : objects) {
      const TreeInstance its{&other->model->shape.touched, other->body.T_world_object};
      if (other.get() == &object || !other->in_room ||
          !share_space(radar, proximity, {&tree, T_world_raised}, its, margin_m))
        continue;
      shared.push_back({its, SurfaceKind::kObject});
      top_m = std::max(top_m, its.T_world_mesh.translation().z() + highest_m(*other));
    }
    if (shared.empty()) break;
    const double rise_m = top_m + 2.0 * margin_m - (T_world_raised.translation().z() + lowest_m(object));
    T_world_raised.translation() += rise_m * up;
    const Contact below = radar.query({{&tree, T_world_raised}, -up, rise_m}, {shared, {}});
    if (below.status != ContactStatus::kContact) return;
    T_world_raised.translation() -= std::max(below.lower_m - margin_m, 0.0) * up;
  }
  const double raised_m = T_world_raised.translation().z() - T_world_asked.translation().z();
  if (!(raised_m > 0.0)) return;
  std::vector<ClosestPoint> closest_points;
  const bool is_in_the_way =
      radar.query({{&tree, T_world_asked}, up, raised_m}, {room, {}}).status == ContactStatus::kContact ||
      proximity.near({&tree, T_world_raised}, {room, {}}, kTouching_m, 0, closest_points) != 0;
  if (!is_in_the_way) object.body.T_world_object = T_world_raised;
}

double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar, ProximityQuery& proximity) {
  const TreeInstance instance{&object.model->shape.touched, object.body.T_world_object};
  const Contact below = radar.query({instance, direction_world, 0.01}, {scene, {}});
  if (below.status != ContactStatus::kOverlap) return 0.0;
  // An overlapping surface that crosses no part of the object is in a hollow, such as a handle.
  std::vector<ClosestPoint> unused;
  const SurfaceKindMask crossed = proximity.near(instance, {scene, {}}, kTouching_m, 0, unused);
  return (crossed & bit_of(below.touched)) != 0 ? std::max(0.0, -below.contact_distance_m) : 0.0;
}

}  // namespace roomradar
