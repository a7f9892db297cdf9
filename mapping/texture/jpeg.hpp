// jpeg.hpp: encodes and decodes JPEG pictures.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

/// @param quality  1..100
std::vector<std::uint8_t> jpeg_of(const ColourImage& picture, int quality);

/// Decodes a JPEG that must have this size. The bytes are not trusted: the size is read before memory is
/// allocated for the pixels. Throws Error beginning with `where` if the bytes are no JPEG, damaged, or of
/// another size.
ColourImage picture_of_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px,
                            const std::string& where);

/// Checks, without decoding, the markers at both ends and the size. Throws Error as picture_of_jpeg() does.
void require_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px, const std::string& where);

}  // namespace roomradar
