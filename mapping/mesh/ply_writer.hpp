// ply_writer.hpp: a mesh as binary .ply.
#pragma once
#include <string>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// The bytes of a little-endian .ply: x y z and, where the mesh has them, nx ny nz as float, red green blue
/// as uchar; triangles as `vertex_indices`. The origin is added back. Written here because assimp 5.2
/// declares colours as bytes but writes them as floats, which nobody can read.
std::string ply_bytes(const Mesh& mesh);

}  // namespace roomradar
