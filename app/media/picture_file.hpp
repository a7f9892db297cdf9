// picture_file.hpp: writes images to PNG files for viewing.
#pragma once
#include <filesystem>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Throws Error if the path is not empty and does not end in .png.
void require_png_name(const std::filesystem::path& path);

/// Writes an 8-bit RGB PNG. Both overloads throw Error with the path if the image is empty or the file cannot
/// be written completely.
void write_png(const ColourImage& picture, const std::filesystem::path& path);

/// Writes an 8-bit grey PNG.
void write_png(const MaskImage& mask, const std::filesystem::path& path);

}  // namespace roomradar
