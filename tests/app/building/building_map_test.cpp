// building_map_test.cpp: what is said of a building, its checks, and its tiles as one mesh and one octree.
#include "mapping/building/building_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "app/building/building_check.hpp"
#include "app/building/building_map_commands.hpp"
#include "app/building/building_summary.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/saved_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::building_map_test {
namespace {

namespace fs = std::filesystem;

class BuildingMap : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = new test::TemporaryFolder;
    (void)test::write_small_building(made_->path(), "sim:table?seed=1&frames=40&rate=5&width=160");
  }
  static void TearDownTestSuite() { delete made_; }
  void SetUp() override {
    fs::copy(made_->path(), folder_, fs::copy_options::recursive);
    info_ = read_building(folder_);
  }

  inline static test::TemporaryFolder* made_ = nullptr;
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path() / "building";
  BuildingInfo info_;
};

TEST_F(BuildingMap, SharedVerticesOfTilesBecomeOne) {
  ASSERT_GT(info_.tiles.size(), 3U);
  std::size_t vertices = 0, triangles = 0, open_in_tiles = 0;
  const auto open_edges = [](const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& of) { return of.second == 1; }));
  };
  for (const BuildingTile& tile : info_.tiles) {
    const Mesh mesh = read_tile_mesh(folder_ / tile.mesh.name);
    vertices += mesh.vertices.size();
    triangles += mesh.triangles.size();
    open_in_tiles += open_edges(mesh);
  }
  const Mesh whole = load_building_mesh(info_, folder_);
  EXPECT_EQ(whole.triangles.size(), triangles);
  EXPECT_LT(whole.vertices.size(), vertices);
  EXPECT_LT(open_edges(whole), open_in_tiles) << "the seams are closed";
  // No two vertices of different indices at one place lie on the border.
  std::map<std::array<float, 6>, int> uses;
  for (const Triangle& t : whole.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<float, 3> a{}, b{};
      Eigen::Vector3f::Map(a.data()) = whole.vertices[t[k]];
      Eigen::Vector3f::Map(b.data()) = whole.vertices[t[(k + 1) % 3]];
      if (b < a) std::swap(a, b);
      ++uses[{a[0], a[1], a[2], b[0], b[1], b[2]}];
    }
  EXPECT_EQ(open_edges(whole), static_cast<std::size_t>(std::count_if(
                                   uses.begin(), uses.end(), [](const auto& of) { return of.second == 1; })));
  EXPECT_EQ(whole.colours.size(), whole.vertices.size());
}

TEST_F(BuildingMap, OctreesOfTilesAddUpToTheWhole) {
  const StaticMap whole = load_building_octree(info_, folder_);
  std::size_t samples = 0;
  for (const BuildingTile& tile : info_.tiles)
    StaticMap::read(folder_ / tile.octree.name).visit_samples([&](const SurfaceSample&) { ++samples; });
  std::size_t whole_samples = 0;
  whole.visit_samples([&](const SurfaceSample&) { ++whole_samples; });
  EXPECT_GT(samples, 1000U);
  EXPECT_EQ(whole_samples, samples);
}

TEST_F(BuildingMap, IsDescribedWithItsFloor) {
  const BuildingSummary summary = summarise_building(folder_);
  ASSERT_GE(summary.floors.size(), 1U);
  EXPECT_NEAR(summary.floors.front().height_m, 0.0, 0.05);
  EXPECT_GT(summary.floors.front().area_m2, 1.0);
  const auto json = json_of(summary);
  EXPECT_EQ(json.at("tiles").size(), info_.tiles.size());
  EXPECT_EQ(json.at("recordings").at(0).at("frames_placed"), info_.recordings[0].frames_placed);
  EXPECT_NE(describe(summary).find("floors"), std::string::npos);
}

TEST_F(BuildingMap, EveryAlteredFileIsNamed) {
  EXPECT_EQ(verify_building(folder_), std::vector<std::string>{});
  const std::string file = info_.tiles.front().octree.name;
  std::string bytes = read_bytes(folder_ / file, "octree");
  bytes[bytes.size() / 2] ^= 1;
  write_bytes(folder_ / file, bytes);
  ASSERT_EQ(verify_building(folder_).size(), 1U);
  EXPECT_NE(verify_building(folder_)[0].find(file), std::string::npos);
  write_bytes(folder_ / info_.recordings[0].keyframe_file.name, "short");
  fs::remove(folder_ / info_.tiles.back().glb.name);
  write_bytes(folder_ / kTilesetFile, "{}\n");
  EXPECT_EQ(verify_building(folder_).size(), 4U);
}

TEST_F(BuildingMap, BordersOfUnknownSpaceAreCheckedWhereThereAreAny) {
  const ContentFile border = info_.tiles.front().unknown;
  EXPECT_EQ(json_of(summarise_building(folder_)).at("tiles").at(0).at("unknown"), border.name);
  const std::uintmax_t bytes = summarise_building(folder_).bytes;
  // The border of a far tile in place of a tile's own: only the content tells.
  std::swap(info_.tiles.front().unknown, info_.tiles.back().unknown);
  write_building(info_, folder_);
  const std::vector<std::string> faults = verify_building(folder_);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_NE(faults[1].find(border.name), std::string::npos) << faults[1];
  // A building of an earlier version has none.
  for (BuildingTile& tile : info_.tiles) tile.unknown = {};
  write_building(info_, folder_);
  EXPECT_EQ(verify_building(folder_), std::vector<std::string>{});
  EXPECT_LT(summarise_building(folder_).bytes, bytes);
  EXPECT_FALSE(json_of(summarise_building(folder_)).at("tiles").at(0).contains("unknown"));
}

TEST_F(BuildingMap, ContentThatContradictsTheListIsNamed) {
  ++info_.tiles.front().triangles;
  ++info_.recordings.front().keyframes;
  info_.grid.resolution_m = 0.02;  // another grid: voxels and unknown cells outside their tiles
  write_building(info_, folder_);
  write_tileset(info_, folder_);
  EXPECT_EQ(verify_building(folder_).size(), 2 * info_.tiles.size() + 2);
}

TEST_F(BuildingMap, IsExportedAndOtherFormatsAreRefused) {
  for (const char* name : {"all.ply", "all.glb", "all.stl", "all.obj", "all.bt", "all.ot", "plan.png"}) {
    EXPECT_EQ(run_on_building(MapExportOptions{folder_, temporary_.path() / name}), 0);
    EXPECT_GT(fs::file_size(temporary_.path() / name), 1000U) << name;
  }
  EXPECT_NE(test::error_of([&] {
              (void)run_on_building(MapExportOptions{folder_, temporary_.path() / "all.html"});
            }).find(".png"),
            std::string::npos);
}

TEST_F(BuildingMap, IsRefusedWhereARoomIsMeant) {
  EXPECT_NE(test::error_of([&] { (void)load_map(folder_); }).find("building"), std::string::npos);
}

TEST(BuildingFloors, AreLargeAndAStoreyApart) {
  const auto at = [](double height_m, double area_m2) {
    return LevelSurface{height_m, area_m2, {0.0, 0.0, height_m}};
  };
  const std::vector<LevelSurface> surfaces = {at(0.0, 20.0), at(0.02, 10.0), at(0.74, 4.0),
                                              at(2.9, 8.0),  at(3.7, 2.0),   at(5.5, 0.5)};
  const std::vector<BuildingFloor> floors = floors_among(surfaces);
  ASSERT_EQ(floors.size(), 2U);
  EXPECT_NEAR(floors[0].height_m, 0.02 / 3.0, 1e-9);
  EXPECT_NEAR(floors[0].area_m2, 30.0, 1e-9);
  EXPECT_NEAR(floors[1].height_m, 2.9, 1e-9);
  EXPECT_TRUE(floors_among({}).empty());
}

}  // namespace
}  // namespace roomradar::building_map_test
