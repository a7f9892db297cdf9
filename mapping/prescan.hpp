// prescan.hpp: from a recording of a room to its saved form: track, level, fuse, remove ghosts, extract the
// surface.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "mapping/coverage/holes.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/revision/ghosts.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct PrescanConfig {
  double resolution_m = 0.01;  ///< edge of the octree's smallest cells
  PoseOrigin poses = PoseOrigin::kTracked;
  OdometryConfig odometry;
  int fuse_every = 1;         ///< of the tracked frames every so many-th, by its index, goes into the map
  std::int64_t hold_out = 0;  ///< N > 0: frames that is_held_out names are tracked, but not fused
  bool remove_ghosts = true;  ///< take out of the map what moved on during the scan
  GhostConfig ghosts;
  SurfaceConfig surface;
  /// Of the process; 0: no cap. Before it is reached the scan stops, and what was fused so far is the map.
  std::size_t max_memory_bytes = 0;
};

/// Every hold_out-th frame, from the middle of the first so many on: frame_index mod N = N / 2. None for N
/// < 1.
bool is_held_out(std::int64_t frame_index, std::int64_t hold_out);

/// What happened to the frames, and how well the trajectory fits the recorded one where there is one.
struct PrescanCounts {
  std::int64_t frames_read = 0;
  std::int64_t frames_skipped = 0;  ///< unreadable ones
  std::int64_t frames_tracked = 0;  ///< with a pose that is trusted
  std::int64_t frames_fused = 0;
  std::int64_t frames_lost = 0;  ///< without one; not fused
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;
  std::int64_t ghost_voxels = 0;    ///< surface that later, or earlier, frames see through; taken out
  std::int64_t frames_resumed = 0;  ///< that a checkpoint had behind it, in the pass that it was of
  bool stopped_for_memory = false;  ///< not all of the source is in the map
  std::string last_fault;           ///< of the last skipped frame
  std::optional<TrajectoryError> against_recorded;  ///< where at least 3 frames came with poses; tracked only
};

struct PrescanResult {
  SavedMap map;
  std::vector<Hole> holes;  ///< where the scan has not looked, largest first of each kind
  PrescanCounts counts;
  SurfaceFacts surface;
};

/// Called after each frame of a pass: the stage ("track", "fuse" or "ghosts"), and what became of the frame;
/// while tracking also how much surface was seen so far, and in the last second.
using PrescanProgress = std::function<void(const std::string& stage, const std::string& note)>;

class Checkpoints;

/// What a prescan goes on from, where it does not begin anew.
struct PrescanStart {
  /// Where the state is written now and then during both passes; if there is one already the work goes on
  /// from it, and the source must deliver the same frames again. Null: none is written.
  Checkpoints* checkpoints = nullptr;
  /// A map to which is added what the source shows. Its world and its resolution stay.
  std::optional<SavedMap> map;
};

/// Scans a room. The source is read to know where the camera was, again to fuse with the final poses, and in
/// part twice more where something moved on and has to go from the map. The map's world is the recording's
/// own (recorded poses) or the first camera's (tracked), turned so that +z is up. Stages timed: read, track,
/// optimise, fuse, ghosts, surface, coverage, checkpoint (what it holds the work up), and frame (track and
/// fuse of one frame together; no reading).
///
/// @throws Error if the source cannot be rewound, has no frame at all, or not one frame's pose is trusted; if
/// the start's map does not show the room that the source shows, or too little of it to be certain
PrescanResult prescan(FrameSource& source, const PrescanConfig& config, StageTimes& times,
                      const PrescanProgress& progress = {}, PrescanStart start = {});

}  // namespace roomradar
