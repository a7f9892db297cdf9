// object_motion.cpp: advances the objects that are due, and the surfaces around them.
#include "app/session/object_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/physics/physics.hpp"
#include "app/physics/sleeper_contacts.hpp"
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

/// How the dynamic surfaces near an object move in this frame.
struct SurfaceSweep {
  Eigen::Vector3d way_world = Eigen::Vector3d::Zero();  // from the last frame to this one, m
  PushDirections push{};
};

SurfaceSweep sweep_near(const DueObject& one, const FrameScene& moving) {
  constexpr double kFarthest_m = 0.15;  // 4.5 m/s at 30 frames/s
  const VirtualObject& object = *one.object;
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
void put_surfaces(SurfaceSweep& sweep, double left, const FrameScene& moving,
                  std::span<const SceneTree> surfaces, DueObject& one, AdvancedBody& advanced) {
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
bool grip(const SurfaceSweep& sweep, const Eigen::Vector3d& shift_world, const DynamicSurface& surfaces,
          const DueObject& one, double dt_s, Radar& radar) {
  constexpr double kDeepest_m = 0.03;  // fingers may be this deep in the object
  constexpr double kCentred = 0.3;     // fraction of the way to the middle, per call
  VirtualObject& object = *one.object;
  const Eigen::Vector3d middle = middle_world(object) - shift_world;
  const Mesh near = triangles_near(surfaces, middle, radius_m(object));
  if (near.triangles.empty()) return false;
  for (const Eigen::Vector3d& direction : sweep.push.span()) {
    const Mesh ahead = side_of(near, middle, direction), behind = side_of(near, middle, -direction);
    if (ahead.triangles.empty() || behind.triangles.empty()) continue;
    const double ahead_m = depth_m(ahead, shift_world, object, direction, radar);
    const double behind_m = depth_m(behind, shift_world, object, -direction, radar);
    if (!(ahead_m > 0.0 && behind_m > 0.0 && std::max(ahead_m, behind_m) < kDeepest_m)) continue;
    object.body.velocity_world_mps = sweep.way_world / std::max(one.waited_s, 1e-9) +
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

bool is_undisturbed(const VirtualObject& object, std::span<const SceneTree> scene) {
  if (!object.T_world_undisturbed) return false;
  if (object.T_world_undisturbed->matrix() != object.body.T_world_object.matrix()) return false;
  const TreeInstance own{&object.model->shape.touched, object.body.T_world_object};
  return std::none_of(scene.begin(), scene.end(), [&](const SceneTree& surface) {
    return is_moving_surface(surface.kind) && is_usable(surface.instance) &&
           !are_farther_apart(own, surface.instance, kNearbyReach_m);
  });
}

void advance_objects(std::span<DueObject> due, const FrameScene* moving, const PhysicsConfig& config,
                     const TimedRadar& timed, ContactSystem& contacts, ContactCounts& counts) {
  std::vector<RadarScene> scenes;
  std::vector<CollisionQueries> probes;
  std::vector<AdvancedBody> advanced;
  std::vector<SurfaceSweep> sweeps;
  const std::vector<SceneTree> surfaces = moving != nullptr ? moving->surfaces() : std::vector<SceneTree>{};
  scenes.reserve(due.size());  // the queries refer to them
  probes.reserve(due.size());
  int pieces = 1;
  for (DueObject& one : due) {
    scenes.push_back({one.scene, {}});
    probes.push_back(make_collision_queries(timed.radar, one.object->model->shape.touched, scenes.back(),
                                            &timed.queries_ms));
    probes.back().others = one.bodies;
    sweeps.push_back(moving == nullptr || one.is_undisturbed ? SurfaceSweep{} : sweep_near(one, *moving));
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
                        .surface_speed_mps = sweeps.back().way_world.norm() / std::max(one.waited_s, 1e-9),
                        .moved = [&body, seen_as = std::move(seen_as)] {
                          for (SceneTree* tree : seen_as) tree->instance.T_world_mesh = body.T_world_object;
                        }});
    pieces = std::max({pieces, pieces_of(one.waited_s, config), steps_of(sweeps.back())});
  }
  for (int left = pieces; left > 0; --left) {
    for (std::size_t i = 0; i < due.size(); ++i) {
      advanced[i].dt_s = due[i].waited_s / pieces;
      if (due[i].object->carried_to_world) set_in_hand(*due[i].object, left * advanced[i].dt_s);
      if (moving == nullptr || due[i].is_undisturbed) continue;
      const double left_part = static_cast<double>(left - 1) / pieces;
      put_surfaces(sweeps[i], left_part, *moving, surfaces, due[i], advanced[i]);
      advanced[i].is_gripped = !due[i].object->carried_to_world &&
                               grip(sweeps[i], -left_part * sweeps[i].way_world, moving->dynamic_world(),
                                    due[i], advanced[i].dt_s, timed.radar);
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

}  // namespace roomradar
