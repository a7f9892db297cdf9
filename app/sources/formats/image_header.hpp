// image_header.hpp: size and type of an image file, read before memory is allocated for its pixels.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace roomradar {

enum class ImageKind { kPng, kJpeg, kPgm, kPpm };

struct ImageHeader {
  ImageKind kind = ImageKind::kPng;
  int width_px = 0;
  int height_px = 0;
  /// Number of channels: 1 grey, 3 colour (including palette images); 2 and 4 are the same with transparency.
  int channels = 0;
  /// Bits per channel.
  int bits = 0;
  /// PGM and PPM only: byte offset of the pixels.
  std::size_t pixels_at = 0;
};

/// Recognises a PNG, JPEG, binary PGM (P5) or PPM (P6) by its content. Checks as far as possible without
/// decoding that the file is complete: PNG and JPEG by their end marks, PGM and PPM by their length.
/// @param name  file name for messages
/// @throws Error if the file is empty, none of these types, truncated, or wider or higher than 16384 px
ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name);

/// Returns a description, for example "640 x 480 16 bit grey PNG".
std::string to_string(const ImageHeader& header);

}  // namespace roomradar
