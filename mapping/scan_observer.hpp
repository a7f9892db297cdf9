// scan_observer.hpp: interface that follows a prescan while it tracks the camera.
#pragma once
#include <cstdint>

#include "mapping/odometry/odometry.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

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

}  // namespace roomradar
