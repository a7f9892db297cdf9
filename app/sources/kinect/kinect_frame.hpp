// kinect_frame.hpp: a raw frame of a Kinect, and the settings of the feed that delivers it.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
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

}  // namespace roomradar
