// surface_texture.cpp: hash of a mesh, and duplication of its vertices along the seams of a texture.
#include "mapping/texture/surface_texture.hpp"

#include <bit>
#include <unordered_map>

#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

std::uint64_t fingerprint(const Mesh& mesh) {
  std::uint64_t hash = hash_of(mesh.vertices.size(), mesh.triangles.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    // As it is in a file.
    const Eigen::Vector3f p = (mesh.origin + vertex.cast<double>()).cast<float>();
    hash = mixed(hash ^ std::bit_cast<std::uint32_t>(p.x()));
    hash = mixed(hash ^ (std::uint64_t{std::bit_cast<std::uint32_t>(p.y())} << 32U) ^
                 std::bit_cast<std::uint32_t>(p.z()));
  }
  for (const Triangle& t : mesh.triangles)
    hash = mixed(mixed(hash ^ t[0]) ^ ((std::uint64_t{t[1]} << 32U) | t[2]));
  return hash;
}

bool fits(const SurfaceTexture& texture, const Mesh& mesh) {
  return texture.corners.size() == mesh.triangles.size() && texture.mesh_fingerprint == fingerprint(mesh);
}

TexturedMesh textured_mesh(const Mesh& mesh, const SurfaceTexture& texture) {
  TexturedMesh out;
  out.mesh.origin = mesh.origin;
  out.texture_jpeg = texture.atlas_jpeg;
  struct Key {
    std::uint32_t vertex;
    AtlasPoint point;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return hash_of(key.vertex, (std::uint64_t{key.point[0]} << 16U) | key.point[1]);
    }
  };
  std::unordered_map<Key, std::uint32_t, KeyHash> known;
  known.reserve(2 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle& triangle = out.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[i][k];
      const AtlasPoint point = texture.corners[i][k];
      const auto [found, is_new] =
          known.try_emplace(Key{vertex, point}, static_cast<std::uint32_t>(out.mesh.vertices.size()));
      triangle[k] = found->second;
      if (!is_new) continue;
      out.mesh.vertices.push_back(mesh.vertices[vertex]);
      if (!mesh.normals.empty()) out.mesh.normals.push_back(mesh.normals[vertex]);
      out.texture_points.emplace_back(static_cast<float>(point[0]) / 65535.0F,
                                      static_cast<float>(point[1]) / 65535.0F);
    }
  }
  return out;
}

}  // namespace roomradar
