// tga_picture.hpp: decodes Truevision TGA pictures, which OpenCV does not read.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace roomradar {

/// Pixels of 4 bytes: blue, green, red, opacity; rows from the top.
struct TgaPicture {
  int width = 0, height = 0;
  std::string bgra;
};

/// Decodes grey pictures of 8 bits and colour pictures of 24 or 32 bits, plain or run-length coded, of at
/// most 16,384 px a side. Returns nullopt for anything else, also for a picture that is cut short. Source:
/// Truevision TGA file format specification, version 2.0.
std::optional<TgaPicture> decode_tga(std::string_view bytes);

}  // namespace roomradar
