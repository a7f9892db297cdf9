// object_set.cpp: the calls of users on objects, and one frame of their physics.
#include "app/session/object_set.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "app/physics/physics.hpp"
#include "app/session/object_overlap.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
ObjectSet::ObjectSet(GlContext& context, const FrameScene& scene, const SessionRoom& room,
                     const SessionConfig& config)
    : context_(context), scene_(scene), room_(room), config_(config) {
  set_radar(config.radar);
}

VirtualObject& ObjectSet::named(const std::string& name) {
  if (VirtualObject* found = find_object(objects_, name)) return *found;
  throw Error("script: there is no object named " + name);
}

void ObjectSet::require_new(const std::string& name) const {
  if (find_object(objects_, name) != nullptr)
    throw Error("script: an object named " + name + " already exists");
}

void ObjectSet::add(const std::string& name, Model model, const BodyMaterial& material) {
  require_new(name);
  std::vector<std::string> notes = model.notes;
  take_in(object_of(context_, name, std::move(model), objects_), std::move(notes), material);
}

void ObjectSet::add(const std::string& name, ObjectParts parts, const BodyMaterial& material) {
  require_new(name);
  std::vector<std::string> notes = parts.source.notes;
  take_in(object_of(context_, name, std::move(parts), objects_), std::move(notes), material);
}

void ObjectSet::take_in(std::unique_ptr<VirtualObject> object, std::vector<std::string> notes,
                        const BodyMaterial& material) {
  change_material(*object, material);
  objects_.push_back(std::move(object));
  for (std::string& note : notes) notices_.push_back({"", std::move(note)});
}

void ObjectSet::cancel_drop(const std::string& name) {
  std::erase_if(waiting_, [&](const WaitingDrop& waiting) { return waiting.drop.name == name; });
}

VirtualObject& ObjectSet::take_over(const std::string& name) {
  VirtualObject& object = named(name);
  cancel_drop(name);
  object.carried_to_world.reset();
  return object;
}

void ObjectSet::put(VirtualObject& object, const ObjectState& state) {
  const Eigen::Isometry3d T_world_before = object.body.T_world_object;
  if (state.R_world_object) object.body.T_world_object.linear() = *state.R_world_object;
  object.body.T_world_object.translation() = state.position_world;
  try {
    raise_over_others(object, objects_, scene_.surfaces(), config_.physics.contact_margin_m, radar_);
    const std::string moved = leave_surfaces(object, way_out_of(object), !state.velocity_world_mps.isZero());
    if (!moved.empty()) notices_.push_back({object.body.name, moved});
  } catch (const PlaceRefused&) {
    object.body.T_world_object = T_world_before;
    object.why_not_in_room = "its start position was refused";
    throw;
  }
  object.R_world_put = object.body.T_world_object.linear();
  object.body.velocity_world_mps = state.velocity_world_mps;
  object.body.angular_velocity_world_rad_s = state.angular_velocity_world_rad_s;
  object.body.asleep = false;
  object.in_room = true;
  object.waited_s = 0.0;
  object.T_world_undisturbed.reset();
  object.stuck = false;
  object.still_s = 0.0;
  object.T_world_still = object.body.T_world_object;
  object.in_unknown = object.began_in_unknown = is_in_solid_unknown(room_, object);
}

WayOut ObjectSet::way_out_of(const VirtualObject& object) {
  return {room_, scene_.surfaces(), scene_without(&object), config_.physics.contact_margin_m, exact_radar_};
}

void ObjectSet::place(const std::string& name, const ObjectState& state) { put(take_over(name), state); }

void ObjectSet::drop(const DropRequest& drop, std::int64_t frame_number) {
  if (!drop.position_world) require_small_enough(named(drop.name), drop);
  VirtualObject& object = take_over(drop.name);
  if (!drop.position_world) {
    waiting_.push_back({drop, frame_number});
    return;
  }
  const Eigen::Matrix3d R_world_object = drop.R_world_object.value_or(object.body.T_world_object.linear());
  const double rise_m = drop.height_m - lowest_m(object, R_world_object);
  put(object, {.position_world = *drop.position_world + Eigen::Vector3d(0.0, 0.0, rise_m),
               .R_world_object = R_world_object});
}

void ObjectSet::carry(const std::string& name, const Eigen::Vector3d& position_world) {
  VirtualObject& object = take_over(name);
  if (!object.in_room) put(object, {.position_world = position_world});
  object.carried_to_world = position_world;
}

void ObjectSet::release(const std::string& name, const Eigen::Vector3d& velocity_world_mps) {
  VirtualObject& object = take_over(name);
  object.body.velocity_world_mps = velocity_world_mps;
  object.R_world_put = object.body.T_world_object.linear();
}

void ObjectSet::turn(const std::string& name, const Eigen::Vector3d& turn_world_deg) {
  VirtualObject& object = named(name);
  if (!object.in_room) return;
  cancel_drop(name);
  turn_until_contact(object, turn_world_deg, scene_without(&object), radar_);
}

void ObjectSet::remove(const std::string& name) {
  VirtualObject& object = take_over(name);
  if (object.in_room) object.why_not_in_room = "it was removed";
  object.in_room = false;
}

void ObjectSet::release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                                const ExpectedView& expected, const FrameForeground& foreground,
                                std::int64_t frame_number) {
  constexpr std::int64_t kAgainAfter_frames = 10;  // a search takes some 50 ms
  for (WaitingDrop& waiting : std::exchange(waiting_, {})) {
    if (frame_number < waiting.try_at_frame) {
      waiting_.push_back(std::move(waiting));
      continue;
    }
    DropRequest& drop = waiting.drop;
    VirtualObject& object = named(drop.name);
    DropPosition found =
        find_drop_position(object, drop, {frame.depth_camera, T_world_camera, expected, foreground},
                           {room_, scene_without(&object), config_.physics, exact_radar_});
    if (found.position_world) {
      if (!found.note.empty()) notices_.push_back({drop.name, found.note});
      drop.height_m = found.height_m;
      drop.position_world = found.position_world;
      try {
        this->drop(drop, frame_number);
      } catch (const PlaceRefused& refused) {
        notices_.push_back({"", refused.what()});
      }
      continue;
    }
    if (drop.near_world) {
      object.why_not_in_room = "no place for its drop was found";
      notices_.push_back({drop.name, " is not dropped: " + found.note});
      continue;
    }
    if (waiting.why.empty()) notices_.push_back({drop.name, " is not dropped so far: " + found.note});
    waiting.why = std::move(found.note);
    waiting.try_at_frame = frame_number + kAgainAfter_frames + std::ssize(waiting_);  // staggered
    waiting_.push_back(std::move(waiting));
  }
}

ContactCounts ObjectSet::move(double dt_s, std::int64_t frame_number, StageTimes& times) {
  constexpr double kStuckLooksAfter_s = 0.5;  // overlaps are the most expensive contacts
  std::atomic<double> queries_ms = 0.0;
  std::vector<DueObject> due;
  for (std::size_t index = 0; index < objects_.size(); ++index) {
    VirtualObject* const object = objects_[index].get();
    if (!object->in_room || (!object->carried_to_world && !is_loaded_round(room_, *object))) continue;
    object->waited_s += std::min(dt_s, config_.physics.max_advance_s);  // longer gaps are stalls
    if (!object->carried_to_world && !is_turn_to_move(index, frame_number, config_)) continue;
    if (object->stuck && object->waited_s < kStuckLooksAfter_s) continue;
    if (!object->body.asleep) object->in_unknown = object->in_unknown && is_in_solid_unknown(room_, *object);
    due.push_back({.object = object, .waited_s = std::exchange(object->waited_s, 0.0)});
  }
  // Without the map, all surfaces are the frame's, and none is known to be dynamic.
  const bool has_map = config_.scene.surfaces == SurfacePolicy::kMap;
  for (DueObject& one : due) {
    one.scene = scene_without(one.object);
    one.is_undisturbed = has_map && is_undisturbed(*one.object, one.scene);
    one.bodies = bodies_in(one.scene, objects_, *one.object);
  }
  ContactCounts counts;
  Radar& radar = passes_ ? static_cast<Radar&>(*passes_) : radar_;
  advance_objects(due, has_map ? &scene_ : nullptr, config_.physics, {radar, queries_ms}, contact_system_,
                  counts);
  const bool is_any_overlapped =  // an object shifted out of an overlap may overlap others now
      std::any_of(due.begin(), due.end(), [](const DueObject& one) { return one.was_overlapped; });
  for (const DueObject& one : due) {
    VirtualObject& object = *one.object;
    object.T_world_undisturbed.reset();
    if (!is_any_overlapped && !object.in_unknown) object.T_world_undisturbed = object.body.T_world_object;
    if (!is_still_too_long(object, one.waited_s)) continue;
    const std::string news = free_or_stuck(object, way_out_of(object));
    if (!news.empty()) notices_.push_back({object.body.name, news});
  }
  times.add_ms("radar", queries_ms);
  return counts;
}

std::vector<Departure> ObjectSet::end_departures() {
  std::vector<Departure> departures;
  for (const auto& object : objects_) {
    auto departure = end_departure(*object, room_.lowest_known_m);
    if (!departure) continue;
    if (departure->is_back) {  // others may have taken its place
      Body& body = object->body;
      const double z_m = body.T_world_object.translation().z();
      raise_over_others(*object, objects_, scene_.surfaces(), config_.physics.contact_margin_m, radar_);
      body.asleep = body.T_world_object.translation().z() == z_m;
    }
    departures.push_back(std::move(*departure));
  }
  return departures;
}

double ObjectSet::penetration_m() {
  double deepest_m = 0.0;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    std::vector<SceneTree> still = scene_without(object.get());
    // A real hand may enter an object, and unknown space may be empty; neither counts.
    if (config_.scene.surfaces == SurfacePolicy::kMap)
      std::erase_if(still, [](const SceneTree& surface) {
        return surface.kind != SurfaceKind::kStatic && surface.kind != SurfaceKind::kObject;
      });
    deepest_m = std::max(deepest_m, roomradar::penetration_m(
                                        *object, still, config_.physics.gravity_world_mps2, exact_radar_));
  }
  return deepest_m;
}

std::vector<SceneTree> ObjectSet::scene_without(const VirtualObject* object) const {
  std::vector<SceneTree> scene = scene_.surfaces();
  for (const auto& other : objects_) {
    if (other.get() != object && other->in_room)
      scene.push_back({{&other->model->shape.touched, other->body.T_world_object}, SurfaceKind::kObject});
  }
  return scene;
}

std::vector<FineRegion> ObjectSet::fine_regions() const {
  return config_.fine_mesh ? roomradar::fine_regions(objects_) : std::vector<FineRegion>{};
}

std::vector<FineRegion> ObjectSet::bounding_balls() const {
  constexpr double kEverything_m = 1e3;
  std::vector<FineRegion> balls = roomradar::fine_regions(objects_);
  if (!waiting_.empty()) balls.push_back({Eigen::Vector3d::Zero(), kEverything_m});
  return balls;
}

void ObjectSet::count_fine_cells() {
  const bool has_map = config_.scene.surfaces == SurfacePolicy::kMap;
  set_fine_cells(objects_, has_map ? scene_.dynamic_cells().fine_of_region : std::vector<std::uint32_t>{});
}

void ObjectSet::set_radar(const RadarConfig& config) {
  CyberRadar radar(config);
  if (config.mode == RadarMode::kPasses)
    passes_ = std::make_unique<PassesRadar>(context_, config.resolution_px);
  else
    passes_.reset();
  tested_before_ += radar_.static_triangles_tested();
  radar_ = std::move(radar);
}

void ObjectSet::room_changed() {
  for (const auto& object : objects_) {
    object->body.asleep = false;
    object->T_world_undisturbed.reset();
  }
}

void ObjectSet::unknown_changed() {
  for (const auto& object : objects_) {
    object->in_unknown = object->began_in_unknown = object->in_room && is_in_solid_unknown(room_, *object);
    object->T_world_undisturbed.reset();
  }
}

}  // namespace roomradar
