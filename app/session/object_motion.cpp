// object_motion.cpp: steps of physics for one object.
#include "app/session/object_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/physics/physics.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {
namespace {

/// Returns the physics of a carried object: without gravity, friction and restitution, so it slides along
/// surfaces.
PhysicsConfig in_hand(PhysicsConfig config) {
  config.gravity_world_mps2.setZero();
  config.friction = config.restitution = 0.0;
  return config;
}

/// Returns the number of advance() calls for a time that may exceed the max of one call.
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

void advance_object(VirtualObject& object, double waited_s, const CollisionQueries& probe,
                    const PhysicsConfig& config, const PushDirections& push, ContactCounts& counts) {
  const int pieces = pieces_of(waited_s, config);
  for (int left = pieces; left > 0; --left) {
    const double piece_s = waited_s / pieces;
    if (object.carried_to_world) set_in_hand(object, left * piece_s);
    const StepReport moved =
        advance(object.body, piece_s, probe, object.carried_to_world ? in_hand(config) : config, push.span());
    counts.contacts += moved.contacts;
    for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
      counts.by_kind[kind] += moved.contacts_by_kind[kind];
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
