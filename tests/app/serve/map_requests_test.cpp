// map_requests_test.cpp: answers apart from HTTP; a map that is replaced; look-alike places.
#include "app/serve/map_requests.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "mapping/localization/recognise_place.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/locate_body.hpp"
#include "tests/support/saved_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::map_requests_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class MapRequests : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new test::TemporaryFolder;
    frames_ = test::write_small_building(made_->path(), "sim:table?seed=1&frames=40&rate=5&width=320");
  }
  static void TearDownTestSuite() {
    delete made_;
    frames_.clear();
  }
  void SetUp() override {
    fs::copy(made_->path(), folder_, fs::copy_options::recursive);
    catalogue_.maps.push_back(std::make_unique<ServedMap>(folder_));
  }
  [[nodiscard]] Answer get(const std::string& path, const std::string& if_none_match = "") const {
    return answer_get(catalogue_, path, if_none_match);
  }

  inline static test::TemporaryFolder* made_ = nullptr;
  inline static std::vector<Frame> frames_;
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path() / "house";
  MapCatalogue catalogue_;
};

TEST_F(MapRequests, MapsFactsAndTilesAreRead) {
  EXPECT_EQ(get("/health").status, 200);
  EXPECT_EQ(json::parse(get("/maps").body).at("maps").at(0).at("name"), "house");
  const json facts = json::parse(get("/maps/house").body);
  ASSERT_GT(facts.at("tiles").size(), 1U);
  const std::string glb = facts.at("tiles").at(0).at("glb");
  const Answer tile = get("/maps/house/" + glb);
  EXPECT_EQ(tile.status, 200);
  EXPECT_EQ(tile.content_type, "model/gltf-binary");
  EXPECT_EQ(tile.file_bytes, fs::file_size(folder_ / glb));
  EXPECT_EQ(get("/maps/house/tileset.json").body, read_bytes(folder_ / "tileset.json", "tileset"));
  EXPECT_EQ(get("/maps/house/" + glb, "\"" + tile.etag + "\"").status, 304);
  EXPECT_EQ(get("/maps/house/" + glb, "\"other\"").status, 200);
}

TEST_F(MapRequests, NothingElseIsEverServed) {
  write_bytes(folder_ / "tiles" / "secret", "x");
  for (const char* path :
       {"/maps/house/building.json", "/maps/house/tiles/secret", "/maps/house/tiles/../building.json",
        "/maps/house//etc/passwd", "/maps/house/../house/building.json", "/maps/../house",
        "/maps/house/tiles/", "/maps/house/recordings/one.trajectory.txt", "/etc/passwd", "", "/",
        "/maps/other", "/maps/house/locate"}) {
    const Answer answer = get(path);
    EXPECT_GE(answer.status, 400) << path;
    EXPECT_TRUE(json::parse(answer.body).contains("error")) << path;
  }
}

TEST_F(MapRequests, AReplacedBuildingIsTakenUpAndADamagedOneIsSaid) {
  const std::string before = get("/maps/house").etag;
  BuildingInfo info = read_building(folder_);
  info.tiles.pop_back();
  write_building(info, folder_);
  const Answer after = get("/maps/house");
  EXPECT_NE(after.etag, before);
  EXPECT_EQ(json::parse(after.body).at("tiles").size(), info.tiles.size());
  write_bytes(folder_ / "building.json", "{");
  EXPECT_EQ(get("/maps/house").status, 503);
  write_building(info, folder_);
  EXPECT_EQ(get("/maps/house").etag, after.etag);
  fs::remove(folder_ / info.tiles[0].glb.name);
  EXPECT_EQ(get("/maps/house/" + info.tiles[0].glb.name).status, 503);
}

TEST_F(MapRequests, AFrameBetweenKeyframesIsLocated) {
  constexpr double kMax_m = 0.02;  // noise of the keyframes' depth
  int found = 0, asked = 0;
  for (std::size_t i = 2; i < frames_.size(); i += 5, ++asked) {
    const Answer answer =
        answer_locate(catalogue_, "/maps/house/locate", test::locate_body_of(frames_[i]).text());
    ASSERT_EQ(answer.status, 200) << answer.body;
    const json said = json::parse(answer.body);
    if (!said.at("found")) continue;
    ++found;
    const auto& p = said.at("pose").at("position_m");
    const Eigen::Vector3d position(p.at(0), p.at(1), p.at(2));
    EXPECT_LT((position - frames_[i].T_world_camera->translation()).norm(), kMax_m) << i;
    EXPECT_EQ(said.at("geopose"), "local");
    EXPECT_GE(said.at("feature_inliers").get<int>(), 20);
    EXPECT_GE(said.at("tiles").size(), 1U);
  }
  EXPECT_GT(2 * found, asked);
}

TEST_F(MapRequests, WhatIsNoFrameIsRefused) {
  EXPECT_EQ(answer_locate(catalogue_, "/locate", "{}\n").status, 400);
  EXPECT_EQ(answer_locate(catalogue_, "/maps/other/locate", "{}\n").status, 404);
  Frame blank = frames_[0];
  blank.depth_m = DepthImage(blank.depth_m.width, blank.depth_m.height, 0.0F);
  const json said =
      json::parse(answer_locate(catalogue_, "/locate", test::locate_body_of(blank).text()).body);
  EXPECT_EQ(said.at("found"), false);
  EXPECT_EQ(said.at("reason"), "no depth");
}

TEST_F(MapRequests, TwoEqualMapsAreAmbiguousForOneFrame) {
  const fs::path twin = temporary_.path() / "twin";
  fs::copy(folder_, twin, fs::copy_options::recursive);
  catalogue_.maps.push_back(std::make_unique<ServedMap>(twin));
  const std::string body = test::locate_body_of(frames_[20]).text();
  EXPECT_EQ(json::parse(answer_locate(catalogue_, "/maps/twin/locate", body).body).at("found"), true);
  EXPECT_EQ(json::parse(answer_locate(catalogue_, "/locate", body).body).at("reason"), "ambiguous");
}

TEST_F(MapRequests, AFrameOfAnotherRoomIsNotFound) {
  const test::TemporaryFolder other;
  const std::vector<Frame> frames =
      test::write_small_building(other.path() / "b", "sim:shelf?seed=4&frames=12&rate=1&width=320");
  for (std::size_t i = 0; i < frames.size(); i += 3)
    EXPECT_FALSE(
        json::parse(answer_locate(catalogue_, "/locate", test::locate_body_of(frames[i]).text()).body)
            .at("found"))
        << i;
}

TEST_F(MapRequests, TwoEqualRoomsInOneMapAreAmbiguous) {
  const auto snapshot = catalogue_.maps[0]->current();
  KeyframeDatabase both;
  for (const double shift_m : {0.0, 12.0})
    for (MapKeyframe keyframe : snapshot->keyframes().keyframes) {
      keyframe.T_world_camera.translation().x() += shift_m;
      both.keyframes.push_back(keyframe);
    }
  update_index(both);
  int once = 0;
  for (std::size_t i = 2; i < frames_.size(); i += 5) {
    once += recognise_place(frames_[i], snapshot->keyframes()) ? 1 : 0;
    const RecognisedPlace place = recognise_place(frames_[i], both);
    EXPECT_FALSE(place) << i;
  }
  EXPECT_GE(once, 4);
}

}  // namespace
}  // namespace roomradar::map_requests_test
