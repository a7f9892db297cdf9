// mesh_file_test.cpp: round trips through each format, and files that are not meshes.
#include "mapping/mesh/mesh_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::mesh_file_test {
namespace {

// A wavy sheet with more vertices than a 16-bit index allows, and every colour level in it.
Mesh wavy_sheet(int side) {
  Mesh mesh;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float u = static_cast<float>(x) * 0.01F, v = static_cast<float>(y) * 0.01F;
      mesh.vertices.emplace_back(
          u, v, 0.1F * std::sin(3.0F * u) * std::cos(2.0F * v) + 1e-7F * static_cast<float>(x));
      mesh.normals.push_back(Eigen::Vector3f(0.1F * u, -0.1F * v, 1.0F).normalized());
      const auto level = static_cast<std::uint8_t>((y * side + x) % 256);
      mesh.colours.push_back(
          {level, static_cast<std::uint8_t>(255 - level), static_cast<std::uint8_t>(level / 2)});
    }
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const auto a = static_cast<std::uint32_t>(y * side + x), below = a + static_cast<std::uint32_t>(side);
      mesh.triangles.push_back({a, a + 1, below});
      mesh.triangles.push_back({a + 1, below + 1, below});
    }
  return mesh;
}

std::string message_of(const std::filesystem::path& path) {
  try {
    static_cast<void>(read_mesh(path));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

class MeshFile : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& content) {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
    return folder_.path() / name;
  }
  void expect_fault(const std::filesystem::path& path, const std::string& fault) {
    const std::string message = message_of(path);
    EXPECT_NE(message.find(fault), std::string::npos) << message;
    EXPECT_EQ(message.rfind(path.string(), 0), 0U) << "the file comes first: " << message;
  }
  /// Adds a comment to a .ply's header, so that it is another program's, and returns the new file.
  std::filesystem::path with_comment(const std::string& name) {
    std::ifstream in(folder_.path() / name, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    content.insert(content.find("element vertex"), "comment made elsewhere\n");
    return file("foreign-" + name, content);
  }
  test::TemporaryFolder folder_;
};

TEST_F(MeshFile, EachFormatKeepsVerticesAndTrianglesAndWhatElseItCan) {
  const Mesh mesh = wavy_sheet(270);
  ASSERT_GT(mesh.vertices.size(), 65'536U);
  for (const char* extension : {".ply", ".obj", ".glb", ".PLY"}) {
    const std::filesystem::path path = folder_.path() / (std::string("sheet") + extension);
    write_mesh(mesh, path);
    const Mesh read = read_mesh(path);
    // An .obj is read with its vertices in the order of their use, so vertices are compared triangle by
    // triangle.
    ASSERT_EQ(read.vertices.size(), mesh.vertices.size()) << extension;
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size()) << extension;
    ASSERT_EQ(read.colours.size(), mesh.colours.size()) << extension;
    ASSERT_EQ(read.normals.size(), mesh.normals.size()) << extension;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t before = mesh.triangles[i][k], after = read.triangles[i][k];
        ASSERT_LT((read.vertices[after] - mesh.vertices[before]).norm(), 1e-7F)
            << extension;  // axes unchanged
        ASSERT_LT((read.normals[after] - mesh.normals[before]).norm(), 1e-6F) << extension;
        ASSERT_EQ(read.colours[after], mesh.colours[before]) << extension;
      }
  }
}

/// Returns the first vertex's value of an attribute of a .glb's first mesh.
std::vector<float> first_of_glb(const std::filesystem::path& path, const char* attribute) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, bytes.data() + 12, 4);
  const auto json = nlohmann::json::parse(bytes.substr(20, json_bytes));
  const auto& accessor =
      json["accessors"][json["meshes"][0]["primitives"][0]["attributes"][attribute].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5126) << "float";
  const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::vector<float> values(3);
  std::memcpy(
      values.data(),
      bytes.data() + 28 + json_bytes + view.value("byteOffset", 0U) + accessor.value("byteOffset", 0U), 12);
  return values;
}

TEST_F(MeshFile, AGlbHasYUpAndLinearColoursAsOtherProgramsExpect) {
  Mesh mesh;
  mesh.vertices = {{1.0F, 2.0F, 3.0F}, {2.0F, 2.0F, 3.0F}, {1.0F, 4.0F, 3.0F}};
  mesh.normals.assign(3, Eigen::Vector3f::UnitZ());
  mesh.colours.assign(3, {255, 128, 0});
  mesh.triangles = {{0, 1, 2}};
  const std::filesystem::path path = folder_.path() / "up.glb";
  write_mesh(mesh, path);
  EXPECT_EQ(first_of_glb(path, "POSITION"), (std::vector{1.0F, 3.0F, -2.0F}));
  EXPECT_EQ(first_of_glb(path, "NORMAL"), (std::vector{0.0F, 1.0F, 0.0F}));
  const std::vector<float> colour = first_of_glb(path, "COLOR_0");
  EXPECT_EQ(colour[0], 1.0F);
  EXPECT_NEAR(colour[1], 0.21586, 1e-5);
  EXPECT_EQ(colour[2], 0.0F);
}

// assimp, which reads files of other programs, takes a newline at the start of the data for the end of the
// header.
TEST_F(MeshFile, APlyIsReadWhateverByteItsFirstNumberBeginsWith) {
  Mesh mesh = wavy_sheet(3);
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    const std::uint32_t bits = 0x3f8000U << 8U | byte;
    std::memcpy(&mesh.vertices[0].x(), &bits, sizeof bits);
    write_mesh(mesh, folder_.path() / "sheet.ply");
    const Mesh read = read_mesh(folder_.path() / "sheet.ply");
    ASSERT_EQ(read.vertices, mesh.vertices) << byte;
    ASSERT_EQ(read.triangles, mesh.triangles) << byte;
    const Mesh foreign = read_mesh(with_comment("sheet.ply"));
    ASSERT_EQ(foreign.vertices, mesh.vertices) << byte;
    ASSERT_EQ(foreign.triangles, mesh.triangles) << byte;
  }
}

TEST_F(MeshFile, APlyOfItsOwnIsReadAsAssimpReadsIt) {
  Mesh mesh = wavy_sheet(40);
  mesh.triangles.push_back({7, 7, 8});  // no area
  for (const bool has_normals : {false, true})
    for (const bool has_colours : {false, true}) {
      Mesh some = mesh;
      if (!has_normals) some.normals.clear();
      if (!has_colours) some.colours.clear();
      write_mesh(some, folder_.path() / "m.ply");
      const Mesh own = read_mesh(folder_.path() / "m.ply"), foreign = read_mesh(with_comment("m.ply"));
      EXPECT_EQ(own.vertices, mesh.vertices);
      EXPECT_EQ(own.triangles.size() + 1, mesh.triangles.size());
      EXPECT_EQ(own.colours, some.colours);
      EXPECT_EQ(own.vertices, foreign.vertices);
      EXPECT_EQ(own.triangles, foreign.triangles);
      EXPECT_EQ(own.colours, foreign.colours);
      ASSERT_EQ(own.normals.size(), foreign.normals.size());
      for (std::size_t i = 0; i < own.normals.size(); ++i)
        EXPECT_LT((own.normals[i] - foreign.normals[i]).norm(), 1e-6F);
    }
}

TEST_F(MeshFile, APlyOfItsOwnWithAFaultIsNamed) {
  const Mesh mesh = wavy_sheet(5);
  write_mesh(mesh, folder_.path() / "m.ply");
  std::ifstream in(folder_.path() / "m.ply", std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::string bad = good;
  const std::uint32_t absent = 25;
  std::memcpy(bad.data() + bad.size() - 4, &absent, sizeof(absent));
  expect_fault(file("bad.ply", bad), "a triangle names a vertex that is not there");
  bad = good;
  bad[bad.size() - 13] = 2;  // a face of two corners
  EXPECT_NE(message_of(file("bad.ply", bad)), "");
  EXPECT_NE(message_of(file("bad.ply", good + "x")), "");
}

TEST_F(MeshFile, StlKeepsTheTrianglesAndJoinsTheirCorners) {
  const Mesh mesh = wavy_sheet(20);
  write_mesh(mesh, folder_.path() / "sheet.stl");
  const Mesh read = read_mesh(folder_.path() / "sheet.stl");
  EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(read.vertices[read.triangles[i][k]], mesh.vertices[mesh.triangles[i][k]]);
}

TEST_F(MeshFile, TheOriginIsAddedBack) {
  Mesh mesh = wavy_sheet(5);
  mesh.origin = {300.0, -20.0, 4.0};
  write_mesh(mesh, folder_.path() / "far.ply");
  const Mesh read = read_mesh(folder_.path() / "far.ply");
  EXPECT_TRUE(read.origin.isZero());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    ASSERT_LT((read.vertices[i].cast<double>() - mesh.origin - mesh.vertices[i].cast<double>()).norm(), 3e-5);
}

TEST_F(MeshFile, ObjNumbersMayBeginWithAPoint) {
  const Mesh mesh = read_mesh(file("points.obj",
                                   "# v.5 stays\n"
                                   "v .5 -.25 0\nv 1. +.5 0\r\n  v\t.5 1e0 .125\n"
                                   "vt .5 .5\nvn 0 0 1.\n"
                                   "f 1/1/1 2/1/1 3/1/1\n"));
  ASSERT_EQ(mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.vertices.size(), 3U);
  const Triangle t = mesh.triangles[0];
  EXPECT_EQ(mesh.vertices[t[0]], Eigen::Vector3f(0.5F, -0.25F, 0.0F));
  EXPECT_EQ(mesh.vertices[t[1]], Eigen::Vector3f(1.0F, 0.5F, 0.0F));
  EXPECT_EQ(mesh.vertices[t[2]], Eigen::Vector3f(0.5F, 1.0F, 0.125F));
}

TEST_F(MeshFile, DegenerateTrianglesGoAndPolygonsAreCut) {
  const Mesh mesh = read_mesh(file("m.obj",
                                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n"
                                   "f 1 2 3 4\n"   // a square
                                   "f 1 2 2\n"     // two coincident vertices
                                   "f 1 2 5\n"));  // three collinear vertices
  EXPECT_EQ(mesh.triangles.size(), 2U);
}

TEST_F(MeshFile, WhatIsNoMeshIsNamedWithItsFault) {
  expect_fault(folder_.path() / "none.ply", "no such file");
  expect_fault(file("a.xyz", "1 2 3"), ".ply, .obj, .stl or .glb");
  expect_fault(file("noextension", "1 2 3"), ".ply, .obj, .stl or .glb");
  expect_fault(file("empty.obj", ""), "is empty");
  for (const char* extension : {".ply", ".obj", ".stl", ".glb"})
    EXPECT_NE(message_of(file(std::string("text") + extension, "this is a shopping list\nmilk\n")),
              "no error")
        << extension;
  expect_fault(file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "");
  std::filesystem::create_directory(folder_.path() / "folder.obj");
  expect_fault(folder_.path() / "folder.obj", "is not a file");
  expect_fault(file("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), "no triangles");
}

TEST_F(MeshFile, VerticesThatAreNotFiniteAreRefused) {
  Mesh mesh = wavy_sheet(5);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    write_mesh(mesh, folder_.path() / "m.ply");
    std::fstream bytes(folder_.path() / "m.ply", std::ios::binary | std::ios::in | std::ios::out);
    std::string content{std::istreambuf_iterator<char>(bytes), std::istreambuf_iterator<char>()};
    std::memcpy(content.data() + content.find("end_header\n") + 11, &bad, sizeof(bad));
    expect_fault(file("bad.ply", content), "not finite");
    Mesh unwritable = mesh;
    unwritable.vertices[3].y() = bad;
    EXPECT_THROW(write_mesh(unwritable, folder_.path() / "never.ply"), Error);
  }
  EXPECT_NE(message_of(file("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), "no error");
}

TEST_F(MeshFile, TenMillionTrianglesAreRefusedBeforeTheyAreRead) {
  const std::string word =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 10000000\nproperty list uchar int vertex_indices\nend_header\n";
  expect_fault(file("large.ply", word), "10000000 triangles, more than 2000000");
  std::string header(84, '\0');
  const std::uint32_t count = 10'000'000;
  std::memcpy(header.data() + 80, &count, sizeof(count));
  const std::filesystem::path stl = file("large.stl", header);
  std::filesystem::resize_file(stl, 84 + 50 * std::uintmax_t{count});  // a sparse file
  expect_fault(stl, "10000000 triangles, more than 2000000");
  const std::filesystem::path obj = file("large.obj", "v 0 0 0\n");
  std::filesystem::resize_file(obj, 600U << 20U);
  expect_fault(obj, "MB, more than");
}

TEST_F(MeshFile, CutAndDamagedFilesNeverCrash) {
  const Mesh mesh = wavy_sheet(8);
  for (const char* extension : {".ply", ".stl", ".glb", ".obj"}) {
    const std::filesystem::path path = folder_.path() / (std::string("m") + extension);
    write_mesh(mesh, path);
    std::ifstream in(path, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 40)
      static_cast<void>(message_of(file(std::string("cut") + extension, good.substr(0, length))));
    unsigned state = 12345;
    for (int round = 0; round < 150; ++round) {
      std::string bad = good;
      for (int i = 0; i < 3; ++i) {
        state = state * 1664525U + 1013904223U;
        bad[(state >> 8U) % bad.size()] = static_cast<char>(state >> 4U);
      }
      static_cast<void>(message_of(file(std::string("bad") + extension, bad)));
    }
  }
}

// assimp crashes on the first two and never terminates on the last.
TEST_F(MeshFile, FilesThatEndTheirReaderAreRefusedByThisProcess) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_NE(message_of(file("empty-face.ply", head + "\n" + vertices + "3 0 1 2\n0\n")), "");
  std::string binary = head;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  EXPECT_NE(message_of(file("short.ply", binary + "\n" + std::string(36, '\0') + "\xff")), "");
  EXPECT_NE(message_of(file("endless.ply", head + "\v" + vertices + "3 0 1 2\n3 0 1 2\n")), "");
}

TEST_F(MeshFile, MeshesThatCannotBeWrittenAreNamed) {
  Mesh mesh = wavy_sheet(3);
  EXPECT_THROW(write_mesh(mesh, folder_.path() / "m.step"), Error);
  EXPECT_THROW(write_mesh(mesh, folder_.path() / "no" / "such" / "folder" / "m.ply"), Error);
  EXPECT_THROW(write_mesh(mesh, "/dev/full/m.ply"), Error);
  EXPECT_THROW(write_mesh(Mesh{}, folder_.path() / "m.ply"), Error);
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_THROW(write_mesh(mesh, folder_.path() / "m.ply"), Error);
  mesh = wavy_sheet(3);
  mesh.normals.pop_back();
  EXPECT_THROW(write_mesh(mesh, folder_.path() / "m.ply"), Error);
}

TEST(MeshFileRecording, TheTeapotAndTheBunnyAreWhole) {
  ROOMRADAR_RECORDING_OR_SKIP(meshes, "meshes");
  EXPECT_EQ(read_mesh(meshes / "teapot.obj").triangles.size(), 6'320U);
  EXPECT_EQ(read_mesh(meshes / "stanford-bunny.obj").triangles.size(), 69'451U);
}

}  // namespace
}  // namespace roomradar::mesh_file_test
