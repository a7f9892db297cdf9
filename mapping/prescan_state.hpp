// prescan_state.hpp: all that a prescan knows in the middle of its work, and its form on disk.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "mapping/prescan.hpp"
#include "mapping/revision/ghost_removal.hpp"
#include "mapping/storage/checkpoints.hpp"

namespace roomradar {

/// The first pass: where was the camera?
struct TrackingPass {
  explicit TrackingPass(const OdometryConfig& config) : odometry(config) {}
  PrescanCounts counts;  ///< so many frames are read
  Odometry odometry;
  UpEstimator up;
  std::vector<TimedPose> recorded;
};

/// Its result: where the camera was in each frame, and which way is up there.
struct Whereabouts {
  std::vector<TrackedFrame> frames;
  Places places;
  UpDirection up;
  std::vector<TimedPose> recorded;
};

/// The second pass: what was there?
struct FusingPass {
  PrescanCounts counts;  ///< of the first pass
  Whereabouts found;
  Eigen::Isometry3d T_world_found = Eigen::Isometry3d::Identity();  ///< the tracker's world to the map's
  std::int64_t frames_read = 0;                                     ///< in this pass
  StaticMap octree{0.01};
  std::vector<FusedFrame> fused;
  bool stopped_for_memory = false;           ///< in this pass
  std::optional<GhostRevision> revision;     ///< while the octree is put right where they were
  std::optional<std::int64_t> ghost_voxels;  ///< once it is
};

inline constexpr const char* kTrackingStage = "track";
inline constexpr const char* kFusingStage = "fuse";

/// Writes the state's files into a checkpoint's folder; see Checkpoints::WriteFiles. The state is only read.
void write_state(TrackingPass& pass, const std::filesystem::path& into,
                 const std::filesystem::path& previous);
void write_state(FusingPass& pass, const std::filesystem::path& into, const std::filesystem::path& previous);

/// Reads a checkpoint of that stage: the second pass goes on exactly as it would have, the first up to what
/// the rounding of the keyframes' views does (about 1 mm). The files are not trusted. Throws Error naming the
/// file and the fault.
TrackingPass read_tracking_pass(const Checkpoint& checkpoint, const OdometryConfig& config);
FusingPass read_fusing_pass(const Checkpoint& checkpoint);

}  // namespace roomradar
