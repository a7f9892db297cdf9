// image_file.hpp: depth and colour images from and to files.
#pragma once
#include <cstdint>
#include <filesystem>

#include "mapping/types/image.hpp"

namespace roomradar {

/// How a depth file's numbers become metres.
enum class DepthEncoding {
  kMillimetres,  ///< 16 bit grey PNG, mm; 0 and 65535: none (7-Scenes, numbered folders)
  kTum,          ///< 16 bit grey PNG, 1/5000 m; 0: none
  kKinectRaw,    ///< 11 bit disparity as 16 bit little-endian behind a PGM header, whatever PGM says; 2047:
                 ///< none
};

/// Reads a depth image in metres (0 = none). Throws Error naming the file if it is missing, cut short, of
/// another type, or cannot be decoded.
void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, DepthImage& depth_m);

/// Reads a colour image: PNG, JPEG or PPM; grey ones too. Throws Error as above.
void read_colour_file(const std::filesystem::path& path, ColourImage& colour);

/// Writes the nearest number of the encoding for each pixel, 0 or 2047 for none and for depths that it cannot
/// hold. Throws Error naming the file if it cannot be written whole (disk full).
void write_depth_file(const DepthImage& depth_m, DepthEncoding encoding, const std::filesystem::path& path);

/// Lossless: PPM where the path ends in .ppm, else PNG. Throws Error as above.
void write_colour_file(const ColourImage& colour, const std::filesystem::path& path);

/// 8 bit grey PNG. Throws Error as above.
void write_mask_file(const MaskImage& mask, const std::filesystem::path& path);

/// All 32 bits of each pixel, as a 16 bit PNG of twice the height: the upper halves above, the lower halves
/// below.
void write_exact_depth_file(const DepthImage& depth_m, const std::filesystem::path& path);
void read_exact_depth_file(const std::filesystem::path& path, DepthImage& depth_m);

}  // namespace roomradar
