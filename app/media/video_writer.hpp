// video_writer.hpp: writes pictures to a video file.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "mapping/types/image.hpp"

namespace roomradar {

/// The file's extension selects the format: .mp4 (H.264 if an encoder is available, else MPEG-4), .avi
/// (Motion JPEG) or .mkv (MPEG-4, else Motion JPEG). Encoders need even sizes. If width or height is odd, the
/// last column or row is dropped. The video is written to a temporary file in the same folder, such as
/// NAME.partial-PID.avi. close() moves it to its final name, and replaces an earlier video. A pipe or a
/// device is written directly.
class VideoWriter {
 public:
  /// Throws Error for another extension, a folder that does not exist, a path that cannot be written, or
  /// frames_per_s not in 1..240. The file is created when the first picture is written.
  VideoWriter(std::filesystem::path path, double frames_per_s);
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  ~VideoWriter();  ///< calls close(), ignoring errors

  /// Writes a picture as the next frame. A picture of another size than the first is scaled to the first
  /// one's size. Throws Error if the file cannot be created or the disk is full.
  void write(const ColourImage& picture);

  /// Writes a picture as zero, one or more frames, so that the video runs at the speed of the stamps. For
  /// example, each picture is written twice if the source has half the video's frame rate. If the stamp jumps
  /// backwards, or forwards by more than a second, the picture is written as the next frame.
  void write_at(const ColourImage& picture, double stamp_s);

  /// Completes the file, checks it by reading it, and moves it to its final name. Throws Error with the
  /// file's current path if it contains fewer frames than were written or cannot be moved. A second call, or
  /// a call before any write, does nothing.
  void close();

  /// Deletes the temporary file. An earlier video with the final name remains. Does nothing after close().
  void discard();

  [[nodiscard]] std::int64_t frames_written() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
