// trajectory.hpp: poses over time, their file in the TUM RGB-D benchmark's format, and trajectory errors.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

struct TimedPose {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// First line of a trajectory file, a comment.
inline constexpr const char* kTrajectoryHeader = "# stamp_s tx ty tz qx qy qz qw: camera to world, metres\n";

/// Returns a pose's line in a trajectory file, with its end of line.
std::string trajectory_line(const TimedPose& pose);

/// Writes one line per pose in order, `stamp tx ty tz qx qy qz qw` (s, m, unit quaternion). Values read back
/// differ by at most 1e-9. Throws Error if the file cannot be written.
void write_trajectory(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory);

/// Reads a file written by write_trajectory(). Lines starting with # are comments. frame_index counts the
/// poses, from 0. Throws Error naming file and line if a line does not have 8 finite numbers or its
/// quaternion is not a unit quaternion.
std::vector<TimedPose> read_trajectory(const std::filesystem::path& path);

struct TrajectoryError {
  std::size_t poses = 0;  ///< number of poses matched by frame_index
  double rmse_m = 0.0;
  double max_m = 0.0;
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
};

/// Computes the absolute trajectory error (ATE): distances between positions of equal frame index, after the
/// best rigid alignment (scale 1). TrajectoryError::poses is 0 if fewer than 3 positions match. Source: Horn
/// 1987; Sturm et al., IROS 2012.
TrajectoryError absolute_trajectory_error(const std::vector<TimedPose>& estimate,
                                          const std::vector<TimedPose>& reference);

/// Returns the T_reference_estimate that best aligns poses matched by frame index. Each pose contributes the
/// camera's position and the points 1 m along its axes. Positions alone would not constrain the rotation of a
/// camera that hardly moves or moves along a line. Returns nullopt if no pose matches.
std::optional<Eigen::Isometry3d> pose_alignment(const std::vector<TimedPose>& estimate,
                                                const std::vector<TimedPose>& reference);

/// Returns the distance between the last positions of both trajectories, m, after aligning their first poses.
/// Returns 0 if a trajectory is empty. The first poses of both trajectories must be of the same frame, as
/// must the last poses.
double end_gap_m(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& reference);

}  // namespace roomradar
