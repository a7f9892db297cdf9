// image_file.hpp: reads and writes depth and colour image files.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Encoding of depth as integers in a file.
enum class DepthEncoding {
  /// 16 bit grey PNG or PGM (big-endian) in mm. 0 and 65535 are invalid (7-Scenes, numbered folders).
  kMillimetres,
  /// 16 bit grey PNG or PGM (big-endian) in 1/5000 m. 0 is invalid.
  kTum,
  /// 11 bit disparity as 16 bit little-endian (unlike standard PGM) after a PGM header. 2047 is invalid.
  kKinectRaw,
};

/// Reads a depth image and converts it to metres; 0: invalid. Throws Error with the file's name if the file
/// is missing, truncated, of another type, or cannot be decoded.
void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, DepthImage& depth_m);
/// As above, with another length of a unit of the stored depth. For kKinectRaw, whose depth is a disparity,
/// unit_m is the length of a metre.
void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, double unit_m,
                     DepthImage& depth_m);
/// Returns the length of a unit of the encoding, m; 1 for kKinectRaw.
double depth_unit_m(DepthEncoding encoding);
/// Multiplies each depth, for files that hold metres by their format, but another unit by their user's word.
void scale_depth(double factor, DepthImage& depth_m);

/// Reads a colour or grey image (PNG, JPEG or PPM). Throws Error as read_depth_file() does.
void read_colour_file(const std::filesystem::path& path, ColourImage& colour);

/// Decodes a depth image, a 16 bit grey PNG or PGM, from memory. 0 and 65535 are invalid.
/// @param units_per_m  1000: the PNG is in mm
/// @throws Error as read_depth_file() does, naming `name`
void decode_depth_png(std::string_view bytes, float units_per_m, const std::string& name,
                      DepthImage& depth_m);
/// Decodes a depth image whose pixels are floats in m, stored as the four 8 bit channels of a PNG, from
/// memory.
void decode_float_png(std::string_view bytes, const std::string& name, DepthImage& depth_m);
/// Decodes a colour or grey image (PNG, JPEG or PPM) from memory. Throws Error naming `name`.
void decode_colour(std::string_view bytes, const std::string& name, ColourImage& colour);
/// Decodes a grey PNG of 8 bit from memory, such as a confidence map. Throws Error naming `name`.
void decode_grey_png(std::string_view bytes, const std::string& name, Image<std::uint8_t>& image);

/// Writes a depth image, with each depth rounded to the nearest one that the encoding can represent. Invalid
/// depth, and depth outside the encoding's range, is written as the encoding's invalid value, 0 or 2047.
/// Throws Error with the file's name if it cannot be written completely.
void write_depth_file(const DepthImage& depth_m, DepthEncoding encoding, const std::filesystem::path& path);

/// Writes a lossless image: PPM if the path ends in .ppm, else PNG. Throws Error as write_depth_file() does.
void write_colour_file(const ColourImage& colour, const std::filesystem::path& path);

/// Writes an 8 bit grey PNG. Throws Error as write_depth_file() does.
void write_mask_file(const MaskImage& mask, const std::filesystem::path& path);

/// Throws Error naming `name` if a depth is negative or not finite.
void require_depth(const DepthImage& depth_m, const std::string& name);
/// Reads a lossless depth image that an earlier version wrote: a 16 bit PNG of twice the height. Its top half
/// contains the upper 16 bits of each pixel's float, its bottom half the lower 16 bits.
void read_exact_depth_file(const std::filesystem::path& path, DepthImage& depth_m);

}  // namespace roomradar
