// texture_file.hpp: decodes the image files of textures.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "app/models/model.hpp"
#include "mapping/mesh/model_folder.hpp"

namespace roomradar {

inline constexpr int kMaxTextureSide_px = 4096;
/// Max number of pixels of all textures of a model together.
inline constexpr std::size_t kMaxTexturePixels = std::size_t{64} << 20U;

/// Decodes a PNG, JPEG, WebP, BMP or TGA image. Pixels that a truncated JPEG, BMP or TGA lacks are grey or
/// black. An image with more than kMaxTextureSide_px per side or more than max_pixels in total is reduced by
/// averaging. Alpha is kept if some pixel is not opaque. `bytes` may be malicious: call this function within
/// run_sandboxed().
/// @throws Error such as "cannot be decoded as PNG: ...", without the file's name
Texture decode_texture(std::string_view bytes, std::size_t max_pixels);
/// Makes a texture from uncompressed pixels of 4 bytes: blue, green, red, alpha. Reduces it as
/// decode_texture() does.
Texture texture_of_bgra(std::string_view bytes, int width, int height, std::size_t max_pixels);

/// Looks up an image that a model file names, within the model's folder. The name is searched relative to
/// this folder. Then its last component is searched in it, since many files contain paths of their author's
/// machine. If neither exists, repeats the search without "file://", with percent encoding (%20) decoded, and
/// with backslashes replaced by slashes. The fault is that of the first file that is not just missing.
NamedFile find_texture(const std::filesystem::path& model, const std::string& name);

/// @throws Error as decode_texture(), also for a file above 64 MiB
Texture read_texture(const std::filesystem::path& path, std::size_t max_pixels);

}  // namespace roomradar
