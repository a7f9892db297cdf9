// prescan_counts.hpp: counts of a prescan's frames by outcome.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "mapping/types/frame.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

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

}  // namespace roomradar
