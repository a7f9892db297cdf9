// prescan.hpp: turns a recording of a room into a map by tracking, fusion, ghost removal and surface
// extraction.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapping/coverage/holes.hpp"
#include "mapping/fusion_selection.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/revision/ghosts.hpp"
#include "mapping/scan_parts.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct PrescanConfig {
  double resolution_m = 0.01;  ///< edge of the octree's smallest voxels
  PoseOrigin poses = PoseOrigin::kAuto;
  OdometryConfig odometry;
  std::optional<GivenUp> up;  ///< up direction that the user states; unset: estimated
  int fuse_every = 1;         ///< only tracked frames whose index is a multiple of this are fused
  std::int64_t hold_out = 0;  ///< N > 0: frames selected by is_held_out() are tracked, but not fused
  /// Max number of frames that are fused; see choose_frames_to_fuse(). 0: no limit.
  std::int64_t max_fused_frames = kMaxFusedFrames;
  bool remove_ghosts = true;  ///< remove surfaces of objects that moved during the scan
  GhostConfig ghosts;
  SurfaceConfig surface;
  bool bake_texture = false;  ///< make SavedMap::texture from the frames' colours
  /// Cap on the process's memory; 0: no cap. The scan stops before it reaches the cap. The map then contains
  /// the frames fused so far.
  std::size_t max_memory_bytes = 0;
};

/// Returns true for every hold_out-th frame: frame_index mod hold_out = hold_out / 2. Always false if
/// hold_out < 1.
bool is_held_out(std::int64_t frame_index, std::int64_t hold_out);

/// Consecutive frames of the source.
struct FrameSpan {
  std::int64_t first = 0, last = 0;  ///< frame indices, both included
};

/// Frame counts, and the trajectory's error against recorded poses if there are any.
struct PrescanCounts {
  std::int64_t frames_read = 0;
  std::int64_t frames_skipped = 0;  ///< unreadable
  std::int64_t frames_tracked = 0;  ///< with a trusted pose
  std::int64_t frames_fused = 0;
  std::int64_t frames_lost = 0;  ///< readable, but without a trusted pose; not fused
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;
  std::int64_t restarts = 0;       ///< number of times that tracking restarted with corrected sensor times
  std::int64_t recorded_used = 0;  ///< frames whose motion recorded poses constrained; see MotionPrior
  std::int64_t recorded_contradicted = 0;  ///< frames whose depth contradicted the recorded motion
  /// Frames whose poses are not trusted because no camera moves so; see distrust_impossible_motion().
  std::int64_t impossible_motion = 0;
  double recorded_sigma_m = 0.0;           ///< estimated noise of a recorded pose, see MotionPrior::sigma_m
  std::int64_t ghost_voxels = 0;           ///< surface voxels removed by ghost removal
  /// Frames of the interrupted pass (tracking or fusion) that were finished at the checkpoint and are not
  /// processed again.
  std::int64_t frames_resumed = 0;
  bool stopped_for_memory = false;  ///< memory cap reached: part of the source is not in the map
  SensorTiming timing;              ///< times of the sensor, estimated if the poses were tracked
  std::string last_fault;           ///< reason why the last skipped frame was unreadable
  /// Set if the poses were tracked and at least 3 tracked frames have recorded poses.
  std::optional<TrajectoryError> trajectory_error;
};

struct PrescanResult {
  SavedMap map;                 ///< map.info.counts are set, too
  std::vector<Hole> holes;      ///< regions that the scan did not observe; largest first, outer borders last
  std::vector<ScanPart> parts;  ///< parts of the scan, see join_parts()
  std::vector<FrameSpan> lost;  ///< readable frames without a trusted pose, in order
  PrescanCounts counts;
  SurfaceStats surface;
};

/// Callback after each frame. `stage` is "track", "track again" (from the first frame, with corrected sensor
/// times), "fuse" or "ghosts", and `note` states the frame's outcome. Also called with "surface" before the
/// surface is extracted, and with "texture" before the texture is baked. While tracking, the note also states
/// the surface area observed in total and in the last second.
using PrescanProgress = std::function<void(const std::string& stage, const std::string& note)>;

/// Follows the first pass of a prescan. The prescan's thread makes the calls, and their time adds to the
/// frame's. The only way to change the scan is take_undo_s().
class ScanObserver {
 public:
  ScanObserver() = default;
  ScanObserver(const ScanObserver&) = delete;
  ScanObserver& operator=(const ScanObserver&) = delete;
  virtual ~ScanObserver() = default;

  /// Called after each readable frame, with its tracking result and the state of the odometry after it.
  /// @param times  stages "read" and "track" so far
  virtual void after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry,
                           const StageTimes& times) = 0;

  /// Called after after_frame(). Returns how many seconds at the end of the scan to undo, by the frames'
  /// stamps; 0: none. To be tracked again, the camera must then return to its pose at that time.
  virtual double take_undo_s() { return 0.0; }
  /// Called when the frames from this index on have been removed from the scan.
  virtual void forgot_frames(std::int64_t /*from_index*/) {}
};

class Checkpoints;
class MapWriter;

/// Optional inputs: checkpoints to resume from, a map to extend, an observer, and where the map is saved.
struct PrescanInput {
  /// Receives the prescan's state at intervals. If a checkpoint exists already, the prescan resumes from it.
  /// The source must then deliver the same frames again. Null: no checkpoints.
  Checkpoints* checkpoints = nullptr;
  /// Map to extend with the source's frames. The map's world frame and resolution are kept.
  std::optional<SavedMap> map;
  ScanObserver* observer = nullptr;  ///< follows the first pass; null: none
  /// Writes keyframes and octree as soon as they are not needed, which frees their memory; null: none. The
  /// caller commits. Both parts of the result are then read from the saved map if they are used.
  MapWriter* writer = nullptr;
};

/// Scans a room. Reads the source once to track the camera, and a second time to fuse the frames with their
/// final poses. To remove ghosts (surface of objects that moved), reads selected frames a third time and, if
/// there are ghosts, a fourth time. To bake the texture, reads at most 160 frames once more.
///
/// A new map's world frame has +z up. With recorded poses, the origin of the world frame is the recording's.
/// With tracked poses, the origin is on the floor below the first camera. If no level surface is measured,
/// the origin is at the height of the first camera. With start.map, the map's world frame is kept.
///
/// Stages timed: read, track, optimise, join, fuse, ghosts, surface, coverage, save_octree, texture,
/// checkpoint (time during which the work is blocked), and frame (track plus fuse of one frame, without
/// reading).
///
/// @throws Error if the source cannot be rewound, has no readable frame, no trusted pose or no surface. Also
///         throws if start.map shows another room, or overlaps the source too little for a reliable
///         registration
PrescanResult prescan(FrameSource& source, const PrescanConfig& config, StageTimes& times,
                      const PrescanProgress& progress = {}, PrescanInput start = {});

}  // namespace roomradar
