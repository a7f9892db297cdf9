// tga_picture.hpp: decodes Truevision TGA images, which OpenCV does not read.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace roomradar {

/// Pixels of 4 bytes (blue, green, red, alpha), rows from the top.
struct TgaPicture {
  int width = 0, height = 0;
  std::string bgra;
};

/// Decodes grey images of 8 bits and colour images of 24 or 32 bits, plain or run-length encoded, of at most
/// 16,384 px per side. Returns nullopt for other and truncated images. Source: Truevision TGA file format
/// specification, version 2.0.
std::optional<TgaPicture> decode_tga(std::string_view bytes);

}  // namespace roomradar
