// image_file.hpp: reading and writing of depth and colour image files.
#pragma once
#include <cstdint>
#include <filesystem>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Encoding of depth in a file's integers.
enum class DepthEncoding {
  kMillimetres,  ///< 16 bit grey PNG, mm; 0 and 65535: invalid (7-Scenes, numbered folders)
  kTum,          ///< 16 bit grey PNG, 1/5000 m; 0: invalid
  kKinectRaw,    ///< 11 bit disparity as 16 bit little-endian (unlike standard PGM) after a PGM header; 2047:
                 ///< invalid
};

/// Reads a depth image in metres (0 = invalid). Throws Error naming the file if it is missing, truncated, of
/// another type, or cannot be decoded.
void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, DepthImage& depth_m);

/// Reads a colour or grey image: PNG, JPEG or PPM. Throws Error as read_depth_file() does.
void read_colour_file(const std::filesystem::path& path, ColourImage& colour);

/// Writes the nearest representable depth for each pixel. Invalid depth, and depth outside the encoding's
/// range, is written as 0 or 2047. Throws Error naming the file if it cannot be written completely (disk
/// full).
void write_depth_file(const DepthImage& depth_m, DepthEncoding encoding, const std::filesystem::path& path);

/// Writes a lossless image: PPM if the path ends in .ppm, else PNG. Throws Error as write_depth_file() does.
void write_colour_file(const ColourImage& colour, const std::filesystem::path& path);

/// Writes an 8 bit grey PNG. Throws Error as write_depth_file() does.
void write_mask_file(const MaskImage& mask, const std::filesystem::path& path);

/// Writes and reads all 32 bits per pixel, as a 16 bit PNG of twice the height: upper 16 bits in the top
/// half, lower 16 bits in the bottom half.
void write_exact_depth_file(const DepthImage& depth_m, const std::filesystem::path& path);
void read_exact_depth_file(const std::filesystem::path& path, DepthImage& depth_m);

}  // namespace roomradar
