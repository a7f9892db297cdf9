// trajectory.hpp: poses over time, and their file in the form of the TUM RGB-D benchmark.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace roomradar {

struct TimedPose {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// One line a pose, `stamp tx ty tz qx qy qz qw` (s, m, unit quaternion), in order, with enough digits to
/// come back within 1e-9. Throws Error if the file cannot be written.
void write_trajectory(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory);

/// Reads that form; lines starting with # are comments. frame_index counts the poses, from 0.
/// Throws Error naming file and line where a line has not 8 finite numbers or no usable quaternion.
std::vector<TimedPose> read_trajectory(const std::filesystem::path& path);

struct TrajectoryError {
  std::size_t poses = 0;  ///< matched by frame_index
  double rmse_m = 0.0;
  double max_m = 0.0;
  Eigen::Isometry3d T_reference_estimate = Eigen::Isometry3d::Identity();
};

/// Absolute trajectory error: positions matched by frame index after the best rigid alignment (scale 1).
/// `poses` is 0 where fewer than 3 match. Source: Horn 1987; Sturm et al., IROS 2012.
TrajectoryError absolute_trajectory_error(const std::vector<TimedPose>& estimate,
                                          const std::vector<TimedPose>& reference);

/// T_reference_estimate that brings whole poses together, matched by frame index: the places of the camera
/// and those a metre in front of it, beside and below it. So it holds where the camera hardly moved, or
/// moved in a line, and positions alone would leave a rotation to noise. Nothing where no pose matches.
std::optional<Eigen::Isometry3d> pose_alignment(const std::vector<TimedPose>& estimate,
                                                const std::vector<TimedPose>& reference);

/// How far the estimate's last position is from the reference's, m, once both begin at the same pose; 0 where
/// one of them is empty. First and last poses of both are of the same frames.
double end_gap_m(const std::vector<TimedPose>& estimate, const std::vector<TimedPose>& reference);

}  // namespace roomradar
