// tile_surface_test.cpp: the tiles' surfaces together are the whole surface, without a crack.
#include "mapping/building/tile_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "mapping/building/building_info.hpp"
#include "mapping/mesh/components.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::tile_surface_test {
namespace {

constexpr double kResolution_m = 0.02;
const TileGrid kGrid{kResolution_m, 64};  // tiles of 1.28 m

/// The noisy room, seen from a path. Far walls are in coarse cells.
StaticMap room_map() {
  StaticMap map(kResolution_m);
  constexpr int kFrames = 24;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Isometry3d T_world_camera = test::on_path(i, kFrames);
    EXPECT_EQ(map.fuse(test::frame_at(T_world_camera, i), T_world_camera), FuseStatus::kFused);
  }
  return map;
}

using Point = std::array<double, 3>;
using PointTriangle = std::array<Point, 3>;

Point point_of(const Mesh& mesh, std::uint32_t vertex) {
  const Eigen::Vector3d p = mesh.origin + mesh.vertices[vertex].cast<double>();
  return {p.x(), p.y(), p.z()};
}

/// The triangle with its least corner first.
PointTriangle triangle_of(const Mesh& mesh, const Triangle& t) {
  PointTriangle corners{point_of(mesh, t[0]), point_of(mesh, t[1]), point_of(mesh, t[2])};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::vector<Mesh> tile_surfaces(const StaticMap& map, const SurfaceConfig& config) {
  std::vector<Mesh> surfaces;
  for (const TileIndex& tile : tiles_of(map, kGrid, kSurfaceReach_voxels)) {
    // Only what the tile may know.
    StaticMap part(kResolution_m);
    part.add_evidence(map, lowest_voxel(kGrid, tile) - VoxelIndex::Constant(kSurfaceReach_voxels),
                      kGrid.edge_voxels + 2 * kSurfaceReach_voxels);
    surfaces.push_back(extract_tile_surface(part, kGrid, tile, config));
  }
  return surfaces;
}

Mesh whole_surface(const StaticMap& map, const SurfaceConfig& config) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(map.reach_m());
  return drop_small_components(extract_full_surface(map, {-reach, reach}, config),
                               config.min_component_area_m2);
}

TEST(TileSurface, TilesTogetherAreTheWholeSurfaceToTheBit) {
  const StaticMap map = room_map();
  SurfaceConfig config;
  config.max_deviation_m = 0.0F;
  std::map<PointTriangle, int> count;
  const Mesh whole = whole_surface(map, config);
  for (const Triangle& t : whole.triangles) ++count[triangle_of(whole, t)];
  int tiles = 0;
  for (const Mesh& tile : tile_surfaces(map, config)) {
    tiles += tile.triangles.empty() ? 0 : 1;
    for (const Triangle& t : tile.triangles) --count[triangle_of(tile, t)];
  }
  ASSERT_GT(tiles, 8);
  ASSERT_GT(count.size(), 10'000U);
  for (const auto& [triangle, left] : count)
    ASSERT_EQ(left, 0) << (left > 0 ? "missing at " : "twice or another at ") << triangle[0][0] << " "
                       << triangle[0][1] << " " << triangle[0][2];
}

/// Edges with one triangle, after vertices of equal coordinates were merged.
std::set<std::pair<Point, Point>> border_of(const std::vector<Mesh>& meshes) {
  std::map<std::pair<Point, Point>, int> uses;
  for (const Mesh& mesh : meshes)
    for (const Triangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        ++uses[std::minmax(point_of(mesh, t[k]), point_of(mesh, t[(k + 1) % 3]))];
  std::set<std::pair<Point, Point>> border;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count == 1) border.insert(edge);
  }
  return border;
}

TEST(TileSurface, SimplifiedTilesMeetWithoutACrack) {
  const StaticMap map = room_map();
  const SurfaceConfig config;
  const std::vector<Mesh> tiles = tile_surfaces(map, config);
  const Mesh whole = whole_surface(map, config);
  std::size_t triangles = 0;
  std::map<Point, int> tiles_at;  // by vertex: the tiles that have it
  for (const Mesh& tile : tiles) {
    triangles += tile.triangles.size();
    for (std::uint32_t v = 0; v < tile.vertices.size(); ++v) ++tiles_at[point_of(tile, v)];
  }
  EXPECT_LT(triangles, whole.triangles.size() / 2) << "inside, tiles are simplified";
  const auto seam = [&](const Point& p) { return tiles_at[p] > 1; };
  const std::set<std::pair<Point, Point>> whole_border = border_of({whole});
  std::size_t on_seam = 0;
  for (const auto& [point, count] : tiles_at) on_seam += count > 1 ? 1 : 0;
  ASSERT_GT(on_seam, 500U);
  // An open edge between two vertices of the seam must be open in the whole surface, too.
  for (const auto& edge : border_of(tiles)) {
    if (!seam(edge.first) || !seam(edge.second)) continue;
    ASSERT_TRUE(whole_border.contains(edge)) << edge.first[0] << " " << edge.first[1] << " " << edge.first[2];
  }
}

TEST(TileSurface, AnEmptyMapHasNoTilesAndNoSurface) {
  const StaticMap map(kResolution_m);
  EXPECT_TRUE(tiles_of(map, kGrid, kSurfaceReach_voxels).empty());
  EXPECT_TRUE(extract_tile_surface(map, kGrid, TileIndex::Zero()).triangles.empty());
}

TEST(TileGrid, NamesAndPlaces) {
  for (const TileIndex& tile : {TileIndex(0, 0, 0), TileIndex(-3, 12, -1)}) {
    EXPECT_EQ(tile_of_name(name_of(tile)), tile);
    EXPECT_EQ(tile_at(kGrid, box_of(kGrid, tile).center()), tile);
    EXPECT_EQ(tile_at(kGrid, box_of(kGrid, tile).min()), tile) << "the lower sides belong to the cube";
  }
  EXPECT_LT(box_of(kGrid, TileIndex::Zero()).min().z(), -0.1) << "the floor is not cut along its length";
  for (const char* wrong :
       {"", "1", "1_2", "1_2_", "1_2_3_4", "+1_2_3", "01_2_3", "1_2_3 ", "a_b_c", "1__2", "99999999999_0_0"})
    EXPECT_THROW(static_cast<void>(tile_of_name(wrong)), Error) << wrong;
  for (const int edge : {0, -64, 32, 65, 8192})
    EXPECT_THROW(require_valid(TileGrid{0.01, edge}), Error) << edge;
  EXPECT_NO_THROW(require_valid(TileGrid{}));
}

TEST(TileMesh, IsReadAsWrittenAndRefusedIfDamaged) {
  const test::TemporaryFolder folder;
  SurfaceConfig config;
  StaticMap map(kResolution_m);
  const Eigen::Isometry3d T_world_camera = test::on_path(0, 2);
  (void)map.fuse(test::frame_at(T_world_camera, 0), T_world_camera);
  const Mesh mesh = extract_surface(map, config);
  const std::filesystem::path path = folder.path() / "tile.mesh";
  write_tile_mesh(mesh, path);
  const Mesh read = read_tile_mesh(path);
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.origin, mesh.origin);
  Mesh wrong = mesh;
  wrong.triangles.front()[1] = static_cast<std::uint32_t>(mesh.vertices.size());
  write_tile_mesh(wrong, path);
  EXPECT_THROW(static_cast<void>(read_tile_mesh(path)), Error) << "a triangle without a vertex";
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(static_cast<void>(read_tile_mesh(path)), Error) << "cut short";
}

}  // namespace
}  // namespace roomradar::tile_surface_test
