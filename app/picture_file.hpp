// picture_file.hpp: images to PNG files, for looking at.
#pragma once
#include <filesystem>

#include "mapping/types/image.hpp"

namespace roomradar {

/// 8-bit RGB. All three throw Error naming the path if the image is empty or the file cannot be written
/// whole.
void write_png(const ColourImage& picture, const std::filesystem::path& path);

/// Depth in colours, near red to far blue, black where there is none; the ends are the image's own 1st and
/// 99th percentiles, or near_m..far_m where both are given (far_m > near_m).
void write_png(const DepthImage& depth_m, const std::filesystem::path& path, float near_m = 0.0F,
               float far_m = 0.0F);

/// 8-bit grey.
void write_png(const MaskImage& mask, const std::filesystem::path& path);

}  // namespace roomradar
