// video_file.hpp: random access to the frames of a video.
#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>

#include "app/sources/video/video_codecs.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// A video, decoded by the video codec module. Not thread safe.
class VideoFile {
 public:
  /// Throws Error naming the file if it cannot be opened or a side is not in 1..16384.
  explicit VideoFile(const std::filesystem::path& path);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  /// Decodes frame `number`, from 0, as stored, that is, without applying the rotation that the file states.
  /// Consecutive frames are fast. For other frames, decoding starts at the previous key frame. Throws Error
  /// if the video has no such frame.
  void read(std::size_t number, ColourImage& image);

 private:
  std::filesystem::path path_;
  std::unique_ptr<VideoDecoder> decoder_;
  int width_px_ = 0, height_px_ = 0;
  std::size_t next_ = 0;
};

}  // namespace roomradar
