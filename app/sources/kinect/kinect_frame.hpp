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

/// A depth image with its colour image, or the fault that makes it unusable.
struct KinectFrame {
  std::int64_t number = 0;  ///< index of the depth image, from 0; broken and dropped images count too
  double stamp_s = 0.0;
  std::vector<std::uint16_t> depth{};  ///< 640 x 480
  std::vector<std::uint8_t> colour{};  ///< 640 x 480 x 3, or empty
  double colour_after_depth_s = 0.0;   ///< colour stamp minus depth stamp, by the device's clock
  std::optional<Eigen::Vector3d> down_camera{};
  std::string fault{};  ///< if not empty: error message; then only `number` is valid besides
};

struct KinectFeedConfig {
  std::string name;  ///< for messages
  int number = 0;
  KinectDepth depth = KinectDepth::kRaw;
  /// Max frames queued for fetching; when full, the oldest is dropped. A replay waits for the reader instead.
  std::size_t most_waiting = 1;
  /// Replayed by fakenect: the feed ends with the replay, never treats a pause as silence, and waits for its
  /// reader.
  bool is_replay = false;
  /// Depth images that the device does not send but that count as frames: fault by index.
  std::map<std::int64_t, std::string> broken{};
  double silence_s = 1.0;    ///< time without a depth image after which the device is closed and opened again
  double retry_s = 0.5;      ///< between attempts to open the device
  double patience_s = 10.0;  ///< time limit of the first opening
  double stop_s = 2.0;       ///< time limit of closing the device; a device that hangs longer is abandoned
  std::function<void(const std::string&)> say = [](const std::string&) {};
};

}  // namespace roomradar
