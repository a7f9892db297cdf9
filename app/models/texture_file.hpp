// texture_file.hpp: decodes pictures of textures.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "app/models/model.hpp"

namespace roomradar {

inline constexpr int kMaxTextureSide_px = 4096;
/// Of all textures of a model together.
inline constexpr std::size_t kMaxTexturePixels = std::size_t{64} << 20U;

/// Decodes a PNG, JPEG, BMP, TIFF, WebP or TGA picture. A larger picture is reduced, by averaging, to
/// kMaxTextureSide_px per side and max_pixels in all. Opacity is kept if some pixel is not opaque. The bytes
/// are not trusted: call this within run_sandboxed().
/// @throws Error "cannot be decoded; ..." without the file's name
Texture decode_texture(std::string_view bytes, std::size_t max_pixels);
/// Same, for uncompressed pixels of 4 bytes: blue, green, red, opacity.
Texture texture_of_bgra(std::string_view bytes, int width, int height, std::size_t max_pixels);

/// Returns the path of a picture that a model file names: relative to the model's folder, or beside the model
/// if it is not there, since many files keep paths of their author's machine. Empty if there is none.
std::filesystem::path find_texture(const std::filesystem::path& model, const std::string& name);

/// Reads a picture's file.
/// @throws Error as decode_texture(), also for a file above 64 MiB
Texture read_texture(const std::filesystem::path& path, std::size_t max_pixels);

}  // namespace roomradar
