// gltf_test.cpp: each feature of glTF once, in files of its own: drawn as the specification says, or named.
#include <gtest/gtest.h>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <sys/stat.h>
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/models/model_file.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/mesh/scene_mesh.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::gltf_test {
namespace {

using test::error_of;
using test::GltfWriter;
using test::Json;

constexpr int kInt8 = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kUint32 = 5125, kFloat = 5126;

// Quarters of the atlas: top left, top right, bottom left, bottom right.
constexpr Rgb kRed{220, 40, 40}, kGreen{40, 200, 60}, kBlue{50, 80, 230}, kYellow{240, 220, 60};

ColourImage atlas() {
  ColourImage image(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) image.at(x, y) = y < 8 ? (x < 8 ? kRed : kGreen) : (x < 8 ? kBlue : kYellow);
  return image;
}

std::string png_of(const ColourImage& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  return {bytes.begin(), bytes.end()};
}

/// The flag: a square of 1 m in the plane z = 0 of the file, which faces +z, with the whole atlas upright.
const std::vector<double> kCorners = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<double> kNormals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<double> kPoints = {0, 1, 1, 1, 1, 0, 0, 0};
const std::vector<double> kIndices = {0, 1, 2, 0, 2, 3};

std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// Adds the flag with a plain material of the atlas. Attributes and other entries of the primitive replace
/// those of the flag; a null one is left out.
GltfWriter flag(GltfWriter file = {}, const Json& attributes = Json::object(),
                const Json& primitive = Json::object()) {
  Json of = {{"attributes", Json::object()}};
  const auto put = [](Json& object, const char* key, const Json& changes, const auto& usual) {
    if (!changes.contains(key)) object[key] = usual();
  };
  put(of["attributes"], "POSITION", attributes, [&] { return file.accessor(kCorners, 3); });
  put(of["attributes"], "NORMAL", attributes, [&] { return file.accessor(kNormals, 3); });
  put(of["attributes"], "TEXCOORD_0", attributes, [&] { return file.accessor(kPoints, 2); });
  put(of, "indices", primitive, [&] { return file.accessor(kIndices, 1, kUint16); });
  put(of, "material", primitive, [&] { return file.material_of_image(png_of(atlas())); });
  for (const auto& [key, value] : attributes.items())
    if (!value.is_null()) of["attributes"][key] = value;
  for (const auto& [key, value] : primitive.items())
    if (!value.is_null()) of[key] = value;
  file.mesh(of);
  return file;
}

double wrapped(double u, TextureWrap wrap) {
  if (wrap == TextureWrap::kClamp) return std::clamp(u, 0.0, 1.0 - 1e-9);
  if (wrap == TextureWrap::kRepeat) return u - std::floor(u);
  const double twice = u - 2.0 * std::floor(0.5 * u);
  return twice < 1.0 ? twice : 2.0 - twice - 1e-9;
}

/// Returns the colour of the point (x, 0, z) on the model's triangles; transparent pixels are black.
Rgb colour_at(const Model& model, double x, double z) {
  for (std::size_t t = 0; t < model.mesh.triangles.size(); ++t) {
    const Triangle& triangle = model.mesh.triangles[t];
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f& p = model.mesh.vertices[triangle[static_cast<std::size_t>(k)]];
      corners.col(k) = Eigen::Vector3d(p.x(), p.z(), 1.0);
    }
    const Eigen::Vector3d share = corners.inverse() * Eigen::Vector3d(x, z, 1.0);
    if (!(share.minCoeff() >= 0.0)) continue;
    Eigen::Vector3d linear = Eigen::Vector3d::Ones();
    Eigen::Vector2d point = Eigen::Vector2d::Zero();
    if (!model.mesh.colours.empty()) linear.setZero();
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = triangle[static_cast<std::size_t>(k)];
      if (!model.texture_points.empty()) point += share[k] * model.texture_points[v].cast<double>();
      if (model.mesh.colours.empty()) continue;
      const Rgb& c = model.mesh.colours[v];
      linear += share[k] * Eigen::Vector3d(linear_of(static_cast<float>(c.r) / 255.0F),
                                           linear_of(static_cast<float>(c.g) / 255.0F),
                                           linear_of(static_cast<float>(c.b) / 255.0F));
    }
    for (const ModelPart& part : model.parts) {
      if (t < part.first_triangle || t >= part.first_triangle + part.triangle_count || part.texture < 0)
        continue;
      const Texture& texture = model.textures[static_cast<std::size_t>(part.texture)];
      const int i = static_cast<int>(wrapped(point.x(), texture.wrap_u) * texture.colour.width);
      const int j = static_cast<int>(wrapped(point.y(), texture.wrap_v) * texture.colour.height);
      if (!texture.opacity.empty() && texture.opacity.at(i, j) < texture.least_opacity) return {0, 0, 0};
      const Rgb& texel = texture.colour.at(i, j);
      linear = linear.cwiseProduct(Eigen::Vector3d(linear_of(static_cast<float>(texel.r) / 255.0F),
                                                   linear_of(static_cast<float>(texel.g) / 255.0F),
                                                   linear_of(static_cast<float>(texel.b) / 255.0F)));
    }
    const auto channel = [&](int k) { return channel_of(srgb_of(static_cast<float>(linear[k]))); };
    return {channel(0), channel(1), channel(2)};
  }
  ADD_FAILURE() << "no triangle is at " << x << " " << z;
  return {};
}

std::string words(const Rgb& c) {
  return std::to_string(c.r) + " " + std::to_string(c.g) + " " + std::to_string(c.b);
}

void expect_colour(const Model& model, double x, double z, const Rgb& colour, const std::string& what) {
  const Rgb shown = colour_at(model, x, z);
  const int off = std::abs(shown.r - colour.r) + std::abs(shown.g - colour.g) + std::abs(shown.b - colour.b);
  EXPECT_LE(off, 6) << what << " at " << x << " " << z << ": " << words(shown) << ", not " << words(colour);
}

/// The model is one flag, as it should be: corners, front, colours.
void expect_flag(const Model& model, const std::string& what) {
  ASSERT_EQ(model.mesh.triangles.size(), 2U) << what;
  Eigen::AlignedBox3f box;
  for (const Triangle& t : model.mesh.triangles) {
    const auto& p = model.mesh.vertices;
    for (const std::uint32_t v : t) box.extend(p[v]);
    const Eigen::Vector3f out = (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
    EXPECT_LT((out - Eigen::Vector3f(0, -1, 0)).norm(), 1e-3F) << what << ": " << out.transpose();
  }
  EXPECT_LT((box.min() - Eigen::Vector3f(0, 0, 0)).norm(), 2e-3F) << what << ": " << box.min().transpose();
  EXPECT_LT((box.max() - Eigen::Vector3f(1, 0, 1)).norm(), 2e-3F) << what << ": " << box.max().transpose();
  for (const Eigen::Vector3f& normal : model.mesh.normals)
    EXPECT_LT((normal - Eigen::Vector3f(0, -1, 0)).norm(), 2e-2F) << what << ": " << normal.transpose();
  expect_colour(model, 0.2, 0.9, kRed, what);
  expect_colour(model, 0.9, 0.8, kGreen, what);
  expect_colour(model, 0.1, 0.2, kBlue, what);
  expect_colour(model, 0.8, 0.1, kYellow, what);
}

class Gltf : public ::testing::Test {
 protected:
  test::TemporaryFolder folder_;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  std::filesystem::path write(const std::string& bytes, const std::string& name) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  [[nodiscard]] Model read(const GltfWriter& file, const std::string& name = "a.glb") const {
    return read_model(write(file.glb(), name), std::nullopt, ModelOrigin::kAsInFile);
  }
  [[nodiscard]] std::string refusal(const GltfWriter& file) const {
    return error_of([&] { (void)read(file); });
  }
  /// The model's only note, without the file's name.
  [[nodiscard]] static std::string note_of(const Model& model) {
    if (model.notes.size() != 1) {
      std::string all;
      for (const std::string& note : model.notes) all += "\n  " + note;
      ADD_FAILURE() << model.notes.size() << " notes:" << all;
      return {};
    }
    const std::string& note = model.notes.front();
    return note.substr(note.find(": ") + 2);
  }
  void expect_silent_flag(const GltfWriter& file, const std::string& what) const {
    const Model model = read(file);
    expect_flag(model, what);
    EXPECT_TRUE(model.notes.empty()) << what << ": " << model.notes.front();
  }
};

// Accessors.

TEST_F(Gltf, PositionsOfEachComponentTypeAreInPlace) {
  expect_silent_flag(flag(), "float");
  const struct {
    int component;
    double one;
    bool is_normalised;
  } kinds[] = {{kInt8, 127, true},  {kUint8, 255, true},  {kInt16, 32767, true},  {kUint16, 65535, true},
               {kInt8, 100, false}, {kUint8, 200, false}, {kInt16, 30000, false}, {kUint16, 16383, false}};
  for (const auto& kind : kinds) {
    GltfWriter file;
    const std::size_t positions =
        file.accessor(times(kCorners, kind.one), 3, kind.component, {{"normalized", kind.is_normalised}});
    const double scale = kind.is_normalised ? 1.0 : 1.0 / kind.one;
    file.add("nodes", {{"mesh", 0}, {"scale", {scale, scale, scale}}});
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    expect_silent_flag(flag(file, {{"POSITION", positions}}), std::to_string(kind.component));
  }
}

TEST_F(Gltf, AsQuantisedByDefaultByGltfpack) {
  GltfWriter file;
  // Positions of 16 bits in steps of 8 bytes, normals of 8 bits in steps of 4, texture coordinates of 16
  // bits.
  std::vector<double> positions, normals;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) positions.push_back(16383 * kCorners[3 * i + k]);
    positions.push_back(0);
    for (std::size_t k = 0; k < 3; ++k) normals.push_back(127 * kNormals[3 * i + k]);
    normals.push_back(0);
  }
  const auto accessor = [&](const std::vector<double>& values, int component, std::size_t stride, Json more) {
    const std::size_t view = file.view(test::bytes_as(component, values), {{"byteStride", stride}});
    Json of = {{"bufferView", view}, {"componentType", component}, {"count", 4}, {"type", "VEC3"}};
    of.update(more);
    return file.add("accessors", of);
  };
  const std::size_t p = accessor(positions, kUint16, 8, Json::object());
  const std::size_t n = accessor(normals, kInt8, 4, {{"normalized", true}});
  const std::size_t t = file.normalised(times(kPoints, 65535), 2, kUint16);
  file.add("nodes", {{"mesh", 0}, {"scale", {1 / 16383.0, 1 / 16383.0, 1 / 16383.0}}});
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  expect_silent_flag(flag(file, {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}), "gltfpack");
}

TEST_F(Gltf, TextureCoordinatesOfEachComponentTypeShowTheSame) {
  const struct {
    int component;
    double one;
    bool is_normalised;
  } kinds[] = {{kUint8, 255, true},    {kUint16, 65535, true}, {kInt8, 127, true},   {kInt16, 32767, true},
               {kUint16, 4095, false}, {kInt16, 4095, false},  {kUint8, 200, false}, {kInt8, 100, false}};
  for (const auto& kind : kinds) {
    GltfWriter file;
    const std::size_t points =
        file.accessor(times(kPoints, kind.one), 2, kind.component, {{"normalized", kind.is_normalised}});
    const std::size_t material = file.material_of_image(png_of(atlas()));
    if (!kind.is_normalised) {  // gltfpack scales them back so
      const double scale = 1.0 / kind.one;
      file.root["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
          {"KHR_texture_transform", {{"scale", {scale, scale}}}}};
    }
    expect_silent_flag(flag(file, {{"TEXCOORD_0", points}}, {{"material", material}}),
                       std::to_string(kind.component));
  }
}

TEST_F(Gltf, NormalsOfEachComponentTypeAreUnitVectors) {
  for (const auto& [component, one] : {std::pair{kInt8, 127.0}, std::pair{kInt16, 32767.0}}) {
    GltfWriter file;
    const std::size_t normals = file.normalised(times(kNormals, one), 3, component);
    const Model model = read(flag(file, {{"NORMAL", normals}}));
    ASSERT_EQ(model.mesh.normals.size(), 4U);
    EXPECT_NEAR(model.mesh.normals[0].y(), -1.0F, 1e-6F) << component;
  }
}

TEST_F(Gltf, VertexColoursOfEachTypeAreLinear) {
  const struct {
    int component;
    double one;
  } kinds[] = {{kFloat, 1.0}, {kUint8, 255.0}, {kUint16, 65535.0}};
  for (const std::size_t width : {std::size_t{3}, std::size_t{4}})
    for (const auto& kind : kinds) {
      std::vector<double> colours;
      for (int i = 0; i < 4; ++i) {
        for (const double channel : {0.21586, 1.0, 0.0})
          colours.push_back(kind.component == kFloat ? channel : std::round(channel * kind.one));
        if (width == 4) colours.push_back(kind.one);
      }
      GltfWriter file;
      const std::size_t accessor =
          file.accessor(colours, width, kind.component, {{"normalized", kind.component != kFloat}});
      const Model model =
          read(flag(file, {{"COLOR_0", accessor}, {"TEXCOORD_0", nullptr}}, {{"material", nullptr}}));
      ASSERT_EQ(model.mesh.colours.size(), 4U) << kind.component;
      EXPECT_NEAR(model.mesh.colours[2].r, 128, 1) << kind.component << ", " << width;
      EXPECT_EQ(model.mesh.colours[2].g, 255) << kind.component << ", " << width;
      EXPECT_EQ(model.mesh.colours[2].b, 0) << kind.component << ", " << width;
      EXPECT_TRUE(model.notes.empty());
    }
}

TEST_F(Gltf, ASparseAccessorReplacesElements) {
  for (const int component : {kUint8, kUint16, kUint32}) {
    GltfWriter file;
    std::vector<double> damaged = kCorners;
    damaged[3] = 9.0, damaged[10] = 7.0;
    const Json indices = {{"bufferView", file.view(test::bytes_as(component, {1, 3}))},
                          {"componentType", component}};
    const Json values = {{"bufferView", file.view(test::bytes_as(kFloat, {1, 0, 0, 0, 1, 0}))}};
    const std::size_t positions = file.accessor(
        damaged, 3, kFloat, {{"sparse", {{"count", 2}, {"indices", indices}, {"values", values}}}});
    expect_silent_flag(flag(file, {{"POSITION", positions}}), std::to_string(component));
  }
}

TEST_F(Gltf, ASparseAccessorWithoutAViewBeginsAsZeros) {
  GltfWriter file;
  const Json indices = {{"bufferView", file.view(test::bytes_as(kUint8, {1, 2, 3}))},
                        {"componentType", kUint8}};
  const Json values = {{"bufferView", file.view(test::bytes_as(kFloat, {1, 0, 0, 1, 1, 0, 0, 1, 0}))}};
  const std::size_t positions =
      file.add("accessors", {{"componentType", kFloat},
                             {"count", 4},
                             {"type", "VEC3"},
                             {"sparse", {{"count", 3}, {"indices", indices}, {"values", values}}}});
  expect_silent_flag(flag(file, {{"POSITION", positions}}), "zeros");
}

TEST_F(Gltf, InterleavedAttributesAreTakenApart) {
  GltfWriter file;
  std::vector<double> rows;
  for (std::size_t i = 0; i < 4; ++i) {
    rows.insert(rows.end(), kCorners.begin() + 3 * i, kCorners.begin() + 3 * i + 3);
    rows.insert(rows.end(), kNormals.begin() + 3 * i, kNormals.begin() + 3 * i + 3);
    rows.insert(rows.end(), kPoints.begin() + 2 * i, kPoints.begin() + 2 * i + 2);
  }
  const std::size_t view = file.view(test::bytes_as(kFloat, rows), {{"byteStride", 32}});
  const auto accessor = [&](std::size_t offset, const char* type) {
    return file.add("accessors", {{"bufferView", view},
                                  {"byteOffset", offset},
                                  {"componentType", kFloat},
                                  {"count", 4},
                                  {"type", type}});
  };
  const std::size_t p = accessor(0, "VEC3"), n = accessor(12, "VEC3"), t = accessor(24, "VEC2");
  expect_silent_flag(flag(file, {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}), "interleaved");
}

TEST_F(Gltf, IndicesOfEachTypeAndNone) {
  for (const int component : {kUint8, kUint16, kUint32}) {
    GltfWriter file;
    const std::size_t indices = file.accessor(kIndices, 1, component);
    expect_silent_flag(flag(file, Json::object(), {{"indices", indices}}), std::to_string(component));
  }
  GltfWriter file;
  std::vector<double> corners, normals, points;
  for (const double index : kIndices) {
    const auto i = static_cast<std::size_t>(index);
    corners.insert(corners.end(), kCorners.begin() + 3 * i, kCorners.begin() + 3 * i + 3);
    normals.insert(normals.end(), kNormals.begin() + 3 * i, kNormals.begin() + 3 * i + 3);
    points.insert(points.end(), kPoints.begin() + 2 * i, kPoints.begin() + 2 * i + 2);
  }
  const std::size_t p = file.accessor(corners, 3), n = file.accessor(normals, 3),
                    t = file.accessor(points, 2);
  const GltfWriter soup =
      flag(file, {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}, {{"indices", nullptr}});
  expect_silent_flag(soup, "none");
  EXPECT_EQ(read(soup).mesh.vertices.size(), 4U) << "equal vertices are merged";
}

// Primitives.

TEST_F(Gltf, StripsAndFansFaceAsListsDo) {
  const struct {
    int mode;
    std::vector<double> indices;
  } modes[] = {{4, kIndices}, {5, {0, 1, 3, 2}}, {6, {0, 1, 2, 3}}};
  for (const auto& [mode, order] : modes) {
    GltfWriter file;
    const std::size_t indices = file.accessor(order, 1, kUint16);
    expect_silent_flag(flag(file, Json::object(), {{"indices", indices}, {"mode", mode}}),
                       "mode " + std::to_string(mode));
  }
}

TEST_F(Gltf, PointsAndLinesAreNamed) {
  GltfWriter file = flag();
  Json& primitives = file.root["meshes"][0]["primitives"];
  for (const int mode : {0, 1, 2, 3}) {
    Json other = primitives[0];
    other["mode"] = mode;
    primitives.push_back(other);
  }
  const Model model = read(file);
  expect_flag(model, "with points and lines");
  ASSERT_EQ(model.notes.size(), 2U);
  EXPECT_EQ(model.notes[0], path("a.glb").string() + ": 1 set of points is not drawn: only triangles are");
  EXPECT_EQ(model.notes[1], path("a.glb").string() + ": 3 sets of lines are not drawn: only triangles are");
  primitives.erase(0);
  EXPECT_NE(
      refusal(file).find("contains no triangles with an area; must be a surface mesh; 1 set of points is"),
      std::string::npos)
      << refusal(file);
}

TEST_F(Gltf, APrimitiveWithoutPositionsIsNamed) {
  GltfWriter file = flag();
  file.root["meshes"][0]["primitives"].push_back({{"attributes", Json::object()}});
  EXPECT_EQ(note_of(read(file)), "1 primitive without positions is not drawn");
}

TEST_F(Gltf, MorphTargetsAreDrawnWithTheirDefaultWeights) {
  GltfWriter file;
  std::vector<double> moved = kCorners;
  for (std::size_t i = 0; i < 4; ++i) moved[3 * i + 2] -= 0.5;  // target 0 at half weight moves it back
  const std::size_t base = file.accessor(moved, 3);
  const std::size_t forth = file.accessor({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  const std::size_t aside = file.accessor({5, 0, 0, 5, 0, 0, 5, 0, 0, 5, 0, 0}, 3);
  const Json targets = {{{"POSITION", forth}}, {{"POSITION", aside}}};
  GltfWriter of_mesh = flag(file, {{"POSITION", base}}, {{"targets", targets}});
  of_mesh.root["meshes"][0]["weights"] = {0.5, 0.0};
  expect_silent_flag(of_mesh, "weights of the mesh");
  of_mesh.root["meshes"][0]["weights"] = {0.0, 1.0};
  of_mesh.root["nodes"][0]["weights"] = {0.5, 0.0};
  expect_silent_flag(of_mesh, "weights of the node");
}

// Nodes.

TEST_F(Gltf, NodesMoveTurnAndScaleWhatIsBelow) {
  GltfWriter file;
  // The child's matrix has a quarter turn about z and a shift; its parent undoes them and halves a double
  // size.
  file.add("nodes", {{"children", {1}}, {"translation", {-3, 0, 0}}, {"scale", {0.5, 0.5, 0.5}}});
  file.add("nodes", {{"children", {2}}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 6, 0, 0, 1}}});
  const double half = std::sqrt(0.5);
  file.add("nodes", {{"mesh", 0}, {"rotation", {0, 0, -half, half}}});
  expect_silent_flag(flag(file), "matrix and TRS");
}

TEST_F(Gltf, ANegativeScaleKeepsTheFront) {
  GltfWriter file;
  file.add("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}, {"translation", {1, 0, 0}}});
  const std::size_t points = file.accessor({1, 1, 0, 1, 0, 0, 1, 0}, 2);
  expect_silent_flag(flag(file, {{"TEXCOORD_0", points}}), "mirrored");
}

TEST_F(Gltf, TheDefaultSceneIsDrawnAndOthersAreNamed) {
  GltfWriter file;
  file.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}, {{"nodes", Json::array()}}};
  file.root["scene"] = 1;
  file.add("nodes", {{"mesh", 0}});
  file.add("nodes", {{"mesh", 0}, {"translation", {9, 0, 0}}});
  const Model model = read(flag(file));
  expect_flag(model, "scene 1");
  EXPECT_EQ(note_of(model), "2 other scenes are not drawn");
}

TEST_F(Gltf, AFileWithoutScenesIsDrawnWhole) {
  GltfWriter file;
  file.root.erase("scene"), file.root.erase("scenes");
  file.add("nodes", {{"children", {1}}, {"translation", {2, 0, 0}}});
  file.add("nodes", {{"mesh", 0}, {"translation", {-2, 0, 0}}});
  expect_silent_flag(flag(file), "no scenes");
}

TEST_F(Gltf, AMeshOfSeveralNodesIsDrawnForEach) {
  GltfWriter file;
  file.root["scenes"][0]["nodes"] = {0, 1};
  file.add("nodes", {{"mesh", 0}});
  file.add("nodes", {{"mesh", 0}, {"translation", {2, 0, 0}}});
  const Model model = read(flag(file));
  ASSERT_EQ(model.mesh.triangles.size(), 4U);
  for (const double x : {0.0, 2.0}) expect_colour(model, x + 0.1, 0.2, kBlue, "instance");
}

TEST_F(Gltf, InstancesOfTheExtensionAreDrawn) {
  GltfWriter file;
  const std::size_t t = file.accessor({0, 0, 0, 2, 0, 0, 6, 0, 0}, 3);
  const std::size_t s = file.accessor({1, 1, 1, 2, 2, 2, 1, 1, 1}, 3);
  const std::size_t r = file.normalised({0, 0, 0, 32767, 0, 0, 0, 32767, 0, 0, 32767, 0}, 4, kInt16);
  const Json instancing = {{"attributes", {{"TRANSLATION", t}, {"SCALE", s}, {"ROTATION", r}}}};
  file.add("nodes", {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", instancing}}}});
  file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Model model = read(flag(file));
  ASSERT_EQ(model.mesh.triangles.size(), 6U);
  EXPECT_TRUE(model.notes.empty());
  expect_colour(model, 0.2, 0.9, kRed, "first");
  expect_colour(model, 2.4, 1.8, kRed, "twice as large");
  expect_colour(model, 5.8, -0.9, kRed, "turned by half");
}

TEST_F(Gltf, AHiddenNodeIsNotDrawn) {
  GltfWriter file;
  file.root["scenes"][0]["nodes"] = {0, 1};
  file.add("nodes", {{"mesh", 0}});
  file.add("nodes", {{"mesh", 0},
                     {"translation", {2, 0, 0}},
                     {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  expect_silent_flag(flag(file), "hidden");
}

TEST_F(Gltf, ASkinIsDrawnInThePoseOfItsNodes) {
  for (const bool is_packed : {false, true}) {
    GltfWriter file;
    // The lower corners follow joint 1, the upper ones joint 2; each joint has moved since binding, back to
    // the flag's place. The node's own transform does not count.
    std::vector<double> bound = kCorners;
    for (std::size_t i = 0; i < 4; ++i) bound[3 * i] += i < 2 ? 3.0 : -4.0;
    const std::size_t p = file.accessor(bound, 3);
    const std::size_t joints = file.accessor({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4, kUint8);
    const std::vector<double> ones = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const std::size_t weights =
        is_packed ? file.normalised(times(ones, 255), 4, kUint8) : file.accessor(ones, 4);
    const auto shift = [](double x) {
      return std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
    };
    std::vector<double> inverse = shift(1.0);
    const std::vector<double> second = shift(2.0);
    inverse.insert(inverse.end(), second.begin(), second.end());
    const std::size_t bind = file.accessor(inverse, 16);
    file.root["scenes"][0]["nodes"] = {0, 1};
    file.add("nodes", {{"mesh", 0}, {"skin", 0}, {"translation", {0, 50, 0}}});
    file.add("nodes", {{"translation", {-4, 0, 0}}, {"children", {2}}});
    file.add("nodes", {{"translation", {6, 0, 0}}});
    file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bind}});
    expect_silent_flag(flag(file, {{"POSITION", p}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}), "skin");
  }
}

TEST_F(Gltf, AnAnimationIsNamed) {
  GltfWriter file = flag();
  const std::size_t input = file.accessor({0, 1}, 1), output = file.accessor({0, 0, 0, 1, 0, 0}, 3);
  file.root["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}}}}}};
  const Model model = read(file);
  expect_flag(model, "at rest");
  EXPECT_EQ(note_of(model), "1 animation is not drawn; the model is drawn at rest");
}

TEST_F(Gltf, CamerasAndLightsAreNoObjects) {
  GltfWriter file;
  file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.add("nodes", {{"mesh", 0}, {"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  expect_silent_flag(flag(file), "camera and light");
}

// Compression.

TEST_F(Gltf, DracoIsDecompressed) {
  for (const bool is_quantised : {false, true}) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int p = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int n = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int t = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const std::vector<float> corners(kCorners.begin(), kCorners.end()),
        normals(kNormals.begin(), kNormals.end()), points(kPoints.begin(), kPoints.end());
    for (std::uint32_t f = 0; f < 2; ++f) {
      const auto at = [&](const std::vector<float>& values, std::size_t width, std::size_t k) {
        return values.data() + width * static_cast<std::size_t>(kIndices[3 * f + k]);
      };
      const auto set = [&](int id, const std::vector<float>& values, std::size_t width) {
        builder.SetAttributeValuesForFace(id, draco::FaceIndex(f), at(values, width, 0), at(values, width, 1),
                                          at(values, width, 2));
      };
      set(p, corners, 3), set(n, normals, 3), set(t, points, 2);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    if (is_quantised) {
      encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
      encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
      encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    }
    draco::EncoderBuffer packed;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &packed).ok());
    GltfWriter file;
    const std::size_t view = file.view({packed.data(), packed.size()});
    const auto accessor = [&](const char* type, std::size_t count, int component) {
      return file.add("accessors", {{"componentType", component}, {"count", count}, {"type", type}});
    };
    const std::size_t pa = accessor("VEC3", 4, kFloat), na = accessor("VEC3", 4, kFloat),
                      ta = accessor("VEC2", 4, kFloat), ia = accessor("SCALAR", 6, kUint16);
    const Json draco = {{"bufferView", view},
                        {"attributes",
                         {{"POSITION", mesh->attribute(p)->unique_id()},
                          {"NORMAL", mesh->attribute(n)->unique_id()},
                          {"TEXCOORD_0", mesh->attribute(t)->unique_id()}}}};
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const GltfWriter whole = flag(file, {{"POSITION", pa}, {"NORMAL", na}, {"TEXCOORD_0", ta}},
                                  {{"indices", ia}, {"extensions", {{"KHR_draco_mesh_compression", draco}}}});
    expect_silent_flag(whole, is_quantised ? "quantised" : "exact");
    GltfWriter damaged = whole;
    for (std::size_t i = 12; i < packed.size(); ++i) damaged.data[i] = static_cast<char>(0xa5);
    EXPECT_NE(refusal(damaged).find("Draco mesh cannot be decompressed"), std::string::npos)
        << refusal(damaged);
  }
}

/// Adds a view that EXT_meshopt_compression holds, and the fallback buffer that its uncompressed form names.
std::size_t add_packed_view(GltfWriter& file, const std::string& packed, std::size_t count,
                            std::size_t stride, const char* mode, const char* filter = "NONE") {
  file.data.resize((file.data.size() + 3) / 4 * 4, '\0');
  const Json meshopt = {{"buffer", 0},
                        {"byteOffset", file.data.size()},
                        {"byteLength", packed.size()},
                        {"byteStride", stride},
                        {"count", count},
                        {"mode", mode},
                        {"filter", filter}};
  file.data += packed;
  Json view = {
      {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", meshopt}}}};
  if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
  return file.add("bufferViews", view);
}

void add_fallback_buffer(GltfWriter& file) {
  file.root["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  file.root["buffers"] = {
      {{"byteLength", file.data.size()}},
      {{"byteLength", 4096}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
}

std::string packed_vertices(const std::string& bytes, std::size_t count, std::size_t stride) {
  std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
  packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                           bytes.data(), count, stride));
  return packed;
}

std::string packed_indices(const std::vector<unsigned>& indices, bool is_list) {
  std::string packed(is_list ? meshopt_encodeIndexBufferBound(indices.size(), 4)
                             : meshopt_encodeIndexSequenceBound(indices.size(), 4),
                     '\0');
  auto* const to = reinterpret_cast<unsigned char*>(packed.data());
  packed.resize(is_list ? meshopt_encodeIndexBuffer(to, packed.size(), indices.data(), indices.size())
                        : meshopt_encodeIndexSequence(to, packed.size(), indices.data(), indices.size()));
  return packed;
}

TEST_F(Gltf, EachModeAndFilterOfMeshoptIsDecompressed) {
  const auto accessor = [](GltfWriter& file, std::size_t view, int component, const char* type,
                           std::size_t count, bool is_normalised = false) {
    return file.add("accessors", {{"bufferView", view},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type},
                                  {"normalized", is_normalised}});
  };
  for (const bool is_list : {true, false}) {
    GltfWriter file;
    const std::string corners = test::bytes_as(kFloat, kCorners);
    const std::size_t p = accessor(
        file, add_packed_view(file, packed_vertices(corners, 4, 12), 4, 12, "ATTRIBUTES"), kFloat, "VEC3", 4);
    // Normals: octahedral, 8 bits. Texture coordinates: exponential.
    std::string octahedral(16, '\0'), exponential(32, '\0');
    std::vector<float> normals;
    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), {0, 0, 1, 0});
    meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
    const std::size_t n = accessor(
        file, add_packed_view(file, packed_vertices(octahedral, 4, 4), 4, 4, "ATTRIBUTES", "OCTAHEDRAL"),
        kInt8, "VEC3", 4, true);
    const std::vector<float> points(kPoints.begin(), kPoints.end());
    meshopt_encodeFilterExp(exponential.data(), 4, 8, 15, points.data());
    const std::size_t t = accessor(
        file, add_packed_view(file, packed_vertices(exponential, 4, 8), 4, 8, "ATTRIBUTES", "EXPONENTIAL"),
        kFloat, "VEC2", 4);
    const std::vector<unsigned> indices(kIndices.begin(), kIndices.end());
    const std::size_t i = accessor(file,
                                   add_packed_view(file, packed_indices(indices, is_list), 6, is_list ? 2 : 4,
                                                   is_list ? "TRIANGLES" : "INDICES"),
                                   is_list ? kUint16 : kUint32, "SCALAR", 6);
    GltfWriter whole = flag(file, {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", t}}, {{"indices", i}});
    add_fallback_buffer(whole);
    expect_silent_flag(whole, is_list ? "TRIANGLES" : "INDICES");
    GltfWriter damaged = whole;
    damaged.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 9;
    EXPECT_NE(refusal(damaged).find("cannot be decompressed"), std::string::npos) << refusal(damaged);
    damaged.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 4'000'000'000'000;
    EXPECT_NE(refusal(damaged).find("more than 1024 MB"), std::string::npos) << refusal(damaged);
    damaged = whole;
    damaged.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["mode"] = "OTHER";
    EXPECT_NE(refusal(damaged).find("unknown mode \"OTHER\""), std::string::npos) << refusal(damaged);
  }
}

TEST_F(Gltf, TheOctahedralFilterOfMeshoptGivesNormals) {
  for (const int component : {kInt8, kInt16}) {
    GltfWriter file;
    std::vector<float> normals;
    for (int i = 0; i < 4; ++i) normals.insert(normals.end(), {0.48F, 0.6F, 0.64F, 0.0F});
    const std::size_t stride = component == kInt8 ? 4 : 8;
    std::string filtered(4 * stride, '\0');
    meshopt_encodeFilterOct(filtered.data(), 4, stride, component == kInt8 ? 8 : 16, normals.data());
    const std::size_t view =
        add_packed_view(file, packed_vertices(filtered, 4, stride), 4, stride, "ATTRIBUTES", "OCTAHEDRAL");
    const std::size_t n = file.add("accessors", {{"bufferView", view},
                                                 {"componentType", component},
                                                 {"count", 4},
                                                 {"type", "VEC3"},
                                                 {"normalized", true}});
    GltfWriter whole = flag(file, {{"NORMAL", n}});
    add_fallback_buffer(whole);
    const Model model = read(whole);
    ASSERT_EQ(model.mesh.normals.size(), 4U);
    for (const Eigen::Vector3f& normal : model.mesh.normals)
      EXPECT_LT((normal - Eigen::Vector3f(0.48F, -0.64F, 0.6F)).norm(), component == kInt8 ? 0.02F : 2e-4F)
          << normal.transpose();
  }
}

TEST_F(Gltf, TheQuaternionFilterOfMeshoptTurnsInstances) {
  GltfWriter file;
  const std::vector<float> turns = {0, 0, 0, 1, 0, 0, 1, 0};  // none, half about z
  std::string filtered(16, '\0');
  meshopt_encodeFilterQuat(filtered.data(), 2, 8, 12, turns.data());
  const std::size_t view =
      add_packed_view(file, packed_vertices(filtered, 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
  const std::size_t r = file.add("accessors", {{"bufferView", view},
                                               {"componentType", kInt16},
                                               {"count", 2},
                                               {"type", "VEC4"},
                                               {"normalized", true}});
  file.add("nodes",
           {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"ROTATION", r}}}}}}}});
  GltfWriter whole = flag(file);
  add_fallback_buffer(whole);
  const Model model = read(whole);
  ASSERT_EQ(model.mesh.triangles.size(), 4U);
  expect_colour(model, 0.2, 0.9, kRed, "first");
  expect_colour(model, -0.2, -0.9, kRed, "turned");
}

TEST_F(Gltf, WebPTexturesAreDrawn) {
  const ColourImage image = atlas();
  std::uint8_t* bytes = nullptr;
  const std::size_t size = WebPEncodeLosslessRGB(&image.pixels.front().r, 16, 16, 48, &bytes);
  const std::string webp(reinterpret_cast<const char*>(bytes), size);
  WebPFree(bytes);
  GltfWriter file;
  const std::size_t material = file.material_of_image(webp, "image/webp");
  file.root["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  file.root["extensionsRequired"] = {"EXT_texture_webp"};
  const GltfWriter whole = flag(file, Json::object(), {{"material", material}});
  expect_silent_flag(whole, "WebP");
  GltfWriter cut = whole;
  cut.root["bufferViews"][0]["byteLength"] = 30;
  EXPECT_NE(note_of(read(cut)).find("its embedded texture 0 cannot be decoded as WebP"), std::string::npos);
}

TEST_F(Gltf, BasisUniversalIsNamedOrItsFallbackDrawn) {
  GltfWriter file;
  const std::size_t material = file.material_of_image(png_of(atlas()));
  file.add("images", {{"uri", "a.ktx2"}});
  file.root["textures"][0]["extensions"] = {{"KHR_texture_basisu", {{"source", 1}}}};
  file.root["extensionsUsed"] = {"KHR_texture_basisu"};
  GltfWriter whole = flag(file, Json::object(), {{"material", material}});
  expect_silent_flag(whole, "fallback");
  whole.root["textures"][0].erase("source");
  EXPECT_EQ(note_of(read(whole)),
            "1 texture is in the format of KHR_texture_basisu and not drawn; the material's colour is drawn "
            "instead");
}

// Materials.

TEST_F(Gltf, TextureTransformsMoveScaleAndTurn) {
  const double quarter = 0.5 * std::numbers::pi;
  const struct {
    const char* what;
    Json transform;
    double x, z;
    Rgb colour;
  } cases[] = {
      {"offset", {{"offset", {0.5, 0.0}}}, 0.1, 0.9, kGreen},
      {"scale", {{"scale", {0.5, 0.5}}}, 0.9, 0.1, kRed},
      {"offset and scale", {{"offset", {0.5, 0.5}}, {"scale", {0.5, 0.5}}}, 0.1, 0.9, kYellow},
      // The lower left quarter, turned clockwise: the extension's own example.
      {"example, bottom left",
       {{"offset", {0, 1}}, {"rotation", quarter}, {"scale", {0.5, 0.5}}},
       0.1,
       0.1,
       kBlue},
      {"example, top right",
       {{"offset", {0, 1}}, {"rotation", quarter}, {"scale", {0.5, 0.5}}},
       0.9,
       0.9,
       kBlue},
      // A quarter turn about the top left corner, then back into the image: what was bottom left is top left.
      {"turn, top left", {{"offset", {0, 1}}, {"rotation", quarter}}, 0.1, 0.9, kBlue},
      {"turn, top right", {{"offset", {0, 1}}, {"rotation", quarter}}, 0.9, 0.9, kRed},
      {"turn, bottom left", {{"offset", {0, 1}}, {"rotation", quarter}}, 0.1, 0.1, kYellow},
      {"scale before turn",
       {{"offset", {0, 1}}, {"rotation", quarter}, {"scale", {0.5, 1.0}}},
       0.9,
       0.1,
       kYellow},
      {"mirror", {{"offset", {1, 0}}, {"scale", {-1, 1}}}, 0.1, 0.9, kGreen},
  };
  for (const auto& one : cases) {
    GltfWriter file;
    const std::size_t material = file.material_of_image(png_of(atlas()));
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform", one.transform}};
    file.root["extensionsRequired"] = {"KHR_texture_transform"};
    const Model model = read(flag(file, Json::object(), {{"material", material}}));
    expect_colour(model, one.x, one.z, one.colour, one.what);
    EXPECT_TRUE(model.notes.empty());
  }
}

TEST_F(Gltf, TheMaterialChoosesTheSetOfTextureCoordinates) {
  for (const bool by_transform : {false, true}) {
    GltfWriter file;
    const std::size_t wrong = file.accessor({0, 0, 0, 0, 0, 0, 0, 0}, 2), right = file.accessor(kPoints, 2);
    const std::size_t material = file.material_of_image(png_of(atlas()));
    Json& info = file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["texCoord"] = by_transform ? 0 : 1;
    if (by_transform) info["extensions"] = {{"KHR_texture_transform", {{"texCoord", 1}}}};
    expect_silent_flag(flag(file, {{"TEXCOORD_0", wrong}, {"TEXCOORD_1", right}}, {{"material", material}}),
                       by_transform ? "by its transform" : "TEXCOORD_1");
  }
  GltfWriter file;
  const std::size_t material = file.material_of_image(png_of(atlas()));
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 3;
  EXPECT_EQ(note_of(read(flag(file, Json::object(), {{"material", material}}))),
            "1 textured part without texture coordinates is drawn in the material's colour");
}

TEST_F(Gltf, FactorTextureAndVertexColourMultiply) {
  GltfWriter file;
  const std::size_t colours = file.accessor({1, 0.5, 1, 1, 0.5, 1, 1, 0.5, 1, 1, 0.5, 1}, 3);
  const std::size_t material = file.material_of_image(png_of(atlas()));
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 1.0, 0.0, 1.0};
  const Model model = read(flag(file, {{"COLOR_0", colours}}, {{"material", material}}));
  const auto product = [](std::uint8_t channel, float factor) {
    return channel_of(srgb_of(linear_of(static_cast<float>(channel) / 255.0F) * factor));
  };
  expect_colour(model, 0.9, 0.1, {product(kYellow.r, 0.5F), product(kYellow.g, 0.5F), 0}, "product");
  EXPECT_TRUE(model.notes.empty());
}

TEST_F(Gltf, ABlackFactorIsBlack) {
  GltfWriter file;
  const std::size_t material = file.material_of_image(png_of(atlas()));
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0, 0, 0, 1};
  expect_colour(read(flag(file, Json::object(), {{"material", material}})), 0.9, 0.1, {0, 0, 0}, "black");
}

/// The atlas, whose four quarters have alpha 255, 200, 100, 0.
std::string atlas_with_alpha() {
  const ColourImage image = atlas();
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Rgb& c = image.at(x, y);
      const int alpha = y < 8 ? (x < 8 ? 255 : 200) : (x < 8 ? 100 : 0);
      rgba.insert(rgba.end(), {c.r, c.g, c.b, static_cast<std::uint8_t>(alpha)});
    }
  std::uint8_t* bytes = nullptr;
  WebPConfig config;
  WebPPicture picture;
  WebPConfigInit(&config), WebPPictureInit(&picture);
  config.lossless = 1, config.exact = 1;
  picture.use_argb = 1, picture.width = picture.height = 16;
  WebPPictureImportRGBA(&picture, rgba.data(), 64);
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite, picture.custom_ptr = &writer;
  WebPEncode(&config, &picture);
  std::string webp(reinterpret_cast<const char*>(writer.mem), writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  (void)bytes;
  return webp;
}

TEST_F(Gltf, AlphaCutsAsTheMaterialSays) {
  const struct {
    const char* what;
    Json material;
    double factor;
    bool shows_green, shows_blue, shows_yellow;
    std::size_t notes;
  } cases[] = {
      {"opaque", Json::object(), 1.0, true, true, true, 0},
      {"mask", {{"alphaMode", "MASK"}}, 1.0, true, false, false, 0},
      {"mask at 0.9", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.9}}, 1.0, false, false, false, 0},
      {"mask at 0.3", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.3}}, 1.0, true, true, false, 0},
      {"mask at 0.3 of a factor", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.3}}, 0.6, true, false, false, 0},
      {"mask at 0", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.0}}, 1.0, true, true, true, 0},
      {"blend", {{"alphaMode", "BLEND"}}, 1.0, true, false, false, 1},
  };
  for (const auto& one : cases) {
    GltfWriter file;
    const std::size_t material = file.material_of_image(atlas_with_alpha(), "image/webp");
    file.root["materials"][0].update(one.material);
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, one.factor};
    const Model model = read(flag(file, Json::object(), {{"material", material}}));
    const Rgb none{0, 0, 0};
    expect_colour(model, 0.2, 0.9, kRed, one.what);
    expect_colour(model, 0.9, 0.8, one.shows_green ? kGreen : none, one.what);
    expect_colour(model, 0.1, 0.2, one.shows_blue ? kBlue : none, one.what);
    expect_colour(model, 0.8, 0.1, one.shows_yellow ? kYellow : none, one.what);
    ASSERT_EQ(model.notes.size(), one.notes) << one.what;
  }
}

TEST_F(Gltf, WhatIsTransparentAltogetherIsLeftOutAndNamed) {
  for (const Json& alpha : {Json{{"alphaMode", "MASK"}}, Json{{"alphaMode", "BLEND"}}}) {
    GltfWriter file = flag();
    Json ghost = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}};
    ghost.update(alpha);
    Json primitive = file.root["meshes"][0]["primitives"][0];
    primitive["material"] = file.add("materials", ghost);
    file.root["meshes"][0]["primitives"].push_back(primitive);
    const Model model = read(file);
    expect_flag(model, "with a ghost");
    EXPECT_EQ(note_of(model), "1 primitive of a transparent material is invisible and left out");
  }
}

TEST_F(Gltf, HalfTransparencyIsNamed) {
  GltfWriter file = flag();
  file.root["materials"][0]["alphaMode"] = "BLEND";
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.4};
  EXPECT_EQ(note_of(read(file)), "1 material is half transparent, and drawn opaque from an alpha of 0.5 on");
  GltfWriter coloured;
  const std::size_t colours = coloured.accessor({1, 1, 1, 0.5, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, 4);
  coloured = flag(coloured, {{"COLOR_0", colours}});
  EXPECT_TRUE(read(coloured).notes.empty()) << "an opaque material ignores it";
  coloured.root["materials"][0]["alphaMode"] = "MASK";
  EXPECT_EQ(note_of(read(coloured)), "1 part is drawn without the transparency of vertex colours");
}

TEST_F(Gltf, WrapModesRepeatMirrorAndClamp) {
  const struct {
    int wrap;
    Rgb beyond;  // at 1.25 to the right, of the top
  } modes[] = {{10497, kRed}, {33648, kGreen}, {33071, kGreen}};
  for (const auto& mode : modes) {
    GltfWriter file;
    const std::size_t points = file.accessor({0, 1, 3, 1, 3, 0, 0, 0}, 2);
    const std::size_t material = file.material_of_image(png_of(atlas()));
    file.root["samplers"] = {{{"wrapS", mode.wrap}, {"wrapT", mode.wrap}}};
    file.root["textures"][0]["sampler"] = 0;
    const Model model = read(flag(file, {{"TEXCOORD_0", points}}, {{"material", material}}));
    expect_colour(model, 1.25 / 3, 0.9, mode.beyond, std::to_string(mode.wrap));
    expect_colour(model, 2.25 / 3, 0.9, mode.wrap == 33071 ? kGreen : kRed, std::to_string(mode.wrap));
    EXPECT_FALSE(model.textures[0].is_pixelated);
  }
}

TEST_F(Gltf, AFilterWithoutBlendingIsKeptInCopiesAlso) {
  GltfWriter file = flag();
  file.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
  file.root["textures"][0]["sampler"] = 0;
  const Model model = read(file);
  EXPECT_TRUE(model.textures.at(0).is_pixelated);
  EXPECT_TRUE(model.notes.empty());
  write_model_copy(model, path("a.model"));
  EXPECT_EQ(read_model(path("a.model")).textures, model.textures);
  // A copy of the time before filters ends without the last byte, which tells whether texture 0 is pixelated.
  std::string copy = read_bytes(path("a.model"), "a copy");
  ASSERT_EQ(copy.find("roomradar model 2\n"), 0U);
  copy.replace(16, 1, "1").pop_back();
  const Model older = read_model(write(copy, "b.model"));
  EXPECT_FALSE(older.textures.at(0).is_pixelated);
  EXPECT_EQ(older.mesh.vertices, model.mesh.vertices);
}

TEST_F(Gltf, DiffuseColourOfSpecularGlossinessIsDrawn) {
  GltfWriter file = flag();
  file.root["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  const Json info = file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  file.root["materials"][0] = {
      {"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", info}}}}}};
  const Model model = read(file);
  expect_flag(model, "diffuse texture");
  EXPECT_EQ(note_of(model),
            "1 material is drawn by the diffuse colour alone, without specular colour and gloss");
  file.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {0.21586, 1.0, 0.0, 1.0}}};
  expect_colour(read(file), 0.5, 0.4, {128, 255, 0}, "diffuse factor");
}

TEST_F(Gltf, WhatTheBaseColourDoesNotTellIsNamed) {
  const struct {
    Json material;
    const char* note;
  } cases[] = {
      {{{"normalTexture", {{"index", 0}}}}, "1 material is drawn without normal texture"},
      {{{"occlusionTexture", {{"index", 0}}}}, "1 material is drawn without occlusion texture"},
      {{{"emissiveFactor", {0, 1, 0}}, {"emissiveTexture", {{"index", 0}}}},
       "1 material is drawn without the light that it emits"},
      {{{"extensions", {{"KHR_materials_unlit", Json::object()}}}},
       "1 material is unlit in the file, and drawn in the light of the room"},
      {{{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}},
       "1 material is drawn without KHR_materials_clearcoat"},
      {{{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}},
       "1 material is drawn without KHR_materials_transmission"},
  };
  for (const auto& one : cases) {
    GltfWriter file = flag();
    file.root["materials"][0].update(one.material);
    const Model model = read(file);
    expect_flag(model, one.note);
    EXPECT_EQ(note_of(model), one.note);
  }
  GltfWriter metal = flag();
  metal.root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1.0;
  EXPECT_EQ(note_of(read(metal)), "1 material is drawn as if painted, not as metal");
  metal.root["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
  EXPECT_EQ(note_of(read(metal)), "1 material is drawn without metallic-roughness texture");
  GltfWriter unused = flag();
  unused.add("materials", {{"normalTexture", {{"index", 0}}}});
  EXPECT_TRUE(read(unused).notes.empty()) << "a material that nothing uses";
  GltfWriter variants = flag();
  variants.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}}, {{"name", "b"}}};
  EXPECT_EQ(note_of(read(variants)), "2 variants of materials are not offered; the default is drawn");
}

// Extensions.

TEST_F(Gltf, AnUnknownExtensionIsNamedAndRefusedIfRequired) {
  GltfWriter file = flag();
  file.root["extensionsUsed"] = {"VENDOR_something", "KHR_lights_punctual"};
  EXPECT_EQ(note_of(read(file)), "the glTF extension VENDOR_something is unknown; what it adds is not drawn");
  file.root["extensionsRequired"] = {"VENDOR_something", "KHR_lights_punctual", "EXT_other"};
  const std::string refused = refusal(file);
  EXPECT_NE(refused.find("requires the glTF extension EXT_other, VENDOR_something, which is not supported"),
            std::string::npos)
      << refused;
}

TEST_F(Gltf, NamesOfTheFileCannotFillOrSteerATerminal) {
  GltfWriter file = flag();
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "KHR_materials_\x1b[31m" + std::to_string(i);
    file.root["extensionsUsed"].push_back(name);
    file.root["materials"][0]["extensions"][name] = Json::object();
  }
  file.root["extensionsUsed"].push_back(std::string(5000, 'x'));
  file.root["images"][0] = {{"uri", "\x1b[31m" + std::string(5000, 'x')}};
  const Model model = read(file);
  ASSERT_EQ(model.notes.size(), 2U);
  for (const std::string& note : model.notes) {
    EXPECT_LT(note.size(), 1000U) << note;
    EXPECT_EQ(note.find('\x1b'), std::string::npos) << note;
  }
  EXPECT_NE(model.notes[1].find("and 996 more is unknown"), std::string::npos) << model.notes[1];
  file.root["extensionsRequired"] = file.root["extensionsUsed"];
  EXPECT_LT(refusal(file).size(), 1000U);
  EXPECT_EQ(refusal(file).find('\x1b'), std::string::npos);
}

// Files.

TEST_F(Gltf, BuffersAndImagesAreFoundBesideWithinAndInSubfolders) {
  GltfWriter file = flag();
  write(file.data, "my data.bin");
  const auto read_text = [&](const std::string& text) {
    return read_model(write(text, "a.gltf"), std::nullopt, ModelOrigin::kAsInFile);
  };
  expect_flag(read_text(file.gltf("my%20data.bin")), "percent encoding");
  expect_flag(read_text(file.gltf("my data.bin")), "plain blank");
  expect_flag(read_text(file.gltf("./my%20data.bin")), "./");
  expect_flag(read_text(file.gltf("data:application/octet-stream;base64," + test::base64(file.data))),
              "data URI");
  std::filesystem::create_directory(path("t\xc3\xa9x"));
  write(png_of(atlas()), "t\xc3\xa9x/my atlas.png");
  for (const char* uri : {"t%C3%A9x/my%20atlas.png", "t\xc3\xa9x/my atlas.png", "t\xc3\xa9x\\my atlas.png"}) {
    file.root["images"][0] = {{"uri", uri}};
    const Model model = read_text(file.gltf("my%20data.bin"));
    expect_flag(model, uri);
    EXPECT_TRUE(model.notes.empty()) << model.notes.front();
  }
  file.root["images"][0] = {{"uri", "data:image/png;base64," + test::base64(png_of(atlas()))}};
  expect_flag(read_text(file.gltf("my%20data.bin")), "image as data URI");
}

TEST_F(Gltf, AModelReadsNothingOutsideOfItsFolder) {
  GltfWriter file = flag();
  std::filesystem::create_directories(path("model/sub"));
  write(file.data, "outside.bin");
  write(png_of(atlas()), "outside.png");
  write(file.data, "model/sub/inside.bin");
  std::filesystem::create_symlink(path("outside.bin"), path("model/link.bin"));
  std::filesystem::create_symlink(path("outside.png"), path("model/link.png"));
  std::filesystem::create_symlink("sub/inside.bin", path("model/inner.bin"));
  std::filesystem::create_directory_symlink("..", path("model/up"));
  ASSERT_EQ(mkfifo(path("model/pipe").c_str(), 0600), 0);
  const auto read_text = [&](const std::string& text) {
    return read_model(write(text, "model/a.gltf"), std::nullopt, ModelOrigin::kAsInFile);
  };
  expect_flag(read_text(file.gltf("inner.bin")), "a link within");
  const struct {
    std::string uri;
    const char* fault;
  } cases[] = {{"../outside.bin", "leads out of the model's folder and is not read"},
               {"sub/../../outside.bin", "leads out of the model's folder and is not read"},
               {"%2e%2e/outside.bin", "leads out of the model's folder and is not read"},
               {"..\\outside.bin", "leads out of the model's folder and is not read"},
               {path("outside.bin").string(), "leads out of the model's folder and is not read"},
               {"file://" + path("outside.bin").string(), "is an address and is not read"},
               {"http://127.0.0.1/a.bin", "is an address and is not read"},
               {"C:\\a.bin", "is an address and is not read"},
               {"link.bin", "lies outside of the model's folder and is not read"},
               {"up/outside.bin", "lies outside of the model's folder and is not read"},
               {"pipe", "is not a plain file and is not read"},
               {"sub", "is not a plain file and is not read"},
               {"missing.bin", "is missing"}};
  for (const auto& one : cases) {
    const std::string refused = error_of([&] { (void)read_text(file.gltf(one.uri)); });
    EXPECT_NE(refused.find(path("model/a.gltf").string() + ": its buffer " + one.uri.substr(0, 100)),
              std::string::npos)
        << refused;
    EXPECT_NE(refused.find(one.fault), std::string::npos) << one.uri << ": " << refused;
  }
  for (const auto& [uri, fault] :
       {std::pair{"../outside.png", "leads out of the model's folder"},
        std::pair{"link.png", "lies outside of the model's folder"}, std::pair{"pipe", "is not a plain file"},
        std::pair{"https://example.org/a.png", "is an address"}}) {
    file.root["images"][0] = {{"uri", uri}};
    const Model model = read_text(file.gltf("sub/inside.bin"));
    EXPECT_FALSE(model.is_textured());
    EXPECT_NE(note_of(model).find("its texture " + std::string(uri) + " " + fault), std::string::npos)
        << note_of(model);
  }
  // The same for .obj: its materials, and their textures.
  const std::string shape = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  write("newmtl m\nKd 1 0 0\n", "outside.mtl");
  std::filesystem::create_symlink(path("outside.mtl"), path("model/link.mtl"));
  for (const char* library : {"../outside.mtl", "link.mtl", "pipe"}) {
    const Model model = read_model(write("mtllib " + std::string(library) + "\n" + shape, "model/a.obj"));
    EXPECT_TRUE(model.mesh.colours.empty()) << library;
    EXPECT_NE(note_of(model).find("its material file " + std::string(library)), std::string::npos);
    EXPECT_NE(note_of(model).find("is not read"), std::string::npos) << note_of(model);
  }
  for (const std::string& image :
       {std::string("../outside.png"), path("outside.png").string(), "file://" + path("outside.png").string(),
        std::string("link.png"), std::string("pipe")}) {
    write("newmtl m\nKd 1 0 0\nmap_Kd " + image + "\n", "model/a.mtl");
    const Model model = read_model(write("mtllib a.mtl\n" + shape, "model/a.obj"));
    EXPECT_FALSE(model.is_textured()) << image;
    EXPECT_NE(note_of(model).find("is not read"), std::string::npos) << note_of(model);
  }
}

TEST_F(Gltf, DamagedFilesAreRefusedWithASentence) {
  const auto changed = [&](const std::function<void(GltfWriter&)>& change) {
    GltfWriter file = flag();
    change(file);
    return refusal(file);
  };
  const struct {
    const char* sentence;
    std::function<void(GltfWriter&)> change;
  } cases[] = {
      {"reaches beyond the end of its buffer view",
       [](GltfWriter& f) { f.root["accessors"][0]["count"] = 5; }},
      {"reaches beyond the end of its buffer view",
       [](GltfWriter& f) { f.root["accessors"][0]["byteOffset"] = 9007199254740991; }},
      {"reaches beyond the end of its buffer",
       [](GltfWriter& f) { f.root["bufferViews"][0]["byteLength"] = 1 << 20; }},
      {"reaches beyond the end of its buffer",
       [](GltfWriter& f) { f.root["bufferViews"][0]["byteOffset"] = 9007199254740991; }},
      {"is cut short: it declares 100000000 bytes",
       [](GltfWriter& f) {
         f.root["buffers"] = {{{"byteLength", 100000000}}};
       }},
      {"has 4000000000 elements, more than 6000000",
       [](GltfWriter& f) { f.root["accessors"][0]["count"] = 4000000000; }},
      {"names a vertex that is not there",
       [](GltfWriter& f) {
         f.data[f.data.size() - 1] = 0;
         f.root["accessors"][3]["byteOffset"] = 0;
         f.root["accessors"][0]["count"] = 3;
         f.root["accessors"][1]["count"] = 3;
         f.root["accessors"][2]["count"] = 3;
       }},
      {"has 4 positions, but 3 elements of NORMAL",
       [](GltfWriter& f) { f.root["accessors"][1]["count"] = 3; }},
      {"has 2 numbers per element of POSITION",
       [](GltfWriter& f) { f.root["accessors"][0]["type"] = "VEC2"; }},
      {"has the type \"VEC9\"", [](GltfWriter& f) { f.root["accessors"][0]["type"] = "VEC9"; }},
      {"unknown componentType 5124", [](GltfWriter& f) { f.root["accessors"][0]["componentType"] = 5124; }},
      {"does not consist of 1 unsigned integers",
       [](GltfWriter& f) { f.root["accessors"][3]["componentType"] = kInt16; }},
      {"has no whole number \"count\"", [](GltfWriter& f) { f.root["accessors"][0]["count"] = -1; }},
      {"has no whole number \"count\"", [](GltfWriter& f) { f.root["accessors"][0]["count"] = "4"; }},
      {"has no whole number \"bufferView\"",
       [](GltfWriter& f) { f.root["accessors"][0]["bufferView"] = 0.5; }},
      {"names bufferViews 99, which is not there",
       [](GltfWriter& f) { f.root["accessors"][0]["bufferView"] = 99; }},
      {"names accessors 99, which is not there",
       [](GltfWriter& f) { f.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 99; }},
      {"names materials 9, which is not there",
       [](GltfWriter& f) { f.root["meshes"][0]["primitives"][0]["material"] = 9; }},
      {"names meshes 7, which is not there", [](GltfWriter& f) { f.root["nodes"][0]["mesh"] = 7; }},
      {"names nodes 3, which is not there", [](GltfWriter& f) { f.root["nodes"][0]["children"] = {3}; }},
      {"node 0 is reached twice", [](GltfWriter& f) { f.root["nodes"][0]["children"] = {0}; }},
      {"node 1 is reached twice",
       [](GltfWriter& f) {
         f.root["nodes"][0]["children"] = {1, 1};
         f.root["nodes"].push_back({{"mesh", 0}});
       }},
      {"node 0 is reached twice",
       [](GltfWriter& f) {
         f.root["nodes"][0]["children"] = {1};
         f.root["nodes"].push_back({{"children", {0}}});
       }},
      {"names scenes 5, which is not there", [](GltfWriter& f) { f.root["scene"] = 5; }},
      {"is not finite", [](GltfWriter& f) { f.data.replace(0, 4, "\0\0\xc0\x7f", 4); }},
      {"has 3 numbers in \"rotation\", not 4",
       [](GltfWriter& f) {
         f.root["nodes"][0]["rotation"] = {0, 0, 1};
       }},
      {"has no list \"nodes\"", [](GltfWriter& f) { f.root["nodes"] = 5; }},
      {"has the unknown mode 7", [](GltfWriter& f) { f.root["meshes"][0]["primitives"][0]["mode"] = 7; }},
      {"is not an object", [](GltfWriter& f) { f.root["meshes"][0] = nullptr; }},
      {"is glTF 1.0; convert it to glTF 2.0", [](GltfWriter& f) { f.root["asset"]["version"] = "1.0"; }},
      {"is glTF 3.0", [](GltfWriter& f) { f.root["asset"]["minVersion"] = "3.0"; }},
      {"has no \"asset\"", [](GltfWriter& f) { f.root.erase("asset"); }},
      {"replaces more elements than there are",
       [](GltfWriter& f) {
         f.root["accessors"][0]["sparse"] = {{"count", 5}};
       }},
      {"has no indices or no values",
       [](GltfWriter& f) {
         f.root["accessors"][0]["sparse"] = {{"count", 1}};
       }},
      {"byteStride of 2 for elements of 12 bytes",
       [](GltfWriter& f) { f.root["bufferViews"][0]["byteStride"] = 2; }},
      {"names a joint that is not there",
       [](GltfWriter& f) {
         f.root["nodes"][0]["skin"] = 0;
         f.root["skins"] = {{{"joints", {77}}}};
       }},
  };
  for (const auto& one : cases) {
    const std::string refused = changed(one.change);
    EXPECT_EQ(refused.find(path("a.glb").string() + ": "), 0U) << refused;
    EXPECT_NE(refused.find(one.sentence), std::string::npos) << one.sentence << ": " << refused;
    EXPECT_EQ(refused.find("cannot be read; is it damaged?"), std::string::npos) << refused;
  }
}

TEST_F(Gltf, AFileCutAnywhereIsRefused) {
  const std::string whole = flag().glb();
  for (std::size_t size = 1; size < whole.size(); size += 1 + size / 16) {
    const std::string refused = error_of([&] { (void)read_model(write(whole.substr(0, size), "cut.glb")); });
    EXPECT_EQ(refused.find(path("cut.glb").string() + ": "), 0U) << refused;
  }
  EXPECT_NE(error_of([&] { (void)read_model(write("hello", "text.gltf")); }).find("neither .glb nor"),
            std::string::npos);
}

TEST_F(Gltf, AbsurdAmountsAreRefusedSoon) {
  GltfWriter instances = flag();
  const std::size_t where =
      instances.add("accessors", {{"componentType", kFloat}, {"count", 5'000'000}, {"type", "VEC3"}});
  instances.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = where;
  EXPECT_NE(refusal(instances).find("has a mesh with 5000000 instances, more than 2000000"),
            std::string::npos)
      << refusal(instances);
  instances.root["accessors"].back()["count"] = 1'500'000;  // 3 million triangles
  EXPECT_NE(refusal(instances).find("triangles, more than 2000000; simplify it first"), std::string::npos)
      << refusal(instances);
  GltfWriter zeros = flag();  // 600 accessors of 72 MB each, without bytes
  Json& primitives = zeros.root["meshes"][0]["primitives"];
  for (int i = 0; i < 600; ++i) {
    const std::size_t of =
        zeros.add("accessors", {{"componentType", kFloat}, {"count", 6'000'000}, {"type", "VEC3"}});
    primitives.push_back({{"attributes", {{"POSITION", of}}}});
  }
  EXPECT_NE(refusal(zeros).find("more than"), std::string::npos) << refusal(zeros);
  GltfWriter deep = flag();
  deep.root["nodes"] = Json::array();
  for (int i = 0; i < 20'000; ++i) deep.add("nodes", {{"children", {i + 1}}});
  deep.add("nodes", {{"mesh", 0}});
  expect_silent_flag(deep, "20,000 levels of nodes");
}

TEST_F(Gltf, MeshFilesOfTheSameKindsAreReadToo) {
  GltfWriter file;
  const std::size_t positions = file.normalised(times(kCorners, 65535), 3, kUint16);
  const std::size_t colours = file.normalised({255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0}, 3, kUint8);
  const Mesh mesh =
      read_mesh(write(flag(file, {{"POSITION", positions}, {"COLOR_0", colours}}).glb(), "a.glb"));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_LT((mesh.vertices[2] - Eigen::Vector3f(1, 0, 1)).norm(), 1e-6F) << "z up";
  EXPECT_EQ(mesh.normals.size(), 4U);
  EXPECT_EQ(mesh.colours.at(0), (Rgb{255, 0, 0}));
}

}  // namespace
}  // namespace roomradar::gltf_test
