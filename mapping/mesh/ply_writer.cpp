// ply_writer.cpp: header and packed records.
#include "mapping/mesh/ply_writer.hpp"

#include <bit>

namespace roomradar {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");
static_assert(sizeof(Rgb) == 3 && sizeof(Triangle) == 12 && sizeof(Eigen::Vector3f) == 12);

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

std::string ply_bytes(const Mesh& mesh) {
  const bool normals = !mesh.normals.empty();
  const bool colours = !mesh.colours.empty();
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  bytes += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
  bytes += "property float x\nproperty float y\nproperty float z\n";
  if (normals) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (colours) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes += "element face " + std::to_string(mesh.triangles.size()) + "\n";
  bytes += "property list uchar uint vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 27 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = (mesh.origin + mesh.vertices[i].cast<double>()).cast<float>();
    append(bytes, p);
    if (normals) append(bytes, mesh.normals[i]);
    if (colours) append(bytes, mesh.colours[i]);
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle);
  }
  return bytes;
}

}  // namespace roomradar
