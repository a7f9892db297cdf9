// jpeg_colour.hpp: decodes colour images that are JPEG files.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Decodes a JPEG of one or three channels. Fills the same pixels as OpenCV's decoder. That one exchanges red
/// and blue byte by byte, which takes a third of the time.
/// @param[in,out] colour  must have the size of the JPEG
/// @return the fault; nullopt if there is none. A fault in the middle of the pixels is none: libjpeg
/// continues
std::optional<std::string> decode_jpeg(std::string_view bytes, ColourImage& colour);

}  // namespace roomradar
