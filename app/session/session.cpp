// session.cpp: the steps of one frame, in order.
#include "app/session/session.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "app/session/apply_quality.hpp"
#include "dynamic/surface/reduced_depth.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {

namespace {

/// Sets the locator's settings that may change from frame to frame.
void apply_quality(const SessionConfig& config, Locator& locator) {
  locator.live_view.finest_width_px = locator.expected_view.finest_width_px = config.tracking_px;
  locator.verify_every_n_frames = config.verify_every_n_frames;
}

}  // namespace

Session::Session(const SavedMap& map, const SessionConfig& config, StaticMap* octree)
    : map_(map),
      config_(config),
      preparation_(prepare_room(map, config.poses != PoseOrigin::kRecorded && !config.tiles)),
      building_(config.tiles ? std::make_unique<BuildingTracker>(context_, *config.tiles) : nullptr),
      room_{.shape = Shape(context_), .tiles = building_ ? &building_->tiles() : nullptr},
      scene_(context_, room_.shape, config.scene),
      objects_(context_, scene_, room_, config_),
      composer_(context_, scene_, objects_.all(), config_) {
  require_valid(config.physics);
  require_valid(config.picture);
  apply_quality(config_, locator_);
  locator_.use_recorded_poses = config.poses == PoseOrigin::kAuto;
  room_.shape.set(map.mesh, preparation_.tree.get());
  if (preparation_.patches.valid()) locator_.index.patches = preparation_.patches.get();
  set_extent(room_, map);
  scene_.set_tiles(room_.tiles);
  if (!config.map_updates) return;
  if (octree == nullptr || building_) throw Error("commit changes: the session has no octree to change");
  if (config.scene.surfaces != SurfacePolicy::kMap)
    throw Error("commit changes: with --surfaces " + std::string(to_string(config.scene.surfaces)) +
                " the map is not used, so no change can be committed; use --surfaces map");
  map_updater_ = std::make_unique<MapUpdater>(*octree, map.mesh, *config.map_updates);
}

void Session::make_unknown_solid(StageTimes& times) {
  if (config_.scene.surfaces != SurfacePolicy::kMap)
    throw Error(
        "unknown space can be solid only with the map's surfaces: the others do not know which space was "
        "observed");
  if (room_.tiles && !room_.tiles->config().choice.has_unknown)
    throw Error("unknown solid: the tiles were loaded without it; start the run with --unknown solid");
  times.timed("unknown", [&] {
    if (!room_.unknown && !room_.tiles) {
      if (map_updater_ && (last_stamp_s_ || !map_updater_->committed_changes().empty()))
        throw Error(
            "unknown solid: changes are being committed to the map; start the run with --unknown solid");
      set_unknown(room_, map_);
      if (map_updater_) map_updater_->keep_up_unknown();
    }
    room_.unknown_is_solid = true;
    scene_.set_unknown(&room_.unknown_tree);
    objects_.unknown_changed();
  });
}

void Session::make_unknown_free() {
  room_.unknown_is_solid = false;
  scene_.set_unknown(nullptr);
  objects_.unknown_changed();
}

void Session::set_surfaces(SurfacePolicy surfaces) {
  if (surfaces != SurfacePolicy::kMap && map_updater_)
    throw Error("surfaces " + std::string(to_string(surfaces)) +
                ": changes are being committed to the map, which needs its surfaces");
  config_.scene.surfaces = surfaces;
  scene_.set_surfaces(surfaces);
}

void Session::set_radar(const RadarConfig& config) {
  objects_.set_radar(config);
  config_.radar = config;
}

void Session::set_quality(const RunQuality& quality) {
  require_valid(quality);
  const RadarConfig radar = config_.radar;
  roomradar::apply(quality, config_);
  if (!(config_.radar == radar)) set_radar(config_.radar);
  scene_.set_fineness(config_.scene);
  apply_quality(config_, locator_);
}

void Session::set_quality_from(FramePart part, const RunQuality& quality) {
  require_valid(quality);
  schedule_.set(part, quality);
}

void Session::commit_changes() {
  if (!map_updater_) throw Error("script: commit: this session does not watch for changes");
  map_updater_->ask();
}

FrameResult Session::step(const Frame& frame, StageTimes& times) {
  FrameResult bad;
  bad.status = FrameStatus::kBadFrame;
  if (bad.fault = fault_of(frame); !bad.fault.empty()) return bad;
  FrameResult result = times.timed("frame", [&] { return pass_through(frame, times); });
  if (config_.watch)
    static_cast<void>(config_.watch(FramePart::kDone, load_of(objects_.all(), moved_fraction_)));
  schedule_.take_all([&](const RunQuality& quality) { set_quality(quality); });  // of parts not reached
  if (config_.measure_penetration && result.status == FrameStatus::kDone)
    result.deepest_penetration_m = objects_.penetration_m();
  return result;
}

FrameResult Session::pass_through(const Frame& whole, StageTimes& times) {
  const auto handed_over = std::chrono::steady_clock::now();
  const RoomDrawn drawn_before = scene_.room_drawn();
  const std::uint64_t tested_before = objects_.static_triangles_tested();
  const double dt_s = seconds_since_last(whole.stamp_s);
  composer_.begin_frame(whole);

  begin(FramePart::kLocate);
  const Frame& frame = times.timed("reduce", [&]() -> const Frame& { return with_depth_reduced(whole); });
  if (map_updater_ && map_updater_->is_due(frame)) times.timed("commit", [&] { renew_room(); });
  if (building_ && times.timed("tiles", [&] { return building_->begin_frame(whole.stamp_s); }))
    scene_.room_changed();
  while (building_ && building_->has_fault()) objects_.notify(building_->take_fault());
  const Tracking tracking = times.timed("locate", [&] { return locate_camera(frame); });
  if (!has_guess(tracking)) return pass_unlocated(whole, tracking.status);
  const Eigen::Isometry3d& T_world_camera = tracking.T_world_camera;
  const ExpectedView& expected = times.timed("expected", [&]() -> const ExpectedView& {
    return scene_.render_expected(frame.depth_camera, T_world_camera);
  });
  const FrameForeground& foreground = times.timed(
      "foreground", [&]() -> const FrameForeground& { return scene_.find_dynamic(frame, expected); });
  if (map_updater_ && tracking)  // not with kDegenerate: the pose is partly predicted
    times.timed("changes",
                [&] { map_updater_->watch(frame, expected.depth_m, foreground.labels, T_world_camera); });
  moved_fraction_ =
      static_cast<double>(foreground.counts.moved) / static_cast<double>(frame.depth_m.pixels.size());
  begin(FramePart::kMesh);
  times.timed("mesh", [&] {
    scene_.mesh_surfaces(frame, T_world_camera, expected, foreground, objects_.fine_regions(),
                         objects_.bounding_balls());
  });
  objects_.count_fine_cells();
  const bool is_uncertain = tracking.status == TrackStatus::kUncertain;
  if (!objects_.waiting_drops().empty() && !is_uncertain)
    times.timed("place",
                [&] { objects_.release_waiting(frame, T_world_camera, expected, foreground, frames_); });
  begin(FramePart::kPhysics);  // Cyber Radar: R, M, L
  const ContactCounts moved = times.timed(
      "physics", [&] { return is_uncertain ? ContactCounts{} : objects_.move(dt_s, frames_, times); });
  std::vector<Departure> departures = objects_.end_departures();
  times.add_ms("contact", ms_since(handed_over));
  begin(FramePart::kCompose);
  if (config_.make_picture) times.timed("light", [&] { composer_.keep_colour(whole, T_world_camera, dt_s); });
  const bool makes_picture = config_.make_picture && is_due_every(config_.picture_every_n_frames);
  const bool has_shadow = is_due_every(config_.shadow_every_n_frames);
  if (makes_picture) times.timed("compose", [&] { composer_.compose(whole, T_world_camera, has_shadow); });
  composer_.end_frame(T_world_camera);
  ++frames_;
  FrameResult result;
  result.status = is_uncertain ? FrameStatus::kUncertain : FrameStatus::kDone;
  if (config_.poses != PoseOrigin::kRecorded) result.sigma = pose_sigma(tracking);
  result.tracking = tracking.status;
  result.picture_is_new = makes_picture;
  result.T_world_camera = T_world_camera;
  result.static_triangles_drawn = expected.triangles;
  result.foreground = foreground.counts;
  result.dynamic_triangles = scene_.dynamic_triangles();
  result.inferred_triangles = scene_.inferred_triangles();
  result.departures = std::move(departures);
  result.notices = objects_.take_notices();
  result.contacts = moved.contacts;
  result.contacts_by_kind = moved.by_kind;
  result.use = use_of(room_, scene_, config_.scene.surfaces == SurfacePolicy::kMap, foreground.counts,
                      drawn_before, objects_.static_triangles_tested() - tested_before);
  return result;
}

FrameResult Session::pass_unlocated(const Frame& frame, TrackStatus tracking) {
  FrameResult result;
  result.tracking = tracking;
  result.notices = objects_.take_notices();
  if (config_.make_picture) composer_.show_camera_alone(frame);
  result.picture_is_new = config_.make_picture;
  composer_.end_frame(std::nullopt);
  return result;
}

double Session::seconds_since_last(double stamp_s) {
  return std::max(0.0, stamp_s - std::exchange(last_stamp_s_, stamp_s).value_or(stamp_s));
}

void Session::begin(FramePart part) {
  if (const std::optional<RunQuality> due = schedule_.take(part)) set_quality(*due);
  if (!config_.watch) return;
  if (const std::optional<RunQuality> quality = config_.watch(part, load_of(objects_.all(), moved_fraction_)))
    set_quality(*quality);
}

const Frame& Session::with_depth_reduced(const Frame& frame) {
  const int stride = usable_stride(frame.depth_camera, config_.depth_stride);
  if (stride == 1) return frame;
  copy_all_but_images(frame, reduced_);
  reduced_.colour = frame.colour;
  reduce_depth(frame, stride, reduced_);
  return reduced_;
}

Tracking Session::locate_camera(const Frame& frame) {
  if (config_.poses == PoseOrigin::kRecorded) {
    if (!frame.T_world_camera) return {};
    const Eigen::Isometry3d T_world_camera = map_.info.T_world_recorded * *frame.T_world_camera;
    if (building_) building_->follow(frame, T_world_camera);
    return {.status = TrackStatus::kTracked, .T_world_camera = T_world_camera};
  }
  const auto expected_depth = [&](const Eigen::Isometry3d& T_world_camera) -> const DepthImage& {
    return scene_.render_expected(frame.depth_camera, T_world_camera).depth_m;
  };
  const MaskImage& moved = scene_.previous_dynamic_mask(frame.depth_camera);
  if (!building_) return locate(locator_, frame, map_.keyframe_database.load(), moved, expected_depth);
  return building_->locate(locator_, frame, map_.keyframe_database.load(), moved, expected_depth);
}

void Session::renew_room() {
  take_over(room_, map_updater_->room());
  scene_.room_changed();
  objects_.room_changed();
}

std::vector<CommittedChange> Session::committed_changes() const {
  return map_updater_ ? map_updater_->committed_changes() : std::vector<CommittedChange>{};
}

}  // namespace roomradar
