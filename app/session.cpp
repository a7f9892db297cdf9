// session.cpp: the path of one frame, top to bottom, and the steps it is made of.
#include "app/session.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/placement.hpp"
#include "mapping/types/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr double kNearbyReach_m = 0.25;  // moving surfaces farther from an object than this do not push it

}  // namespace

Session::Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree)
    : map_(map),
      config_(config),
      room_(context_),
      scene_(context_, room_, config.scene, &unknown_tree_),
      radar_(config.radar),
      drawer_(context_) {
  require_valid(config.physics);
  require_valid(config.picture);
  room_.set(map.mesh, MeshUsage::kStatic);
  if (!config.adopt) return;
  if (octree == nullptr) throw Error("adopt: the session was given no octree to change");
  if (config.scene.surfaces != SurfacePolicy::kMap)
    throw Error(std::string("adopt: with --surfaces ") + std::string(to_string(config.scene.surfaces)) +
                " nothing is asked of the map, so there is nothing to adopt into; use --surfaces map");
  living_map_ = std::make_unique<LivingMap>(*octree, map.mesh, *config.adopt);
}

void Session::make_unknown_solid(StageTimes& times) {
  if (config_.scene.surfaces != SurfacePolicy::kMap)
    throw Error("unknown space is solid only with the map's surfaces: the others do not know what was seen");
  times.timed("unknown", [&] {
    unknown_ = unknown_surface(map_.octree, map_.mesh);
    unknown_tree_.build_by_place(unknown_.mesh_world);
    unknown_is_solid_ = true;
    if (living_map_) living_map_->keep_up_unknown();
  });
}

FrameResult Session::step(const Frame& frame, StageTimes& times) {
  if (const std::string_view fault = fault_of(frame); !fault.empty()) {
    FrameResult bad;
    bad.status = FrameStatus::kBadFrame;
    bad.fault = fault;
    return bad;
  }
  FrameResult result = times.timed("frame", [&] { return pass_through(frame, times); });
  if (config_.measure_penetration && result.status == FrameStatus::kDone)
    result.deepest_penetration_m = penetration_m();
  return result;
}

FrameResult Session::pass_through(const Frame& frame, StageTimes& times) {
  FrameResult result;
  const auto handed_over = std::chrono::steady_clock::now();
  const double dt_s = has_last_stamp_ ? std::max(0.0, frame.stamp_s - last_stamp_s_) : 0.0;
  last_stamp_s_ = frame.stamp_s;
  has_last_stamp_ = true;

  if (living_map_ && living_map_->is_due(frame)) times.timed("adopt", [&] { renew_room(); });
  const Tracking tracking = times.timed("locate", [&] { return locate_camera(frame); });  // where am I?
  result.tracking = tracking.status;
  if (tracking.status != TrackStatus::kTracked && tracking.status != TrackStatus::kDegenerate) {
    if (config_.make_picture) {
      view_of(frame);
      picture_ = background_;
    }
    return result;
  }
  const Eigen::Isometry3d& T_world_camera = tracking.T_world_camera;
  result.static_triangles_drawn =
      times.timed("expected", [&] { return scene_.render_expected(frame.depth_camera, T_world_camera); });
  result.foreground = times.timed("foreground", [&] { return scene_.find_moved(frame); });  // what moved?
  if (living_map_)
    times.timed("changes", [&] {  // what came to stay, what is gone?
      living_map_->watch(frame, scene_.expected_depth_m(), scene_.labels(), T_world_camera);
    });
  find_fine_regions();
  times.timed("mesh", [&] { scene_.mesh_moved(frame, T_world_camera, fine_regions_); });
  release_waiting(frame, T_world_camera);
  times.timed("physics", [&] { move_objects(dt_s, times, result); });  // R, M, L
  times.add_ms("contact", ms_since(handed_over));
  if (config_.make_picture) times.timed("compose", [&] { compose_picture(frame, T_world_camera); });

  result.status = FrameStatus::kDone;
  result.T_world_camera = T_world_camera;
  result.dynamic_triangles = scene_.moved_triangles();
  result.inferred_triangles = scene_.inferred_triangles();
  return result;
}

Tracking Session::locate_camera(const Frame& frame) {
  if (config_.poses == PoseOrigin::kRecorded) {
    Tracking tracking;
    if (!frame.T_world_camera) return tracking;
    tracking.status = TrackStatus::kTracked;
    tracking.T_world_camera = map_.info.T_world_recorded * *frame.T_world_camera;
    return tracking;
  }
  const auto expected_depth = [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
    scene_.render_expected(frame.depth_camera, T_world_camera);
    return scene_.expected_depth_m();
  };
  return locate(locator_, frame, map_.places, scene_.moved_mask(), expected_depth);
}

void Session::renew_room() {
  ChangedRoom& room = living_map_->room();
  room_.set(room.mesh, std::move(room.tree));
  if (unknown_is_solid_) {
    unknown_ = std::move(room.unknown);
    unknown_tree_ = std::move(room.unknown_tree);
  }
  scene_.room_changed();
}

std::vector<AdoptedChange> Session::adopted() const {
  return living_map_ ? living_map_->adopted() : std::vector<AdoptedChange>{};
}

void Session::finish_adopting() {
  if (living_map_) living_map_->finish();
}

std::vector<SceneTree> Session::scene_without(const VirtualObject* object) const {
  std::vector<SceneTree> scene = scene_.surfaces();
  for (const auto& other : objects_) {
    if (other.get() != object && other->in_room)
      scene.push_back({{&other->shape.touched, other->body.T_world_object}, Touched::kObject});
  }
  return scene;
}

bool Session::is_in_unknown(const VirtualObject& object) const {
  if (!unknown_is_solid_) return false;
  const Eigen::Isometry3d& T_world_object = object.body.T_world_object;
  const GpuMesh& mesh = object.shape.drawn;
  const auto corner = [&](std::uint32_t vertex) -> Eigen::Vector3d {
    return T_world_object * (mesh.origin() + mesh.vertices()[vertex].cast<double>());
  };
  const auto triangles = mesh.triangles();
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& triangle) {
    const Eigen::Vector3d a = corner(triangle[0]), b = corner(triangle[1]), c = corner(triangle[2]);
    return is_unknown(unknown_, a) || is_unknown(unknown_, b) || is_unknown(unknown_, c) ||
           is_unknown(unknown_, (a + b + c) / 3.0);
  });
}

void Session::find_fine_regions() {
  constexpr double kAbout_m = 0.02;  // an object's way in a frame, at 0.6 m/s
  fine_regions_.clear();
  for (const auto& object : objects_) {
    if (object->in_room)
      fine_regions_.push_back({object->body.T_world_object * object->middle,
                               0.5 * object->shape.drawn.bounds().sizes().norm() + kAbout_m});
  }
}

void Session::move_objects(double dt_s, StageTimes& times, FrameResult& result) {
  double radar_ms = 0.0;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    object->in_unknown = object->in_unknown && is_in_unknown(*object);
    PushDirections push;  // without a map all surfaces are the frame's, and none of them is known to move
    if (config_.scene.surfaces == SurfacePolicy::kMap)
      push = push_directions({&scene_.moved_world().seen_world, &scene_.moved_world().inferred_world},
                             object->body.T_world_object * object->middle, kNearbyReach_m);
    std::vector<SceneTree> scene = scene_without(object.get());
    const auto is_back = [](const SceneTree& surface) { return surface.kind == Touched::kInferredBack; };
    const auto back = std::find_if(scene.begin(), scene.end(), is_back);
    if (back != scene.end()) {
      const RadarScene of_back{{&*back, 1}, {}};
      const BodyProbe probe = probe_of(radar_, near_field_, object->shape.touched, of_back, &radar_ms);
      if (is_swallowed(object->body, dt_s, probe.travel, config_.physics, push.span())) scene.erase(back);
    }
    const RadarScene radar_scene{scene, {}};
    const BodyProbe probe = probe_of(radar_, near_field_, object->shape.touched, radar_scene, &radar_ms);
    const StepReport moved = advance(object->body, dt_s, probe, config_.physics, push.span());
    result.contacts += moved.contacts;
    for (std::size_t kind = 0; kind < kTouchedKinds; ++kind)
      result.contacts_by_kind[kind] += moved.contacts_by_kind[kind];
  }
  times.add_ms("radar", radar_ms);
}

double Session::penetration_m() {
  double deepest_m = 0.0;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    std::vector<SceneTree> still = scene_without(object.get());
    // A hand that reaches into an object is the hand's doing; in the unknown there may be nothing.
    if (config_.scene.surfaces == SurfacePolicy::kMap)
      std::erase_if(still, [](const SceneTree& surface) {
        return surface.kind != Touched::kStatic && surface.kind != Touched::kObject;
      });
    const Contact below = exact_radar_.query(
        {{&object->shape.touched, object->body.T_world_object}, config_.physics.gravity_world_mps2, 0.01},
        {still, {}});
    if (below.status == ContactStatus::kOverlap) deepest_m = std::max(deepest_m, -below.travel_m);
  }
  return deepest_m;
}

Session::PictureView Session::view_of(const Frame& frame) {
  if (!frame.colour.empty()) {
    colour_view_ = {frame.colour_camera, frame.T_colour_depth};
    background_ = frame.colour;
  }
  if (colour_view_) return *colour_view_;
  shade_depth(frame.depth_m, frame.depth_camera, background_);
  return {frame.depth_camera, Eigen::Isometry3d::Identity()};
}

void Session::renew_a_shadow() {
  constexpr double kTurned_rad = 0.05;
  VirtualObject* most_turned = nullptr;
  double turned_rad = kTurned_rad;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    const Eigen::AngleAxisd turn(object->shadow.R_world_object.transpose() *
                                 object->body.T_world_object.linear());
    if (!(turn.angle() > turned_rad)) continue;
    turned_rad = turn.angle();
    most_turned = object.get();
  }
  if (most_turned != nullptr)
    make_contact_shadow(most_turned->surface, most_turned->body.T_world_object.linear(), most_turned->shadow);
}

void Session::compose_picture(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  const PictureView view = view_of(frame);
  const Intrinsics& camera = view.camera;
  const Eigen::Isometry3d T_world_view = T_world_camera * view.T_view_depth.inverse();

  renew_a_shadow();
  std::vector<DrawnObject> drawn;
  std::vector<ShadowCaster> casters;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    drawn.push_back({.instance = {&drawn_mesh(*object, camera, T_world_view), object->body.T_world_object},
                     .is_closed = object->shape.touched.is_closed()});
    casters.push_back({&object->shadow, object->body.T_world_object});
  }
  drawer_.draw(drawn, camera, T_world_view, {}, layer_);

  real_depth_m_.resize(camera.width_px, camera.height_px);
  const PixelRect rect = pixels_to_compose(casters, camera, T_world_view, layer_, config_.picture.occlusion);
  if (rect.width > 0 && rect.height > 0) {
    scene_.render_surfaces(camera, T_world_view, rect, real_depth_m_);
  }
  compose(background_, camera, T_world_view, real_depth_m_, casters, layer_, config_.picture, occlusion_,
          picture_);
}

VirtualObject& Session::object_named(const std::string& name) {
  const auto found = std::find_if(objects_.begin(), objects_.end(),
                                  [&](const auto& object) { return object->body.name == name; });
  if (found == objects_.end()) throw Error("script: there is no object named " + name);
  return **found;
}

void Session::add_object(const std::string& name, const Mesh& mesh) {
  objects_.push_back(std::make_unique<VirtualObject>(context_, name, mesh));
}

void Session::apply(const ScriptEvent& event) {
  const auto put = [&](VirtualObject& object, const Eigen::Vector3d& position_world) {
    object.body.T_world_object.translation() = position_world;
    object.R_world_put = object.body.T_world_object.linear();
    object.body.velocity_world_mps = event.velocity_world_mps;
    object.body.spin_world_rad_s = event.spin_world_rad_s;
    object.body.at_rest = false;
    object.in_room = true;
    object.in_unknown = object.began_in_unknown = is_in_unknown(object);
  };
  // Whatever is said of an object now takes the place of a drop that it waits for.
  std::erase_if(waiting_, [&](const ScriptEvent& waiting) { return waiting.name == event.name; });
  if (event.R_world_object && event.position_world)
    object_named(event.name).body.T_world_object.linear() = *event.R_world_object;
  switch (event.action) {
    case Action::kAdd:
      add_object(event.name, object_mesh(event.mesh, event.size_m.value_or(0.0)));
      break;
    case Action::kPlace:
    case Action::kThrow:
      put(object_named(event.name), *event.position_world);
      break;
    case Action::kDrop: {
      VirtualObject& object = object_named(event.name);
      if (!event.position_world) {
        waiting_.push_back(event);
        break;
      }
      put(object, *event.position_world + Eigen::Vector3d(0.0, 0.0, event.height_m - lowest_m(object)));
      break;
    }
    case Action::kRemove:
      object_named(event.name).in_room = false;
      break;
    case Action::kAdopt:
      if (!living_map_) throw Error("script: adopt: this session does not watch for changes");
      living_map_->ask();
      break;
    case Action::kQuit:
      break;
  }
}

void Session::release_waiting(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  for (ScriptEvent& event : std::exchange(waiting_, {})) {
    const std::optional<Support> support =
        find_support(scene_.expected_depth_m(), frame.depth_camera, T_world_camera,
                     object_named(event.name).footprint_radius_m);
    if (support) event.position_world = support->point_world;
    apply(event);  // without a position it waits on
  }
}

}  // namespace roomradar
