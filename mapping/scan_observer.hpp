// scan_observer.hpp: interface that follows a prescan while it tracks the camera.
#pragma once
#include <cstdint>

#include "mapping/odometry/odometry.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// Follows the first pass of a prescan. Calls come from the prescan's thread. They cannot change the scan,
/// but their time is added to that of the frame.
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

  /// Called after after_frame(). Returns the duration of the scan's end to undo, s by the frames' stamps; 0:
  /// none. After an undo, the camera must return to where it was at that time.
  virtual double take_undo_s() { return 0.0; }
  /// Called when the frames from this index on have been removed from the scan.
  virtual void forgot_frames(std::int64_t /*from_index*/) {}
};

}  // namespace roomradar
