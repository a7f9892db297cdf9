// ply_file.cpp: header and packed records.
#include "mapping/mesh/ply_file.hpp"

#include <Eigen/Geometry>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/scene_mesh.hpp"

namespace roomradar {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");
static_assert(sizeof(Rgb) == 3 && sizeof(Triangle) == 12 && sizeof(Eigen::Vector3f) == 12);

constexpr std::size_t kFace_bytes = 1 + sizeof(Triangle);

/// Counts and properties of a file.
struct PlyLayout {
  std::uint64_t vertices = 0, triangles = 0;
  bool has_normals = false, has_colours = false;

  [[nodiscard]] std::size_t vertex_bytes() const {
    return sizeof(Eigen::Vector3f) * (has_normals ? 2 : 1) + (has_colours ? sizeof(Rgb) : 0);
  }
};

std::string header_of(const PlyLayout& layout) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  header += "element vertex " + std::to_string(layout.vertices) + "\n";
  header += "property float x\nproperty float y\nproperty float z\n";
  if (layout.has_normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (layout.has_colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  header += "element face " + std::to_string(layout.triangles) + "\n";
  header += "property list uchar uint vertex_indices\nend_header\n";
  return header;
}

/// Returns the number after the first `name`; 0 if there is none.
std::uint64_t count_after(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  std::uint64_t count = 0;
  if (at != std::string_view::npos)
    std::from_chars(text.data() + at + name.size(), text.data() + text.size(), count);
  return count;
}

/// Returns the layout if the file begins with the header of it, and has its size.
std::optional<PlyLayout> layout_of(std::string_view bytes) {
  constexpr std::size_t kLongestHeader = 400;
  const std::string_view start = bytes.substr(0, kLongestHeader);
  PlyLayout layout{.vertices = count_after(start, "\nelement vertex "),
                   .triangles = count_after(start, "\nelement face "),
                   .has_normals = start.find("\nproperty float nx\n") != std::string_view::npos,
                   .has_colours = start.find("\nproperty uchar red\n") != std::string_view::npos};
  const std::string header = header_of(layout);
  if (!bytes.starts_with(header) || layout.vertices > bytes.size() || layout.triangles > bytes.size() ||
      bytes.size() !=
          header.size() + layout.vertices * layout.vertex_bytes() + layout.triangles * kFace_bytes)
    return std::nullopt;
  return layout;
}

template <typename Value>
void append(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Copies a value from the front of `bytes`, which must be long enough.
template <typename Value>
Value take(std::string_view& bytes) {
  Value value;
  std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(Value));
  bytes.remove_prefix(sizeof(Value));
  return value;
}

}  // namespace

void erase_flat_triangles(Mesh& mesh) {
  // Kept in memory: if a vertex is rounded to float and converted back in one go, GCC 12 drops the rounding
  // of x and y where it vectorises them.
  std::vector<Eigen::Vector3f> in_file;
  in_file.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    in_file.emplace_back((mesh.origin + vertex.cast<double>()).cast<float>());
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Eigen::Vector3d a = in_file[t[0]].cast<double>(), u = in_file[t[1]].cast<double>() - a,
                          v = in_file[t[2]].cast<double>() - a;
    return u.cross(v).squaredNorm() <= 1e-24 * u.squaredNorm() * v.squaredNorm();
  });
}

std::string ply_bytes(const Mesh& mesh) {
  const PlyLayout layout{.vertices = mesh.vertices.size(),
                         .triangles = mesh.triangles.size(),
                         .has_normals = !mesh.normals.empty(),
                         .has_colours = !mesh.colours.empty()};
  std::string bytes = header_of(layout);
  bytes.reserve(bytes.size() + layout.vertices * layout.vertex_bytes() + layout.triangles * kFace_bytes);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = (mesh.origin + mesh.vertices[i].cast<double>()).cast<float>();
    append(bytes, p);
    if (layout.has_normals) append(bytes, mesh.normals[i]);
    if (layout.has_colours) append(bytes, mesh.colours[i]);
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle);
  }
  return bytes;
}

std::optional<Mesh> mesh_of_ply(std::string_view bytes, const std::filesystem::path& path) {
  const std::optional<PlyLayout> layout = layout_of(bytes);
  if (!layout) return std::nullopt;
  if (layout->triangles > kMaxMeshTriangles) fail_for_size(path, layout->triangles);
  bytes.remove_prefix(header_of(*layout).size());
  Mesh mesh;
  mesh.vertices.reserve(layout->vertices);
  if (layout->has_normals) mesh.normals.reserve(layout->vertices);
  if (layout->has_colours) mesh.colours.reserve(layout->vertices);
  for (std::uint64_t i = 0; i < layout->vertices; ++i) {
    mesh.vertices.push_back(take<Eigen::Vector3f>(bytes));
    if (!mesh.vertices.back().allFinite())
      fail_for_file(path, "vertex " + std::to_string(i) + " is not finite; repair the mesh");
    if (layout->has_normals) {
      const Eigen::Vector3f normal = take<Eigen::Vector3f>(bytes).normalized();
      mesh.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f(Eigen::Vector3f::Zero()));
    }
    if (layout->has_colours) mesh.colours.push_back(take<Rgb>(bytes));
  }
  mesh.triangles.reserve(layout->triangles);
  for (std::uint64_t i = 0; i < layout->triangles; ++i) {
    if (take<std::uint8_t>(bytes) != 3) return std::nullopt;
    const auto triangle = take<Triangle>(bytes);
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices.size()) fail_for_file(path, "a triangle names a vertex that is not there");
    if (triangle_area_m2(mesh, triangle) > 0.0) mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace roomradar
