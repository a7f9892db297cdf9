// kinect_feed.hpp: reads and pairs a Kinect's images in a thread. Reopens the device if it stops sending
// images.
#pragma once
#include <memory>
#include <optional>
#include <thread>

#include "app/sources/kinect/kinect_device.hpp"
#include "app/sources/kinect/kinect_frame.hpp"
#include "app/sources/kinect/kinect_queue.hpp"

namespace roomradar {

/// Reads the device in a thread for as long as the object exists. If the device sends no depth image for
/// config.silence_s, or is disconnected, the feed calls config.say and reopens the device until it responds.
/// Frame numbers continue across such a gap, and stamps advance by the elapsed host time. A device that sends
/// depth but no colour is reopened once; if colour is still missing, frames have depth only.
class KinectFeed {
 public:
  using Take = KinectQueue::Take;

  /// Throws Error if the opener does, or if the device does not respond within config.patience_s.
  KinectFeed(KinectOpener opener, KinectFeedConfig config);
  /// Returns within config.stop_s even if the device or its driver hangs.
  ~KinectFeed();
  KinectFeed(const KinectFeed&) = delete;
  KinectFeed& operator=(const KinectFeed&) = delete;

  /// Moves the next frame into `frame` and reuses the memory of `frame`. Waits up to `wait_s` for a frame.
  Take take(KinectFrame& frame, double wait_s);

  /// Returns the factory calibration that was read when the device was first opened.
  [[nodiscard]] const std::optional<KinectConstants>& constants() const { return constants_; }

 private:
  // State of the device's thread, which may outlive this object.
  class Work;
  std::shared_ptr<Work> work_;
  std::optional<KinectConstants> constants_;
  std::thread thread_;
};

}  // namespace roomradar
