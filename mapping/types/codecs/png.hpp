// png.hpp: encodes and decodes PNG pictures.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

struct Rgba {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  friend bool operator==(const Rgba&, const Rgba&) = default;
};

/// Decodes a PNG of any type. Channels of 16 bits are reduced to their upper 8 bits. Grey and palette images
/// are converted to RGBA. Resizes `picture` to the PNG's size, at most 16,384 px per side.
/// @return the fault, nullopt if there is none. After a fault the picture's pixels are unspecified
[[nodiscard]] std::optional<std::string> decode_png(std::string_view bytes, Image<Rgba>& picture);
/// Decodes a PNG of any type and drops its transparency.
[[nodiscard]] std::optional<std::string> decode_png(std::string_view bytes, ColourImage& picture);
/// Decodes a grey PNG of at most 8 bits. Other types are a fault.
[[nodiscard]] std::optional<std::string> decode_png(std::string_view bytes, Image<std::uint8_t>& picture);
/// Decodes a grey PNG of 16 bits. Other types are a fault.
[[nodiscard]] std::optional<std::string> decode_png(std::string_view bytes, Image<std::uint16_t>& picture);

enum class PngEffort {
  kFast,   ///< one filter type, and run-length encoding only: half the time
  kSmall,  ///< libpng's choice of filters, level 3
};

/// Encodes a PNG. Throws Error if the picture is empty or has a side above 16,384 px.
std::vector<std::uint8_t> encode_png(const ColourImage& picture, PngEffort effort = PngEffort::kFast);
std::vector<std::uint8_t> encode_png(const Image<std::uint8_t>& picture, PngEffort effort = PngEffort::kFast);
std::vector<std::uint8_t> encode_png(const Image<std::uint16_t>& picture,
                                     PngEffort effort = PngEffort::kFast);

}  // namespace roomradar
