// surface_texture_test.cpp: which mesh a texture fits, its files, and damage to them.
#include "mapping/texture/surface_texture.hpp"

#include <gtest/gtest.h>

#include "mapping/mesh/mesh_file.hpp"
#include "mapping/mesh/ply_file.hpp"
#include "mapping/types/codecs/jpeg.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/mapping/texture/texture_scene.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::surface_texture_test {
namespace {

using test::error_of;
using test::wall_mesh;

SurfaceTexture texture_for(const Mesh& mesh) {
  SurfaceTexture texture;
  texture.width_px = 48;
  texture.height_px = 32;
  texture.atlas_jpeg = jpeg_of(ColourImage(48, 32, {90, 120, 30}), 90);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto at = static_cast<std::uint16_t>(i * 700);
    // The two triangles of a square meet at a seam.
    texture.corners.push_back({AtlasPoint{at, 0}, AtlasPoint{at, 65535}, AtlasPoint{65535, at}});
  }
  texture.mesh_fingerprint = fingerprint(mesh);
  return texture;
}

class SurfaceTextureFile : public ::testing::Test {
 protected:
  SurfaceTextureFile() { write_surface_texture(texture_, picture_, points_); }
  std::string fault() const {
    return error_of([&] { (void)read_surface_texture(picture_, points_); });
  }

  const SurfaceTexture texture_ = texture_for(wall_mesh());
  test::TemporaryFolder folder_;
  const std::filesystem::path picture_ = folder_.path() / "texture.jpg";
  const std::filesystem::path points_ = folder_.path() / "texture.bin";
};

TEST(SurfaceTexture, FitsItsMeshAlsoAfterAFile) {
  const test::TemporaryFolder folder;
  const Mesh mesh = wall_mesh();
  const SurfaceTexture texture = texture_for(mesh);
  EXPECT_TRUE(fits(texture, mesh));
  write_mesh(mesh, folder.path() / "mesh.ply");
  EXPECT_TRUE(fits(texture, read_mesh(folder.path() / "mesh.ply")));
  Mesh recoloured = mesh;
  recoloured.colours[0] = {1, 2, 3};
  EXPECT_TRUE(fits(texture, recoloured));
}

TEST(SurfaceTexture, FitsAfterAFileAlsoWithTrianglesThatReadingDrops) {
  const test::TemporaryFolder folder;
  Mesh mesh = wall_mesh();
  // Corners in a line: the area is 0 except for rounding.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3f from(0.1F + 0.013F * static_cast<float>(i), -0.7F, 0.37F),
        step(0.01F, 0.03F, 0.007F);
    for (const float n : {0.0F, 1.0F, 2.0F}) {
      mesh.vertices.push_back(from + n * step);
      mesh.normals.emplace_back(-1.0F, 0.0F, 0.0F);
      mesh.colours.push_back({1, 2, 3});
    }
    const std::uint32_t a = first + 3 * static_cast<std::uint32_t>(i);
    mesh.triangles.push_back({a, a + 1, a + 2});
    mesh.triangles.push_back({a, a, a + 1});
  }
  erase_flat_triangles(mesh);
  const SurfaceTexture texture = texture_for(mesh);
  write_mesh(mesh, folder.path() / "mesh.ply");
  EXPECT_TRUE(fits(texture, read_mesh(folder.path() / "mesh.ply")));
}

// Triangles that have an area in memory, but none once their corners are rounded to float in a file.
TEST(SurfaceTexture, FitsAfterAFileAlsoWithTrianglesThatRoundingFlattens) {
  const test::TemporaryFolder folder;
  Mesh mesh = wall_mesh();
  mesh.origin = {1000.0, -2000.0, 500.0};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t i = 0; i < 300; ++i) {
    const float at = 0.01F * static_cast<float>(i);
    // 20 um wide; floats at 1000 m are 61 um apart.
    for (const Eigen::Vector3f& corner :
         {Eigen::Vector3f(at, 0, 0), Eigen::Vector3f(at + 2e-5F, 1e-5F, 0), Eigen::Vector3f(at, 0, 1)}) {
      mesh.vertices.push_back(corner);
      mesh.normals.emplace_back(-1.0F, 0.0F, 0.0F);
      mesh.colours.push_back({1, 2, 3});
    }
    mesh.triangles.push_back({first + 3 * i, first + 3 * i + 1, first + 3 * i + 2});
  }
  const std::size_t before = mesh.triangles.size();
  erase_flat_triangles(mesh);
  EXPECT_LT(mesh.triangles.size(), before - 100);
  const SurfaceTexture texture = texture_for(mesh);
  write_mesh(mesh, folder.path() / "mesh.ply");
  EXPECT_TRUE(fits(texture, read_mesh(folder.path() / "mesh.ply")));
}

TEST(SurfaceTexture, DoesNotFitAChangedMesh) {
  const Mesh mesh = wall_mesh();
  const SurfaceTexture texture = texture_for(mesh);
  Mesh moved = mesh;
  moved.vertices[3].z() += 1e-4F;
  EXPECT_FALSE(fits(texture, moved));
  Mesh turned = mesh;
  std::swap(turned.triangles[0], turned.triangles[1]);
  EXPECT_FALSE(fits(texture, turned));
  Mesh fewer = mesh;
  fewer.triangles.pop_back();
  EXPECT_FALSE(fits(texture, fewer));
}

TEST(SurfaceTexture, VerticesAreDuplicatedAtSeamsOnly) {
  const Mesh mesh = wall_mesh(1.0F, 1);
  SurfaceTexture texture = texture_for(mesh);
  EXPECT_EQ(textured_mesh(mesh, texture).mesh.vertices.size(), 6U);  // no corner is shared
  texture.corners = {{AtlasPoint{0, 0}, AtlasPoint{0, 9}, AtlasPoint{9, 9}},
                     {AtlasPoint{0, 0}, AtlasPoint{9, 9}, AtlasPoint{9, 0}}};
  const TexturedMesh textured = textured_mesh(mesh, texture);
  EXPECT_EQ(textured.mesh.vertices.size(), 4U);
  ASSERT_EQ(textured.texture_points.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(textured.mesh.vertices[textured.mesh.triangles[i][k]], mesh.vertices[mesh.triangles[i][k]]);
      EXPECT_NEAR(textured.texture_points[textured.mesh.triangles[i][k]].x(),
                  texture.corners[i][k][0] / 65535.0F, 1e-6F);
    }
}

TEST_F(SurfaceTextureFile, IsReadAsItWasWritten) {
  const SurfaceTexture read = read_surface_texture(picture_, points_);
  EXPECT_EQ(read.width_px, 48);
  EXPECT_EQ(read.height_px, 32);
  EXPECT_EQ(read.atlas_jpeg, texture_.atlas_jpeg);
  EXPECT_EQ(read.corners, texture_.corners);
  EXPECT_EQ(read.mesh_fingerprint, texture_.mesh_fingerprint);
}

TEST_F(SurfaceTextureFile, DamageIsNamed) {
  const std::string points = read_bytes(points_, "points"), picture = read_bytes(picture_, "picture");
  for (std::size_t size = 0; size < points.size(); size += 13) {
    write_bytes(points_, points.substr(0, size));
    EXPECT_NE(fault().find("texture.bin"), std::string::npos) << size;
  }
  write_bytes(points_, points);
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{40}, picture.size() - 1}) {
    write_bytes(picture_, picture.substr(0, size));
    EXPECT_NE(fault().find("texture.jpg"), std::string::npos) << size;
  }
  const std::vector<std::uint8_t> other = jpeg_of(ColourImage(64, 32), 90);
  write_bytes(picture_, {reinterpret_cast<const char*>(other.data()), other.size()});
  EXPECT_NE(fault().find("has 64 x 32 pixels, and 48 x 32 belong to the map"), std::string::npos) << fault();
  std::filesystem::remove(picture_);
  EXPECT_NE(fault().find("texture.jpg"), std::string::npos);
}

}  // namespace
}  // namespace roomradar::surface_texture_test
