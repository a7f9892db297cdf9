// source_options.hpp: what a caller may say about a source that the source itself does not say.
#pragma once
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// What a Kinect is asked to make of the disparity that it measures.
enum class KinectDepth {
  kRaw,          ///< the disparity itself, 11 bit; made metres here
  kMillimetres,  ///< made millimetres by libfreenect
  kRegistered,   ///< millimetres, as the colour camera would see them
};

/// A line on stderr, below the line of a progress bar that may be there.
inline void say_on_stderr(const std::string& sentence) {
  std::fprintf(stderr, "\nroomradar: %s\n", sentence.c_str());
}

struct SourceOptions {
  /// Taken instead of what the recording's files or the format's published figures say. Must be of the depth
  /// image's size. Where colour is registered to depth (TUM, numbered folders without camera.json) the colour
  /// camera follows.
  std::optional<Intrinsics> depth_camera;
  KinectDepth kinect_depth = KinectDepth::kRaw;
  /// What a live device sends is kept until it is fetched, as far as memory allows: for a scan, to which
  /// every frame is worth something. Else there is only ever the newest, for a picture of what is now.
  bool keep_all = false;
  /// A calibration.json beside a recording is passed over: frames are as the device gave them.
  bool as_recorded = false;
  /// A live device that sends no depth for as long, though it is started anew again and again, is given up.
  double device_timeout_s = 60.0;
  /// Is told what becomes of a live device while it is read, by a thread of its own.
  std::function<void(const std::string&)> say = say_on_stderr;
};

}  // namespace roomradar
