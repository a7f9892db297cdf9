// surface_texture_file.hpp: reads and writes the texture of a map's surface.
#pragma once
#include <filesystem>

#include "mapping/texture/surface_texture.hpp"

namespace roomradar {

/// Writes the atlas to `picture` (JPEG). Writes texture coordinates, size and fingerprint to `points`, a
/// binary file with a checksum. Throws Error if a file cannot be written.
void write_surface_texture(const SurfaceTexture& texture, const std::filesystem::path& picture,
                           const std::filesystem::path& points);

/// Reads files written by write_surface_texture(). The atlas is not decoded; only its size is checked. Throws
/// Error naming the file and the fault if a file is missing, truncated, altered, or of another version. Sizes
/// are checked before memory is allocated.
SurfaceTexture read_surface_texture(const std::filesystem::path& picture,
                                    const std::filesystem::path& points);

}  // namespace roomradar
