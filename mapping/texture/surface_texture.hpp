// surface_texture.hpp: texture of a map's surface: a colour atlas, and the texture coordinates of each
// triangle; reads and writes them.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Position in an atlas, from its top left corner (0, 0) to its bottom right corner (65535, 65535).
using AtlasPoint = std::array<std::uint16_t, 2>;

struct SurfaceTexture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> atlas_jpeg;            ///< sRGB
  std::vector<std::array<AtlasPoint, 3>> corners;  ///< one per triangle of the mesh, in its order
  std::uint64_t mesh_fingerprint = 0;  ///< fingerprint() of the mesh for which the texture was baked
};

/// Returns a hash of the mesh's vertices and triangles, without colours and normals. Writing the mesh to a
/// file and reading it back does not change the hash.
std::uint64_t fingerprint(const Mesh& mesh);

/// Returns true if the texture was baked for this mesh.
bool fits(const SurfaceTexture& texture, const Mesh& mesh);

/// Returns the mesh with texture coordinates and without colours. Vertices with several positions in the
/// atlas are duplicated. The texture must fit the mesh.
TexturedMesh textured_mesh(const Mesh& mesh, const SurfaceTexture& texture);

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
