// kinect_feed.hpp: reads and pairs a Kinect's images in a thread. Reopens the device if it stops sending
// images.
#pragma once
#include <Eigen/Core>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/sources/kinect/kinect_device.hpp"

namespace roomradar {

/// A depth image with its colour image, or the error message of an unusable frame.
struct KinectFrame {
  /// Index of the depth image, from 0. Broken and dropped images are counted, too.
  std::int64_t number = 0;
  double stamp_s = 0.0;
  /// Raw values, 640 x 480.
  std::vector<std::uint16_t> depth{};
  /// Red, green and blue, 640 x 480 x 3; empty without colour.
  std::vector<std::uint8_t> colour{};
  /// Colour stamp minus depth stamp, by the device's clock.
  double colour_after_depth_s = 0.0;
  /// Unit direction of gravity in the depth camera's frame, if known.
  std::optional<Eigen::Vector3d> down_camera{};
  /// Error message if the frame is unusable, else empty. With a message, all other fields except `number` are
  /// invalid.
  std::string fault{};
};

struct KinectFeedConfig {
  /// Name of the source in messages.
  std::string name;
  /// Index among the connected devices.
  int number = 0;
  KinectDepth depth = KinectDepth::kRaw;
  /// Max number of queued frames. If the queue is full, the oldest frame of a live device is dropped. A
  /// replay waits for the reader instead.
  std::size_t most_waiting = 1;
  /// True if fakenect replays a recording. The feed then ends with the replay, waits for its reader, and does
  /// not reopen the device after a pause.
  bool is_replay = false;
  /// Error messages, by index, of depth images that are omitted from the replay but count as frames.
  std::map<std::int64_t, std::string> broken{};
  /// Time without a depth image after which the device is closed and opened again.
  double silence_s = 1.0;
  /// Time between attempts to open the device.
  double retry_s = 0.5;
  /// Time limit of the first opening.
  double patience_s = 10.0;
  /// Time limit of closing the device. If closing takes longer, the device's thread is abandoned.
  double stop_s = 2.0;
  /// Receives status messages.
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Queue of frames between a Kinect's thread and the reader's thread, with the state that both share. Thread
/// safe.
class KinectQueue {
 public:
  enum class Take { kFrame, kNothing, kEnd };

  /// @param config  must outlive the queue
  explicit KinectQueue(const KinectFeedConfig& config) : config_(config) {}

  // ---- called by the device's thread ----

  /// Tells the reader that the device is open.
  void announce(const KinectDevice& device);
  /// Tells the reader that the device cannot be opened.
  void refuse(const std::string& fault);
  /// Tells the reader that no frame follows.
  void end();
  /// Queues a frame. Returns true if the queue was full and its oldest frame was dropped.
  bool put(KinectFrame frame);
  /// Returns an empty frame, with reused memory if available.
  KinectFrame empty_frame();
  /// Returns true if the reader has stopped the feed. During a replay, first waits until fewer than two
  /// frames are queued.
  bool must_stop();
  /// Waits for wait_s and returns false. Returns true as soon as the reader stops the feed.
  bool stopped_within(double wait_s);

  // ---- called by the reader's thread ----

  /// Waits up to config.patience_s until the device is open, and returns its factory calibration. Throws
  /// Error if the device could not be opened in this time.
  std::optional<KinectConstants> wait_for_opening();
  /// Moves the next frame into `frame`. Waits up to wait_s for a frame.
  Take take(KinectFrame& frame, double wait_s);
  /// Stops the feed. Returns true if the device's thread ended within config.stop_s.
  bool stop();

 private:
  /// Stores the memory of `frame` for reuse, unless the frame has an error message and thus no memory.
  void keep_memory(KinectFrame frame);

  const KinectFeedConfig& config_;
  /// Guards the members below.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<KinectFrame> ready_;
  std::vector<KinectFrame> spare_;
  std::optional<KinectConstants> constants_;
  std::string refused_;
  bool opened_ = false;
  bool ended_ = false;
  bool stop_ = false;
};

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
