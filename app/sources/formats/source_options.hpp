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

/// Prints a line on stderr. Starts with a newline, since a progress bar may occupy the current line.
inline void say_on_stderr(const std::string& sentence) {
  std::fprintf(stderr, "\nroomradar: %s\n", sentence.c_str());
}

struct SourceOptions {
  /// Intrinsics of the depth camera. They replace those in the recording's files and the defaults of its
  /// format. Their size must match the depth image's. If depth is registered to colour (TUM and numbered
  /// folders without camera.json), the colour camera's intrinsics are derived from them.
  std::optional<Intrinsics> depth_camera;
  /// Depth mode of a live Kinect.
  KinectDepth kinect_depth = KinectDepth::kRaw;
  /// True: up to 120 frames of a live device are queued, for scans. Scans need every frame. False: only the
  /// newest frame is kept, for live display.
  bool keep_all = false;
  /// True: simulated frames are cached on disk, for callers that read each frame several times.
  bool cache_simulated = false;
  /// True: calibration.json in the recording's folder is ignored. Frames are then delivered as recorded.
  bool as_recorded = false;
  /// Max time without depth images from a live device, despite restarts, before next() throws Error, s.
  double device_timeout_s = 60.0;
  /// Receives status messages about a live device. Called from the device's thread.
  std::function<void(const std::string&)> say = say_on_stderr;
};

}  // namespace roomradar
