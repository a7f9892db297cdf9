// source_options.hpp: options for opening a frame source.
#pragma once
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Depth mode of a Kinect.
enum class KinectDepth {
  /// 11 bit disparity, which roomradar converts to metres.
  kRaw,
  /// Millimetres, converted by libfreenect.
  kMillimetres,
  /// Millimetres, registered to the colour camera by libfreenect.
  kRegistered,
};

/// Prints a line on stderr, preceded by a newline, so it does not continue a progress bar's line.
inline void say_on_stderr(const std::string& sentence) {
  std::fprintf(stderr, "\nroomradar: %s\n", sentence.c_str());
}

struct SourceOptions {
  /// Intrinsics of the depth camera. Override those in the recording's files and the published ones of its
  /// format. Must match the depth image's size. If colour is registered to depth (TUM, numbered folders
  /// without camera.json), the colour camera is derived from them.
  std::optional<Intrinsics> depth_camera;
  /// Depth mode of a live Kinect.
  KinectDepth kinect_depth = KinectDepth::kRaw;
  /// True: frames of a live device are queued until fetched, as far as memory allows; for a scan, which needs
  /// every frame. False: only the newest frame is kept, for live display.
  bool keep_all = false;
  /// True: ignores a calibration.json beside a recording, so frames stay as the device delivered them.
  bool as_recorded = false;
  /// Time limit, s: a live device that has sent no depth for this long, despite repeated restarts, is given
  /// up.
  double device_timeout_s = 60.0;
  /// Receives status messages about a live device. Called from another thread while the device is read.
  std::function<void(const std::string&)> say = say_on_stderr;
};

}  // namespace roomradar
