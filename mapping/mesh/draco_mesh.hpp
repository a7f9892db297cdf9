// draco_mesh.hpp: decompresses meshes of KHR_draco_mesh_compression.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace roomradar {

/// Numbers of an attribute as they are stored, `width` per vertex.
struct DracoAttribute {
  std::uint32_t id = 0;  ///< unique number within the compressed mesh
  std::size_t width = 0;
  bool is_float = false;
  std::vector<double> values{};
};

struct DracoMesh {
  std::vector<std::uint32_t> corners;  ///< three per triangle
  std::size_t vertices = 0;
  std::vector<DracoAttribute> attributes;
};

/// Decompresses a mesh. Call it within run_sandboxed(): the bytes may be malicious.
/// @throws Error with the rest of a sentence about the bytes, such as "cannot be decompressed (...)"
DracoMesh draco_mesh(std::string_view bytes);

}  // namespace roomradar
