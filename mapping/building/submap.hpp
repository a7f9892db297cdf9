// submap.hpp: trajectory and keyframes of one recording of a building.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// The camera's path in one recording, in its own world frame: +z up, the origin on the floor below the first
/// camera.
struct Submap {
  std::string source;  ///< name of the recording
  std::int64_t frames_read = 0;
  SensorTiming timing;
  std::vector<TimedPose> trajectory;  ///< poses of the frames with a trusted pose, in order
  /// Poses stored in the recording, in the recording's world frame (not the submap's); empty: none.
  std::vector<TimedPose> recorded;
  KeyframeDatabase keyframes;  ///< in order of frame_index
};

/// Writes a submap to `folder`, which must exist: submap.bin and keyframes.bin. Throws Error if a file cannot
/// be written.
void save_submap(const Submap& submap, const std::filesystem::path& folder);
/// Reads submap.bin and keyframes.bin. Throws Error naming the file and the fault if a file is missing,
/// damaged or of another version.
Submap load_submap(const std::filesystem::path& folder);
/// Reads only submap.bin. Keyframes then have a frame index and a pose, but no features and no depth.
Submap load_submap_poses(const std::filesystem::path& folder);

/// Splits a submap at each loss of tracking for more than `max_gap` frames. The relocalised pose after the
/// loss is not certain enough, since rooms of a building may look alike. Drops parts with fewer than
/// min_frames frames, and parts without a keyframe.
std::vector<Submap> split_at_losses(const Submap& submap, std::int64_t max_gap, std::size_t min_frames);

/// Returns the pose at the fraction `part` (0 to 1) between a and b: linear in position, slerp in rotation.
Eigen::Isometry3d pose_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double part);

/// Propagates the corrections of the keyframes' poses to all frames. Between two keyframes, interpolates by
/// frame index between the poses that result from either correction, see pose_between().
/// @param T_world_keyframe  one new pose per keyframe of the submap
/// @return the trajectory in the new world frame; empty if the submap has no keyframe
std::vector<TimedPose> corrected_trajectory(const Submap& submap,
                                            std::span<const Eigen::Isometry3d> T_world_keyframe);

}  // namespace roomradar
