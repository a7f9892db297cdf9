// scan_observer.hpp: interface that follows a prescan while it tracks the camera.
#pragma once
#include "mapping/odometry/odometry.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Follows the first pass of a prescan. Calls come from the prescan's thread. They cannot change the scan, but
/// their time is added to that of the frame.
class ScanObserver {
 public:
  ScanObserver() = default;
  ScanObserver(const ScanObserver&) = delete;
  ScanObserver& operator=(const ScanObserver&) = delete;
  virtual ~ScanObserver() = default;

  /// Called after each readable frame, with its tracking result and the state of the odometry after it.
  virtual void after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry) = 0;
};

}  // namespace roomradar
