// prescan_passes.cpp: reads the source frame by frame, with checkpoints between frames.
#include "mapping/prescan_passes.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "mapping/coverage/observed_area.hpp"
#include "mapping/map/level_surfaces.hpp"
#include "mapping/map/registration.hpp"
#include "mapping/map/surface_points.hpp"
#include "mapping/octree/prepared_frame.hpp"
#include "mapping/odometry/impossible_motion.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/revision/ghost_removal.hpp"
#include "mapping/scan_memory.hpp"
#include "mapping/storage/checkpoints.hpp"
#include "mapping/types/read_ahead.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;

/// Reads the next readable frame; returns false at the end.
/// @param next  as FrameSource::next()
template <typename Next>
bool read(const Next& next, StageTimes& times, PrescanCounts& counts) {
  for (;;) {
    const ReadResult result = times.timed("read", next);
    if (result.status == ReadStatus::kEnd) return false;
    if (result.status == ReadStatus::kWaiting) continue;
    ++counts.frames_read;
    if (result.status == ReadStatus::kFrame) return true;
    ++counts.frames_skipped;
    counts.last_fault = result.fault;
  }
}

/// Returns the frame's recorded pose if a map centred on `middle` reaches it. Rejects a corrupt pose,
/// kilometres away.
std::optional<Eigen::Isometry3d> recorded_pose(const Frame& frame, const Eigen::Vector3d& middle,
                                               double reach_m) {
  const auto& T = frame.T_world_camera;
  return T && ((T->translation() - middle).array().abs() < reach_m).all() ? T : std::nullopt;
}

/// Skips frames that a checkpoint already covers, without reading them if the source can seek.
void skip_frames(FrameSource& source, std::int64_t count) {
  Frame frame;
  const auto refuse = [&](const std::string& has) {
    throw Error(source.name() + ": has " + has + " frames, but the scan to be resumed had read " +
                std::to_string(count) + "; is it the same recording?");
  };
  std::int64_t position = source.seek(count - 1) ? count - 1 : 0;
  // A source that can seek, but not this far, has too few frames. A live scan's source would deliver new
  // frames of the device instead of the stored ones.
  if (position < count - 1 && source.seek(0)) refuse("fewer");
  while (position < count && source.next(frame).status != ReadStatus::kEnd) ++position;
  if (position < count) refuse(std::to_string(position));
}

/// Reports frames of a resumed stage as done.
void show_resumed(const PrescanWork& work, const char* stage, std::size_t frames) {
  for (std::size_t i = 0; i < frames; ++i) work.show(stage, "resumed");
}

/// Returns true if the memory in use, plus the memory that later stages need, exceeds the cap.
bool is_full(const PrescanConfig& config, double needed_later_bytes) {
  return config.max_memory_bytes > 0 && static_cast<double>(resident_bytes()) + needed_later_bytes >
                                            static_cast<double>(config.max_memory_bytes);
}

/// Intervals of `every_s` between two checkpoints of the second pass, which can be repeated from the frames.
/// Checkpoints slow this pass down: the octree is compressed on one core, and meanwhile the first change to a
/// page of the octree copies the page.
constexpr double kFusingIntervals = 24.0;

void write(Checkpoints& checkpoints, const char* stage, auto& pass, StageTimes& times) {
  times.timed("checkpoint", [&] {
    checkpoints.write(stage,
                      [&](const auto& into, const auto& previous) { write_state(pass, into, previous); });
  });
}

/// Writes a checkpoint of the second pass if one is due. Between two frames it is postponed while the last
/// one is still being written. At the end of a stage a shorter interval applies, because the next stage may
/// take seconds before its first checkpoint.
void keep_fusing(Checkpoints* checkpoints, FusionPass& pass, StageTimes& times, bool between_frames = true) {
  if (!checkpoints) return;
  const bool is_due =
      between_frames ? checkpoints->is_due(kFusingIntervals) : checkpoints->is_due_at_end(kFusingIntervals);
  if (is_due) write(*checkpoints, kFusingStage, pass, times);
}

/// Same in the first pass, after each interval. The odometry's second thread must be idle meanwhile.
void keep_tracking(Checkpoints* checkpoints, TrackingPass& pass, StageTimes& times) {
  if (!checkpoints || !checkpoints->is_due()) return;
  times.timed("checkpoint", [&] { pass.odometry.finish_jobs(); });
  write(*checkpoints, kTrackingStage, pass, times);
}

/// Returns the expected centre of the recorded poses: the origin if the map shares it, else the first
/// position.
Eigen::Vector3d middle_of_recorded(const PrescanWork& work, const TrackingPass& pass, const Frame& frame) {
  if (work.maps_recorded_world || !frame.T_world_camera) return Eigen::Vector3d::Zero();
  return pass.recorded.empty() ? frame.T_world_camera->translation()
                               : pass.recorded.front().T_world_camera.translation();
}

OdometryConfig odometry_config_of(const PrescanConfig& config) {
  OdometryConfig odometry = config.odometry;
  odometry.use_recorded_poses = config.poses == PoseOrigin::kAuto;
  return odometry;
}

/// Removes the last seconds of the scan: the frames' poses, and the keyframes made of them. The frames remain
/// counted as read, and are not fused since they have no pose.
/// @param known  keyframes of the map that is extended; null: a new map
void undo(PrescanWork& work, TrackingPass& pass, const KeyframeDatabase* known, double from_s) {
  pass.odometry.finish_jobs();
  OdometrySnapshot kept = pass.odometry.snapshot();
  const auto first = std::find_if(kept.frames.begin(), kept.frames.end(),
                                  [&](const KeptFrame& frame) { return frame.stamp_s >= from_s; });
  if (first == kept.frames.end()) return;
  const std::int64_t from_index = first->frame_index;
  forget_frames_from(from_index, kept);
  pass.odometry = Odometry(odometry_config_of(work.config), std::move(kept));
  if (known) pass.odometry.set_prior_map(*known);
  std::erase_if(pass.recorded, [&](const TimedPose& pose) { return pose.frame_index >= from_index; });
  work.observer->forgot_frames(from_index);
}

/// Begins the pass again with corrected times of the sensor, if the times that it began with turn out wrong.
/// Only for a source of known length: a live device cannot be rewound while it delivers.
/// @param known  keyframes of the map that is extended; null: a new map
bool restart_with_better_times(PrescanWork& work, const KeyframeDatabase* known, TrackingPass& pass) {
  const std::int64_t frames = work.source->frame_count().value_or(0);
  if (work.config.poses == PoseOrigin::kRecorded || pass.counts.restarts >= kMostRestarts) return false;
  if (pass.counts.frames_read != std::min(frames, kProbeFrames)) return false;
  if (!are_times_wrong(pass.odometry.state().timing) || !work.source->rewind()) return false;
  OdometryConfig config = odometry_config_of(work.config);
  config.timing = pass.odometry.state().timing.current;
  const std::int64_t restarts = pass.counts.restarts + 1;
  pass = TrackingPass(config);
  pass.counts.restarts = restarts;
  if (known) pass.odometry.set_prior_map(*known);
  if (work.observer) work.observer->forgot_frames(0);
  return true;
}

/// Optimises all poses after the last frame, joins the parts, and estimates the up direction.
TrajectoryEstimate finished_trajectory(const PrescanWork& work, TrackingPass& pass) {
  TrajectoryEstimate found;
  found.frames = work.times.timed("optimise", [&] { return pass.odometry.optimise(); });
  found.recorded = std::move(pass.recorded);
  pass.counts.keyframes = pass.odometry.counts().keyframes;
  pass.counts.loops_found = pass.odometry.counts().loops_found;
  pass.counts.timing = pass.odometry.state().timing.current;
  pass.counts.recorded_used = pass.odometry.state().prior.used;
  pass.counts.recorded_contradicted = pass.odometry.state().prior.contradicted;
  pass.counts.recorded_sigma_m = pass.odometry.state().prior.sigma_m;
  found.keyframe_database = pass.odometry.take_keyframe_database();
  if (work.config.poses != PoseOrigin::kRecorded) {
    pass.counts.impossible_motion = distrust_impossible_motion(found.frames);
    std::set<std::int64_t> distrusted;
    for (const TrackedFrame& frame : found.frames)
      if (!frame.trusted) distrusted.insert(frame.frame_index);
    std::erase_if(found.keyframe_database.keyframes,
                  [&](const MapKeyframe& keyframe) { return distrusted.contains(keyframe.frame_index); });
  }
  int main_part = 0;
  found.parts = work.times.timed("join", [&] {
    return join_parts(found.frames, found.keyframe_database, pass.odometry.state().located, main_part);
  });
  const UpEstimator& up = pass.up[std::min(static_cast<std::size_t>(main_part), pass.up.size() - 1)];
  found.up = work.config.up ? up.take(*work.config.up) : up.estimate();
  return found;
}

/// Reads the source to its end and returns the camera pose of each frame.
/// @param known  keyframes of the map that is extended; null: a new map
TrajectoryEstimate estimate_trajectory(PrescanWork& work, const KeyframeDatabase* known, TrackingPass& pass) {
  const PrescanConfig& config = work.config;
  Frame frame;
  ObservedArea seen;
  const auto next = [&] { return work.source->next(frame); };
  while (read(next, work.times, pass.counts)) {
    const Clock::time_point start = Clock::now();
    const std::optional<Eigen::Isometry3d> recorded =
        recorded_pose(frame, middle_of_recorded(work, pass, frame), work.reach_m);
    if (recorded) pass.recorded.push_back({frame.index, frame.stamp_s, *recorded});
    Tracking tracking;
    if (config.poses != PoseOrigin::kRecorded) {
      tracking = pass.odometry.track(frame);
    } else if (recorded) {
      tracking = {.status = TrackStatus::kTracked, .T_world_camera = *recorded};
      pass.odometry.add_posed(frame, *recorded);
    }
    work.track_ms[frame.index] = ms_since(start);
    work.times.add_ms("track", work.track_ms[frame.index]);
    if (tracking) {
      const auto part = static_cast<std::size_t>(pass.odometry.current_part());
      if (part >= pass.up.size()) pass.up.resize(part + 1);
      pass.up[part].add(frame, tracking.T_world_camera);
    }
    if (work.observer) {
      work.observer->after_frame(frame, tracking, pass.odometry, work.times);
      if (const double undo_s = work.observer->take_undo_s(); undo_s > 0.0)
        undo(work, pass, known, frame.stamp_s - undo_s);
    }
    if (work.progress) {  // only `progress` reports the observed area
      if (tracking) seen.add(frame, tracking.T_world_camera);
      work.progress(pass.counts.restarts > 0 ? kTrackingAgainStage : kTrackingStage,
                    std::string(to_string(tracking.status)) + ", " + describe(seen));
    }
    if (restart_with_better_times(work, known, pass)) {
      seen = {};
      continue;
    }
    keep_tracking(work.checkpoints, pass, work.times);
    // Reserve a quarter of the cap for the octree and its surface, which are built after the tracker is
    // freed.
    pass.counts.stopped_for_memory = is_full(config, 0.25 * static_cast<double>(config.max_memory_bytes));
    if (pass.counts.stopped_for_memory) break;
  }
  return finished_trajectory(work, pass);
}

/// Returns the poses of the frames that are to be fused.
std::vector<TimedPose> poses_to_fuse(const PrescanConfig& config, std::vector<TimedPose> trajectory) {
  std::erase_if(trajectory, [&](const TimedPose& pose) {
    return is_held_out(pose.frame_index, config.hold_out) || pose.frame_index % config.fuse_every != 0;
  });
  std::vector<TimedPose> chosen;
  for (const std::size_t i :
       choose_frames_to_fuse(trajectory, static_cast<std::size_t>(config.max_fused_frames)))
    chosen.push_back(trajectory[i]);
  return chosen;
}

/// Returns the positions in the source of the frames still to be fused. Returns all positions if frames
/// without an entry in pass.found, such as unreadable ones, leave them unknown.
std::vector<std::int64_t> positions_of(const std::map<std::int64_t, Eigen::Isometry3d>& T_world_camera,
                                       const FusionPass& pass) {
  const std::vector<TrackedFrame>& frames = pass.found.frames;
  const bool are_known = static_cast<std::int64_t>(frames.size()) == pass.counts.frames_read;
  std::vector<std::int64_t> positions;
  for (std::int64_t i = pass.frames_read; i < pass.counts.frames_read; ++i)
    if (!are_known || T_world_camera.contains(frames[static_cast<std::size_t>(i)].frame_index))
      positions.push_back(i);
  return positions;
}

/// Computes the world of a new map: +z up. Tracked poses get their origin on the floor below the first
/// camera; recorded poses keep the recording's.
Eigen::Isometry3d transform_to_new_map(const TrajectoryEstimate& found, PoseOrigin poses) {
  Eigen::Isometry3d T_map_found = level_rotation(found.up.up_world);
  const auto first = std::find_if(found.frames.begin(), found.frames.end(),
                                  [](const TrackedFrame& frame) { return frame.trusted; });
  if (poses == PoseOrigin::kRecorded || first == found.frames.end()) return T_map_found;
  const Eigen::Vector3d camera_map = T_map_found * first->T_world_camera.translation();
  const double floor_m = floor_height_m(found.keyframe_database, found.up.up_world).value_or(camera_map.z());
  T_map_found.pretranslate(Eigen::Vector3d(-camera_map.x(), -camera_map.y(), -floor_m));
  return T_map_found;
}

/// Computes the transform from the tracker's world frame to that of an existing map.
Eigen::Isometry3d transform_to_map(const Odometry& odometry, const TrajectoryEstimate& found,
                                   const SavedMap& map, const std::string& source) {
  constexpr std::size_t kPoints = 12'000;
  const std::vector<Eigen::Vector3d> surface = surface_of(found.keyframe_database, kPoints);
  // A long scan may be localised in the map, then leave it for other rooms, so only a small fraction
  // overlaps.
  RegistrationConfig located;
  located.min_overlap = 0.01;
  // Many keyframes were localised in the map, so it is the same room, in which things may have moved.
  constexpr std::size_t kManyAnchored = 5;
  constexpr double kMovedThings = 0.5;
  if (agreeing_anchors(odometry.state().graph).size() >= kManyAnchored) located.min_agreement = kMovedThings;
  Registration placed;
  if (odometry.state().located)
    placed = refine_registration(map.octree.load(), surface, Eigen::Isometry3d::Identity(), located);
  if (!placed) {
    RegistrationConfig anew;
    anew.up_b = found.up.up_world;
    const Registration found_anew =
        register_to(map.octree.load(), map.keyframe_database.load(), found.keyframe_database, surface, anew);
    if (found_anew || !odometry.state().located) placed = found_anew;
  }
  if (!placed)
    throw Error(source + ": cannot be registered to the map that it is to be added to: " + describe(placed) +
                "; the map is unchanged. Begin where the map was scanned, or save as another map");
  return placed.T_a_b;
}

}  // namespace

FusionPass run_tracking_pass(PrescanWork& work, std::optional<SavedMap>& map) {
  const std::optional<Checkpoint> checkpoint = work.checkpoints ? work.checkpoints->resume() : std::nullopt;
  if (checkpoint && checkpoint->stage == kFusingStage) {
    FusionPass fusing = read_fusing_pass(*checkpoint);
    fusing.counts.frames_resumed = fusing.frames_read;
    return fusing;
  }
  TrackingPass pass(odometry_config_of(work.config));
  if (checkpoint) {
    pass = read_tracking_pass(*checkpoint, odometry_config_of(work.config));
    pass.counts.frames_resumed = pass.counts.frames_read;
    show_resumed(work, kTrackingStage, static_cast<std::size_t>(pass.counts.frames_read));
    skip_frames(*work.source, pass.counts.frames_read);
  }
  const KeyframeDatabase* const known =
      map && work.config.poses != PoseOrigin::kRecorded ? &map->keyframe_database.load() : nullptr;
  if (known) pass.odometry.set_prior_map(*known);
  FusionPass fusing;
  fusing.found = estimate_trajectory(work, known, pass);
  fusing.counts = pass.counts;
  if (fusing.counts.frames_read == fusing.counts.frames_skipped)
    throw Error(work.source->name() + ": there is not one readable frame" +
                (fusing.counts.last_fault.empty() ? "" : "; the last fault: " + fusing.counts.last_fault));
  fusing.T_world_found = map ? transform_to_map(pass.odometry, fusing.found, *map, work.source->name())
                             : transform_to_new_map(fusing.found, work.config.poses);
  fusing.octree = map ? std::move(map->octree.load()) : StaticMap(work.config.resolution_m);
  // The trajectory took the whole scan, so it is stored soon.
  if (work.checkpoints && work.checkpoints->is_due_at_end())
    write(*work.checkpoints, kFusingStage, fusing, work.times);
  return fusing;
}

void run_fusion_pass(PrescanWork& work, const std::vector<TimedPose>& trajectory, FusionPass& pass) {
  if (pass.revision || pass.ghost_voxels) return;
  const std::vector<TimedPose> to_fuse = poses_to_fuse(work.config, trajectory);
  std::map<std::int64_t, Eigen::Isometry3d> T_world_camera;
  for (const TimedPose& pose : to_fuse) T_world_camera[pose.frame_index] = pose.T_world_camera;
  if (!work.source->rewind()) throw Error(work.source->name() + ": cannot be read a second time");
  PrescanCounts second_pass;
  show_resumed(work, kFusingStage, pass.fused.size());
  if (pass.frames_read > 0) skip_frames(*work.source, pass.frames_read);
  release_unused_memory();
  bool has_room = !pass.stopped_for_memory;  // set if the pass had ended before it was resumed
  ReadAhead<PreparedFrame> frames(*work.source, pass.frames_read, positions_of(T_world_camera, pass),
                                  [&](const Frame& ahead, PreparedFrame& made) {
                                    const auto pose = T_world_camera.find(ahead.index);
                                    if (pose != T_world_camera.end())
                                      pass.octree.prepare(ahead, pose->second, made);
                                  });
  Frame frame;
  PreparedFrame prepared;
  const auto next = [&] { return frames.next(frame, prepared); };
  while (has_room && read(next, work.times, second_pass)) {
    pass.frames_read = frames.position() + 1;
    const auto pose = T_world_camera.find(frame.index);
    if (pose == T_world_camera.end()) continue;
    const Clock::time_point start = Clock::now();
    const FuseStatus fused = pass.octree.fuse(frame, prepared);
    const double fuse_ms = ms_since(start);
    work.times.add_ms("fuse", fuse_ms);
    if (const auto track_ms = work.track_ms.find(frame.index); track_ms != work.track_ms.end())
      work.times.add_ms("frame", track_ms->second + fuse_ms);
    work.last_fused = fused;
    if (fused == FuseStatus::kFused)
      pass.fused.push_back({pass.frames_read - 1, frame.index, frame.depth_camera, pose->second});
    work.show(kFusingStage, std::string(to_string(fused)));
    keep_fusing(work.checkpoints, pass, work.times);
    has_room = !is_full(work.config, memory_after_fusion(static_cast<double>(pass.octree.memory_bytes())));
  }
  pass.stopped_for_memory = !has_room;
  keep_fusing(work.checkpoints, pass, work.times, /*between_frames=*/false);
}

void run_ghost_removal(PrescanWork& work, FusionPass& pass) {
  if (pass.ghost_voxels) return;
  if (!pass.revision)
    pass.revision = remove_ghosts(*work.source, pass.fused, work.config.ghosts, pass.octree, work.times,
                                  [&](const std::string& note) { work.show("ghosts", note); });
  refuse_surroundings(*work.source, pass.fused, *pass.revision, pass.octree, work.times,
                      [&](const std::string& note) {
                        work.show("ghosts", note);
                        keep_fusing(work.checkpoints, pass, work.times);
                      });
  pass.ghost_voxels = pass.revision->voxels();
  pass.revision.reset();
  keep_fusing(work.checkpoints, pass, work.times, /*between_frames=*/false);
}

}  // namespace roomradar
