// surface_texture.cpp: hash of a mesh, and duplication of its vertices along the seams of a texture; reads
// and writes texture coordinates as a binary file, and the atlas as a JPEG file.
//
// The file of texture coordinates: all numbers are little-endian. The body: width and height of the atlas (2
// u32), fingerprint of the mesh (u64), then two columns of u16 (see compressed_columns.hpp) with x and y of
// the triangles' corners, three per triangle: 0 is the left or upper edge of the atlas, 65535 the right or
// lower edge.
#include "mapping/texture/surface_texture.hpp"

#include <bit>
#include <string>
#include <unordered_map>
#include <vector>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMagic = "RRTEXTUR";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxSide_px = 16384;
constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t{1} << 28U;

}  // namespace

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

void write_surface_texture(const SurfaceTexture& texture, const std::filesystem::path& picture,
                           const std::filesystem::path& points) {
  write_bytes(picture, {reinterpret_cast<const char*>(texture.atlas_jpeg.data()), texture.atlas_jpeg.size()});
  ByteWriter body;
  body(texture.width_px, texture.height_px, texture.mesh_fingerprint);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::vector<std::uint16_t> column;
    column.reserve(3 * texture.corners.size());
    for (const auto& triangle : texture.corners)
      for (const AtlasPoint& point : triangle) column.push_back(point[axis]);
    put_column(body.bytes, column);
  }
  write_binary(points, kMagic, kVersion, body.bytes);
}

SurfaceTexture read_surface_texture(const std::filesystem::path& picture,
                                    const std::filesystem::path& points) {
  const std::string body = read_binary(points, kMagic, kVersion);
  ColumnReader in(body, points.string());
  SurfaceTexture texture;
  const auto width = in.numbers().number<std::uint32_t>(), height = in.numbers().number<std::uint32_t>();
  if (width == 0 || height == 0 || width > kMaxSide_px || height > kMaxSide_px)
    in.numbers().fail("a texture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  texture.width_px = static_cast<int>(width);
  texture.height_px = static_cast<int>(height);
  texture.mesh_fingerprint = in.numbers().number<std::uint64_t>();
  const auto x = in.take<std::uint16_t>("points");
  if (x.size() % 3 != 0 || x.size() > 3 * kMaxMeshTriangles)
    in.numbers().fail(std::to_string(x.size()) + " corners of triangles");
  const auto y = in.take<std::uint16_t>("points", x.size());
  if (in.numbers().left() != 0) in.numbers().fail("bytes after its end");
  texture.corners.resize(x.size() / 3);
  for (std::size_t i = 0; i < x.size(); ++i) texture.corners[i / 3][i % 3] = {x[i], y[i]};
  const std::string jpeg = read_bytes(picture, "a map's texture", kMaxPictureBytes);
  texture.atlas_jpeg.assign(jpeg.begin(), jpeg.end());
  require_jpeg(texture.atlas_jpeg, texture.width_px, texture.height_px, picture.string());
  return texture;
}

}  // namespace roomradar
