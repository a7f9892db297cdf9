// mesh_blocks.cpp: median splits and vertex renumbering.
#include "mapping/mesh/mesh_blocks.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace roomradar {
namespace {

Eigen::Vector3f corner_sum(const Mesh& mesh, const Triangle& t) {
  return mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
}

void halve(const Mesh& mesh, std::span<Triangle> triangles, std::size_t max_triangles,
           std::vector<std::span<Triangle>>& blocks) {
  if (triangles.size() <= max_triangles) {
    blocks.push_back(triangles);
    return;
  }
  Eigen::AlignedBox3f box;
  for (const Triangle& t : triangles) box.extend(corner_sum(mesh, t));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t half = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                   [&](const Triangle& a, const Triangle& b) {
                     return corner_sum(mesh, a)[axis] < corner_sum(mesh, b)[axis];
                   });
  halve(mesh, triangles.first(half), max_triangles, blocks);
  halve(mesh, triangles.subspan(half), max_triangles, blocks);
}

}  // namespace

std::vector<std::span<Triangle>> sort_into_blocks(Mesh& mesh, std::size_t max_triangles) {
  std::vector<std::span<Triangle>> blocks;
  if (!mesh.triangles.empty()) halve(mesh, mesh.triangles, max_triangles, blocks);
  return blocks;
}

std::vector<bool> seam_vertices(const Mesh& mesh, const std::vector<std::span<Triangle>>& blocks) {
  constexpr std::uint32_t kNoBlock = ~std::uint32_t{0};
  std::vector<std::uint32_t> block_of(mesh.vertices.size(), kNoBlock);
  std::vector<bool> on_seam(mesh.vertices.size(), false);
  for (std::uint32_t b = 0; b < blocks.size(); ++b)
    for (const Triangle& t : blocks[b])
      for (const std::uint32_t v : t) {
        if (block_of[v] == kNoBlock) block_of[v] = b;
        if (block_of[v] != b) on_seam[v] = true;
      }
  return on_seam;
}

BlockMesh block_mesh(const Mesh& whole, std::span<const Triangle> block) {
  BlockMesh out;
  out.name.reserve(3 * block.size());
  for (const Triangle& t : block) out.name.insert(out.name.end(), t.begin(), t.end());
  std::sort(out.name.begin(), out.name.end());
  out.name.erase(std::unique(out.name.begin(), out.name.end()), out.name.end());
  out.mesh.origin = whole.origin;
  for (const std::uint32_t v : out.name) {
    out.mesh.vertices.push_back(whole.vertices[v]);
    if (!whole.normals.empty()) out.mesh.normals.push_back(whole.normals[v]);
    if (!whole.colours.empty()) out.mesh.colours.push_back(whole.colours[v]);
  }
  out.mesh.triangles.assign(block.begin(), block.end());
  for (Triangle& t : out.mesh.triangles)
    for (std::uint32_t& v : t)
      v = static_cast<std::uint32_t>(std::lower_bound(out.name.begin(), out.name.end(), v) -
                                     out.name.begin());
  return out;
}

}  // namespace roomradar
