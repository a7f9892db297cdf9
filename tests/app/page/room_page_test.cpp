// room_page_test.cpp: what a page holds, read back from its file.
#include "app/page/room_page.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "app/page/page_template.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/mapping/texture/texture_scene.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::room_page_test {
namespace {

using Json = nlohmann::json;

std::string written(const RoomPage& page) {
  const test::TemporaryFolder folder;
  write_room_page(page, folder.path() / "room.html");
  return read_bytes(folder.path() / "room.html", "a page");
}

/// Returns the room's data in a page.
Json data_of(const std::string& html) {
  const std::string begin = "<script id=\"ROOM\" type=\"application/json\">";
  const std::size_t at = html.find(begin) + begin.size();
  return Json::parse(html.substr(at, html.find("</script>", at) - at));
}

std::vector<std::uint8_t> bytes_of(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned bits = 0, count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
  }
  return bytes;
}

TEST(RoomPage, HoldsTheRoomAndNeedsNoNetwork) {
  const Mesh mesh = test::wall_mesh();
  const SurfaceTexture texture = test::red_texture(mesh);
  RoomPage page{.title = "kitchen", .rooms = {{"kitchen", &mesh, &texture}}};
  Hole hole;
  hole.position_world = {1.0, 2.0, 0.5};
  page.holes = {hole, hole};
  page.holes[1].kind = HoleKind::kOuterBorder;  // the end of the scan is no hole
  page.trajectory = {{0, 0.0, test::wall_poses()[0]}, {1, 0.1, test::wall_poses()[1]}};
  const std::string html = written(page);
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find(kPageRoom), std::string::npos);
  const Json data = data_of(html);
  EXPECT_EQ(data["name"], "kitchen");
  EXPECT_EQ(data["holes"].size(), 1U);
  EXPECT_EQ(data["path_m"].size(), 6U);
  ASSERT_EQ(data["meshes"].size(), 1U);
  const Json& room = data["meshes"][0];
  EXPECT_EQ(bytes_of(room["texture"]), texture.atlas_jpeg);
  EXPECT_EQ(bytes_of(room["triangles"]).size(), mesh.triangles.size() * 12);
  const std::vector<std::uint8_t> positions = bytes_of(room["positions"]);
  EXPECT_EQ(positions.size() % 6, 0U);
  EXPECT_EQ(positions.size() / 6, bytes_of(room["points"]).size() / 4);
  // The first vertex is the box's low corner.
  EXPECT_NEAR(room["low_m"][0].get<double>(), 2.0, 1e-6);
  EXPECT_NEAR(room["low_m"][1].get<double>(), -0.6, 1e-6);
  EXPECT_NEAR(room["size_m"][2].get<double>(), 1.2, 1e-6);
}

TEST(RoomPage, WithoutATextureItHasTheVerticesColours) {
  const Mesh mesh = test::wall_mesh();
  const Json data = data_of(written({.title = "a", .rooms = {{"a", &mesh, nullptr}}}));
  EXPECT_FALSE(data["meshes"][0].contains("texture"));
  EXPECT_EQ(bytes_of(data["meshes"][0]["colours"]).size(), 3 * mesh.vertices.size());
}

TEST(RoomPage, NamesCannotEndItsScript) {
  const Mesh mesh = test::wall_mesh();
  const std::string name = "a</script><script>alert(1)</script>\xff";
  const std::string html = written({.title = name, .rooms = {{name, &mesh, nullptr}}});
  EXPECT_EQ(html.find("alert(1)</script>"), std::string::npos);
  EXPECT_NE(data_of(html)["name"].get<std::string>().find("</script><script>alert(1)"), std::string::npos);
}

TEST(RoomPage, ChangesBelongToTheirRooms) {
  const Mesh mesh = test::wall_mesh();
  RoomPage page{.title = "a and b", .rooms = {{"a", &mesh, nullptr}, {"b", &mesh, nullptr}}};
  Change change;
  change.kind = ChangeKind::kVanished;
  change.box_world = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 0.2, 0.3)};
  change.surface_world.assign(20'000, {0.05, 0.1, 0.2});
  page.changes = {change};
  const Json data = data_of(written(page));
  EXPECT_EQ(data["changes"][0]["kind"], "vanished");
  EXPECT_LE(data["changes"][0]["surface_m"].size(), 3U * 4000U);
  EXPECT_NE(data["changes"][0]["text"].get<std::string>().find("0.10 x 0.20 x 0.30 m"), std::string::npos);
}

TEST(RoomPage, ABrowserDrawsItAndMeasures) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  const Mesh mesh = test::wall_mesh();
  const SurfaceTexture texture = test::red_texture(mesh);
  const test::TemporaryFolder folder;
  const std::string page = (folder.path() / "room.html").string();
  write_room_page({.title = "wall", .rooms = {{"wall", &mesh, &texture}}}, page);
  // Clicks two points of the wall, 0.5 m apart, in the view from its front.
  std::ofstream(page, std::ios::app) << R"(<script>
    setTimeout(() => {  // when the page has its final size
      view.azimuth = Math.PI - 0.3;
      $('measure').click();
      for (const p of [[2, 0.1, 0.4], [2, 0.4, 0]]) {
        const [x, y] = onScreen(clipFromWorld(frame()), p);
        for (const kind of ['pointerdown', 'pointerup'])
          canvas.dispatchEvent(new PointerEvent(kind, {pointerId: 1, clientX: x, clientY: y}));
      }
    }, 1000);
  </script>)";
  // Writes the document after the page's program has run; it throws where WebGL or a shader fails.
  const std::string dom = (folder.path() / "dom.txt").string();
  const std::string browser =
      "timeout 100 chromium --headless=new --no-sandbox --use-gl=angle --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --virtual-time-budget=5000 --window-size=900,700 --user-data-dir=" +
      (folder.path() / "profile").string() + " --dump-dom file://" + page + " > " + dom + " 2> /dev/null";
  ASSERT_EQ(std::system(browser.c_str()), 0);
  const std::string shown = read_bytes(dom, "a document");
  EXPECT_NE(shown.find(">0.0 × 1.2 × 1.2 m, 32 triangles<"), std::string::npos) << shown.substr(0, 4000);
  EXPECT_NE(shown.find(">0.500 m  (height 0.400 m)<"), std::string::npos)
      << shown.substr(shown.find("id=\"labels\""), 400);
}

TEST(RoomPage, ARoomWithoutSurfaceIsRefused) {
  const Mesh mesh;
  EXPECT_NE(test::error_of([&] {
              written({.title = "a", .rooms = {{"a", &mesh, nullptr}}});
            }).find("no surface"),
            std::string::npos);
}

TEST(RoomPage, OnlyHtmlIsAPage) {
  EXPECT_TRUE(is_page("a/b.html"));
  EXPECT_TRUE(is_page("B.HTML"));
  EXPECT_FALSE(is_page("html"));
  EXPECT_FALSE(is_page("a.glb"));
}

}  // namespace
}  // namespace roomradar::room_page_test
