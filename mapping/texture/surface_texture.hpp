// surface_texture.hpp: a texture of a map's surface: an atlas of its colours, and where each triangle lies in
// it.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
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
  std::uint64_t mesh_fingerprint = 0;              ///< of the mesh that the texture belongs to
};

/// Returns a number that changes with any vertex or triangle of the mesh, but neither when the mesh is
/// written to a file and read, nor with its colours and normals.
std::uint64_t fingerprint(const Mesh& mesh);

/// Returns true if the texture was made for this mesh.
bool fits(const SurfaceTexture& texture, const Mesh& mesh);

/// Returns the mesh as textured meshes are drawn and written: vertices with several positions in the atlas
/// are duplicated. Colours are left out. The texture must fit the mesh.
TexturedMesh textured_mesh(const Mesh& mesh, const SurfaceTexture& texture);

}  // namespace roomradar
