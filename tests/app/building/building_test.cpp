// building_test.cpp: lists of recordings, words of jobs, and tileset.json.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "app/building/building_stages.hpp"
#include "app/building/recording_list.hpp"
#include "app/building/tileset.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::building_test {
namespace {

namespace fs = std::filesystem;

std::vector<ListedRecording> listed(const test::TemporaryFolder& folder, const std::string& text) {
  write_bytes(folder.path() / "list.txt", text);
  return read_recording_list(folder.path() / "list.txt");
}

TEST(RecordingList, IsSortedByName) {
  const test::TemporaryFolder folder;
  const auto recordings = listed(folder, "# a comment\n\n  b : rooms/b \r\na: sim:building?walk=1&rooms=4\n");
  ASSERT_EQ(recordings.size(), 2U);
  EXPECT_EQ(recordings[0].name, "a");
  EXPECT_EQ(recordings[0].source, "sim:building?walk=1&rooms=4") << "only the first colon separates";
  EXPECT_EQ(recordings[1].source, "rooms/b");
}

TEST(RecordingList, SaysWhatIsWrongAndWhere) {
  const test::TemporaryFolder folder;
  for (const char* wrong :
       {"", "# nothing\n", "no colon\n", ": x\n", "a:\n", "a b: x\n", "../a: x\n", "a: x\na: y\n"})
    EXPECT_THROW(static_cast<void>(listed(folder, wrong)), Error) << wrong;
  EXPECT_NE(test::error_of([&] { (void)listed(folder, "a: x\nb\n"); }).find("line 2"), std::string::npos);
  EXPECT_NE(test::error_of([&] { (void)listed(folder, "a: x\na: y\n"); }).find("'a'"), std::string::npos);
  EXPECT_THROW(static_cast<void>(read_recording_list(folder.path() / "missing.txt")), Error);
}

TEST(BuildingStages, SourcesAreRelativeToTheJobsAndBracesStay) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path() / "recordings" / "it's {one}");
  BuildingWork work;
  work.folder = folder.path() / "building";
  work.list_folder = folder.path();
  work.recordings = {{"a", "recordings/it's {one}"}, {"b", "sim:table?seed=2"}};
  const Manifest manifest = track_stage(work);
  ASSERT_EQ(manifest.jobs.size(), 2U);
  EXPECT_EQ(manifest.jobs[0].name, "track-a");
  const std::vector<WordPart> source = parts_of(manifest.jobs[0].words.at(2));
  ASSERT_EQ(source.size(), 1U);
  EXPECT_EQ(source[0].text, "../../recordings/it's {one}");
  EXPECT_EQ(manifest.jobs[1].words.at(2), "sim:table?seed=2");
  work.recordings[0].source = "both ' and \"";
  EXPECT_THROW(static_cast<void>(track_stage(work)), Error);
}

BuildingInfo building_of(const std::vector<TileIndex>& tiles) {
  BuildingInfo info;
  info.recordings = {{"a", "sim:table", 10, 9, 3, 9}};
  for (const TileIndex& index : tiles) {
    BuildingTile tile;
    tile.index = index;
    tile.triangles = 7;
    tile.surface_world = box_of(info.grid, index);
    tile.mesh_origin = tile.surface_world.min();
    for (ContentFile* file : {&tile.octree, &tile.mesh, &tile.glb, &tile.unknown})
      *file = {"tiles/" + name_of(index) + ".x", std::string(64, 'a'), 12};
    info.tiles.push_back(tile);
  }
  return info;
}

/// Checks that a node's box holds its children's, and collects the leaves' contents.
Eigen::AlignedBox3d check_node(const nlohmann::json& node, const Eigen::Vector3d& offset,
                               std::set<std::string>& contents) {
  const auto& box = node.at("boundingVolume").at("box");
  const Eigen::Vector3d middle(box.at(0), box.at(1), box.at(2)), half(box.at(3), box.at(7), box.at(11));
  Eigen::Vector3d own = offset;
  if (node.contains("transform")) {
    const auto& t = node.at("transform");
    own += Eigen::Vector3d(t.at(12), t.at(13), t.at(14));
  }
  const Eigen::AlignedBox3d volume(middle - half + own, middle + half + own);
  if (node.contains("content")) contents.insert(node.at("content").at("uri").get<std::string>());
  if (node.contains("children"))
    for (const auto& child : node.at("children")) {
      const Eigen::AlignedBox3d inner = check_node(child, own, contents);
      EXPECT_TRUE(
          Eigen::AlignedBox3d(volume.min().array() - 1e-9, volume.max().array() + 1e-9).contains(inner));
      EXPECT_LT(child.at("geometricError").get<double>(), node.at("geometricError").get<double>());
    }
  return volume;
}

TEST(BuildingStages, OnePartAloneHasNoPairs) {
  const test::TemporaryFolder folder;
  BuildingWork work;
  work.folder = folder.path();
  EXPECT_TRUE(join_stage(work, {{"a", 0}}, {}).jobs.empty());
  EXPECT_EQ(join_stage(work, {{"a", 0}, {"b", 0}}, {{0, 1, 2}}).jobs.size(), 1U);
}

TEST(Tileset, NestsBoxesRoundAllTilesOnBothSidesOfTheOrigin) {
  const test::TemporaryFolder folder;
  const std::vector<TileIndex> tiles{{-3, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {5, 2, 1}};
  write_tileset(building_of(tiles), folder.path());
  std::ifstream file(folder.path() / "tileset.json");
  const nlohmann::json tileset = nlohmann::json::parse(file);
  EXPECT_EQ(tileset.at("asset").at("version"), "1.1");
  std::set<std::string> contents;
  (void)check_node(tileset.at("root"), Eigen::Vector3d::Zero(), contents);
  EXPECT_EQ(contents.size(), tiles.size());
  write_tileset(building_of({{0, 0, 0}}), folder.path());
  write_tileset(building_of({}), folder.path());  // no tiles: still a valid file
}

TEST(BuildingInfo, IsReadAsWrittenAndRefusedIfDamaged) {
  const test::TemporaryFolder folder;
  BuildingInfo info = building_of({{-3, 0, 0}, {5, 2, 1}});
  LookAlike twin{{1.0, 2.0, 1.5}, Eigen::Isometry3d(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()))};
  twin.T_other_this.translation().z() = 3.0;
  info.look_alikes.push_back(twin);
  write_building(info, folder.path());
  ASSERT_TRUE(is_building(folder.path()));
  const BuildingInfo read = read_building(folder.path());
  ASSERT_EQ(read.tiles.size(), 2U);
  EXPECT_EQ(read.tiles[1].index, info.tiles[1].index);
  EXPECT_EQ(read.tiles[1].surface_world.min(), info.tiles[1].surface_world.min());
  EXPECT_EQ(read.recordings[0].frames_tracked, 9);
  ASSERT_EQ(read.look_alikes.size(), 1U);
  EXPECT_EQ(read.look_alikes[0].p_world, twin.p_world);
  EXPECT_TRUE(read.look_alikes[0].T_other_this.isApprox(twin.T_other_this, 1e-12));
  const fs::path path = folder.path() / kBuildingFile;
  const std::string text = read_bytes(path, "json");
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string damaged = text;
    const std::size_t at = damaged.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_bytes(path, damaged.replace(at, from.size(), to));
    EXPECT_NE(test::error_of([&] { (void)read_building(folder.path()); }).find(kBuildingFile),
              std::string::npos)
        << to;
  };
  refused("\"format\": 1", "\"format\": 2");
  refused("tiles/-3_0_0.x", "../../etc/passwd");
  refused("tiles/-3_0_0.x", "/etc/passwd");
  refused("aaaa", "zzzz");
  refused("\"other_rotation_xyzw\": [\n    0.0", "\"other_rotation_xyzw\": [\n    7.0");
  refused("\"-3_0_0\"", "\"9_9_9\"");  // out of order
  refused("\"resolution_m\": 0.01", "\"resolution_m\": -1");
  refused("\"tiles\"", "\"other\"");
  refused("{", "");
}

}  // namespace
}  // namespace roomradar::building_test
