// kinect_feed.hpp: a Kinect's images, paired, from a thread of its own that brings the device back when it
// falls silent.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/sources/kinect/kinect_device.hpp"

namespace roomradar {

/// A depth image with the colour image that goes with it, or what is wrong with it.
struct KinectFrame {
  std::int64_t number = 0;  ///< of the depth image, counted from 0, those that are broken or dropped as well
  double stamp_s = 0.0;
  std::vector<std::uint16_t> depth{};  ///< 640 x 480
  std::vector<std::uint8_t> colour{};  ///< 640 x 480 x 3, or empty
  double colour_after_depth_s = 0.0;   ///< how much later it was taken, by the device's clock
  std::optional<Eigen::Vector3d> down_camera{};
  std::string fault{};  ///< if not empty: a sentence; the rest but the number is not to be used
};

struct KinectFeedConfig {
  std::string name;  ///< for messages
  int number = 0;
  KinectDepth depth = KinectDepth::kRaw;
  /// Frames that wait to be fetched; when one more comes the oldest goes. A replay waits instead.
  std::size_t most_waiting = 1;
  /// By fakenect: it ends, is never silent, however long it pauses, and is in no hurry.
  bool is_replay = false;
  /// Depth images that are not sent and should be counted, by their numbers, with what is wrong with them.
  std::map<std::int64_t, std::string> broken{};
  double silence_s = 1.0;    ///< without a depth image, and the device is closed and opened anew
  double retry_s = 0.5;      ///< from one try to open it to the next
  double patience_s = 10.0;  ///< for the first opening
  double stop_s = 2.0;       ///< for the device to be closed; then it is left to itself
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// While one lives, a thread of its own serves the device. A device that sends no depth image for silence_s,
/// or goes, is said and opened again until it is back: numbers and stamps go on, the stamps by the time that
/// passed here. One that sends depth but no colour is opened anew once, then goes on without.
class KinectFeed {
 public:
  enum class Take { kFrame, kNothing, kEnd };

  /// Throws Error as the opener does, or if the device does not answer.
  KinectFeed(KinectOpener opener, KinectFeedConfig config);
  /// Does not wait longer than config.stop_s, even where the device or its driver hangs.
  ~KinectFeed();
  KinectFeed(const KinectFeed&) = delete;
  KinectFeed& operator=(const KinectFeed&) = delete;

  /// The next frame, into `frame`, whose memory is used again; waits for it for as long as `wait_s`.
  Take take(KinectFrame& frame, double wait_s);

  /// Of the device that was opened first.
  [[nodiscard]] const std::optional<KinectConstants>& constants() const { return constants_; }

 private:
  class Work;  // of the device's thread, which may outlive this
  std::shared_ptr<Work> work_;
  std::optional<KinectConstants> constants_;
  std::thread thread_;
};

}  // namespace roomradar
