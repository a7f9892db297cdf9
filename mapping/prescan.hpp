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
#include "mapping/prescan_counts.hpp"
#include "mapping/revision/ghosts.hpp"
#include "mapping/scan_observer.hpp"
#include "mapping/scan_parts.hpp"
#include "mapping/surface/surface_extraction.hpp"
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
