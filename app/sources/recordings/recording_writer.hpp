// recording_writer.hpp: writes frames as a folder that open_folder reads back.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "app/sources/formats/camera_rig.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class RecordingFormat { kTum, kSevenScenes, kFakenect };

/// "tum", "7scenes" or "fakenect".
std::string_view to_string(RecordingFormat format);

/// Writes a recording frame by frame. What comes back through open_folder:
///   kTum          stamps to 1 us, depth to 0.1 mm (none past 13.1 m), colour, poses, gravity
///   kSevenScenes  depth to 0.5 mm (none past 65.5 m), colour, poses; stamps are frame / 30 s; no gravity;
///                 of a frame without colour an empty file frame-N.color.none
///   kFakenect     stamps to 1/60 us but for a common offset (a gap of more than 30 s is written as one of
///                 30 s: the device's clock goes round in 72 s), depth in the
///                 Kinect's own steps (none past 10 m), colour, gravity to 1/819 g; no poses; 640 x 480
///                 only, which is all that fakenect replays
/// Colour is lossless. All frames must have the first one's cameras, which go to camera.json.
class RecordingWriter {
 public:
  /// Makes the folder, or takes an empty one. Throws Error if it holds anything or cannot be written.
  /// @param are_calibrated  frames are freed of lens and depth errors; camera.json says so
  RecordingWriter(std::filesystem::path folder, RecordingFormat format, bool are_calibrated = false);

  /// Throws Error if a file cannot be written, if the cameras change, if the stamp does not advance, or if
  /// the images are not of the cameras' size.
  void write(const Frame& frame);

  /// Finishes the lists and says so if they are not on disk (Error). Nothing may be written afterwards.
  /// Without it what was written is still a readable recording, most likely.
  void close();

  [[nodiscard]] std::int64_t frames_written() const { return frames_written_; }

 private:
  void write_tum(const Frame& frame);
  void write_seven_scenes(const Frame& frame);
  void write_fakenect(const Frame& frame);

  std::filesystem::path folder_;
  RecordingFormat format_;
  bool are_calibrated_;
  std::optional<CameraRig> rig_;
  double last_stamp_s_ = 0.0;
  double left_out_s_ = 0.0;     // of long gaps, as kFakenect keeps none
  bool wrote_gravity_ = false;  // and not since that it is not known
  std::int64_t frames_written_ = 0;
  std::ofstream depth_list_, colour_list_, pose_list_, gravity_list_;
};

}  // namespace roomradar
