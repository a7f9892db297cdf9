// prescan_state.hpp: state of a prescan in progress, and its files on disk.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "mapping/map/map_folder.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/prescan.hpp"
#include "mapping/revision/ghost_removal.hpp"
#include "mapping/scan_parts.hpp"
#include "mapping/storage/checkpoints.hpp"

namespace roomradar {

/// State of the first pass, which estimates the camera poses.
struct TrackingPass {
  explicit TrackingPass(const OdometryConfig& config) : odometry(config) {}
  PrescanCounts counts;  ///< over the frames read so far
  Odometry odometry;
  std::vector<UpEstimator> up = std::vector<UpEstimator>(1);  ///< one per part of the scan
  std::vector<TimedPose> recorded;                            ///< recorded camera poses, if any
};

/// Result of the first pass: camera poses, keyframe database and up direction.
struct TrajectoryEstimate {
  std::vector<TrackedFrame> frames;
  KeyframeDatabase keyframe_database;
  UpDirection up;
  std::vector<TimedPose> recorded;
  std::vector<ScanPart> parts;  ///< see join_parts()
};

/// State of the second pass, which fuses the frames and then removes ghosts.
struct FusionPass {
  PrescanCounts counts;  ///< counts of the first pass
  TrajectoryEstimate found;
  /// Maps points from the tracker's to the map's world frame.
  Eigen::Isometry3d T_world_found = Eigen::Isometry3d::Identity();
  std::int64_t frames_read = 0;  ///< frames read in this pass
  StaticMap octree{0.01};
  std::vector<FusedFrame> fused;
  bool stopped_for_memory = false;           ///< memory cap reached in this pass
  std::optional<GhostRevision> revision;     ///< set while ghost removal is in progress
  std::optional<std::int64_t> ghost_voxels;  ///< set once ghost removal is complete
};

/// Returns the trusted poses, in the map's world frame.
std::vector<TimedPose> trusted_poses(const FusionPass& pass);

inline constexpr const char* kTrackingStage = "track";
inline constexpr const char* kTrackingAgainStage = "track again";  ///< after a restart; shown, not stored
inline constexpr const char* kFusingStage = "fuse";

/// Writes the state's files into a checkpoint's folder; see Checkpoints::WriteFiles.
void write_state(const TrackingPass& pass, const std::filesystem::path& into,
                 const std::filesystem::path& previous);
void write_state(const FusionPass& pass, const std::filesystem::path& into,
                 const std::filesystem::path& previous);

/// Reads and validates a checkpoint of the matching stage. A resumed second pass gives exactly the result of
/// an uninterrupted one. A resumed first pass differs by the rounding of stored keyframe views (about 1 mm).
/// Throws Error naming the file and the fault.
TrackingPass read_tracking_pass(const Checkpoint& checkpoint, const OdometryConfig& config);
FusionPass read_fusing_pass(const Checkpoint& checkpoint);

}  // namespace roomradar
