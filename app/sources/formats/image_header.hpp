// image_header.hpp: size and type of an image file, read before memory is allocated for its pixels.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace roomradar {

enum class ImageKind { kPng, kJpeg, kPgm, kPpm };

struct ImageHeader {
  ImageKind kind = ImageKind::kPng;
  int width_px = 0;
  int height_px = 0;
  /// Number of channels. 1 is grey, 3 is colour (including palette images). 2 and 4 are grey and colour with
  /// transparency.
  int channels = 0;
  /// Bits per channel.
  int bits = 0;
  /// PGM and PPM only: byte offset of the pixels.
  std::size_t pixels_at = 0;
};

/// Reads the header of a PNG, JPEG, binary PGM (P5) or binary PPM (P6), recognised by its content. Checks
/// that the file is complete without decoding it. Checks PNG and JPEG by their end markers, PGM and PPM by
/// their length.
/// @param name  file name for error messages
/// @throws Error if the file is empty, of another type, truncated, or wider or higher than 16384 px
ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name);
ImageHeader read_image_header(std::string_view bytes, const std::string& name);

/// Returns a description, for example "640 x 480 16 bit grey PNG".
std::string to_string(const ImageHeader& header);

}  // namespace roomradar
