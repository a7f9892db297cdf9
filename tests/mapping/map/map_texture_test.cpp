// map_texture_test.cpp: the texture in a map's folder: saved, dropped with its mesh, verified, exported.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "mapping/map/map_export.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/mapping/texture/texture_scene.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::map_texture_test {
namespace {

namespace fs = std::filesystem;

class MapTexture : public ::testing::Test {
 protected:
  MapTexture() {
    const Eigen::Isometry3d T_world_camera = test::wall_poses()[0];
    map_.octree.load().fuse(test::wall_frame(test::wall_scene(), T_world_camera), T_world_camera);
    map_.mesh = test::wall_mesh();
    map_.trajectory = {{0, 0.0, T_world_camera}};
    map_.texture = std::make_shared<const SurfaceTexture>(test::red_texture(map_.mesh));
    save_map(path_, map_);
  }
  test::TemporaryFolder folder_;
  const fs::path path_ = folder_.path() / "map";
  SavedMap map_;
};

TEST_F(MapTexture, IsLoadedAsItWasSaved) {
  const SavedMap read = load_map(path_);
  ASSERT_NE(read.texture.load(), nullptr);
  EXPECT_TRUE(fits(*read.texture.load(), read.mesh));
  EXPECT_EQ(read.texture.load()->atlas_jpeg, map_.texture.load()->atlas_jpeg);
  EXPECT_EQ(verify_map(path_), std::vector<std::string>{});
  // Saved again, it is still there.
  save_map(path_, read);
  EXPECT_TRUE(fs::exists(path_ / "texture.jpg"));
  EXPECT_NE(load_map(path_).texture.load(), nullptr);
}

TEST_F(MapTexture, IsLeftOutWhenTheMeshHasChanged) {
  SavedMap read = load_map(path_);
  read.mesh.vertices[7].x() += 0.01F;
  save_map(path_, read);
  EXPECT_FALSE(fs::exists(path_ / "texture.jpg"));
  EXPECT_FALSE(fs::exists(path_ / "texture.bin"));
  EXPECT_EQ(load_map(path_).texture.load(), nullptr);
  EXPECT_EQ(verify_map(path_), std::vector<std::string>{});
  EXPECT_TRUE(load_textured_map_mesh(path_).second.corners.empty());
}

TEST_F(MapTexture, DamageIsFoundWhenItIsUsed) {
  for (const char* name : {"texture.jpg", "texture.bin"}) {
    save_map(path_, map_);
    std::string bytes = read_bytes(path_ / name, "a file");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x11);
    write_bytes(path_ / name, bytes);
    const std::vector<std::string> faults = verify_map(path_);
    ASSERT_EQ(faults.size(), 1U) << name;
    EXPECT_NE(faults[0].find(name), std::string::npos) << faults[0];
    const SavedMap read = load_map(path_);
    EXPECT_NE(test::error_of([&] { read.texture.load(); }).find(name), std::string::npos);
    EXPECT_NE(test::error_of([&] { export_map(path_, folder_.path() / "room.glb"); }).find(name),
              std::string::npos);
    export_map(path_, folder_.path() / "room.ply");  // needs no texture
    fs::remove(path_ / name);
    EXPECT_NE(test::error_of([&] { (void)load_map(path_); }).find(name), std::string::npos);
  }
}

TEST_F(MapTexture, GlbEmbedsIt) {
  const fs::path path = folder_.path() / "room.glb";
  export_map(path_, path);
  const std::string bytes = read_bytes(path, "a glb");
  EXPECT_NE(bytes.find("\"baseColorTexture\""), std::string::npos);
  EXPECT_NE(bytes.find("image/jpeg"), std::string::npos);
  const std::vector<std::uint8_t>& jpeg = map_.texture.load()->atlas_jpeg;
  EXPECT_NE(bytes.find(std::string(jpeg.begin(), jpeg.end())), std::string::npos);
  EXPECT_EQ(bytes.find("COLOR_0"), std::string::npos);  // would multiply the texture
  EXPECT_EQ(read_mesh(path).triangles.size(), map_.mesh.triangles.size());
}

TEST_F(MapTexture, ObjHasItBeside) {
  export_map(path_, folder_.path() / "room.obj");
  const std::string obj = read_bytes(folder_.path() / "room.obj", "an obj");
  EXPECT_NE(obj.find("\nmtllib room.mtl\n"), std::string::npos) << obj.substr(0, 300);
  EXPECT_NE(obj.find("\nusemtl room\n"), std::string::npos);
  EXPECT_NE(obj.find("\nvt "), std::string::npos);
  const std::string mtl = read_bytes(folder_.path() / "room.mtl", "an mtl");
  EXPECT_NE(mtl.find("newmtl room\n"), std::string::npos);
  EXPECT_NE(mtl.find("map_Kd room.jpg\n"), std::string::npos);
  const std::string jpeg = read_bytes(folder_.path() / "room.jpg", "a jpg");
  EXPECT_TRUE(std::equal(jpeg.begin(), jpeg.end(), map_.texture.load()->atlas_jpeg.begin(),
                         map_.texture.load()->atlas_jpeg.end(),
                         [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }));
  EXPECT_EQ(read_mesh(folder_.path() / "room.obj").triangles.size(), map_.mesh.triangles.size());
}

TEST_F(MapTexture, FilesBesideAnObjHaveNamesThatEveryReaderTakesWhole) {
  const auto names_of = [&](const std::string& obj_name) {
    export_map(path_, folder_.path() / (obj_name + ".obj"));
    const auto rest_of_line = [](const std::string& text, const std::string& word) {
      const std::size_t at = text.find("\n" + word) + 1 + word.size();
      return text.substr(at, text.find('\n', at) - at);
    };
    const std::string obj = read_bytes(folder_.path() / (obj_name + ".obj"), "an obj");
    std::string library = rest_of_line(obj, "mtllib ");
    const std::string mtl = read_bytes(folder_.path() / library, "an mtl");
    EXPECT_EQ(rest_of_line(mtl, "map_Ka "), rest_of_line(mtl, "map_Kd "));
    EXPECT_TRUE(fs::exists(folder_.path() / rest_of_line(mtl, "map_Kd ")));
    EXPECT_EQ(rest_of_line(mtl, "map_Kd "), library.substr(0, library.size() - 4) + ".jpg");
    return library;
  };
  EXPECT_EQ(names_of("my room"), "my_room.mtl");
  EXPECT_EQ(names_of("\xc3\xbcr v1.2"), "\xc3\xbcr_v1.2.mtl");
  EXPECT_EQ(names_of("v1.2"), "v1.2.mtl");
  EXPECT_EQ(names_of("-o a\\b\t#1"), "_o_a_b__1.mtl");
  EXPECT_EQ(names_of("a_b"), "a_b.mtl");
  EXPECT_EQ(names_of("a b"), "a_b_.mtl") << "not the material of a_b.obj";
  EXPECT_EQ(names_of("a b"), "a_b_.mtl") << "again the same";
}

TEST_F(MapTexture, OtherFormatsRefuseATexture) {
  const TexturedMesh textured = textured_mesh(map_.mesh, *map_.texture.load());
  EXPECT_NE(test::error_of([&] { write_mesh(textured, folder_.path() / "a.ply"); }).find(".glb and .obj"),
            std::string::npos);
  TexturedMesh without = textured;
  without.texture_points.pop_back();
  EXPECT_NE(test::error_of([&] { write_mesh(without, folder_.path() / "a.glb"); }).find("no point"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar::map_texture_test
