// models_test.cpp: models in each format stand upright, in metres, and look as their authors made them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/models/model_file.hpp"
#include "app/models/texture_file.hpp"
#include "app/objects/object_file.hpp"
#include "app/objects/object_lod.hpp"
#include "app/objects/published_objects.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/render/draw.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/app/objects/model_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::models_test {
namespace {

using test::crate;
using test::GlbWants;

Eigen::AlignedBox3f box_of(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.vertices) box.extend(p);
  return box;
}

/// Draws a model as an object, seen from its front (-y), 1 m away.
ObjectLayer drawn_from_front(const Model& model, const Eigen::Vector3d& turn_rad = Eigen::Vector3d::Zero()) {
  GlContext context;
  ObjectDrawer drawer(context);
  const auto object = object_of(context, "drawn", model, {});
  const Intrinsics camera{
      .width_px = 400, .height_px = 300, .fx_px = 1000, .fy_px = 1000, .cx_px = 199.5, .cy_px = 149.5};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  T_world_camera.translation() = object->model->middle - Eigen::Vector3d(0, 1, 0);
  if (turn_rad.norm() > 0.0)
    object->body.T_world_object.linear() =
        Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()).toRotationMatrix();
  const DrawnObject drawn = drawn_object(*object, camera, T_world_camera, 0.7);
  Lighting even;
  even.gloss = 0.0F;
  ObjectLayer layer;
  drawer.draw({&drawn, 1}, camera, T_world_camera, even, layer);
  return layer;
}

/// Returns the colour at a part of the layer's width and height.
Rgb colour_at(const ObjectLayer& layer, double across, double down) {
  return layer.colour.at(static_cast<int>(across * layer.colour.width),
                         static_cast<int>(down * layer.colour.height));
}

/// Returns true if the colour is a shaded version of the other: same proportions of its channels.
bool is_shade_of(const Rgb& shown, const Rgb& colour) {
  const Eigen::Vector3d a = Eigen::Vector3d(shown.r, shown.g, shown.b).normalized();
  const Eigen::Vector3d b = Eigen::Vector3d(colour.r, colour.g, colour.b).normalized();
  return a.dot(b) > 0.985;
}

std::string words_of(const Rgb& c) {
  return std::to_string(c.r) + " " + std::to_string(c.g) + " " + std::to_string(c.b);
}

void expect_quarters(const ObjectLayer& layer, const std::string& what) {
  ASSERT_GT(layer.colour.width, 100) << what;
  const struct {
    double across, down;
    Rgb colour;
  } quarters[] = {{0.35, 0.35, test::kRed},
                  {0.75, 0.25, test::kGreen},
                  {0.25, 0.75, test::kBlue},
                  {0.75, 0.75, test::kYellow}};
  for (const auto& quarter : quarters) {
    const Rgb shown = colour_at(layer, quarter.across, quarter.down);
    EXPECT_TRUE(is_shade_of(shown, quarter.colour))
        << what << " at " << quarter.across << " " << quarter.down << ": " << words_of(shown);
  }
  const Rgb mark = colour_at(layer, 8.0 / 64, 8.0 / 64);
  EXPECT_TRUE(is_shade_of(mark, {255, 255, 255})) << what << ": " << words_of(mark);
}

/// Returns the message of the Error that `work` throws; empty if it throws none.
template <typename Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

class Models : public ::testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  test::TemporaryFolder folder_;
};

TEST_F(Models, TexturedFilesOfEachFormatStandAndLookAlike) {
  test::write_glb(crate(), path("crate.glb"));
  test::write_obj(crate(), path("crate.obj"));
  test::write_dae(crate(), path("crate.dae"));
  for (const char* name : {"crate.glb", "crate.obj", "crate.dae"}) {
    const Model model = read_model(path(name));
    EXPECT_TRUE(model.notes.empty()) << model.notes.front();
    EXPECT_EQ(model.mesh.triangles.size(), 12U) << name;
    const Eigen::AlignedBox3f box = box_of(model.mesh);
    EXPECT_LT((box.min() - Eigen::Vector3f(-0.1F, -0.07F, 0.0F)).norm(), 1e-6F)
        << name << box.min().transpose();
    EXPECT_LT((box.max() - Eigen::Vector3f(0.1F, 0.07F, 0.1F)).norm(), 1e-6F)
        << name << box.max().transpose();
    ASSERT_EQ(model.textures.size(), 1U) << name;
    EXPECT_EQ(model.textures[0].colour.pixels, test::quarters_picture().pixels) << name;
    expect_quarters(drawn_from_front(model), name);
  }
}

TEST_F(Models, ATextureIsShownInItsOwnColours) {
  const Rgb green = colour_at(drawn_from_front(crate()), 0.75, 0.25);
  Model plain = crate();
  plain.mesh.colours.assign(plain.mesh.vertices.size(), test::kGreen);
  plain.texture_points.clear(), plain.parts.clear(), plain.textures.clear();
  const Rgb coloured = colour_at(drawn_from_front(plain), 0.75, 0.25);
  EXPECT_NEAR(green.r, coloured.r, 1);  // a colour looks the same from a texture and from a material
  EXPECT_NEAR(green.g, coloured.g, 1);
  EXPECT_NEAR(green.b, coloured.b, 1);
}

TEST_F(Models, FormatsWithoutAnAxisStandAsTheyAreUsuallyWritten) {
  const Mesh plain = [] {
    Mesh mesh = crate({0.2F, 0.14F, 0.5F}).mesh;
    mesh.normals.clear();
    return mesh;
  }();
  for (const char* name : {"tall.stl", "tall.ply"}) {
    write_mesh(plain, path(name));
    EXPECT_FLOAT_EQ(box_of(read_model(path(name)).mesh).sizes().z(), 0.5F) << name;
    EXPECT_FLOAT_EQ(box_of(read_model(path(name), UpAxis::kY).mesh).sizes().z(), 0.14F) << name;
    EXPECT_FLOAT_EQ(box_of(read_model(path(name), UpAxis::kX).mesh).sizes().z(), 0.2F) << name;
  }
  test::write_obj(crate({0.2F, 0.14F, 0.5F}), path("tall.obj"));
  EXPECT_FLOAT_EQ(box_of(read_model(path("tall.obj")).mesh).sizes().z(), 0.5F);
  EXPECT_FLOAT_EQ(box_of(read_model(path("tall.obj"), UpAxis::kZ).mesh).sizes().z(), 0.14F);
}

TEST_F(Models, EachAxisTurnsToPlusZWithoutMirroring) {
  const struct {
    UpAxis up;
    Eigen::Vector3f axis;
  } axes[] = {{UpAxis::kX, {1, 0, 0}},       {UpAxis::kY, {0, 1, 0}},       {UpAxis::kZ, {0, 0, 1}},
              {UpAxis::kMinusX, {-1, 0, 0}}, {UpAxis::kMinusY, {0, -1, 0}}, {UpAxis::kMinusZ, {0, 0, -1}}};
  for (const auto& axis : axes) {
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, axis.axis};
    stand_up(mesh, axis.up);
    EXPECT_EQ(mesh.vertices[3], Eigen::Vector3f(0, 0, 1)) << to_string(axis.up);
    EXPECT_EQ(mesh.vertices[0].cross(mesh.vertices[1]), mesh.vertices[2]) << to_string(axis.up);
    EXPECT_EQ(up_axis_of(to_string(axis.up)), axis.up);
  }
  EXPECT_FALSE(up_axis_of("up").has_value());
}

TEST_F(Models, MaterialAndVertexColoursAreDrawn) {
  test::write_glb(crate(), path("linear.glb"),
                  {.material = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.21586, 1.0, 0.0, 1.0}}}}},
                   .has_texture = false});
  const Model factor = read_model(path("linear.glb"));
  ASSERT_EQ(factor.mesh.colours.size(), 24U);
  EXPECT_EQ(factor.mesh.colours[5], (Rgb{128, 255, 0})) << "a factor is linear";
  EXPECT_FALSE(factor.is_textured());

  GlbWants wants{.material = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1.0, 1.0, 1.0}}}}},
                 .has_texture = false};
  wants.colours.assign(72, 0.43172F);
  test::write_glb(crate(), path("product.glb"), wants);
  EXPECT_EQ(read_model(path("product.glb")).mesh.colours[0], (Rgb{128, 176, 176}))
      << "both multiply, linearly";

  test::write_glb(crate(), path("none.glb"), {.material = nullptr, .has_texture = false});
  EXPECT_TRUE(read_model(path("none.glb")).mesh.colours.empty()) << "no colour is stated";

  test::write_obj(crate(), path("kd.obj"));
  test::write_file(path("kd.mtl"), "newmtl wood\nKd 0.2 0.4 0.6\n");
  EXPECT_EQ(read_model(path("kd.obj")).mesh.colours[7], (Rgb{51, 102, 153})) << "sRGB";

  Mesh coloured = crate().mesh;
  for (std::size_t i = 0; i < coloured.vertices.size(); ++i)
    coloured.colours.push_back({static_cast<std::uint8_t>(10 * i), 50, 200});
  write_mesh(coloured, path("coloured.ply"));
  EXPECT_EQ(read_model(path("coloured.ply")).mesh.colours.size(), 24U);
  const Rgb shown = colour_at(drawn_from_front(read_model(path("coloured.ply"))), 0.5, 0.5);
  EXPECT_GT(shown.b, 2 * shown.r) << words_of(shown);
}

TEST_F(Models, ATextureThatCannotBeReadIsNamedAndTheMaterialIsDrawn) {
  test::write_obj(crate(), path("missing.obj"), /*writes_picture=*/false);
  test::write_file(path("missing.mtl"), "newmtl wood\nKd 0.2 0.4 0.6\nmap_Kd pictures/oak.png\n");
  const Model missing = read_model(path("missing.obj"));
  ASSERT_EQ(missing.notes.size(), 1U);
  EXPECT_EQ(missing.notes[0].find(path("missing.obj").string()), 0U) << missing.notes[0];
  EXPECT_NE(missing.notes[0].find("oak.png is missing"), std::string::npos) << missing.notes[0];
  EXPECT_FALSE(missing.is_textured());
  EXPECT_EQ(missing.mesh.colours[0], (Rgb{51, 102, 153}));

  test::write_file(path("oak.png"), "\x89PNG and then nothing of the kind");
  const Model broken = read_model(path("missing.obj"));  // found beside the model
  ASSERT_EQ(broken.notes.size(), 1U);
  EXPECT_NE(broken.notes[0].find("cannot be decoded"), std::string::npos) << broken.notes[0];

  test::write_glb(crate(), path("broken.glb"), {.picture = "not a picture"});
  const Model embedded = read_model(path("broken.glb"));
  ASSERT_EQ(embedded.notes.size(), 1U);
  EXPECT_NE(embedded.notes[0].find("embedded texture"), std::string::npos) << embedded.notes[0];
  EXPECT_FALSE(embedded.is_textured());

  test::write_obj(crate(), path("alone.obj"));
  std::filesystem::remove(path("alone.mtl"));
  const Model alone = read_model(path("alone.obj"));
  ASSERT_EQ(alone.notes.size(), 1U);
  EXPECT_NE(alone.notes[0].find("alone.mtl is missing"), std::string::npos) << alone.notes[0];
}

TEST_F(Models, ALargePictureIsReducedToItsMean) {
  ColourImage wide(6000, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 6000; ++x) wide.at(x, y) = x < 3000 ? test::kRed : test::kBlue;
  write_png(wide, path("wide.png"));
  const Texture texture = read_texture(path("wide.png"), kMaxTexturePixels);
  EXPECT_EQ(texture.colour.width, 4096);
  EXPECT_EQ(texture.colour.height, 13);
  EXPECT_EQ(texture.colour.at(10, 5), test::kRed);
  EXPECT_EQ(texture.colour.at(4090, 5), test::kBlue);
  EXPECT_LE(read_texture(path("wide.png"), 1000).colour.pixels.size(), 1000U);
  EXPECT_NE(message_of([&] { static_cast<void>(texture_of_bgra("short", 100, 100, 1000)); }), "");
}

TEST_F(Models, ABitmapAndATgaAreTexturesAndOtherFormatsAreRefused) {
  // A bitmap of 2 x 1 pixels of 24 bits, a TGA whose packet repeats a pixel, and the last row first.
  const std::string bmp(
      "BM\x3e\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\x18\0\0\0\0\0\x08\0\0\0"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\0\0\0\0\xff\0\0",
      62);
  const std::string tga("\0\0\x0a\0\0\0\0\0\0\0\0\0\2\0\2\0\x20\x08\x81\1\2\3\x40\x81\4\5\6\x80", 28);
  const Texture bitmap = decode_texture(bmp, 100);
  ASSERT_EQ(bitmap.colour.width, 2);
  EXPECT_EQ(bitmap.colour.pixels, (std::vector<Rgb>{{0, 0, 255}, {255, 0, 0}}));
  const Texture targa = decode_texture(tga, 100);
  ASSERT_EQ(targa.colour.height, 2);
  EXPECT_EQ(targa.colour.pixels, (std::vector<Rgb>{{6, 5, 4}, {6, 5, 4}, {3, 2, 1}, {3, 2, 1}}));
  EXPECT_EQ(targa.opacity.pixels, (std::vector<std::uint8_t>{128, 128, 64, 64}));
  for (const std::string& other :
       {std::string("RIFF\x10\0\0\0WAVEfmt and more than 18 bytes", 40),
        std::string("II*\0 a TIFF of more than 18 bytes", 34), std::string("\0", 1)})
    EXPECT_NE(
        message_of([&] { (void)decode_texture(other, 100); }).find("neither PNG, JPEG, WebP, BMP nor TGA"),
        std::string::npos);
  std::string empty = tga;
  empty[12] = '\0';  // the width
  EXPECT_NE(message_of([&] { (void)decode_texture(empty, 100); }).find("1..16384 px"), std::string::npos);
  std::string huge = tga;
  huge[13] = '\x3f';
  EXPECT_EQ(message_of([&] { (void)decode_texture(huge, 100); }), "is cut short");
  for (std::size_t size = 0; size < bmp.size(); ++size)
    (void)message_of([&] { (void)decode_texture(bmp.substr(0, size), 100); });
  for (std::size_t size = 0; size < tga.size(); ++size)
    (void)message_of([&] { (void)decode_texture(tga.substr(0, size), 100); });
}

TEST_F(Models, HolesOfATextureAreNotDrawn) {
  Model model = crate();
  model.textures[0].opacity.resize(64, 64, 255);
  for (int y = 32; y < 64; ++y)
    for (int x = 0; x < 32; ++x) model.textures[0].opacity.at(x, y) = 0;
  const ObjectLayer layer = drawn_from_front(model);
  const Rgb through = colour_at(layer, 0.25, 0.75), solid = colour_at(layer, 0.75, 0.75);
  EXPECT_TRUE(is_shade_of(solid, test::kYellow)) << words_of(solid);
  EXPECT_FALSE(is_shade_of(through, test::kBlue)) << "the back is seen: " << words_of(through);
}

TEST_F(Models, APixelatedTextureHasSharpEdges) {
  Model model = crate();
  ColourImage& image = model.textures[0].colour;
  image.resize(2, 2);
  image.pixels = {test::kRed, test::kGreen, test::kBlue, test::kYellow};
  for (const bool is_pixelated : {true, false}) {
    model.textures[0].is_pixelated = is_pixelated;
    const ObjectLayer layer = drawn_from_front(model);
    const Rgb left = colour_at(layer, 0.45, 0.25), right = colour_at(layer, 0.55, 0.25);
    EXPECT_EQ(is_shade_of(left, test::kRed), is_pixelated) << words_of(left);
    EXPECT_EQ(is_shade_of(right, test::kGreen), is_pixelated) << words_of(right);
  }
}

TEST_F(Models, AModelFarFromItsOriginGetsItsMiddleAsOrigin) {
  Mesh mesh = crate().mesh;
  mesh.origin = {1000.0, 0.0, 2.0};
  write_mesh(mesh, path("far.ply"));
  const Model model = read_model(path("far.ply"));
  EXPECT_LT(box_of(model.mesh).center().norm(), 1e-6F);
  ASSERT_EQ(model.notes.size(), 1U);
  EXPECT_NE(model.notes[0].find("1000 m from the origin"), std::string::npos) << model.notes[0];
  EXPECT_GT(box_of(read_model(path("far.ply"), std::nullopt, ModelOrigin::kAsInFile).mesh).min().x(), 999.0F);
  mesh.origin = {0.25, 0.0, 0.0};  // beside it, nearer than it is long
  write_mesh(mesh, path("near.ply"));
  EXPECT_NEAR(box_of(read_model(path("near.ply")).mesh).center().x(), 0.25, 1e-6);
}

TEST_F(Models, AnAnimatedModelIsReadAtRest) {
  test::write_glb(crate(), path("moves.glb"), {.moves = true});
  const Model model = read_model(path("moves.glb"), std::nullopt, ModelOrigin::kAsInFile);
  EXPECT_LT((box_of(model.mesh).center() - Eigen::Vector3f(1.0F, 0.0F, 0.05F)).norm(), 1e-6F);
  expect_quarters(drawn_from_front(model), "moves.glb");
}

TEST_F(Models, AbsurdSizesAreRefusedWithTheOptionToPaste) {
  const auto refusal = [&](float longest_m, double room_m, const std::string& option = "--object-size ") {
    const Model model = crate({longest_m, 0.1F * longest_m, 0.1F * longest_m});
    return message_of([&] { require_sensible_size(model, {.mesh = "part.stl"}, {room_m, option}); });
  };
  EXPECT_EQ(refusal(0.3F, 6.0), "");
  EXPECT_EQ(refusal(2.9F, 6.0), "");
  EXPECT_EQ(refusal(300.0F, 6.0),
            "part.stl: its longest side is 300 m, more than 5 m; if its unit is millimetres, use "
            "--object-size 0.3");
  EXPECT_EQ(refusal(12.0F, 6.0, "add pot part.stl size "),
            "part.stl: its longest side is 12 m, more than 5 m; if its unit is centimetres, use add pot "
            "part.stl size 0.12");
  EXPECT_EQ(
      refusal(3.5F, 6.0),
      "part.stl: its longest side is 3.5 m, more than half of the room, which is 6 m long; if its unit is "
      "centimetres, use --object-size 0.035");
  EXPECT_EQ(refusal(0.004F, 6.0),
            "part.stl: its longest side is 4 mm, less than 5 mm; give it a size in metres, such as "
            "--object-size 0.3");
  EXPECT_EQ(refusal(1e6F, 6.0),
            "part.stl: its longest side is 1000000 m, more than 5 m; give it a size in metres, such as "
            "--object-size 0.3");
  EXPECT_EQ(
      message_of([&] {
        require_sensible_size(crate({9.0F, 1.0F, 1.0F}), {.mesh = "part.stl", .size_m = 9.0}, {6.0, ""});
      }),
      "")
      << "the user has given a size";
}

TEST_F(Models, ACopyForARecordedSessionIsTheSameToTheBit) {
  Model model = crate();
  model.textures[0].opacity.resize(64, 64, 200);
  model.textures[0].wrap_v = TextureWrap::kMirror;
  write_model_copy(model, path("copy.model"));
  const Model copy = read_model(path("copy.model"));
  EXPECT_EQ(copy.mesh.vertices, model.mesh.vertices);
  EXPECT_EQ(copy.mesh.normals, model.mesh.normals);
  EXPECT_EQ(copy.mesh.triangles, model.mesh.triangles);
  EXPECT_EQ(copy.texture_points, model.texture_points);
  EXPECT_EQ(copy.parts, model.parts);
  EXPECT_EQ(copy.textures, model.textures);

  const std::string good = test::file_bytes(path("copy.model"));
  for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 60) {
    test::write_file(path("cut.model"), good.substr(0, length));
    EXPECT_NE(message_of([&] { static_cast<void>(read_model(path("cut.model"))); }), "") << length;
  }
  unsigned state = 1;
  for (int round = 0; round < 300; ++round) {  // refused, or read with other numbers
    std::string bad = good;
    state = state * 1664525U + 1013904223U;
    bad[(state >> 8U) % 1500] = static_cast<char>(state >> 4U);
    test::write_file(path("bad.model"), bad);
    static_cast<void>(message_of([&] { static_cast<void>(read_model(path("bad.model"))); }));
  }
}

TEST_F(Models, DamagedTexturedFilesNeverCrash) {
  test::write_glb(crate(), path("good.glb"));
  test::write_dae(crate(), path("good.dae"));
  for (const char* name : {"good.glb", "good.dae"}) {
    const std::string good = test::file_bytes(path(name));
    const std::filesystem::path bad_path = path(std::string("bad") + path(name).extension().string());
    unsigned state = 7;
    for (int round = 0; round < 60; ++round) {
      std::string bad =
          round % 2 == 0 ? good : good.substr(0, good.size() * static_cast<std::size_t>(round) / 60);
      for (int i = 0; i < 3 && !bad.empty(); ++i) {
        state = state * 1664525U + 1013904223U;
        bad[(state >> 8U) % bad.size()] = static_cast<char>(state >> 4U);
      }
      test::write_file(bad_path, bad);
      static_cast<void>(message_of([&] { static_cast<void>(read_model(bad_path)); }));
    }
  }
}

TEST_F(Models, AMillionTrianglesAreReadAndDrawn) {
  Mesh mesh = bumpy_torus(1000, 500);
  for (const Eigen::Vector3f& p : mesh.vertices)
    mesh.colours.push_back(p.x() < 0.0F ? test::kRed : test::kBlue);
  ASSERT_EQ(mesh.triangles.size(), 1'000'000U);
  write_mesh(mesh, path("million.ply"));
  const Model model = read_model(path("million.ply"));
  ASSERT_EQ(model.mesh.triangles.size(), 1'000'000U);
  const ObjectLayer layer = drawn_from_front(model);
  EXPECT_TRUE(is_shade_of(colour_at(layer, 0.1, 0.5), test::kRed)) << words_of(colour_at(layer, 0.1, 0.5));
  EXPECT_TRUE(is_shade_of(colour_at(layer, 0.9, 0.5), test::kBlue)) << words_of(colour_at(layer, 0.9, 0.5));
}

/// A torus of 2 * around * across triangles with a seam in each direction, on which the texture is there
/// three times around.
Model textured_torus(int around, int across) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  Model model;
  for (int i = 0; i <= around; ++i)
    for (int j = 0; j <= across; ++j) {
      const double a = kTurn * i / around, b = kTurn * j / across;
      const Eigen::Vector3d out(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
      const Eigen::Vector3d middle(0.08 * std::cos(a), 0.08 * std::sin(a), 0.0);
      model.mesh.vertices.push_back((middle + 0.035 * out).cast<float>());
      model.mesh.normals.push_back(out.cast<float>());
      model.texture_points.emplace_back(3.0F * static_cast<float>(i) / static_cast<float>(around),
                                        static_cast<float>(j) / static_cast<float>(across));
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (across + 1) + j); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      model.mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      model.mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  model.parts = {{0, static_cast<std::uint32_t>(model.mesh.triangles.size()), 0}};
  model.textures.emplace_back().colour = test::quarters_picture();
  return model;
}

TEST_F(Models, LevelsOfATexturedModelKeepItsTextureInPlace) {
  const Model model = textured_torus(200, 80);
  const std::vector<LevelOfDetail> levels = levels_of_detail(model);
  ASSERT_GE(levels.size(), 4U);
  std::size_t before = model.mesh.triangles.size();
  float deviation_m = 0.0F;
  for (const LevelOfDetail& level : levels) {
    EXPECT_LT(level.mesh.triangles.size(), before);
    EXPECT_GT(level.deviation_m, deviation_m);
    ASSERT_EQ(level.texture_points.size(), level.mesh.vertices.size());
    ASSERT_EQ(level.parts.size(), 1U);
    EXPECT_EQ(level.parts[0].triangle_count, level.mesh.triangles.size());
    before = level.mesh.triangles.size();
    deviation_m = level.deviation_m;
    // Independent of the carried points: where a vertex is on the torus, its texture point is known.
    double worst_m = 0.0;
    for (std::size_t v = 0; v < level.mesh.vertices.size(); ++v) {
      const Eigen::Vector3d p = level.mesh.vertices[v].cast<double>();
      const double around = std::atan2(p.y(), p.x()) / (2.0 * std::numbers::pi);
      const double off = 3.0 * around - static_cast<double>(level.texture_points[v].x());
      const double off_turns = (off - 3.0 * std::round(off / 3.0)) / 3.0;
      worst_m = std::max(worst_m, std::abs(off_turns) * 2.0 * std::numbers::pi * 0.08);
    }
    EXPECT_LT(worst_m, 2.0 * static_cast<double>(level.deviation_m) + 1e-4) << level.mesh.triangles.size();
  }
  EXPECT_LT(before, 1000U);
}

TEST_F(Models, ATexturedLevelLooksLikeTheFullModel) {
  const Model model = textured_torus(200, 80);
  const std::vector<LevelOfDetail> levels = levels_of_detail(model);
  const ObjectLayer full = drawn_from_front(model);  // 1 m away, where a pixel is 1 mm
  Model coarse = model;
  for (const LevelOfDetail& level : levels) {
    if (level.deviation_m > 0.002F) break;
    coarse.mesh = level.mesh, coarse.texture_points = level.texture_points, coarse.parts = level.parts;
  }
  ASSERT_LT(coarse.mesh.triangles.size(), model.mesh.triangles.size() / 4);
  const ObjectLayer shown = drawn_from_front(coarse);
  ASSERT_EQ(shown.colour.width, full.colour.width);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(full.colour.pixels.size(), shown.colour.pixels.size()); ++i) {
    const Rgb &a = full.colour.pixels[i], &b = shown.colour.pixels[i];
    if (a == Rgb{} && b == Rgb{}) continue;
    sum += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
    ++count;
  }
  EXPECT_LT(sum / static_cast<double>(count), 9.0) << "mean difference of three channels";
}

TEST_F(Models, PartsOfSeveralTexturesKeepTheirsInEachLevel) {
  Model model = textured_torus(100, 40);
  const auto half = static_cast<std::uint32_t>(model.mesh.triangles.size() / 2);
  // Two tori, the second without a texture.
  const Model other = textured_torus(100, 40);
  const auto first = static_cast<std::uint32_t>(model.mesh.vertices.size());
  for (std::size_t v = 0; v < other.mesh.vertices.size(); ++v) {
    model.mesh.vertices.push_back(other.mesh.vertices[v] + Eigen::Vector3f(0.3F, 0.0F, 0.0F));
    model.mesh.normals.push_back(other.mesh.normals[v]);
    model.texture_points.push_back(other.texture_points[v]);
  }
  for (const Triangle& t : other.mesh.triangles)
    model.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  model.mesh.colours.assign(model.mesh.vertices.size(), Rgb{255, 255, 255});
  std::fill(model.mesh.colours.begin() + first, model.mesh.colours.end(), test::kBlue);
  model.parts = {{0, 2 * half, 0}, {2 * half, 2 * half, kNoTexture}};
  const std::vector<LevelOfDetail> levels = levels_of_detail(model);
  ASSERT_FALSE(levels.empty());
  for (const LevelOfDetail& level : levels) {
    ASSERT_EQ(level.parts.size(), 2U);
    EXPECT_EQ(level.parts[1].first_triangle, level.parts[0].triangle_count);
    EXPECT_EQ(level.parts[1].texture, kNoTexture);
    for (std::size_t t = 0; t < level.mesh.triangles.size(); ++t) {
      const bool is_second = t >= level.parts[0].triangle_count;
      const std::uint32_t vertex = level.mesh.triangles[t][0];
      EXPECT_EQ(level.mesh.vertices[vertex].x() > 0.15F, is_second);
      EXPECT_EQ(level.mesh.colours[vertex], (is_second ? test::kBlue : Rgb{255, 255, 255}));
    }
  }
}

TEST_F(Models, ASplitCrateIsClosedForTheRadar) {
  test::write_glb(crate(), path("crate.glb"));
  const ObjectParts parts = object_parts("crate", read_model(path("crate.glb")));
  EXPECT_TRUE(parts.touched.is_closed()) << "vertices are there once per side";
  EXPECT_NEAR(parts.mass.mass_kg, object_parts("box", box_mesh({0.2F, 0.14F, 0.1F})).mass.mass_kg, 1e-6);
}

TEST_F(Models, UnknownFormatsAreNamed) {
  test::write_file(path("part.step"), "ISO-10303-21;");
  EXPECT_NE(message_of([&] { static_cast<void>(read_model(path("part.step"))); }).find(".glb, .gltf, .obj"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar::models_test
