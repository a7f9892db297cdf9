// object_motion.cpp: steps of physics for one object.
#include "app/session/object_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/physics/physics.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/joint_motion.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {
namespace {

/// Returns the number of advance_together() calls for a time that may exceed the max of one call.
int pieces_of(double waited_s, const PhysicsConfig& config) {
  return std::max(1, static_cast<int>(std::ceil(waited_s / config.max_advance_s - 1e-9)));
}

/// Sets the velocity that takes a carried object to its target by the end of this frame.
void set_in_hand(VirtualObject& object, double dt_s) {
  const Eigen::Vector3d way = *object.carried_to_world - object.body.T_world_object.translation();
  object.body.asleep = false;
  object.body.angular_velocity_world_rad_s.setZero();
  object.body.velocity_world_mps = dt_s > 0.0 ? Eigen::Vector3d(way / dt_s) : Eigen::Vector3d::Zero();
}

}  // namespace

bool is_turn_to_move(std::size_t index, std::int64_t frame_number, const SessionConfig& config) {
  const std::int64_t number = static_cast<std::int64_t>(index);
  const std::int64_t pictures = config.picture_every_n_frames;
  if (pictures == 1) return (frame_number + number) % config.move_every_n_frames == 0;
  // Frames with a picture do not move objects. The same frames are left out if no pictures are made, so
  // objects move the same with and without pictures.
  const std::int64_t frame = frame_number % pictures;
  const std::int64_t of_these = frame_number / pictures * (pictures - 1) + frame - 1;
  return frame > 0 && (of_these + number) % config.move_every_n_frames == 0;
}

std::vector<SceneBody> bodies_in(const std::vector<SceneTree>& scene,
                                 std::span<const std::unique_ptr<VirtualObject>> objects,
                                 const VirtualObject& object) {
  std::vector<SceneBody> bodies;
  for (const auto& other : objects) {
    if (other.get() == &object || !other->in_room) continue;
    const double mass_ratio = object.body.mass.mass_kg / other->body.mass.mass_kg;
    bodies.push_back({&other->body, other->carried_to_world ? 0.0 : mass_ratio});
  }
  bodies.insert(bodies.begin(), scene.size() - bodies.size(), SceneBody{});  // objects come last
  return bodies;
}

bool is_undisturbed(const VirtualObject& object, std::span<const SceneTree> scene, double reach_m) {
  if (!object.T_world_undisturbed) return false;
  if (object.T_world_undisturbed->matrix() != object.body.T_world_object.matrix()) return false;
  const TreeInstance own{&object.model->shape.touched, object.body.T_world_object};
  return std::none_of(scene.begin(), scene.end(), [&](const SceneTree& surface) {
    return is_moving_surface(surface.kind) && is_usable(surface.instance) &&
           !are_farther_apart(own, surface.instance, reach_m);
  });
}

void advance_objects(std::span<DueObject> due, const PhysicsConfig& config, CyberRadar& radar,
                     ProximityQuery& proximity, ContactSystem& contacts, ContactCounts& counts,
                     double& radar_ms) {
  std::vector<RadarScene> scenes;
  std::vector<CollisionQueries> probes;
  std::vector<AdvancedBody> advanced;
  scenes.reserve(due.size());  // the queries refer to them
  probes.reserve(due.size());
  double longest_s = 0.0;
  for (DueObject& one : due) {
    scenes.push_back({one.scene, {}});
    probes.push_back(
        make_collision_queries(radar, proximity, one.object->model->shape.touched, scenes.back(), &radar_ms));
    probes.back().others = one.bodies;
    Body& body = one.object->body;
    std::vector<SceneTree*> seen_as;  // in the scenes of the others
    for (DueObject& other : due)
      for (std::size_t i = 0; i < other.bodies.size(); ++i)
        if (other.bodies[i].body == &body) seen_as.push_back(&other.scene[i]);
    advanced.push_back({.body = &body,
                        .probe = &probes.back(),
                        .mass_kg = body.mass.mass_kg,
                        .is_carried = one.object->carried_to_world.has_value(),
                        .is_undisturbed = one.is_undisturbed,
                        .depenetration_directions_world = one.push.span(),
                        .moved = [&body, seen_as = std::move(seen_as)] {
                          for (SceneTree* tree : seen_as) tree->instance.T_world_mesh = body.T_world_object;
                        }});
    longest_s = std::max(longest_s, one.waited_s);
  }
  const int pieces = pieces_of(longest_s, config);
  for (int left = pieces; left > 0; --left) {
    for (std::size_t i = 0; i < due.size(); ++i) {
      advanced[i].dt_s = due[i].waited_s / pieces;
      if (due[i].object->carried_to_world) set_in_hand(*due[i].object, left * advanced[i].dt_s);
    }
    advance_together(advanced, config, contacts);
    for (std::size_t i = 0; i < due.size(); ++i) {
      const StepReport& report = advanced[i].report;
      due[i].was_overlapped |= report.deepest_overlap_m > config.overlap_allowed_m;
      counts.contacts += report.contacts;
      for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
        counts.by_kind[kind] += report.contacts_by_kind[kind];
    }
  }
}

void drop_engulfing_back(const VirtualObject& object, double waited_s, const PushDirections& push,
                         const PhysicsConfig& config, CyberRadar& radar, ProximityQuery& proximity,
                         std::vector<SceneTree>& scene, double& radar_ms) {
  const auto back = std::find_if(scene.begin(), scene.end(), [](const SceneTree& surface) {
    return surface.kind == SurfaceKind::kInferredBack;
  });
  if (back == scene.end()) return;
  const RadarScene of_back{{&*back, 1}, {}};
  const CollisionQueries probe =
      make_collision_queries(radar, proximity, object.model->shape.touched, of_back, &radar_ms);
  if (is_engulfed(object.body, waited_s, probe.travel, config, push.span())) scene.erase(back);
}

std::vector<FineRegion> fine_regions(std::span<const std::unique_ptr<VirtualObject>> objects) {
  constexpr double kAbout_m = 0.02;  // an object's travel per frame at 0.6 m/s
  std::vector<FineRegion> regions;
  for (const auto& object : objects) {
    if (object->in_room)
      regions.push_back({object->body.T_world_object * object->model->middle, radius_m(*object) + kAbout_m});
  }
  return regions;
}

void set_fine_cells(std::span<const std::unique_ptr<VirtualObject>> objects,
                    std::span<const std::uint32_t> cells_of_region) {
  std::size_t region = 0;
  for (const auto& object : objects) {
    const bool has_region = object->in_room && region < cells_of_region.size();
    object->fine_cells = has_region ? cells_of_region[region++] : 0;
  }
}

void turn_until_contact(VirtualObject& object, const Eigen::Vector3d& turn_world_deg,
                        std::span<const SceneTree> scene, CyberRadar& radar) {
  RigidMotion motion;
  motion.angular_rad_s = turn_world_deg * (std::numbers::pi / 180.0);
  motion.centre_object = object.model->middle;
  const TimeOfImpact free = time_of_impact(radar, {&object.model->shape.touched, object.body.T_world_object},
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

}  // namespace roomradar
