// ply_writer.hpp: encodes a mesh as binary .ply.
#pragma once
#include <string>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns the bytes of a little-endian .ply. Its properties are x y z and, if present, nx ny nz as float,
/// red green blue as uchar, and triangles as `vertex_indices`. The mesh's origin is added to the vertices.
/// Does not use assimp. assimp 5.2 declares colours as bytes but writes floats, so its files cannot be read.
std::string ply_bytes(const Mesh& mesh);

}  // namespace roomradar
