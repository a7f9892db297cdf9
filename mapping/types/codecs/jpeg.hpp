// jpeg.hpp: encodes and decodes JPEG pictures.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Encodes a JPEG with optimal Huffman tables. Throws Error if the picture is empty.
/// @param quality  1..100
std::vector<std::uint8_t> jpeg_of(const ColourImage& picture, int quality);

/// Decodes a JPEG: grey, colour or CMYK. Resizes `picture` to the JPEG's size, at most 16,384 px per side.
/// @return the fault, nullopt if there is none. Damage within the pixel data is not a fault, since libjpeg
///         continues. After a fault the picture's pixels are unspecified
[[nodiscard]] std::optional<std::string> decode_jpeg(std::string_view bytes, ColourImage& picture);

/// Decodes a JPEG that must have this size. The bytes are not trusted: the size is read before memory is
/// allocated for the pixels. Throws Error beginning with `where` if the bytes are not a JPEG, are damaged, or
/// have another size.
ColourImage picture_of_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px,
                            const std::string& where);

/// Checks, without decoding, the markers at both ends and the size. Throws Error as picture_of_jpeg() does.
void require_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px, const std::string& where);

}  // namespace roomradar
