// map_tasks_test.cpp: maps are renamed, deleted, exported and compared, or stay as they are.
#include "app/start/map_tasks.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/app/start/small_map.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::map_tasks_test {
namespace {

namespace fs = std::filesystem;

class MapTasks : public ::testing::Test {
 protected:
  MapTasks() { save_small_map(map_); }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(here_ / "maps"), fs::directory_iterator()));
  }

  TemporaryFolder folder_;
  fs::path here_ = folder_.path(), map_ = here_ / "maps/wall";
};

TEST_F(MapTasks, AProposedNameIsFree) {
  std::tm noon{};
  noon.tm_year = 126;
  noon.tm_mon = 10;
  noon.tm_mday = 26;
  noon.tm_hour = 12;
  noon.tm_isdst = -1;
  const std::time_t at = std::mktime(&noon);
  EXPECT_EQ(proposed_map_name(here_, at), "maps/room-2026-11-26");
  fs::create_directory(here_ / "maps/room-2026-11-26");
  fs::create_directory(here_ / "maps/room-2026-11-26-2.unfinished");
  EXPECT_EQ(proposed_map_name(here_, at), "maps/room-2026-11-26-3");
}

TEST_F(MapTasks, RenameMovesTheMapOrRefuses) {
  save_small_map(here_ / "maps/other");
  fs::create_directory(here_ / "maps/empty");
  fs::create_directory(here_ / "maps/begun.unfinished");
  for (const char* name : {"", ".", "..", "a/b", "/tmp/x", "other", "empty", "begun"})
    EXPECT_NE(error_of([&] { rename_map(map_, name); }), "") << name;
  EXPECT_EQ(entries(), 4U);
  EXPECT_EQ(rename_map(map_, "wall"), map_);
  const fs::path renamed = rename_map(map_, "my wall");
  EXPECT_EQ(renamed, here_ / "maps/my wall");
  EXPECT_TRUE(verify_map(renamed).empty());
  EXPECT_FALSE(fs::exists(map_));
  fs::create_directory(here_ / "maps/my wall.unfinished");
  EXPECT_NE(error_of([&] { rename_map(renamed, "third"); }).find("interrupted scan"), std::string::npos);
}

TEST_F(MapTasks, DeleteTakesMapsOnly) {
  const fs::path pictures = here_ / "maps/pictures";
  fs::create_directory(pictures);
  std::ofstream(pictures / "holiday.jpg") << "x";
  EXPECT_NE(error_of([&] { delete_map(pictures); }), "");
  std::ofstream(map_ / "notes.txt") << "x";
  EXPECT_NE(error_of([&] { delete_map(map_); }).find("notes.txt"), std::string::npos);
  EXPECT_TRUE(fs::exists(map_ / "mesh.ply"));
  EXPECT_TRUE(fs::exists(pictures / "holiday.jpg"));
  fs::remove(map_ / "notes.txt");
  fs::create_directory_symlink(map_, here_ / "maps/link");
  EXPECT_NE(error_of([&] { delete_map(here_ / "maps/link"); }).find("link"), std::string::npos);
  EXPECT_TRUE(fs::exists(map_ / "mesh.ply"));
  fs::remove(here_ / "maps/link");
  fs::create_directory(here_ / "maps/wall.unfinished");
  std::ofstream(here_ / "maps/wall.unfinished/work.json") << "{}";
  delete_map(map_);
  EXPECT_EQ(entries(), 1U);  // the pictures
}

TEST_F(MapTasks, ADamagedMapCanBeDeleted) {
  std::ofstream(map_ / "map.json") << "{}";
  delete_map(map_);
  EXPECT_EQ(entries(), 0U);
}

TEST_F(MapTasks, ExportsReplaceNothing) {
  EXPECT_EQ(export_beside(map_, ".ply"), here_ / "maps/wall.ply");
  const auto bytes = fs::file_size(here_ / "maps/wall.ply");
  EXPECT_GT(bytes, 1000U);
  EXPECT_EQ(export_beside(map_, ".ply"), here_ / "maps/wall-2.ply");
  EXPECT_EQ(export_beside(map_, ".glb"), here_ / "maps/wall.glb");
  std::ofstream(map_ / "mesh.ply", std::ios::app) << "x";
  EXPECT_NE(error_of([&] { export_beside(map_, ".glb"); }).find("mesh.ply"), std::string::npos);
  EXPECT_FALSE(fs::exists(here_ / "maps/wall-2.glb"));
}

TEST_F(MapTasks, CompareNamesWhatAppearedAndVanished) {
  const fs::path ball = here_ / "maps/ball";
  save_small_map(ball, /*has_ball=*/true);
  const std::vector<std::string> later = compare_maps(map_, ball);
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0].rfind("Appeared: ", 0), 0U) << later[0];
  EXPECT_NE(later[0].find("at x 1.0"), std::string::npos) << later[0];  // the side that the camera sees
  const std::vector<std::string> earlier = compare_maps(ball, map_);
  ASSERT_EQ(earlier.size(), 1U);
  EXPECT_EQ(earlier[0].rfind("Vanished: ", 0), 0U) << earlier[0];
  EXPECT_EQ(compare_maps(map_, map_), std::vector<std::string>{"Nothing appeared, nothing vanished."});
}

}  // namespace
}  // namespace roomradar::test::map_tasks_test
