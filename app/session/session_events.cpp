// session_events.cpp: executes the events of scripts and users.
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "app/physics/placement.hpp"
#include "app/physics/rigid_motion.hpp"
#include "app/session/session.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {
namespace {

constexpr double kTouching_m = 1e-6;

/// Returns the room's depth; 0 where something dynamic is in front of it and might stand on it.
DepthImage seen_room_depth_m(const FrameScene& scene) {
  DepthImage depth_m = scene.expected_depth_m();
  const MaskImage& moved = scene.dynamic_mask();
  for (std::size_t i = 0; i < std::min(moved.pixels.size(), depth_m.pixels.size()); ++i)
    if (moved.pixels[i] != 0) depth_m.pixels[i] = 0.0F;
  return depth_m;
}

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

/// Throws Error if the object is too large for any place in view.
void require_small_enough(const VirtualObject& object, const ScriptEvent& drop) {
  const double reach_m =
      footprint_radius_m(object, drop.R_world_object.value_or(object.body.T_world_object.linear()));
  if (reach_m <= kMostFootprint_m) return;
  std::array<char, 240> text{};
  std::snprintf(
      text.data(), text.size(),
      ": reaches %.3g m sideways from its middle, and only what reaches at most %.0f m is dropped in view. "
      "Meshes are in metres: give it a size (add NAME FILE size 0.2) or a place (drop NAME at X Y Z)",
      reach_m, kMostFootprint_m);
  throw Error(object.body.name + text.data());
}

}  // namespace

VirtualObject& Session::object_named(const std::string& name) {
  const auto found = std::find_if(objects_.begin(), objects_.end(),
                                  [&](const auto& object) { return object->body.name == name; });
  if (found == objects_.end()) throw Error("script: there is no object named " + name);
  return **found;
}

void Session::require_new(const std::string& name) const {
  const bool is_there = std::any_of(objects_.begin(), objects_.end(),
                                    [&](const auto& object) { return object->body.name == name; });
  if (is_there) throw Error("script: there is an object named " + name + " already");
}

void Session::add_object(const std::string& name, const Mesh& mesh) {
  require_new(name);
  objects_.push_back(object_of(context_, name, mesh, objects_));
}

void Session::add_object(const std::string& name, ObjectParts parts) {
  require_new(name);
  objects_.push_back(object_of(context_, name, std::move(parts), objects_));
}

void Session::turn(VirtualObject& object, const Eigen::Vector3d& turn_world_deg) {
  RigidMotion motion;
  motion.angular_rad_s = turn_world_deg * (std::numbers::pi / 180.0);
  motion.centre_object = object.model->middle;
  const std::vector<SceneTree> scene = scene_without(&object);
  const TimeOfImpact free = time_of_impact(radar_, {&object.model->shape.touched, object.body.T_world_object},
                                           motion, 1.0, {scene, {}});
  if (free.status == TimeOfImpactStatus::kInvalidInput || free.status == TimeOfImpactStatus::kNoAnswer)
    return;
  const Eigen::Vector3d origin_before = object.body.T_world_object.translation();
  object.body.T_world_object = pose_after(object.body.T_world_object, motion, free.safe_s);
  make_orthonormal(object.body.T_world_object);
  if (object.carried_to_world)  // the carry target follows, so the middle stays in place
    *object.carried_to_world += object.body.T_world_object.translation() - origin_before;
  object.body.asleep = false;
}

void Session::raise_over_others(VirtualObject& object) {
  const double margin_m = config_.physics.contact_margin_m;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const TriangleTree& tree = object.model->shape.touched;
  const Eigen::Isometry3d T_world_asked = object.body.T_world_object;
  Eigen::Isometry3d T_world_raised = T_world_asked;
  for (std::size_t round = 0; round < objects_.size(); ++round) {
    std::vector<SceneTree> shared;  // objects that overlap it
    double top_m = -std::numeric_limits<double>::infinity();
    for (const auto& other : objects_) {
      const TreeInstance its{&other->model->shape.touched, other->body.T_world_object};
      if (other.get() == &object || !other->in_room ||
          !share_space(radar_, proximity_, {&tree, T_world_raised}, its, margin_m))
        continue;
      shared.push_back({its, SurfaceKind::kObject});
      top_m = std::max(top_m, its.T_world_mesh.translation().z() + highest_m(*other));
    }
    if (shared.empty()) break;
    const double rise_m = top_m + 2.0 * margin_m - (T_world_raised.translation().z() + lowest_m(object));
    T_world_raised.translation() += rise_m * up;
    const Contact below = radar_.query({{&tree, T_world_raised}, -up, rise_m}, {shared, {}});
    if (below.status != ContactStatus::kContact) return;
    T_world_raised.translation() -= std::max(below.lower_m - margin_m, 0.0) * up;
  }
  const double raised_m = T_world_raised.translation().z() - T_world_asked.translation().z();
  if (!(raised_m > 0.0)) return;
  std::vector<SceneTree> room = scene_without(&object);
  std::erase_if(room, [](const SceneTree& surface) { return surface.kind == SurfaceKind::kObject; });
  const bool is_in_the_way =
      radar_.query({{&tree, T_world_asked}, up, raised_m}, {room, {}}).status == ContactStatus::kContact ||
      proximity_.near({&tree, T_world_raised}, {room, {}}, kTouching_m, 0, closest_points_) != 0;
  if (!is_in_the_way) object.body.T_world_object = T_world_raised;
}

void Session::apply(const ScriptEvent& event) {
  switch (event.action) {
    case Action::kSurfaces:
      set_surfaces(event.surfaces);
      break;
    case Action::kUnknown: {
      StageTimes unreported;
      if (event.unknown_is_solid)
        make_unknown_solid(unreported);
      else
        make_unknown_free();
      break;
    }
    case Action::kRadar:
      set_radar(event.radar);
      break;
    case Action::kQuality:
      require_valid(event.quality);
      due_quality_[index_of(event.from)] = event.quality;
      break;
    case Action::kCommit:
      if (!map_updater_) throw Error("script: adopt: this session does not watch for changes");
      map_updater_->ask();
      break;
    case Action::kCamera:  // handled by the source
    case Action::kQuit:
      break;
    default:
      change_objects(event);
  }
}

void Session::change_objects(const ScriptEvent& event) {
  if (event.action == Action::kAdd) {
    add_object(event.name, object_mesh(event.mesh, event.size_m.value_or(0.0)));
    return;
  }
  VirtualObject& object = object_named(event.name);
  const auto put = [&](const Eigen::Vector3d& position_world) {
    object.body.T_world_object.translation() = position_world;
    object.R_world_put = object.body.T_world_object.linear();
    object.body.velocity_world_mps = event.velocity_world_mps;
    object.body.angular_velocity_world_rad_s = event.angular_velocity_world_rad_s;
    object.body.asleep = false;
    object.in_room = true;
    object.waited_s = 0.0;
    raise_over_others(object);
    object.in_unknown = object.began_in_unknown = is_in_unknown(object);
  };
  if (event.action == Action::kTurn && !object.in_room) return;
  if (event.action == Action::kDrop && !event.position_world) require_small_enough(object, event);
  // Any later event of the object replaces its waiting drop.
  std::erase_if(waiting_, [&](const WaitingDrop& waiting) { return waiting.drop.name == event.name; });
  if (event.R_world_object && event.position_world)
    object.body.T_world_object.linear() = *event.R_world_object;
  if (event.action != Action::kTurn) object.carried_to_world.reset();
  switch (event.action) {
    case Action::kPlace:
    case Action::kThrow:
      put(*event.position_world);
      break;
    case Action::kDrop:
      if (event.position_world) {
        put(*event.position_world + Eigen::Vector3d(0.0, 0.0, event.height_m - lowest_m(object)));
      } else {
        waiting_.push_back({event, frames_});
      }
      break;
    case Action::kCarry:
      if (!object.in_room) put(*event.position_world);
      object.carried_to_world = event.position_world;
      break;
    case Action::kRelease:
      object.body.velocity_world_mps = event.velocity_world_mps;
      object.R_world_put = object.body.T_world_object.linear();
      break;
    case Action::kTurn:
      turn(object, event.turn_world_deg);
      break;
    case Action::kRemove:
      object.in_room = false;
      break;
    default:
      break;
  }
}

void Session::release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  constexpr std::int64_t kAgainAfter_frames = 10;  // a search takes some 10 ms
  for (WaitingDrop& waiting : std::exchange(waiting_, {})) {
    if (frames_ < waiting.try_at_frame) {
      waiting_.push_back(std::move(waiting));
      continue;
    }
    ScriptEvent& event = waiting.drop;
    const VirtualObject& object = object_named(event.name);
    const Eigen::Matrix3d R_world_object = event.R_world_object.value_or(object.body.T_world_object.linear());
    const std::optional<Eigen::Vector3d> support_world =
        find_support(seen_room_depth_m(scene_), frame.depth_camera, T_world_camera,
                     footprint_radius_m(object, R_world_object));
    if (!support_world) {  // staggered, so waiting drops do not all search in the same frame
      waiting.try_at_frame = frames_ + kAgainAfter_frames + static_cast<std::int64_t>(waiting_.size());
      waiting_.push_back(std::move(waiting));
      continue;
    }
    event.position_world = *support_world - level_to_middle(object, R_world_object);
    apply(event);
  }
}

}  // namespace roomradar
