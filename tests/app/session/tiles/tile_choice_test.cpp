// tile_choice_test.cpp: which tiles are chosen, and what lies behind those that are not loaded.
#include "app/session/tiles/tile_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "app/session/tiles/unloaded_space.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::tile_choice_test {
namespace {

using Eigen::Vector3d;
using Chosen = std::vector<std::size_t>;

const Vector3d kStill = Vector3d::Zero();

/// A corridor of 20 tiles of 5.12 m along x, from x = 0.
BuildingInfo corridor() {
  BuildingInfo info;
  for (int x = 0; x < 20; ++x) {
    BuildingTile tile;
    tile.index = {x, 0, 0};
    tile.triangles = 100'000;
    tile.surface_world = box_of(info.grid, tile.index);
    tile.octree.bytes = 5'000'000;
    tile.mesh.bytes = 2'500'000;
    info.tiles.push_back(tile);
  }
  return info;
}

/// Position in the middle of a tile.
Vector3d in_tile(double x) { return {5.12 * (x + 0.5), 2.0, 1.0}; }

Chosen chosen_from(const BuildingInfo& info, const Vector3d& position, const Chosen& loaded,
                   const TileChoiceConfig& config, const Vector3d& velocity = kStill) {
  std::vector<bool> is_loaded(info.tiles.size(), false);
  for (const std::size_t tile : loaded) is_loaded[tile] = true;
  return choose_tiles(info, position, velocity, {}, is_loaded, config);
}

TEST(TileChoice, TakesTheTilesWithinReachNearestFirst) {
  const BuildingInfo info = corridor();
  // 2.56 m to the next tiles, 7.68 m to those behind them, 12.8 m to the third ones.
  EXPECT_EQ(chosen_from(info, in_tile(10), {}, {.reach_m = 8.0}), (Chosen{10, 9, 11, 8, 12}));
  EXPECT_EQ(chosen_from(info, in_tile(10), {}, {.reach_m = 2.0}), (Chosen{10}));
  EXPECT_TRUE(chosen_from(info, {0.0, 500.0, 0.0}, {}, {}).empty());
}

TEST(TileChoice, LooksAheadOfTheMotion) {
  const BuildingInfo info = corridor();
  const TileChoiceConfig config{.reach_m = 4.0, .ahead_s = 2.0};
  EXPECT_EQ(chosen_from(info, in_tile(10), {}, config), (Chosen{10, 9, 11}));
  const Chosen ahead = chosen_from(info, in_tile(10), {}, config, {2.0, 0.0, 0.0});
  EXPECT_NE(std::find(ahead.begin(), ahead.end(), 12), ahead.end()) << "4 m further, 12 is 3.7 m away";
}

TEST(TileChoice, KeepsLoadedTilesALittleLonger) {
  const BuildingInfo info = corridor();
  const TileChoiceConfig config{.reach_m = 3.0, .keep_m = 2.0};
  const Vector3d gone = in_tile(10) + Vector3d(1.0, 0.0, 0.0);  // tile 9 is 3.56 m away
  const Chosen fresh = chosen_from(info, gone, {}, config);
  EXPECT_EQ(std::find(fresh.begin(), fresh.end(), 9), fresh.end());
  const Chosen kept = chosen_from(info, gone, {9, 10, 11}, config);
  EXPECT_NE(std::find(kept.begin(), kept.end(), 9), kept.end());
  const Chosen left = chosen_from(info, gone + Vector3d(2.0, 0.0, 0.0), {9, 10, 11}, config);  // 5.56 m
  EXPECT_EQ(std::find(left.begin(), left.end(), 9), left.end());
}

TEST(TileChoice, StaysWithinTheMemoryAlsoWhileATileIsLoaded) {
  const BuildingInfo info = corridor();
  const std::size_t tile = tile_bytes(info.tiles[0], true), loading = loading_bytes(info.tiles[0], true);
  EXPECT_GT(tile, tile_bytes(info.tiles[0], false));
  for (std::size_t fitting = 0; fitting <= 4; ++fitting) {
    const TileChoiceConfig config{.max_bytes = fitting * tile + loading};
    EXPECT_EQ(chosen_from(info, in_tile(10), {}, config).size(), fitting) << "of five in reach";
    const TileChoiceConfig less{.max_bytes = fitting * tile + loading - 1};
    EXPECT_EQ(chosen_from(info, in_tile(10), {}, less).size(), fitting == 0 ? 0 : fitting - 1);
  }
  // Loaded tiles need no memory for loading: all five stay.
  EXPECT_EQ(chosen_from(info, in_tile(10), {8, 9, 10, 11, 12}, {.max_bytes = 5 * tile}).size(), 5U);
}

TEST(TileChoice, TilesInViewComeFirst) {
  const BuildingInfo info = corridor();
  std::vector<Vector3d> points(6, in_tile(12));
  points.insert(points.end(), 93, in_tile(13));
  points.push_back(in_tile(15));
  const Vector3d behind(5.12 * 12.0 - 1.0, 500.0,
                        1.0);  // beside the corridor: rays enter it at the points' tiles
  const Chosen in_view = tiles_in_view(info, behind, points);
  EXPECT_EQ(in_view, (Chosen{13, 12})) << "one ray of 100 does not count";
  EXPECT_EQ(tiles_in_view(info, in_tile(10), points), (Chosen{10, 11, 12, 13}))
      << "rays pass through 10 and 11";
  EXPECT_TRUE(tiles_in_view(info, behind, {}).empty());
  const std::vector<bool> none(info.tiles.size(), false);
  EXPECT_EQ(choose_tiles(info, in_tile(10), kStill, in_view, none, {.reach_m = 3.0}),
            (Chosen{13, 12, 10, 9, 11}));
  const std::size_t two = 2 * tile_bytes(info.tiles[0], true) + loading_bytes(info.tiles[0], true);
  EXPECT_EQ(choose_tiles(info, in_tile(10), kStill, in_view, none, {.max_bytes = two}), in_view);
}

TEST(TileChoice, RefusesConfigsOutOfRange) {
  for (const TileChoiceConfig& wrong : {TileChoiceConfig{.reach_m = 0.0},
                                        TileChoiceConfig{.reach_m = std::numeric_limits<double>::quiet_NaN()},
                                        TileChoiceConfig{.keep_m = -1.0}, TileChoiceConfig{.ahead_s = 1e9}})
    EXPECT_THROW(require_valid(wrong), Error);
}

constexpr Intrinsics kCamera{80, 60, 70.0, 70.0, 39.5, 29.5};

/// Looks along the world's +x from the origin; the image's right is -y, its bottom -z.
Eigen::Isometry3d looking_along_x() {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear().col(0) = -Vector3d::UnitY();
  T_world_camera.linear().col(1) = -Vector3d::UnitZ();
  T_world_camera.linear().col(2) = Vector3d::UnitX();
  return T_world_camera;
}

DepthImage wall_at(float depth_m) {
  DepthImage depth(kCamera.width_px, kCamera.height_px);
  std::fill(depth.pixels.begin(), depth.pixels.end(), depth_m);
  return depth;
}

TEST(UnloadedSpace, HidesWhatIsBehindABoxOnly) {
  // From 3 to 4 m ahead, 0 < y < 5: the left half of the image.
  const Eigen::AlignedBox3d box(Vector3d(3.0, 0.0, -5.0), Vector3d(4.0, 5.0, 5.0));
  DepthImage far = wall_at(6.0F);
  hide_behind({&box, 1}, kCamera, looking_along_x(), far);
  EXPECT_EQ(far.at(10, 30), 0.0F);
  EXPECT_EQ(far.at(39, 30), 0.0F);
  EXPECT_EQ(far.at(40, 30), 6.0F) << "right of the box";
  DepthImage near = wall_at(2.9F);
  hide_behind({&box, 1}, kCamera, looking_along_x(), near);
  EXPECT_EQ(near.pixels, wall_at(2.9F).pixels) << "in front of the box";
  DepthImage inside = wall_at(3.5F);
  hide_behind({&box, 1}, kCamera, looking_along_x(), inside);
  EXPECT_EQ(inside.at(10, 30), 0.0F);
}

TEST(UnloadedSpace, FromWithinABoxNothingIsKnown) {
  const Eigen::AlignedBox3d round_camera(Vector3d(-1.0, -1.0, -1.0), Vector3d(1.0, 1.0, 1.0));
  DepthImage depth = wall_at(6.0F);
  hide_behind({&round_camera, 1}, kCamera, looking_along_x(), depth);
  EXPECT_EQ(depth.pixels, DepthImage(kCamera.width_px, kCamera.height_px).pixels);
  const Eigen::AlignedBox3d behind(Vector3d(-4.0, -1.0, -1.0), Vector3d(-2.0, 1.0, 1.0));
  DepthImage seen = wall_at(6.0F);
  hide_behind({&behind, 1}, kCamera, looking_along_x(), seen);
  EXPECT_EQ(seen.pixels, wall_at(6.0F).pixels);
  DepthImage none;
  hide_behind({&behind, 1}, kCamera, looking_along_x(), none);
  EXPECT_TRUE(none.pixels.empty());
}

}  // namespace
}  // namespace roomradar::tile_choice_test
