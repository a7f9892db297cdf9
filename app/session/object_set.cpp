// object_set.cpp: the calls of users on objects, and one frame of their physics.
#include "app/session/object_set.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/depenetration.hpp"
#include "app/physics/physics.hpp"
#include "app/physics/placement/placement.hpp"
#include "app/session/object_overlap.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"
#include "radar/geometry/tree_pairs.hpp"
#include "radar/motion/joint_motion.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {
namespace {

/// Returns the number of advance_together() calls for a time that may exceed the max of one call.
int pieces_of(double waited_s, const PhysicsConfig& config) {
  return std::max(1, static_cast<int>(std::ceil(waited_s / config.max_advance_s - 1e-9)));
}

constexpr double kNearbyReach_m = 0.25;  // dynamic surfaces farther than this from the object do not push it

/// A radar and the total duration of its queries. Refers to both, which must outlive it.
struct TimedRadar {
  Radar& radar;
  std::atomic<double>& queries_ms;  ///< incremented by each query
};

/// How the dynamic surfaces near an object move in this frame.
struct SurfaceSweep {
  Eigen::Vector3d way_world = Eigen::Vector3d::Zero();  // from the last frame to this one, m
  PushDirections push{};
};

/// An object that is moved in this frame, and the surfaces and objects that it can touch. Its queries refer
/// to it.
struct DueObject {
  VirtualObject* object = nullptr;
  double waited_s = 0.0;  ///< time since the object was last advanced; may exceed config.max_advance_s
  std::vector<SceneTree> scene{};   ///< surfaces, then the other objects
  std::vector<SceneBody> bodies{};  ///< body of each tree of the scene; null for surfaces
  RadarScene seen{};                ///< `scene`
  CollisionQueries probe{};         ///< against `seen`
  SurfaceSweep sweep{};
  bool was_overlapped = false;  ///< a surface overlapped the object, which may have been shifted
};

SurfaceSweep sweep_near(const VirtualObject& object, const FrameScene& moving) {
  constexpr double kFarthest_m = 0.15;  // 4.5 m/s at 30 frames/s
  const auto way = translation_near(moving.last_dynamic_points_world(), moving.dynamic_points_world(),
                                    middle_world(object), radius_m(object) + kNearbyReach_m, kFarthest_m);
  return {way.value_or(Eigen::Vector3d::Zero()), {}};
}

/// Returns the number of steps in which the surfaces move. If it is 1, as for slow surfaces, only this
/// frame's surfaces count.
int steps_of(const SurfaceSweep& sweep) {
  constexpr double kStep_m = 0.015;
  return std::max(1, static_cast<int>(std::ceil(sweep.way_world.norm() / kStep_m)));
}

/// Moves the dynamic surfaces in the object's scene to where they are when a part of their way is left.
/// @param surfaces  this frame's surfaces, with which the object's scene begins
void put_surfaces(double left, const FrameScene& moving, std::span<const SceneTree> surfaces, DueObject& one,
                  AdvancedBody& advanced) {
  SurfaceSweep& sweep = one.sweep;
  const Eigen::Vector3d back_world = -left * sweep.way_world;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (!is_moving_surface(surfaces[i].kind)) continue;
    one.scene[i] = surfaces[i];
    one.scene[i].instance.T_world_mesh.pretranslate(back_world);
  }
  const VirtualObject& object = *one.object;
  sweep.push =
      depenetration_directions({&moving.dynamic_world().seen_world, &moving.dynamic_world().inferred_world},
                               middle_world(object) - back_world, radius_m(object) + kNearbyReach_m);
  if (steps_of(sweep) > 1) sweep.push.add(-sweep.way_world.normalized());
  advanced.depenetration_directions_world = sweep.push.span();
}

/// Returns the middle of a triangle, relative to a point.
Eigen::Vector3f middle_from(const Eigen::Vector3d& point_world, const Mesh& mesh, const Triangle& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F -
         (point_world - mesh.origin).cast<float>();
}

/// Returns the triangles of the dynamic surfaces within reach_m of a point.
Mesh triangles_near(const DynamicSurface& surfaces, const Eigen::Vector3d& point_world, double reach_m) {
  Mesh near;
  near.origin = surfaces.seen_world.origin;  // also that of the inferred backs
  for (const Mesh* mesh : {&surfaces.seen_world, &surfaces.inferred_world}) {
    for (const Triangle& t : mesh->triangles) {
      if (middle_from(point_world, *mesh, t).norm() > static_cast<float>(reach_m)) continue;
      const auto first = static_cast<std::uint32_t>(near.vertices.size());
      for (const std::uint32_t v : t) near.vertices.push_back(mesh->vertices[v]);
      near.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return near;
}

/// Returns the mesh with only the triangles on one side of a point.
Mesh side_of(Mesh mesh, const Eigen::Vector3d& point_world, const Eigen::Vector3d& direction) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return middle_from(point_world, mesh, t).dot(direction.cast<float>()) < 0.0F;
  });
  return mesh;
}

/// Returns the depth by which the surfaces on one side of the object's middle overlap it; 0 without overlap.
double depth_m(const Mesh& side, const Eigen::Vector3d& shift_world, const VirtualObject& object,
               const Eigen::Vector3d& direction, Radar& radar) {
  TriangleTree tree;
  tree.build_in_order(side);
  SceneTree surface{{&tree, Eigen::Isometry3d::Identity()}, SurfaceKind::kDynamic};
  surface.instance.T_world_mesh.translation() = shift_world;
  const Contact contact = radar.query(
      {{&object.model->shape.touched, object.body.T_world_object}, direction, 0.001}, {{&surface, 1}, {}});
  return contact.status == ContactStatus::kOverlap ? std::max(0.0, -contact.contact_distance_m) : 0.0;
}

/// If dynamic surfaces overlap the object from two opposite sides, as two fingers do: sets its velocity to
/// theirs, and to the middle between them. Returns false otherwise.
bool grip(const Eigen::Vector3d& shift_world, const DynamicSurface& surfaces, const DueObject& one,
          double dt_s, Radar& radar) {
  constexpr double kDeepest_m = 0.03;  // fingers may be this deep in the object
  constexpr double kCentred = 0.3;     // fraction of the way to the middle, per call
  VirtualObject& object = *one.object;
  const Eigen::Vector3d middle = middle_world(object) - shift_world;
  const Mesh near = triangles_near(surfaces, middle, radius_m(object));
  if (near.triangles.empty()) return false;
  for (const Eigen::Vector3d& direction : one.sweep.push.span()) {
    const Mesh ahead = side_of(near, middle, direction), behind = side_of(near, middle, -direction);
    if (ahead.triangles.empty() || behind.triangles.empty()) continue;
    const double ahead_m = depth_m(ahead, shift_world, object, direction, radar);
    const double behind_m = depth_m(behind, shift_world, object, -direction, radar);
    if (!(ahead_m > 0.0 && behind_m > 0.0 && std::max(ahead_m, behind_m) < kDeepest_m)) continue;
    object.body.velocity_world_mps = one.sweep.way_world / std::max(one.waited_s, 1e-9) +
                                     kCentred * 0.5 * (behind_m - ahead_m) / std::max(dt_s, 1e-9) * direction;
    object.body.angular_velocity_world_rad_s.setZero();
    object.body.asleep = false;
    return true;
  }
  return false;
}

/// Removes the inferred back from the object's scene if it engulfs the object.
void leave_out_engulfing_back(DueObject& one, const AdvancedBody& advanced, PhysicsConfig config,
                              const TimedRadar& timed) {
  const auto back = std::find_if(one.scene.begin(), one.scene.end(), [](const SceneTree& surface) {
    return surface.kind == SurfaceKind::kInferredBack;
  });
  if (back == one.scene.end()) return;
  const RadarScene of_back{{&*back, 1}, {}};
  const CollisionQueries probe =
      make_collision_queries(timed.radar, one.object->model->shape.touched, of_back, &timed.queries_ms);
  config.max_depenetration_mps = max_push_mps(advanced, config);
  if (is_engulfed(*advanced.body, advanced.dt_s, probe.travel, config,
                  advanced.depenetration_directions_world))
    back->instance.tree = nullptr;
}

/// Sets the velocity that takes a carried object to its target by the end of this frame.
void set_in_hand(VirtualObject& object, double dt_s) {
  const Eigen::Vector3d way = *object.carried_to_world - object.body.T_world_object.translation();
  object.body.asleep = false;
  object.body.angular_velocity_world_rad_s.setZero();
  object.body.velocity_world_mps = dt_s > 0.0 ? Eigen::Vector3d(way / dt_s) : Eigen::Vector3d::Zero();
}

/// Sets VirtualObject::contacts of the objects that are awake or have just fallen asleep.
void keep_contacts(std::span<const DueObject> due, std::span<AdvancedBody> advanced) {
  for (std::size_t i = 0; i < due.size(); ++i)
    if (!advanced[i].near.empty() || !due[i].object->body.asleep) due[i].object->contacts.clear();
  for (std::size_t i = 0; i < due.size(); ++i) {
    for (const ClosestPoint& p : advanced[i].near) {
      const Body* other = body_of(due[i].bodies, p);
      due[i].object->contacts.push_back({p, other});
      const auto met = std::find_if(due.begin(), due.end(),
                                    [&](const DueObject& one) { return &one.object->body == other; });
      if (met == due.end() || met->object->body.asleep) continue;
      ClosestPoint reversed = p;
      reversed.point_world += p.gap_m * p.normal_world;
      reversed.normal_world = -p.normal_world;
      met->object->contacts.push_back({reversed, &due[i].object->body});
    }
    advanced[i].near.clear();
  }
}

/// Returns the body of each tree of the object's scene. Entries of surfaces are null. The other objects must
/// be the last trees of the scene.
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

/// Returns true if nothing new can overlap the object: only physics has moved it to its pose, and no moving
/// surface is within 25 cm.
bool is_undisturbed(const VirtualObject& object, std::span<const SceneTree> scene) {
  if (!object.placement.T_world_undisturbed) return false;
  if (object.placement.T_world_undisturbed->matrix() != object.body.T_world_object.matrix()) return false;
  const TreeInstance own{&object.model->shape.touched, object.body.T_world_object};
  return std::none_of(scene.begin(), scene.end(), [&](const SceneTree& surface) {
    return is_moving_surface(surface.kind) && is_usable(surface.instance) &&
           !are_farther_apart(own, surface.instance, kNearbyReach_m);
  });
}

/// Advances the objects together; see advance_together(). A carried object moves at the velocity that reaches
/// its target after waited_s. Gravity, friction and restitution do not act on a carried object. Obstacles
/// stop it.
///
/// Within the call, the dynamic surfaces near an object move from their position in the last frame to their
/// position in this frame. They move in steps of at most 15 mm, and push the object on the way. Hence a hand
/// that moves by up to 15 cm per frame does not pass the object between two frames. An inferred back that
/// engulfs the object (is_engulfed()) is left out of the object's scene.
/// @param moving    this frame's surfaces; null: no surface is known to be dynamic
/// @param contacts  buffers; keeps impulses as initial guesses for a next call with the same objects
/// @param counts    incremented by the contacts of this call
void advance_objects(std::span<DueObject> due, const FrameScene* moving, const PhysicsConfig& config,
                     const TimedRadar& timed, ContactSystem& contacts, ContactCounts& counts) {
  std::vector<AdvancedBody> advanced;
  const std::vector<SceneTree> surfaces = moving != nullptr ? moving->surfaces() : std::vector<SceneTree>{};
  int pieces = 1;
  for (DueObject& one : due) {
    VirtualObject& object = *one.object;
    one.seen.trees = one.scene;
    one.probe = make_collision_queries(timed.radar, object.model->shape.touched, one.seen, &timed.queries_ms);
    one.probe.others = one.bodies;
    const bool is_left_alone = moving != nullptr && is_undisturbed(object, one.scene);
    if (moving != nullptr && !is_left_alone) one.sweep = sweep_near(object, *moving);
    advanced.push_back({.body = &object.body,
                        .probe = &one.probe,
                        .scene = one.scene,
                        .mass_kg = object.body.mass.mass_kg,
                        .is_carried = object.carried_to_world.has_value(),
                        .is_undisturbed = is_left_alone,
                        .surface_speed_mps = one.sweep.way_world.norm() / std::max(one.waited_s, 1e-9)});
    pieces = std::max({pieces, pieces_of(one.waited_s, config), steps_of(one.sweep)});
  }
  for (int left = pieces; left > 0; --left) {
    for (std::size_t i = 0; i < due.size(); ++i) {
      advanced[i].dt_s = due[i].waited_s / pieces;
      if (due[i].object->carried_to_world) set_in_hand(*due[i].object, left * advanced[i].dt_s);
      if (moving == nullptr || advanced[i].is_undisturbed) continue;
      const double left_part = static_cast<double>(left - 1) / pieces;
      put_surfaces(left_part, *moving, surfaces, due[i], advanced[i]);
      advanced[i].is_gripped = !due[i].object->carried_to_world &&
                               grip(-left_part * due[i].sweep.way_world, moving->dynamic_world(), due[i],
                                    advanced[i].dt_s, timed.radar);
      advanced[i].is_carried = advanced[i].is_gripped || due[i].object->carried_to_world;
      leave_out_engulfing_back(due[i], advanced[i], config, timed);
    }
    advance_together(advanced, config, contacts);
    keep_contacts(due, advanced);
    for (std::size_t i = 0; i < due.size(); ++i) {
      const StepReport& report = advanced[i].report;
      due[i].was_overlapped |= report.deepest_overlap_m > config.overlap_allowed_m;
      counts.contacts += report.contacts;
      for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
        counts.by_kind[kind] += report.contacts_by_kind[kind];
    }
  }
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

std::vector<FineRegion> fine_regions(std::span<const std::unique_ptr<VirtualObject>> objects) {
  constexpr double kAbout_m = 0.02;  // an object's travel per frame at 0.6 m/s
  std::vector<FineRegion> regions;
  for (const auto& object : objects) {
    if (object->in_room) regions.push_back({middle_world(*object), radius_m(*object) + kAbout_m});
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

namespace {

/// Returns the room's depth; 0 where something dynamic is in front of it and might stand on it.
DepthImage seen_room_depth_m(const ExpectedView& expected, const FrameForeground& foreground) {
  DepthImage depth_m = expected.depth_m;
  const MaskImage& moved = foreground.dynamic_mask;
  for (std::size_t i = 0; i < std::min(moved.pixels.size(), depth_m.pixels.size()); ++i)
    if (moved.pixels[i] != 0) depth_m.pixels[i] = 0.0F;
  return depth_m;
}

/// Returns true if an object at the start of its fall, and on its way down, is clear of everything, and the
/// surface that it meets is the room's own at the expected height.
bool is_fall_free(const VirtualObject& object, const Eigen::Isometry3d& T_world_start, double height_m,
                  const DropScene& scene) {
  constexpr double kClearance_m = 0.02;  // sideways, and above the object
  constexpr double kUnevenness_m = 0.02;
  const PlacementConfig placement;
  const double slope = std::tan(placement.max_tilt_deg * (std::numbers::pi / 180.0));
  const double early_m = slope * footprint_radius_m(object, T_world_start.linear()) + kUnevenness_m;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const TreeInstance at_start{&object.model->shape.touched, T_world_start};
  const RadarScene surfaces{scene.surfaces, {}};
  if (is_in_solid_unknown(scene.room, object, T_world_start)) return false;
  const Contact around = scene.radar.query({at_start, down, height_m + kClearance_m, kClearance_m}, surfaces);
  if (!(around.lower_m >= height_m - kClearance_m - early_m)) return false;
  const Contact below = scene.radar.query({at_start, down, height_m + kUnevenness_m + early_m}, surfaces);
  // Without the map, only the frame's own surfaces exist.
  const bool has_map = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                   [](const SceneTree& s) { return s.kind == SurfaceKind::kStatic; });
  return below.status == ContactStatus::kContact &&
         below.touched == (has_map ? SurfaceKind::kStatic : SurfaceKind::kDynamic);
}

/// Simulates the fall against the surfaces as they are in this frame. Returns true if the object then is at
/// rest, within 5 cm of its start seen from above and turned by at most 30 degrees.
bool stays_after_fall(const VirtualObject& object, const Eigen::Isometry3d& T_world_start,
                      const DropScene& scene) {
  constexpr double kMostMoved_m = 0.05, kMostTurned_deg = 30.0;
  constexpr double kStep_s = 1.0 / 30.0;
  constexpr int kMostSteps = 90;
  Body body = object.body;
  body.T_world_object = T_world_start;
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
  body.asleep = false;
  body.sleep_timer_s = 0.0;
  body.supporting_bodies.clear();
  const RadarScene surfaces{scene.surfaces, {}};
  const CollisionQueries probe = make_collision_queries(scene.radar, object.model->shape.touched, surfaces);
  const Eigen::Vector3d start_world = T_world_start * object.model->middle;
  for (int step = 0; step < kMostSteps && !body.asleep; ++step) {
    if (advance(body, kStep_s, probe, scene.physics).status != StepStatus::kMoved) return false;
    const Eigen::Vector3d moved_m = body.T_world_object * object.model->middle - start_world;
    const double turned_deg =
        Eigen::AngleAxisd(body.T_world_object.linear() * T_world_start.linear().transpose()).angle() *
        (180.0 / std::numbers::pi);
    if (moved_m.head<2>().norm() > kMostMoved_m || turned_deg > kMostTurned_deg) return false;
  }
  return body.asleep;
}

/// Returns the end of a sentence that says why an object is dropped from less than the requested height.
std::string note_of_height(double height_m, double requested_m) {
  if (height_m == requested_m) return {};
  std::array<char, 160> text{};
  format_classic(text.data(), text.size(),
                 " is dropped from %.3g m, since it would topple or move away if dropped from %.3g m",
                 height_m, requested_m);
  return text.data();
}

/// Returns the end of a sentence: the reason why there is no place.
std::string reason_of(SupportStatus status, double footprint_radius_m) {
  std::array<char, 160> text{};
  switch (status) {
    case SupportStatus::kNothingMeasured:
      return "the map has no surface between 0.4 and 4 m in this view";
    case SupportStatus::kNotLevel:
      return "the map has no level surface in this view";
    case SupportStatus::kTooSmall:
      format_classic(text.data(), text.size(),
                     "it needs a free circle %.2f m across, and no level surface in this view has one",
                     2.0 * (footprint_radius_m + PlacementConfig{}.room_to_spare_m));
      return text.data();
    case SupportStatus::kTooFar:
      format_classic(text.data(), text.size(),
                     "it needs a free level circle %.2f m across, and none is within %.0f cm of that point",
                     2.0 * (footprint_radius_m + PlacementConfig{}.room_to_spare_m),
                     100.0 * PlacementConfig{}.max_away_m);
      return text.data();
    case SupportStatus::kBlocked:
      return "something is in the way above or beside every level surface that is large enough, or that "
             "space was not scanned";
    case SupportStatus::kInvalidInput:
    case SupportStatus::kFound:
      break;
  }
  return "the frame has no usable depth";
}

}  // namespace

void require_small_enough(const VirtualObject& object, const DropRequest& drop) {
  const double reach_m =
      footprint_radius_m(object, drop.R_world_object.value_or(object.body.T_world_object.linear()));
  if (reach_m <= kMostFootprint_m) return;
  std::array<char, 320> text{};
  format_classic(
      text.data(), text.size(),
      ": reaches %.3g m sideways from its middle, and only what reaches at most %.0f m is dropped in view. "
      "Make it smaller, in metres (--object FILE,size=0.2; add NAME FILE size 0.2), or say the place "
      "(at=X,Y,Z; drop NAME at X Y Z)",
      reach_m, kMostFootprint_m);
  throw Error(object.body.name + text.data());
}

DropPosition find_drop_position(const VirtualObject& object, const DropRequest& drop, const DropView& view,
                                const DropScene& scene) {
  const Eigen::Matrix3d R_world_object = drop.R_world_object.value_or(object.body.T_world_object.linear());
  const Eigen::Vector3d to_middle = level_to_middle(object, R_world_object);
  const auto start = [&](const Eigen::Vector3d& point_world, double height_m) {
    Eigen::Isometry3d T_world_start = Eigen::Isometry3d::Identity();
    T_world_start.linear() = R_world_object;
    T_world_start.translation() = point_world - to_middle;
    T_world_start.translation().z() += height_m - lowest_m(object, R_world_object);
    return T_world_start;
  };
  constexpr int kMostTried = 6;
  int tried = 0;
  std::optional<Eigen::Vector3d> first_free;
  double height_m = drop.height_m;
  const auto is_free = [&](const Eigen::Vector3d& point_world) {
    if (tried == kMostTried) return false;
    if (!is_fall_free(object, start(point_world, drop.height_m), drop.height_m, scene)) return false;
    if (!first_free) first_free = point_world;
    ++tried;
    const auto stays_from = [&](double from_m) {
      height_m = from_m;
      return stays_after_fall(object, start(point_world, from_m), scene);
    };
    return stays_from(drop.height_m) || (drop.height_m > kGentleDrop_m && stays_from(kGentleDrop_m));
  };
  const double radius_m = footprint_radius_m(object, R_world_object);
  const Support support = find_support(seen_room_depth_m(view.expected, view.foreground), view.camera,
                                       view.T_world_camera, {radius_m, drop.near_world, is_free});
  if (support) return {support.point_world - to_middle, height_m, note_of_height(height_m, drop.height_m)};
  if (first_free)
    return {*first_free - to_middle, drop.height_m,
            " may not stay where it is dropped: it topples, rolls or slides on every level surface that was "
            "tried"};
  return {std::nullopt, 0.0, reason_of(support.status, radius_m)};
}

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
  object.body.velocity_world_mps = state.velocity_world_mps;
  object.body.angular_velocity_world_rad_s = state.angular_velocity_world_rad_s;
  object.body.asleep = false;
  object.in_room = true;
  const bool is_in_unknown = is_in_solid_unknown(room_, object);
  object.placement = {.R_world = object.body.T_world_object.linear(),
                      .began_in_unknown = is_in_unknown,
                      .in_unknown = is_in_unknown,
                      .T_world_still = object.body.T_world_object};
}

WayOut ObjectSet::way_out_of(const VirtualObject& object) {
  return {room_, scene_.surfaces(), scene_without(&object), config_.physics.contact_margin_m, exact_radar_};
}

void ObjectSet::place(const std::string& name, const ObjectState& state) { put(take_over(name), state); }

void ObjectSet::stand(const std::string& name, const Eigen::Isometry3d& T_world_object) {
  VirtualObject& object = take_over(name);
  Body& body = object.body;
  body.T_world_object = T_world_object;
  body.velocity_world_mps.setZero();
  body.angular_velocity_world_rad_s.setZero();
  body.asleep = true;
  body.rests_on = SurfaceKind::kStatic;
  body.supporting_bodies.clear();
  object.in_room = true;
  const bool is_in_unknown = is_in_solid_unknown(room_, object);
  object.placement = {.R_world = T_world_object.linear(),
                      .began_in_unknown = is_in_unknown,
                      .in_unknown = is_in_unknown,
                      .T_world_still = T_world_object};
}

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
  object.placement.R_world = object.body.T_world_object.linear();
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
    object->placement.waited_s += std::min(dt_s, config_.physics.max_advance_s);  // longer gaps are stalls
    if (!object->carried_to_world && !is_turn_to_move(index, frame_number, config_)) continue;
    if (object->placement.stuck && object->placement.waited_s < kStuckLooksAfter_s) continue;
    if (!object->body.asleep)
      object->placement.in_unknown = object->placement.in_unknown && is_in_solid_unknown(room_, *object);
    due.push_back({.object = object, .waited_s = std::exchange(object->placement.waited_s, 0.0)});
  }
  // Without the map, all surfaces are the frame's, and none is known to be dynamic.
  const bool has_map = config_.scene.surfaces == SurfacePolicy::kMap;
  for (DueObject& one : due) {
    one.scene = scene_without(one.object);
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
    object.placement.T_world_undisturbed.reset();
    if (!is_any_overlapped && !object.placement.in_unknown)
      object.placement.T_world_undisturbed = object.body.T_world_object;
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
    object->placement.T_world_undisturbed.reset();
  }
}

void ObjectSet::unknown_changed() {
  for (const auto& object : objects_) {
    object->placement.in_unknown = object->placement.began_in_unknown =
        object->in_room && is_in_solid_unknown(room_, *object);
    object->placement.T_world_undisturbed.reset();
  }
}

}  // namespace roomradar
