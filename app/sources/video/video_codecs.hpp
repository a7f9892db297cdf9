// video_codecs.hpp: interface between the program and its video codec module, and the module's loading.
#pragma once
#include <cstddef>
#include <memory>
#include <string>

#include "mapping/types/image.hpp"

namespace roomradar {

/// An open video. Its functions throw std::runtime_error if the file is damaged.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;
  [[nodiscard]] virtual double width_px() const = 0;
  [[nodiscard]] virtual double height_px() const = 0;
  [[nodiscard]] virtual double frame_count() const = 0;
  /// Seeks to frame `number`, from 0, so that the next call delivers it. Returns false on failure.
  virtual bool seek(std::size_t number) = 0;
  virtual bool skip() = 0;
  /// Decodes the next frame. Returns false if there is no next frame, or its size differs from the image's.
  virtual bool read(ColourImage& image) = 0;
};

/// Encoder of a video file. Failed writes are not reported.
class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;  ///< completes the file
  /// Writes a picture, scaled to the video's size if its size differs.
  virtual void write(const ColourImage& picture) = 0;
};

/// Functions of the video codec module. They return null if the video cannot be opened, or if there is no
/// encoder for the codec.
class VideoCodecs {
 public:
  virtual ~VideoCodecs() = default;
  [[nodiscard]] virtual std::unique_ptr<VideoDecoder> open(const std::string& path) const = 0;
  /// @param codec  four characters, such as "mp4v"
  /// @param width_px, height_px  size of the pictures; an odd last column or row is dropped
  [[nodiscard]] virtual std::unique_ptr<VideoEncoder> create(const std::string& path,
                                                             const std::string& codec, double frames_per_s,
                                                             int width_px, int height_px) const = 0;
};

/// Returns the codecs of the module roomradar-video.so, which is loaded on the first call and never unloaded.
/// The module is separate because OpenCV's video library loads 240 other libraries, too many for every start
/// of the program. The module is first searched for in the folder of the binary that contains this function.
/// The next candidates are lib/roomradar in the parent and grandparent of that folder, in the configured
/// prefix, and in /usr. Thread safe.
/// @throws Error if the module is not installed, cannot be loaded, or has a different version from the
/// program's
const VideoCodecs& video_codecs();

}  // namespace roomradar

/// The entry point of the module. Returns the codecs, or nullptr if `version` is not the version that the
/// module was built with.
extern "C" const roomradar::VideoCodecs* roomradar_video_codecs(const char* version);
