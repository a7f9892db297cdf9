// video_writer.hpp: writes pictures to a video file, in the format of its extension.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Writes .mp4 (H.264 if an encoder is available, else MPEG-4), .avi (Motion JPEG) or .mkv (MPEG-4). An odd
/// last row or column is dropped, since encoders need even sizes. The video is written to a temporary file
/// beside (NAME.partial-PID.avi), which replaces any previous video when finished.
class VideoWriter {
 public:
  /// Throws Error for another extension, a folder that does not exist, or frames_per_s not in 1..240. The
  /// file is created with the first picture.
  VideoWriter(std::filesystem::path path, double frames_per_s);
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  ~VideoWriter();  ///< calls close(), ignoring errors

  /// Writes a picture as the next frame, scaled to the first picture's size if different (e.g. if a run shows
  /// depth until it has colour). Throws Error if the file cannot be created, or the disk is full.
  void write(const ColourImage& picture);

  /// Writes a picture as often as keeps the video at the speed of the stamps: twice if the source has half
  /// the video's rate, not at all if two pictures coincide. After stamps that jump backwards or by more than
  /// a second, the picture is written as the next frame.
  void write_at(const ColourImage& picture, double stamp_s);

  /// Finishes the file, reads it back and moves it to its final name. If the file has fewer frames than were
  /// written (disk full) or cannot be moved, throws Error with its actual location. A second call, or a call
  /// before any write, does nothing.
  void close();

  [[nodiscard]] std::int64_t frames_written() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
