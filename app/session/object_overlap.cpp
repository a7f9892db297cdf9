// object_overlap.cpp: raises an object until the radar reports no overlap.
#include "app/session/object_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>

#include "app/physics/placement/free_pose.hpp"
#include "app/physics/rigid_motion.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr double kTouching_m = 1e-6;

bool overlap(CyberRadar& radar, const TreeInstance& a, const TreeInstance& b) {
  const SceneTree a_of_scene{a, SurfaceKind::kObject}, b_of_scene{b, SurfaceKind::kObject};
  const RadarScene scene_a{{&a_of_scene, 1}, {}}, scene_b{{&b_of_scene, 1}, {}};
  const auto has_inside = [&](const TreeInstance& object, const RadarScene& scene) {
    const RadarQuery query{object, -Eigen::Vector3d::UnitZ(), kTouching_m};
    return radar.query(query, scene).status == ContactStatus::kOverlap;
  };
  std::vector<ClosestPoint> unused;
  return near_features(a, scene_b, kTouching_m, 0, unused) != 0 || has_inside(a, scene_b) ||
         has_inside(b, scene_a);
}

/// Returns true if two bodies overlap by more than a shift by shift_m resolves. Bodies that only touch are
/// separated by one of the two shifts. Bodies at exactly the same place have no crossing surfaces until
/// shifted.
bool share_space(CyberRadar& radar, const TreeInstance& a, const TreeInstance& b, double shift_m) {
  const auto overlap_shifted = [&](double by_m) {
    TreeInstance shifted = a;
    // unlikely to be parallel to an edge
    shifted.T_world_mesh.translation() += by_m * Eigen::Vector3d(0.31, 0.53, 0.79);
    return overlap(radar, shifted, b);
  };
  return overlap_shifted(shift_m) && overlap_shifted(-shift_m);
}

constexpr double kWayOut_m = 0.10;   // max way of an object out of an overlap
constexpr double kSearched_m = 1.0;  // radius in which a free place is searched for the message

std::string millimetres(double distance_m) { return std::to_string(std::lround(1e3 * distance_m)) + " mm"; }

/// Returns "X Y Z m", in the form that a script accepts.
std::string coordinates(const Eigen::Vector3d& p) {
  std::array<char, 80> text{};
  format_classic(text.data(), text.size(), "%.3f %.3f %.3f m", p.x(), p.y(), p.z());
  return text.data();
}

bool is_middle_unknown(const SessionRoom& room, const VirtualObject& object) {
  return room.unknown_is_solid && is_unknown_at(room, object.body.T_world_object * object.model->middle);
}

TreeInstance instance_of(const VirtualObject& object) {
  return {&object.model->shape.touched, object.body.T_world_object};
}

std::optional<FreePose> free_pose_near(const VirtualObject& object, double max_m, const WayOut& way) {
  const auto is_known = [&](const Eigen::Isometry3d& T_world_object) {
    return !is_in_solid_unknown(way.room, object, T_world_object);
  };
  return nearest_free_pose(instance_of(object), way.all, way.gap_m, max_m, is_known, way.radar);
}

}  // namespace

std::string leave_surfaces(VirtualObject& object, const WayOut& way, bool is_thrown) {
  constexpr double kSaid_m = 0.005;  // less is a surface's noise
  const bool crosses = is_crossed(instance_of(object), way.surfaces);
  if (!crosses && !is_in_solid_unknown(way.room, object)) return {};
  if (const auto free = free_pose_near(object, kWayOut_m, way)) {
    object.body.T_world_object = free->T_world_object;
    if (free->moved_m < kSaid_m) return {};
    return crosses ? " would start inside a surface; moved out by " + millimetres(free->moved_m)
                   : " would start in space that was not scanned; moved out by " + millimetres(free->moved_m);
  }
  const bool is_middle = is_middle_unknown(way.room, object);
  if (!crosses && is_thrown)
    return is_middle
               ? " starts in space that was not scanned, where nothing stops it"
               : " starts partly in space that was not scanned; nothing there stops it until it has left";
  std::string text = object.body.name + ": cannot be placed at " +
                     coordinates(object.body.T_world_object.translation()) + ": " +
                     (crosses     ? "a surface is in the way"
                      : is_middle ? "that space was not scanned"
                                  : "a part of it would be in space that was not scanned") +
                     ", and there is no free place within 10 cm";
  const auto far = free_pose_near(object, kSearched_m, way);
  text += far ? "; the nearest found is " + coordinates(far->T_world_object.translation())
              : ", nor was one found within 1 m";
  throw PlaceRefused(text);
}

bool is_still_too_long(VirtualObject& object, double waited_s) {
  constexpr double kStill_m = 0.002, kStuckAfter_s = 1.0;
  if (object.body.asleep || object.carried_to_world ||
      strayed_m(object.body, object.placement.T_world_still) > kStill_m) {
    object.placement.T_world_still = object.body.T_world_object;
    object.placement.still_s = 0.0;
    object.placement.stuck = false;
    return false;
  }
  object.placement.still_s += waited_s;
  if (object.placement.still_s < kStuckAfter_s) return false;
  object.placement.still_s = 0.0;
  return true;
}

std::string free_or_stuck(VirtualObject& object, const WayOut& way) {
  std::vector<SceneTree> lasting = way.all;  // dynamic surfaces go away, or push the object
  std::erase_if(lasting, [](const SceneTree& surface) { return is_moving_surface(surface.kind); });
  if (!is_crossed(instance_of(object), lasting)) return {};
  if (const auto free = free_pose_near(object, kWayOut_m, way)) {
    object.body.T_world_object = free->T_world_object;
    return " was stuck in a surface; moved out by " + millimetres(free->moved_m);
  }
  if (std::exchange(object.placement.stuck, true)) return {};
  return " is stuck in a surface at " + coordinates(object.body.T_world_object.translation()) +
         "; place it somewhere else";
}

void raise_over_others(VirtualObject& object, std::span<const std::unique_ptr<VirtualObject>> objects,
                       std::span<const SceneTree> room, double margin_m, CyberRadar& radar) {
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
          !share_space(radar, {&tree, T_world_raised}, its, margin_m))
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
      near_features({&tree, T_world_raised}, {room, {}}, kTouching_m, 0, closest_points) != 0;
  if (!is_in_the_way) object.body.T_world_object = T_world_raised;
}

double penetration_m(const VirtualObject& object, std::span<const SceneTree> scene,
                     const Eigen::Vector3d& direction_world, CyberRadar& radar) {
  const TreeInstance instance{&object.model->shape.touched, object.body.T_world_object};
  const Contact below = radar.query({instance, direction_world, 0.01}, {scene, {}});
  if (below.status != ContactStatus::kOverlap) return 0.0;
  // An overlapping surface that crosses no part of the object is in a hollow, such as a handle.
  std::vector<ClosestPoint> unused;
  const SurfaceKindMask crossed = near_features(instance, {scene, {}}, kTouching_m, 0, unused);
  return (crossed & bit_of(below.touched)) != 0 ? std::max(0.0, -below.contact_distance_m) : 0.0;
}

}  // namespace roomradar
