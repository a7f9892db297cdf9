// session.cpp: the steps of one frame, in order, and their implementation. Events are in session_events.cpp,
// pictures in session_picture.cpp.
#include "app/session/session.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/session/apply_quality.hpp"
#include "dynamic/surface/reduced_depth.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr double kNearbyReach_m = 0.25;  // dynamic surfaces farther than this from the object do not push it

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

Session::Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree)
    : map_(map),
      config_(config),
      room_(context_),
      scene_(context_, room_, config.scene),
      radar_(config.radar),
      drawer_(context_) {
  require_valid(config.physics);
  require_valid(config.picture);
  locator_.live_view.finest_width_px = locator_.expected_view.finest_width_px = config.tracking_px;
  room_.set(map.mesh, MeshUsage::kStatic);
  if (!config.map_updates) return;
  if (octree == nullptr) throw Error("adopt: the session was given no octree to change");
  if (config.scene.surfaces != SurfacePolicy::kMap)
    throw Error(std::string("adopt: with --surfaces ") + std::string(to_string(config.scene.surfaces)) +
                " the map is not used, so no change can be adopted; use --surfaces map");
  map_updater_ = std::make_unique<MapUpdater>(*octree, map.mesh, *config.map_updates);
}

void Session::make_unknown_solid(StageTimes& times) {
  if (config_.scene.surfaces != SurfacePolicy::kMap)
    throw Error(
        "unknown space can be solid only with the map's surfaces: the others do not know which space was "
        "observed");
  times.timed("unknown", [&] {
    if (unknown_tree_.empty()) {
      if (map_updater_ && (has_last_stamp_ || !map_updater_->committed_changes().empty()))
        throw Error(
            "unknown solid: changes are being adopted into the map; begin the run with --unknown solid");
      unknown_ = unknown_surface(map_.octree, map_.mesh);
      unknown_tree_.build_by_place(unknown_.mesh_world);
      if (map_updater_) map_updater_->keep_up_unknown();
    }
    unknown_is_solid_ = true;
    scene_.set_unknown(&unknown_tree_);
    for (const auto& object : objects_)
      object->in_unknown = object->began_in_unknown = object->in_room && is_in_unknown(*object);
  });
}

void Session::make_unknown_free() {
  unknown_is_solid_ = false;
  scene_.set_unknown(nullptr);
  for (const auto& object : objects_) object->in_unknown = object->began_in_unknown = false;
}

void Session::set_surfaces(SurfacePolicy surfaces) {
  if (surfaces != SurfacePolicy::kMap && map_updater_)
    throw Error("surfaces " + std::string(to_string(surfaces)) +
                ": changes are being adopted into the map, which needs its surfaces");
  if (surfaces != SurfacePolicy::kMap && unknown_is_solid_)
    throw Error("surfaces " + std::string(to_string(surfaces)) +
                ": unknown space is solid, which needs the map's surfaces; make it free first");
  config_.scene.surfaces = surfaces;
  scene_.set_surfaces(surfaces);
}

void Session::set_radar(const RadarConfig& config) {
  asked_of_former_ += radar_.static_triangles_tested();
  radar_ = CyberRadar(config);
  config_.radar = config;
}

void Session::set_quality(const RunQuality& quality) {
  require_valid(quality);
  const RadarConfig radar = config_.radar;
  roomradar::apply(quality, config_);
  if (!(config_.radar == radar)) set_radar(config_.radar);
  scene_.set_fineness(config_.scene);
  locator_.live_view.finest_width_px = locator_.expected_view.finest_width_px = config_.tracking_px;
}

FrameResult Session::step(const Frame& frame, StageTimes& times) {
  if (const std::string_view fault = fault_of(frame); !fault.empty()) {
    FrameResult bad;
    bad.status = FrameStatus::kBadFrame;
    bad.fault = fault;
    return bad;
  }
  FrameResult result = times.timed("frame", [&] { return pass_through(frame, times); });
  if (config_.watch) static_cast<void>(config_.watch(FramePart::kDone, load()));
  for (auto& due : due_quality_)  // for parts that the frame did not reach
    if (due) set_quality(*std::exchange(due, std::nullopt));
  if (config_.measure_penetration && result.status == FrameStatus::kDone)
    result.deepest_penetration_m = penetration_m();
  return result;
}

FrameResult Session::pass_through(const Frame& whole, StageTimes& times) {
  FrameResult result;
  const auto handed_over = std::chrono::steady_clock::now();
  const FrameScene::RoomDrawn drawn_before = scene_.room_drawn();
  const std::uint64_t asked_before = static_triangles_tested();
  const double dt_s = has_last_stamp_ ? std::max(0.0, whole.stamp_s - last_stamp_s_) : 0.0;
  last_stamp_s_ = whole.stamp_s;
  has_last_stamp_ = true;
  watch_for_colour(whole);

  begin(FramePart::kLocate);
  const Frame& frame = times.timed("reduce", [&]() -> const Frame& { return with_depth_reduced(whole); });
  if (map_updater_ && map_updater_->is_due(frame)) times.timed("adopt", [&] { renew_room(); });
  const Tracking tracking = times.timed("locate", [&] { return locate_camera(frame); });
  result.tracking = tracking.status;
  if (tracking.status != TrackStatus::kTracked && tracking.status != TrackStatus::kDegenerate) {
    if (config_.make_picture) show_camera_alone(whole);
    result.picture_is_new = config_.make_picture;
    T_world_before_.reset();
    return result;
  }
  const Eigen::Isometry3d& T_world_camera = tracking.T_world_camera;
  result.static_triangles_drawn =
      times.timed("expected", [&] { return scene_.render_expected(frame.depth_camera, T_world_camera); });
  result.foreground = times.timed("foreground", [&] { return scene_.find_dynamic(frame); });
  if (map_updater_ && tracking)  // not with kDegenerate: the pose is partly predicted
    times.timed("changes", [&] {
      map_updater_->watch(frame, scene_.expected_depth_m(), scene_.labels(), T_world_camera);
    });
  moved_fraction_ =
      static_cast<double>(result.foreground.moved) / static_cast<double>(frame.depth_m.pixels.size());
  begin(FramePart::kMesh);
  find_fine_regions();
  times.timed("mesh", [&] { scene_.mesh_dynamic(frame, T_world_camera, fine_regions_); });
  count_fine_cells();
  if (!waiting_.empty()) times.timed("place", [&] { release_waiting(frame, T_world_camera); });
  begin(FramePart::kPhysics);
  times.timed("physics", [&] { move_objects(dt_s, times, result); });  // Cyber Radar: R, M, L
  times.add_ms("contact", ms_since(handed_over));
  begin(FramePart::kCompose);
  if (config_.make_picture) keep_colour(whole, T_world_camera, dt_s);
  result.picture_is_new = config_.make_picture && is_turn(0, config_.picture_every_n_frames);
  if (result.picture_is_new) times.timed("compose", [&] { compose_picture(whole, T_world_camera); });
  T_world_before_ = T_world_camera;
  ++frames_;

  result.status = FrameStatus::kDone;
  result.T_world_camera = T_world_camera;
  result.dynamic_triangles = scene_.dynamic_triangles();
  result.inferred_triangles = scene_.inferred_triangles();
  result.use = use_of(result.foreground, drawn_before, asked_before);
  return result;
}

void Session::begin(FramePart part) {
  if (auto& due = due_quality_[index_of(part)]; due) set_quality(*std::exchange(due, std::nullopt));
  if (!config_.watch) return;
  if (const std::optional<RunQuality> quality = config_.watch(part, load())) set_quality(*quality);
}

FrameLoad Session::load() const {
  FrameLoad load{.dynamic_fraction = moved_fraction_};
  for (const auto& object : objects_)
    if (object->in_room) ++(object->body.asleep ? load.resting : load.moving);
  return load;
}

bool Session::is_turn_to_move(std::size_t number) const {
  const std::int64_t pictures = config_.picture_every_n_frames;
  if (pictures == 1) return is_turn(number, config_.move_every_n_frames);
  // Frames with a picture do not move objects. The same frames are left out if no pictures are made, so
  // objects move the same with and without pictures.
  const std::int64_t frame = frames_ % pictures;
  const std::int64_t of_these = frames_ / pictures * (pictures - 1) + frame - 1;
  return frame > 0 && (of_these + static_cast<std::int64_t>(number)) % config_.move_every_n_frames == 0;
}

const Frame& Session::with_depth_reduced(const Frame& frame) {
  const int stride = usable_stride(frame.depth_camera, config_.depth_stride);
  if (stride == 1) return frame;
  reduced_.index = frame.index;
  reduced_.stamp_s = frame.stamp_s;
  reduced_.colour = frame.colour;
  reduced_.colour_camera = frame.colour_camera;
  reduced_.colour_after_depth_s = frame.colour_after_depth_s;
  reduced_.T_colour_depth = frame.T_colour_depth;
  reduced_.T_world_camera = frame.T_world_camera;
  reduced_.down_camera = frame.down_camera;
  reduce_depth(frame, stride, reduced_);
  return reduced_;
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
  scene_.expect_size(frame.depth_camera);
  return locate(locator_, frame, map_.keyframe_database, scene_.dynamic_mask(), expected_depth);
}

void Session::renew_room() {
  ChangedRoom& room = map_updater_->room();
  room_.set(room.mesh, std::move(room.tree));
  if (!unknown_tree_.empty()) {  // extracted at first use, and kept up to date since
    unknown_ = std::move(room.unknown);
    unknown_tree_ = std::move(room.unknown_tree);
  }
  scene_.room_changed();
}

std::vector<CommittedChange> Session::committed_changes() const {
  return map_updater_ ? map_updater_->committed_changes() : std::vector<CommittedChange>{};
}

void Session::finish_commits() {
  if (map_updater_) map_updater_->finish();
}

std::vector<SceneTree> Session::scene_without(const VirtualObject* object) const {
  std::vector<SceneTree> scene = scene_.surfaces();
  for (const auto& other : objects_) {
    if (other.get() != object && other->in_room)
      scene.push_back({{&other->model->shape.touched, other->body.T_world_object}, SurfaceKind::kObject});
  }
  return scene;
}

std::span<const SceneBody> Session::bodies_in(const std::vector<SceneTree>& scene,
                                              const VirtualObject& object) {
  constexpr double kOfAHand = 1e6;  // mass ratio that makes a carried object immovable for others
  others_.clear();
  for (const auto& other : objects_) {
    if (other.get() == &object || !other->in_room) continue;
    const double gives =
        object.carried_to_world ? kOfAHand : object.body.mass.mass_kg / other->body.mass.mass_kg;
    others_.push_back({&other->body, other->carried_to_world ? 0.0 : gives});
  }
  others_.insert(others_.begin(), scene.size() - others_.size(), SceneBody{});  // objects come last
  return others_;
}

bool Session::is_in_unknown(const VirtualObject& object) const {
  if (!unknown_is_solid_) return false;
  const Eigen::Isometry3d& T_world_object = object.body.T_world_object;
  const GpuMesh& mesh = object.model->shape.drawn;
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
  constexpr double kAbout_m = 0.02;  // an object's travel per frame at 0.6 m/s
  fine_regions_.clear();
  if (!config_.fine_mesh) return;
  for (const auto& object : objects_) {
    if (object->in_room)
      fine_regions_.push_back(
          {object->body.T_world_object * object->model->middle, radius_m(*object) + kAbout_m});
  }
}

void Session::count_fine_cells() {
  const std::vector<std::uint32_t>& of_region = scene_.dynamic_cells().fine_of_region;
  const bool has_map = config_.scene.surfaces == SurfacePolicy::kMap;
  std::size_t region = 0;  // one region per object in the room, in this order
  for (const auto& object : objects_) {
    const bool has_region = has_map && object->in_room && region < of_region.size();
    object->fine_cells = has_region ? of_region[region++] : 0;
  }
}

FrameUse Session::use_of(const ForegroundCounts& foreground, const FrameScene::RoomDrawn& drawn,
                         std::uint64_t asked) {
  const bool has_map = config_.scene.surfaces == SurfacePolicy::kMap;
  FrameUse use;
  use.room_triangles = room_.touched.triangle_count();
  use.views_drawn = scene_.room_drawn().views - drawn.views;
  if (use.views_drawn > 0)
    use.room_drawn = (scene_.room_drawn().triangles - drawn.triangles) / use.views_drawn;
  use.room_asked = static_cast<std::size_t>(static_triangles_tested() - asked);
  use.valid_px = foreground.valid;
  use.knows_moved = has_map;
  use.meshed_px = has_map ? foreground.moved : foreground.valid;
  use.mesh_triangles = scene_.dynamic_triangles();
  if (has_map) use.cells = scene_.dynamic_cells().counts;
  return use;
}

void Session::move_objects(double dt_s, StageTimes& times, FrameResult& result) {
  double radar_ms = 0.0;
  for (std::size_t number = 0; number < objects_.size(); ++number) {
    VirtualObject* const object = objects_[number].get();
    if (!object->in_room) continue;
    object->waited_s += std::min(dt_s, config_.physics.max_advance_s);  // longer gaps are stalls
    if (!object->carried_to_world && !is_turn_to_move(number)) continue;
    const double waited_s = std::exchange(object->waited_s, 0.0);
    if (!object->body.asleep) object->in_unknown = object->in_unknown && is_in_unknown(*object);
    // Without the map, all surfaces are the frame's, and none is known to be dynamic.
    PushDirections push;
    if (config_.scene.surfaces == SurfacePolicy::kMap)
      push = depenetration_directions(
          {&scene_.dynamic_world().seen_world, &scene_.dynamic_world().inferred_world},
          object->body.T_world_object * object->model->middle, radius_m(*object) + kNearbyReach_m);
    std::vector<SceneTree> scene = scene_without(object);
    const auto is_back = [](const SceneTree& surface) { return surface.kind == SurfaceKind::kInferredBack; };
    const auto back = std::find_if(scene.begin(), scene.end(), is_back);
    if (back != scene.end()) {
      const RadarScene of_back{{&*back, 1}, {}};
      const CollisionQueries probe =
          make_collision_queries(radar_, proximity_, object->model->shape.touched, of_back, &radar_ms);
      if (is_engulfed(object->body, waited_s, probe.travel, config_.physics, push.span())) scene.erase(back);
    }
    const RadarScene radar_scene{scene, {}};
    CollisionQueries probe =
        make_collision_queries(radar_, proximity_, object->model->shape.touched, radar_scene, &radar_ms);
    probe.others = bodies_in(scene, *object);
    const int pieces = pieces_of(waited_s, config_.physics);
    for (int left = pieces; left > 0; --left) {
      const double piece_s = waited_s / pieces;
      if (object->carried_to_world) set_in_hand(*object, left * piece_s);
      const StepReport moved =
          advance(object->body, piece_s, probe,
                  object->carried_to_world ? in_hand(config_.physics) : config_.physics, push.span());
      result.contacts += moved.contacts;
      for (std::size_t kind = 0; kind < kSurfaceKinds; ++kind)
        result.contacts_by_kind[kind] += moved.contacts_by_kind[kind];
    }
  }
  times.add_ms("radar", radar_ms);
}

double Session::penetration_m() {
  double deepest_m = 0.0;
  for (const auto& object : objects_) {
    if (!object->in_room) continue;
    std::vector<SceneTree> still = scene_without(object.get());
    // A real hand may enter an object, and unknown space may be empty; neither counts.
    if (config_.scene.surfaces == SurfacePolicy::kMap)
      std::erase_if(still, [](const SceneTree& surface) {
        return surface.kind != SurfaceKind::kStatic && surface.kind != SurfaceKind::kObject;
      });
    const Contact below = exact_radar_.query({{&object->model->shape.touched, object->body.T_world_object},
                                              config_.physics.gravity_world_mps2,
                                              0.01},
                                             {still, {}});
    if (below.status != ContactStatus::kOverlap) continue;
    // An overlapping surface that crosses no part of the object is in a hollow, such as a handle.
    constexpr double kTouching_m = 1e-6;
    const SurfaceKindMask crossed =
        proximity_.near({&object->model->shape.touched, object->body.T_world_object}, {still, {}},
                        kTouching_m, 0, closest_points_);
    if ((crossed & bit_of(below.touched)) != 0) deepest_m = std::max(deepest_m, -below.contact_distance_m);
  }
  return deepest_m;
}

}  // namespace roomradar
