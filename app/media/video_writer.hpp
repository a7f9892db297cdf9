// video_writer.hpp: pictures to a video file, chosen by its extension.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "mapping/types/image.hpp"

namespace roomradar {

/// .mp4 (H.264 where there is an encoder, else MPEG-4), .avi (Motion JPEG), .mkv (MPEG-4). An odd last row or
/// column is left out, for the encoders want even sizes. It is written beside (NAME.partial-PID.avi) and
/// takes its place, and that of a video that was there, when it is finished.
class VideoWriter {
 public:
  /// Throws Error for another extension, a folder that does not exist, or frames_per_s not in 1..240.
  /// The file is made with the first picture.
  VideoWriter(std::filesystem::path path, double frames_per_s);
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  ~VideoWriter();  ///< close() without complaint

  /// A picture of another size than the first (depth is shown until colour comes) is scaled to that. Throws
  /// Error if the file cannot be made, or the disk is full.
  void write(const ColourImage& picture);

  /// The same as often as it takes for the video to go as fast as the stamps do: twice of a source of half
  /// the video's rate, not at all where two pictures fall together. Stamps that jump, back or by more than a
  /// second, are taken for the next picture's.
  void write_at(const ColourImage& picture, double stamp_s);

  /// Finishes the file, reads it back and puts it in its place. If it holds fewer frames than were written
  /// (disk full) or cannot be put there, throws Error that says where it is instead. Nothing happens the
  /// second time, or if nothing was written.
  void close();

  [[nodiscard]] std::int64_t frames_written() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
