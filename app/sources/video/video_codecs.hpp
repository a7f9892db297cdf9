// video_codecs.hpp: interface between the program and its module for videos.
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
  /// Makes frame `number`, from 0, the next one. Decodes from the key frame before it.
  virtual bool seek(std::size_t number) = 0;
  virtual bool skip() = 0;
  /// Decodes the next frame. Returns false if there is none, or none of the image's size.
  virtual bool read(ColourImage& image) = 0;
};

/// A video being written. Failed writes are not reported.
class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;  ///< completes the file
  /// Scales a picture of another size than the video's, then writes it.
  virtual void write(const ColourImage& picture) = 0;
};

/// The module's functions. They return null if there is no such video, or no encoder for the codec.
class VideoCodecs {
 public:
  virtual ~VideoCodecs() = default;
  [[nodiscard]] virtual std::unique_ptr<VideoDecoder> open(const std::string& path) const = 0;
  /// @param codec  four characters, such as "mp4v"
  /// @param width_px, height_px  of the pictures; an odd last column or row is dropped
  [[nodiscard]] virtual std::unique_ptr<VideoEncoder> create(const std::string& path,
                                                             const std::string& codec, double frames_per_s,
                                                             int width_px, int height_px) const = 0;
};

}  // namespace roomradar
