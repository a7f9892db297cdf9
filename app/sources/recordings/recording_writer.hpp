// recording_writer.hpp: writes frames to a folder that open_folder() can read.
#pragma once
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/recordings/bag_frame_writer.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

enum class RecordingFormat { kTum, kSevenScenes, kFakenect, kRosBag };

/// Returns "tum", "7scenes", "fakenect" or "rosbag".
std::string_view to_string(RecordingFormat format);

/// Writes a recording frame by frame. Precision after reading it back with open_folder():
///   kTum          stamps, depth to 0.1 mm (invalid beyond 13.1 m), colour, poses, gravity
///   kSevenScenes  depth to 0.5 mm (invalid beyond 65.5 m), colour, poses; no gravity. Stamps are
///                 frame / 30 s. A frame without colour gets an empty file frame-N.color.none.
///   kFakenect     stamps to 1/60 us plus a common offset, depth quantised as by the Kinect (invalid
///                 beyond 9.9 m), colour, gravity to 1/819 g; no poses. Gaps over 30 s become 30 s, since
///                 the device's clock wraps after 72 s. 640 x 480 px only, since fakenect replays no other
///                 size.
///   kRosBag       recording.bag: depth and poses bit for bit, stamps to 1 ns, colour, gravity. All values
///                 that other programs need are in the bag.
/// Colour is stored without loss. All frames must have the cameras of the first frame, which are written to
/// camera.json.
class RecordingWriter {
 public:
  /// Creates the folder, or uses an empty one. Throws Error if it is not empty or cannot be written.
  /// @param are_calibrated  true if lens and depth errors were removed from the frames; stored in camera.json
  RecordingWriter(std::filesystem::path folder, RecordingFormat format, bool are_calibrated = false);

  /// Appends a frame. Throws Error if a file cannot be written or the cameras change. Also throws if the
  /// stamp is not later than the previous frame's, or an image's size differs from its camera's.
  void write(const Frame& frame);

  /// Completes the recording's text files. Throws Error if they cannot be written. No write() may follow. A
  /// recording without close() is usually readable.
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
  // Total time by which kFakenect has shortened gaps over 30 s.
  double left_out_s_ = 0.0;
  // True if the last written gravity entry is a known direction.
  bool wrote_gravity_ = false;
  std::int64_t frames_written_ = 0;
  std::unique_ptr<BagFrameWriter> bag_;
  std::ofstream depth_list_, colour_list_, pose_list_, gravity_list_;
};

}  // namespace roomradar
