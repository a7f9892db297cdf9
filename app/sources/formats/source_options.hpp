// source_options.hpp: options for opening a frame source.
#pragma once
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/sources/formats/input_report.hpp"
#include "app/sources/formats/pose_convention.hpp"
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

/// Where the times of a recording's images are taken from.
enum class StampChoice {
  /// The stated stamps, repaired where they cannot be right, see repair_stamps().
  kAuto,
  /// The times of reception, where a recording has them.
  kReception,
  /// The number of each image, at 30 per second.
  kIndex,
  // The stated stamps, in this unit.
  kSeconds,
  kMilliseconds,
  kMicroseconds,
  kNanoseconds,
};

/// How much of a recording is compared with itself when it is opened, see decide().
enum class Questions {
  /// Only what the recording states. No image is read.
  kNone,
  /// Also whether depth, unit, cameras and poses agree in some of the frames, which reads these.
  kDepth,
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
  /// camera.json that replaces the recording's cameras; empty: none.
  std::filesystem::path camera_file;
  /// Length of a unit of the stored depth, m. Unset: as the recording or its format states.
  std::optional<double> depth_unit_m;
  /// Convention of the recorded poses. Unset: that of the format, or one under which depth agrees.
  std::optional<PoseConvention> pose_convention;
  /// Where the images' times are taken from.
  StampChoice stamps = StampChoice::kAuto;
  /// Topic of a ROS recording with depth images; empty: chosen by find_streams().
  std::string depth_topic;
  Questions questions = Questions::kNone;
  /// Receives the decisions about a recording. Null: they are passed to `say`.
  std::shared_ptr<InputReport> input;
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
  /// Receives status messages about a live device, from the device's thread, and decisions about a recording.
  std::function<void(const std::string&)> say = say_on_stderr;
};

}  // namespace roomradar
