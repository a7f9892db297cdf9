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
  kRaw,          ///< 11 bit disparity, converted to metres by roomradar
  kMillimetres,  ///< converted to millimetres by libfreenect
  kRegistered,   ///< millimetres, registered to the colour camera
};

/// Prints a line on stderr; the leading newline keeps it below a progress bar.
inline void say_on_stderr(const std::string& sentence) {
  std::fprintf(stderr, "\nroomradar: %s\n", sentence.c_str());
}

struct SourceOptions {
  /// Overrides the recording's files and the format's published intrinsics. Must match the depth image's
  /// size. If colour is registered to depth (TUM, numbered folders without camera.json), the colour camera is
  /// derived from this.
  std::optional<Intrinsics> depth_camera;
  KinectDepth kinect_depth = KinectDepth::kRaw;
  /// true: frames of a live device are queued until fetched, as far as memory allows; for a scan, which needs
  /// every frame. false: only the newest frame is kept, for live display.
  bool keep_all = false;
  /// Ignores a calibration.json beside a recording: frames stay as the device delivered them.
  bool as_recorded = false;
  /// A live device that has sent no depth for this long, despite repeated restarts, is given up.
  double device_timeout_s = 60.0;
  /// Receives status messages about a live device while it is read; called from another thread.
  std::function<void(const std::string&)> say = say_on_stderr;
};

}  // namespace roomradar
