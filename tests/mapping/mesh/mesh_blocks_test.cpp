// mesh_blocks_test.cpp: every triangle is in exactly one block, and blocks share only their seams.
#include "mapping/mesh/mesh_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace roomradar::mesh_blocks_test {
namespace {

// A strip of `squares` squares along x, two triangles each.
Mesh strip(std::uint32_t squares) {
  Mesh mesh;
  for (std::uint32_t x = 0; x <= squares; ++x)
    for (const float y : {0.0F, 1.0F}) mesh.vertices.emplace_back(static_cast<float>(x), y, 0.0F);
  for (std::uint32_t x = 0; x < squares; ++x) {
    mesh.triangles.push_back({2 * x, 2 * x + 2, 2 * x + 3});
    mesh.triangles.push_back({2 * x, 2 * x + 3, 2 * x + 1});
  }
  return mesh;
}

TEST(MeshBlocks, AStripIsHalvedAcrossAndSharesTwoVerticesAtEachCut) {
  Mesh mesh = strip(64);
  const Mesh before = mesh;
  const auto blocks = sort_into_blocks(mesh, 32);
  ASSERT_EQ(blocks.size(), 4U);
  for (const auto& block : blocks) EXPECT_EQ(block.size(), 32U);
  EXPECT_EQ(std::multiset<Triangle>(mesh.triangles.begin(), mesh.triangles.end()),
            std::multiset<Triangle>(before.triangles.begin(), before.triangles.end()));
  const std::vector<bool> on_seam = seam_vertices(mesh, blocks);
  std::map<std::uint32_t, std::set<std::size_t>> users;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (const Triangle& t : blocks[b])
      for (const std::uint32_t v : t) users[v].insert(b);
  for (const auto& [v, by] : users) EXPECT_EQ(on_seam[v], by.size() > 1) << v;
  EXPECT_EQ(std::count(on_seam.begin(), on_seam.end(), true), 6);
}

TEST(MeshBlocks, ABlockIsTheSameTrianglesUnderOtherNames) {
  Mesh mesh = strip(20);
  const auto blocks = sort_into_blocks(mesh, 10);
  const BlockMesh part = block_mesh(mesh, blocks.back());
  ASSERT_EQ(part.mesh.triangles.size(), blocks.back().size());
  ASSERT_EQ(part.mesh.vertices.size(), part.name.size());
  EXPECT_LT(part.name.size(), mesh.vertices.size());
  for (std::size_t t = 0; t < blocks.back().size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(part.name[part.mesh.triangles[t][k]], blocks.back()[t][k]);
      EXPECT_EQ(part.mesh.vertices[part.mesh.triangles[t][k]], mesh.vertices[blocks.back()[t][k]]);
    }
}

TEST(MeshBlocks, NothingAndOneTriangleAreNotHalved) {
  Mesh mesh;
  EXPECT_TRUE(sort_into_blocks(mesh, 1).empty());
  mesh = strip(1);
  EXPECT_EQ(sort_into_blocks(mesh, 2).size(), 1U);
  EXPECT_EQ(sort_into_blocks(mesh, 1).size(), 2U);
}

}  // namespace
}  // namespace roomradar::mesh_blocks_test
