// prescan.cpp: the prescan from first frame to finished map, top to bottom.
#include "mapping/prescan.hpp"

#include <chrono>
#include <map>
#include <utility>

#include "mapping/ghost_removal.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The next readable frame, or false at the end.
bool read(FrameSource& source, StageTimes& times, Frame& frame, PrescanCounts& counts) {
  for (;;) {
    const ReadResult result = times.timed("read", [&] { return source.next(frame); });
    if (result.status == ReadStatus::kEnd) return false;
    ++counts.frames_read;
    if (result.status == ReadStatus::kFrame) return true;
    ++counts.frames_skipped;
    counts.last_fault = result.fault;
  }
}

Tracking recorded_pose(const Frame& frame) {
  Tracking tracking;
  if (!frame.T_world_camera) return tracking;
  tracking.status = TrackStatus::kTracked;
  tracking.T_world_camera = *frame.T_world_camera;
  return tracking;
}

/// Where the camera was in each frame, and which way is up there.
struct Whereabouts {
  std::vector<TrackedFrame> frames;
  Places places;
  UpDirection up;
  std::vector<TimedPose> recorded;
};

Whereabouts find_whereabouts(FrameSource& source, const PrescanConfig& config, StageTimes& times,
                             const PrescanProgress& progress, PrescanCounts& counts,
                             std::map<std::int64_t, double>& track_ms) {
  Odometry odometry(config.odometry);
  UpEstimator up;
  Whereabouts found;
  Frame frame;
  while (read(source, times, frame, counts)) {
    const Clock::time_point start = Clock::now();
    Tracking tracking;
    if (config.poses == PoseOrigin::kTracked) {
      tracking = odometry.track(frame);
    } else {
      tracking = recorded_pose(frame);
      if (tracking) odometry.add_posed(frame, tracking.T_world_camera);
    }
    track_ms[frame.index] = ms_since(start);
    times.add_ms("track", track_ms[frame.index]);
    if (tracking) up.add(frame, tracking.T_world_camera);
    if (frame.T_world_camera) found.recorded.push_back({frame.index, frame.stamp_s, *frame.T_world_camera});
    if (progress) progress("track", std::string(to_string(tracking.status)));
  }
  found.frames = times.timed("optimise", [&] { return odometry.optimise(); });
  found.up = up.estimate();
  counts.keyframes = odometry.counts().keyframes;
  counts.loops_found = odometry.counts().loops_found;
  found.places = odometry.take_places();
  return found;
}

}  // namespace

bool is_held_out(std::int64_t frame_index, std::int64_t hold_out) {
  return hold_out > 0 && frame_index % hold_out == hold_out / 2;
}

std::string_view to_string(PoseOrigin poses) {
  return poses == PoseOrigin::kTracked ? "tracked" : "recorded";
}

PrescanResult prescan(FrameSource& source, const PrescanConfig& config, StageTimes& times,
                      const PrescanProgress& progress) {
  PrescanResult result;
  result.map.octree = StaticMap(config.resolution_m);
  PrescanCounts& counts = result.counts;
  SavedMap& map = result.map;

  // Where was the camera?
  std::map<std::int64_t, double> track_ms;
  Whereabouts found = find_whereabouts(source, config, times, progress, counts, track_ms);
  if (counts.frames_read == counts.frames_skipped)
    throw Error(source.name() + ": there is not one readable frame" +
                (counts.last_fault.empty() ? "" : "; the last fault: " + counts.last_fault));

  // Turn the world so that +z is up.
  const Eigen::Isometry3d T_level = level_rotation(found.up.up_world);
  transform(found.places, T_level);
  std::map<std::int64_t, Eigen::Isometry3d> T_world_camera;
  for (const TrackedFrame& tracked : found.frames) {
    if (!tracked.trusted) continue;
    T_world_camera[tracked.frame_index] = T_level * tracked.T_world_camera;
    map.trajectory.push_back({tracked.frame_index, tracked.stamp_s, T_world_camera[tracked.frame_index]});
  }
  counts.frames_tracked = static_cast<std::int64_t>(T_world_camera.size());
  counts.frames_lost = counts.frames_read - counts.frames_skipped - counts.frames_tracked;
  if (T_world_camera.empty())
    throw Error(source.name() + ": no frame has a pose that can be trusted, so there is nothing to map; " +
                (config.poses == PoseOrigin::kRecorded
                     ? "the recording has no poses: use --poses tracked"
                     : "is there depth between 0.5 and 6 m in the frames?"));

  // What was there?
  if (!source.rewind()) throw Error(source.name() + ": cannot be read a second time");
  PrescanCounts second_pass;
  std::vector<FusedFrame> fused_frames;
  Frame frame;
  while (read(source, times, frame, second_pass)) {
    const auto pose = T_world_camera.find(frame.index);
    if (pose == T_world_camera.end()) continue;
    if (is_held_out(frame.index, config.hold_out)) {
      ++counts.frames_held_out;
      continue;
    }
    const Clock::time_point start = Clock::now();
    const FuseStatus fused = map.octree.fuse(frame, pose->second);
    const double fuse_ms = ms_since(start);
    times.add_ms("fuse", fuse_ms);
    times.add_ms("frame", track_ms[frame.index] + fuse_ms);
    if (fused == FuseStatus::kFused)
      fused_frames.push_back({second_pass.frames_read - 1, frame.index, frame.depth_camera, pose->second});
    if (progress) progress("fuse", std::string(to_string(fused)));
  }
  counts.frames_fused = static_cast<std::int64_t>(fused_frames.size());
  if (counts.frames_fused == 0)
    throw Error(source.name() + ": no frame could be fused; the depth images hold no usable measurement");

  // What of that moved on?
  if (config.remove_ghosts) {
    const auto show = [&](const std::string& note) {
      if (progress) progress("ghosts", note);
    };
    counts.ghost_voxels = remove_ghosts(source, fused_frames, config.ghosts, map.octree, times, show);
  }

  map.mesh = times.timed("surface", [&] { return extract_surface(map.octree, config.surface); });
  if (map.mesh.triangles.empty())
    throw Error(source.name() + ": " + std::to_string(counts.frames_fused) + " frames show no surface at " +
                std::to_string(config.resolution_m) + " m; try another --resolution");
  map.places = std::move(found.places);

  map.info.source = source.name();
  map.info.frames_read = counts.frames_read;
  map.info.frames_fused = counts.frames_fused;
  map.info.up_source = to_string(found.up.source);
  map.info.settings = {{"resolution_m", std::to_string(config.resolution_m)},
                       {"poses", std::string(to_string(config.poses))}};
  if (config.hold_out > 0) map.info.settings["hold_out"] = std::to_string(config.hold_out);
  if (config.poses == PoseOrigin::kRecorded) {
    map.info.T_world_recorded = T_level;
  } else {
    const TrajectoryError error = absolute_trajectory_error(map.trajectory, found.recorded);
    if (error.poses > 0) {
      counts.against_recorded = error;
      map.info.T_world_recorded = error.T_reference_estimate.inverse();
    }
  }
  return result;
}

}  // namespace roomradar
