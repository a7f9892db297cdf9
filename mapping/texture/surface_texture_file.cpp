// surface_texture_file.cpp: reads and writes texture coordinates as a binary file, and the atlas as a JPEG
// file.
//
// All numbers are little-endian. The body: width and height of the atlas (2 u32), fingerprint of the mesh
// (u64), then two columns of u16 (see compressed_columns.hpp) with x and y of the triangles' corners, three
// per triangle: 0 is the left or upper edge of the atlas, 65535 the right or lower edge.
#include "mapping/texture/surface_texture_file.hpp"

#include <string>
#include <vector>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/storage/binary_file.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kMagic = "RRTEXTUR";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxSide_px = 16384;
constexpr std::uintmax_t kMaxPictureBytes = std::uintmax_t{1} << 28U;

}  // namespace

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
