// image_header.hpp: what an image file says about itself, read before any memory is taken for its pixels.
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
  int channels = 0;  ///< 1 grey, 3 colour (a palette counts as colour), 2 and 4 the same with transparency
  int bits = 0;      ///< of one channel
  std::size_t pixels_at = 0;  ///< PGM and PPM: where the pixels start
};

/// Recognises a PNG, JPEG, binary PGM (P5) or PPM (P6) by its content and checks that it is whole as far as
/// can be told without decoding it: PNG and JPEG by their end marks, PGM and PPM by their length.
/// @param name  of the file, for messages
/// @throws Error if it is empty, none of these, cut short, or wider or higher than 16384
ImageHeader read_image_header(std::span<const std::uint8_t> bytes, const std::string& name);

std::string to_string(const ImageHeader& header);  ///< as in "640 x 480 16 bit grey PNG"

}  // namespace roomradar
