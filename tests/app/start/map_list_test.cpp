// map_list_test.cpp: maps are found and described, damaged ones with their fault.
#include "app/start/map_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/app/start/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::map_list_test {
namespace {

namespace fs = std::filesystem;

std::string fact(const MapEntry& map, const MapDetails* details, const std::string& name) {
  for (const auto& [key, value] : facts_of(map, details))
    if (key == name) return value;
  return "";
}

class MapList : public ::testing::Test {
 protected:
  MapList() {
    save_small_map(here_ / "maps/wall");
    save_small_map(here_ / "ball", /*has_ball=*/true);
    fs::create_directories(here_ / "maps/no map");
    fs::create_directories(here_ / "maps/broken");
    std::ofstream(here_ / "maps/broken/map.json") << "{}";
    fs::create_directories(here_ / "maps/begun.unfinished");
    std::ofstream(here_ / "maps/begun.unfinished/work.json") << "{}";
  }
  [[nodiscard]] const MapEntry& entry(const std::vector<MapEntry>& maps, const std::string& path) const {
    const auto found = std::find_if(maps.begin(), maps.end(),
                                    [&](const MapEntry& map) { return map.folder == here_ / path; });
    EXPECT_NE(found, maps.end()) << path;
    return *found;
  }

  TemporaryFolder folder_;
  fs::path here_ = folder_.path();
};

TEST_F(MapList, FindsMapsAndInterruptedScans) {
  const std::vector<MapEntry> maps = list_maps(here_);
  ASSERT_EQ(maps.size(), 4U);
  EXPECT_EQ(entry(maps, "maps/wall").fault, "");
  EXPECT_EQ(entry(maps, "ball").fault, "");
  EXPECT_NE(entry(maps, "maps/broken").fault.find("map.json"), std::string::npos);
  const MapEntry& begun = entry(maps, "maps/begun");
  EXPECT_FALSE(begun.is_saved);
  EXPECT_TRUE(begun.has_unfinished_scan);
  EXPECT_NE(begun.fault.find("Scan more"), std::string::npos);
  EXPECT_EQ(list_maps(here_ / "ball").size(), 1U);  // the folder itself
  EXPECT_TRUE(list_maps(here_ / "not here").empty());
}

TEST_F(MapList, NewestComeFirst) {
  const auto now = fs::file_time_type::clock::now();
  fs::last_write_time(here_ / "maps/wall/map.json", now + std::chrono::hours(2));
  fs::last_write_time(here_ / "ball/map.json", now + std::chrono::hours(1));
  const std::vector<MapEntry> maps = list_maps(here_);
  EXPECT_EQ(maps[0].folder, here_ / "maps/wall");
  EXPECT_EQ(maps[1].folder, here_ / "ball");
}

TEST_F(MapList, AMapIsMeasured) {
  const MapEntry map = describe_map(here_ / "maps/wall");
  EXPECT_EQ(map.source, "a wall");
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& file : fs::directory_iterator(map.folder)) {
    const std::string name = file.path().filename().string();
    if (name != "map.json" && !name.starts_with("visits")) bytes += file.file_size();  // not earlier revisions
  }
  EXPECT_EQ(map.bytes, bytes);
  // The camera sees 160 / 145 * 2.01 m of the wall in width.
  EXPECT_NEAR(map.size_m.y(), 160.0 / 145.0 * 2.01, 0.05);
  const MapDetails details = examine_map(map.folder, 200, {0, 0, 0});
  EXPECT_EQ(details.fault, "");
  EXPECT_NEAR(details.surface_m2, 160.0 * 120.0 / 145.0 / 145.0 * 2.01 * 2.01, 0.2);
  EXPECT_FALSE(details.floor_m2.has_value());
  EXPECT_EQ(details.picture.width, 200);
  EXPECT_EQ(fact(map, &details, "floor"), "not found");
  EXPECT_EQ(fact(map, nullptr, "surface"), "being measured");
  EXPECT_EQ(fact(map, &details, "from"), "a wall");
  MapEntry extended = map;
  extended.source = "a wall; another; kinect:0";
  EXPECT_EQ(fact(extended, &details, "from"), "a wall and 2 more");
}

TEST_F(MapList, ABallHidesSpaceWhichIsAHole) {
  EXPECT_EQ(examine_map(here_ / "maps/wall", 100, {}).holes, 0U);
  const MapDetails ball = examine_map(here_ / "ball", 100, {});
  EXPECT_GE(ball.holes, 1U);
  EXPECT_GT(ball.largest_hole_m2, 0.02);
  const std::string all = std::to_string(ball.holes + ball.outer_holes) + ", ";
  EXPECT_EQ(fact(describe_map(here_ / "ball"), &ball, "holes")
                .find(all + std::to_string(ball.holes) + " inside the scan, the largest "),
            0U);
}

TEST_F(MapList, ADamagedPartIsNamed) {
  std::ofstream(here_ / "ball/mesh.ply", std::ios::app) << "x";
  EXPECT_NE(examine_map(here_ / "ball", 100, {}).fault.find("mesh.ply"), std::string::npos);
}

}  // namespace
}  // namespace roomradar::test::map_list_test
