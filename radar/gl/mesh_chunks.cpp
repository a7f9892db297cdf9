// mesh_chunks.cpp: checks, sorts and bounds triangles.
#include "radar/gl/mesh_chunks.hpp"

#include <algorithm>
#include <utility>

#include "mapping/types/validity.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

void keep_usable(const Mesh& mesh, ChunkedTriangles& out) {
  out.triangles.resize(mesh.triangles.size());
  std::size_t kept = 0;
  for (const Triangle& triangle : mesh.triangles) {
    out.triangles[kept] = triangle;
    kept += is_usable(mesh, triangle) ? 1U : 0U;
  }
  out.triangles.resize(kept);
  out.dropped_triangles = mesh.triangles.size() - kept;
}

}  // namespace

void chunk_by_place(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out) {
  keep_usable(mesh, out);
  Eigen::AlignedBox3f box;
  const auto centre = [&](const Triangle& t) -> Eigen::Vector3f {
    return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F;
  };
  for (const Triangle& triangle : out.triangles) box.extend(centre(triangle));

  // One scale for all axes, so cells are cubes and a flat room is not cut into slabs.
  const float longest_m = box.isEmpty() ? 0.0F : box.sizes().maxCoeff();
  constexpr float kCells = 1023.0F;  // cells of some centimetres in a room
  const float scale = longest_m > 0.0F ? kCells / longest_m : 0.0F;
  std::vector<std::pair<std::uint64_t, Triangle>> keyed(out.triangles.size());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const Eigen::Vector3f cell = (centre(out.triangles[i]) - box.min()) * scale;
    keyed[i] = {morton_code(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
                            static_cast<std::uint32_t>(cell.z())),
                out.triangles[i]};
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < keyed.size(); ++i) out.triangles[i] = keyed[i].second;
  cut_into_chunks(mesh.vertices, out.triangles, max_triangles, out);
}

void chunk_in_order(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out) {
  keep_usable(mesh, out);
  cut_into_chunks(mesh.vertices, out.triangles, max_triangles, out);
}

void cut_into_chunks(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     std::uint32_t max_triangles, ChunkedTriangles& out) {
  out.chunks.clear();
  out.bounds_local.setEmpty();
  for (std::size_t first = 0; first < triangles.size(); first += max_triangles) {
    MeshChunk chunk;
    chunk.first_triangle = static_cast<std::uint32_t>(first);
    chunk.triangle_count =
        static_cast<std::uint32_t>(std::min<std::size_t>(max_triangles, triangles.size() - first));
    for (std::size_t i = first; i < first + chunk.triangle_count; ++i) {
      for (const std::uint32_t vertex : triangles[i]) chunk.bounds_local.extend(vertices[vertex]);
    }
    out.bounds_local.extend(chunk.bounds_local);
    out.chunks.push_back(chunk);
  }
}

}  // namespace roomradar
