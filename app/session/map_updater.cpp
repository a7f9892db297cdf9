// map_updater.cpp: finds, measures and commits lasting changes.
#include "app/session/map_updater.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "mapping/surface/surface_update.hpp"
#include "mapping/types/system/config_check.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr double kLookEvery_s = 0.25;
constexpr double kAskedFor_s = 1.0;
constexpr double kRegionCell_m = 0.03;  // space within one to two cells of a change's points is measured
                                        // again
// A change that is hidden while it is measured is given up after this many times the frames needed.
constexpr int kPatience = 10;

bool holds_samples(const StaticMap& octree) {
  bool any = false;
  octree.visit_samples([&any](const SurfaceSample&) { any = true; });
  return any;
}

}  // namespace

void require_valid(const MapUpdateConfig& config) {
  const ConfigCheck require{"map_update"};
  if (config.after_s)
    require(*config.after_s > 0.0 && *config.after_s <= 86400.0, "after_s", *config.after_s, "in 0..86400 s");
  require(config.asked_after_s > 0.0 && config.asked_after_s <= 60.0, "asked_after_s", config.asked_after_s,
          "in 0..60 s");
  require(config.views >= 2 && config.views <= 100, "views", config.views, "in 2..100");
  require(config.apply_after_frames >= 1, "apply_after_frames", config.apply_after_frames, ">= 1");
}

MapUpdater::MapUpdater(StaticMap& octree, const Mesh& mesh, const MapUpdateConfig& config)
    : octree_(octree), config_(config), tracker_(config.tracker), room_{mesh, {}, {}, {}} {
  require_valid(config);
  if (!holds_samples(octree))
    throw Error(
        "commit changes: the map's octree contains no surface, so nothing can be added to it or carved "
        "from it; scan the room with `roomradar prescan`, or run without --commit-changes");
  measured_.views.resize(static_cast<std::size_t>(config.views));
}

MapUpdater::~MapUpdater() {
  if (working_.valid()) working_.wait();
}

bool MapUpdater::is_due(const Frame& frame) {
  clock_.stamp_s = frame.stamp_s;
  clock_.frame = frame.index;
  // The request's time runs even if nothing is in view: another object may stand there later.
  if (asked_until_s_ && *asked_until_s_ == kNow) asked_until_s_ = clock_.stamp_s + kAskedFor_s;
  if (asked_until_s_ && clock_.stamp_s > *asked_until_s_) asked_until_s_.reset();
  if (!working_.valid()) return std::exchange(is_room_new_, false);
  --measured_.frames_left;
  if (measured_.frames_left > 0) return false;
  const bool may_be_late = !config_.wait;
  if (may_be_late && working_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  finish();
  return std::exchange(is_room_new_, false);
}

void MapUpdater::finish() {
  if (has_failed_)
    throw Error("commit changes: a change could not be committed to the map, which is half changed");
  if (!working_.valid()) return;
  has_failed_ = true;  // reset below unless get() throws
  room_ = working_.get();
  has_failed_ = false;
  is_room_new_ = true;
  for (const LastingChange& change : measured_.pending) {
    tracker_.forget(change);
    committed_.push_back({change.kind, clock_.stamp_s, clock_.frame, change.box_world()});
  }
  measured_.pending.clear();
}

void MapUpdater::watch(const Frame& frame, const DepthImage& expected_depth_m, const LabelImage& labels,
                       const Eigen::Isometry3d& T_world_camera) {
  if (clock_.watched_frame == frame.index) return;
  clock_.watched_frame = frame.index;
  tracker_.set_noise(frame.depth_noise);
  tracker_.update(frame.depth_m, expected_depth_m, labels, frame.depth_camera, T_world_camera, frame.stamp_s);
  if (working_.valid()) return;
  if (measured_.pending.empty())
    look_for_changes(frame.stamp_s);
  else
    measure(frame, expected_depth_m, T_world_camera);
}

void MapUpdater::look_for_changes(double stamp_s) {
  const bool too_soon = stamp_s < clock_.next_look_s && stamp_s > clock_.next_look_s - kLookEvery_s;
  if (too_soon || (!asked_until_s_ && !config_.after_s)) return;
  clock_.next_look_s = stamp_s + kLookEvery_s;
  double after_s = config_.after_s.value_or(config_.asked_after_s);
  if (asked_until_s_) after_s = std::min(after_s, config_.asked_after_s);
  measured_.pending = tracker_.lasting_changes(after_s);
  if (measured_.pending.empty()) return;
  asked_until_s_.reset();
  measured_.view_count = 0;
  measured_.frames_left = kPatience * config_.views;
}

void MapUpdater::measure(const Frame& frame, const DepthImage& expected_depth_m,
                         const Eigen::Isometry3d& T_world_camera) {
  std::erase_if(measured_.pending, [&](const LastingChange& change) {
    return tracker_.still_true(change) < static_cast<double>(config_.tracker.min_steady_fraction);
  });
  const bool in_view =
      std::any_of(measured_.pending.begin(), measured_.pending.end(), [&](const LastingChange& change) {
        return tracker_.seen_now(change) >= static_cast<double>(config_.tracker.min_seen_fraction);
      });
  if (in_view) {
    RegionView& view = measured_.views[static_cast<std::size_t>(measured_.view_count++)];
    view.frame = frame;
    view.expected_depth_m = expected_depth_m;
    view.T_world_camera = T_world_camera;
  }
  if (measured_.view_count == config_.views && !measured_.pending.empty()) {
    measured_.frames_left = config_.apply_after_frames;
    working_ = std::async(std::launch::async, [this] { return work_in(); });
    return;
  }
  if (--measured_.frames_left <= 0) measured_.pending.clear();
}

ChangedRoom MapUpdater::work_in() const {
  ChangedRoom room{room_.mesh, {}, {}, {}};
  for (const LastingChange& change : measured_.pending) {
    const WorldRegion region(change.points_world, kRegionCell_m);
    const Eigen::AlignedBox3d box_world = refuse_region(octree_, region, measured_.views);
    update_surface(octree_, box_world, config_.surface, room.mesh);
  }
  room.tree.build_by_place(room.mesh);
  if (keeps_up_unknown_) {
    room.unknown = unknown_surface(octree_, room.mesh);
    room.unknown_tree.build_by_place(room.unknown.mesh_world);
  }
  return room;
}

}  // namespace roomradar
