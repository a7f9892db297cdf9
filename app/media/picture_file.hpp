// picture_file.hpp: images to PNG files, for looking at.
#pragma once
#include <filesystem>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Throws Error if a PNG picture should not have that name: it would be taken for another format. An empty
/// one is fine.
void require_png_name(const std::filesystem::path& path);

/// 8-bit RGB. Both throw Error naming the path if the image is empty or the file cannot be written whole.
void write_png(const ColourImage& picture, const std::filesystem::path& path);

/// 8-bit grey.
void write_png(const MaskImage& mask, const std::filesystem::path& path);

}  // namespace roomradar
