// unknown_surface_file.hpp: reads and writes the border of a map's unknown space as a binary file.
#pragma once
#include <filesystem>

#include "mapping/surface/unknown/unknown_surface.hpp"

namespace roomradar {

/// Writes the surface and the cells of unknown space as one binary file with a checksum. Throws Error if the
/// file cannot be written.
void write_unknown_surface(const UnknownSurface& surface, const std::filesystem::path& path);

/// Reads a file written by write_unknown_surface(). UnknownSurface::memory_bytes is not stored and is 0.
/// Throws Error naming the file and the fault if the file is missing, truncated, altered, or of another
/// version. Sizes are checked before memory is allocated.
UnknownSurface read_unknown_surface(const std::filesystem::path& path);

}  // namespace roomradar
