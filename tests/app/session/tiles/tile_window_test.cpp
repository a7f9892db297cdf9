// tile_window_test.cpp: sessions in a small building of two rooms: tiles come and go, objects stay.
#include "app/session/tiles/tile_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "app/objects/teapot.hpp"
#include "app/session/session.hpp"
#include "mapping/building/building_map.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/saved_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::tile_window_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// A building of two rooms, with tiles of 2.56 m, and the frames of the walk through both.
struct Building {
  test::TemporaryFolder folder;
  std::vector<Frame> frames;

  Building() : frames(test::write_small_building(folder.path(), "sim:building?rooms=2&width=160&rate=8")) {}
};

const Building& building() {
  static const Building made;
  return made;
}

Vector3d position(const Frame& frame) { return frame.T_world_camera->translation(); }

/// Returns the index of the frame whose camera is the farthest from the first one.
std::size_t farthest_frame() {
  const std::vector<Frame>& frames = building().frames;
  std::size_t farthest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if ((position(frames[i]) - position(frames[0])).norm() >
        (position(frames[farthest]) - position(frames[0])).norm())
      farthest = i;
  return farthest;
}

TileWindowConfig window_config(const fs::path& folder) {
  TileWindowConfig config;
  config.folder = folder;
  config.building = read_building(folder);
  config.choice.reach_m = 1.5;  // far less than the building
  config.choice.keep_m = 0.5;
  config.apply_after_s = 0.2;
  return config;
}

SessionConfig session_config(const TileWindowConfig& tiles, PoseOrigin poses) {
  SessionConfig config;
  config.poses = poses;
  config.make_picture = false;
  config.tiles = tiles;
  return config;
}

/// A session in the building, with frames at 8 per second of its own clock.
class BuildingSession {
 public:
  BuildingSession(const TileWindowConfig& tiles, PoseOrigin poses) : folder_(tiles.folder) {
    if (poses == PoseOrigin::kTracked)
      map_.keyframe_database = load_building_keyframes(tiles.building, tiles.folder);
    for (const BuildingTile& tile : tiles.building.tiles)
      map_.info.counts.known_world.extend(tile.surface_world);
    session = std::make_unique<Session>(map_, session_config(tiles, poses));
  }

  FrameResult show(const Frame& of) {
    Frame frame = of;
    frame.stamp_s = 0.125 * static_cast<double>(shown_++);
    return session->step(frame, times);
  }
  FrameResult show(std::size_t frame) { return show(building().frames.at(frame)); }

  std::unique_ptr<Session> session;
  StageTimes times;

 private:
  fs::path folder_;
  SavedMap map_;
  int shown_ = 0;
};

std::vector<std::size_t> loaded_tiles(const Session& session) {
  std::vector<std::size_t> loaded;
  for (const auto& tile : session.building()->tiles().tiles()) loaded.push_back(tile->index);
  return loaded;
}

/// Returns a point of the floor's surface near the camera, and its tile.
struct FloorPlace {
  Vector3d point_world;
  std::size_t tile;
};
FloorPlace floor_below(const Session& session, const Vector3d& camera_world) {
  FloorPlace best{Vector3d::Constant(1e9), 0};
  for (const auto& tile : session.building()->tiles().tiles()) {
    const TriangleTree& tree = tile->shape.touched;
    for (const Triangle& t : tree.triangles()) {
      const auto vertex = [&](std::uint32_t v) -> Vector3d {
        return tree.origin() + tree.vertices()[v].cast<double>();
      };
      const Vector3d a = vertex(t[0]), b = vertex(t[1]), c = vertex(t[2]);
      const Vector3d normal = (b - a).cross(c - a).normalized(), middle = (a + b + c) / 3.0;
      if (normal.z() < 0.99 || middle.z() > camera_world.z() - 1.0) continue;
      if ((middle - camera_world).norm() < (best.point_world - camera_world).norm())
        best = {middle, tile->index};
    }
  }
  return best;
}

TEST(TileWindow, AnObjectStaysToTheBitWhileItsTileIsGone) {
  TileWindowConfig tiles = window_config(building().folder.path());
  tiles.choice.has_unknown = false;
  BuildingSession run(tiles, PoseOrigin::kRecorded);
  for (int i = 0; i < 40; ++i) (void)run.show(0);
  const FloorPlace place = floor_below(*run.session, position(building().frames[0]));
  ASSERT_LT(place.point_world.norm(), 1e3);
  run.session->add_object("pot", utah_teapot(4, 0.2));
  run.session->add_object("falling", utah_teapot(4, 0.2));
  run.session->place("pot", {.position_world = place.point_world + Vector3d(0.0, 0.0, 0.1)});
  for (int i = 0; i < 40; ++i) (void)run.show(0);
  const VirtualObject& pot = *run.session->objects()[0];
  const VirtualObject& falling = *run.session->objects()[1];
  ASSERT_TRUE(pot.body.asleep);
  const Eigen::Isometry3d T_world_pot = pot.body.T_world_object;

  const std::size_t far = farthest_frame();
  for (std::size_t i = 0; i <= far; ++i) (void)run.show(i);
  for (int i = 0; i < 40; ++i) (void)run.show(far);
  const std::vector<std::size_t> there = loaded_tiles(*run.session);
  EXPECT_EQ(std::find(there.begin(), there.end(), place.tile), there.end())
      << "the pot's tile is still loaded";
  EXPECT_GT(run.session->building()->tiles().counts().dropped, 0);
  EXPECT_TRUE(pot.in_room);
  EXPECT_EQ(pot.departures, 0);
  EXPECT_EQ(pot.body.T_world_object.matrix(), T_world_pot.matrix());
  // An object put where no tile is loaded does not move either, although it hangs in the air.
  run.session->place("falling", {.position_world = place.point_world + Vector3d(0.5, 0.0, 0.4)});
  for (int i = 0; i < 20; ++i) (void)run.show(far);
  const Vector3d hangs_at = falling.body.T_world_object.translation();
  EXPECT_EQ(hangs_at.z(), place.point_world.z() + 0.4);

  for (std::size_t i = far + 1; i-- > 0;) (void)run.show(i);
  for (int i = 0; i < 60; ++i) (void)run.show(0);
  const std::vector<std::size_t> back = loaded_tiles(*run.session);
  EXPECT_NE(std::find(back.begin(), back.end(), place.tile), back.end());
  EXPECT_TRUE(pot.body.asleep);
  EXPECT_EQ(pot.body.T_world_object.matrix(), T_world_pot.matrix());
  EXPECT_LT(falling.body.T_world_object.translation().z(), hangs_at.z() - 0.05)
      << "falls once its tile is back";
  EXPECT_TRUE(falling.in_room);
}

TEST(TileWindow, NothingCountsAsMovedWhereNoTileIsLoaded) {
  TileWindowConfig tiles = window_config(building().folder.path());
  tiles.choice.reach_m = 0.3;  // the camera's own tile, hardly more
  BuildingSession run(tiles, PoseOrigin::kRecorded);
  std::size_t moved = 0, valid = 0;
  for (std::size_t i = 0; i < building().frames.size(); ++i) {
    const FrameResult result = run.show(i);
    moved += result.foreground.moved;
    valid += result.foreground.valid;
    EXPECT_LT(loaded_tiles(*run.session).size(), tiles.building.tiles.size());
  }
  ASSERT_GT(valid, 0U);
  // 0.0011 of them are edges that the map has some pixels off.
  EXPECT_LT(static_cast<double>(moved), 0.0012 * static_cast<double>(valid));
}

TEST(TileWindow, IsLocatedInBothRoomsAlsoAfterAJump) {
  TileWindowConfig tiles = window_config(building().folder.path());
  tiles.choice.reach_m = 4.0;  // the depth in reach must constrain the pose
  BuildingSession run(tiles, PoseOrigin::kTracked);
  int located = 0, wrong = 0;
  const std::size_t far = farthest_frame();
  for (const std::size_t begin : {std::size_t{0}, far, std::size_t{10}, far / 2}) {
    int located_here = 0;
    for (std::size_t i = begin; i < begin + 40 && i < building().frames.size(); ++i) {
      const FrameResult result = run.show(i);
      if (result.status != FrameStatus::kDone) continue;
      ++located_here;
      const Vector3d error_m = result.T_world_camera.translation() - position(building().frames[i]);
      if (error_m.norm() > 0.1) ++wrong;
    }
    EXPECT_GT(located_here, 10) << "from frame " << begin;
    located += located_here;
  }
  EXPECT_EQ(wrong, 0) << "of " << located;
}

TEST(TileWindow, IsNeverWrongWhereMemoryHoldsFewTiles) {
  TileWindowConfig tiles = window_config(building().folder.path());
  tiles.choice.reach_m = 4.0;
  tiles.choice.max_bytes = 0;  // for the largest tile alone
  for (const BuildingTile& tile : tiles.building.tiles)
    tiles.choice.max_bytes =
        std::max(tiles.choice.max_bytes, tile_bytes(tile, true) + loading_bytes(tile, true));
  BuildingSession run(tiles, PoseOrigin::kTracked);
  int located = 0, wrong = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const FrameResult result = run.show(i);
    if (result.status != FrameStatus::kDone) continue;
    ++located;
    const Vector3d error_m = result.T_world_camera.translation() - position(building().frames[i]);
    if (error_m.norm() > 0.2) ++wrong;
  }
  EXPECT_GT(located, 0);
  EXPECT_EQ(wrong, 0) << "of " << located;  // 8 of 101 if poses without support are followed on
}

TEST(TileWindow, TooLittleMemoryIsToldOnce) {
  TileWindowConfig tiles = window_config(building().folder.path());
  tiles.choice.max_bytes = 1000;
  BuildingSession run(tiles, PoseOrigin::kTracked);
  std::string said;
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < 10; ++i) {
      const FrameResult result = run.show(i);
      EXPECT_NE(result.status, FrameStatus::kDone);
      for (const ObjectNotice& notice : result.notices) said += notice.text + "\n";
    }
  const std::size_t at = said.find("--max-memory");
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find("--max-memory", at + 1), std::string::npos) << said;
}

TEST(TileWindow, ResultsDoNotDependOnTheWorkersSpeed) {
  const TileWindowConfig tiles = window_config(building().folder.path());
  std::vector<std::vector<std::size_t>> loaded[2];
  std::vector<Eigen::Matrix4d> poses[2];
  for (int round = 0; round < 2; ++round) {
    BuildingSession run(tiles, PoseOrigin::kTracked);
    for (std::size_t i = 0; i < 80; ++i) {
      const FrameResult result = run.show(i);
      loaded[round].push_back(loaded_tiles(*run.session));
      poses[round].push_back(result.T_world_camera.matrix());
      if (round == 1 && i % 7 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  EXPECT_EQ(loaded[0], loaded[1]);
  EXPECT_EQ(poses[0], poses[1]);
}

TEST(TileWindow, DamagedAndMissingTilesAreNamedAndSurvived) {
  const test::TemporaryFolder copy;
  fs::copy(building().folder.path(), copy.path(), fs::copy_options::recursive);
  TileWindowConfig tiles = window_config(copy.path());
  const Vector3d start = position(building().frames[0]);
  std::vector<std::size_t> near =
      choose_tiles(tiles.building, start, Vector3d::Zero(), {},
                   std::vector<bool>(tiles.building.tiles.size(), false), tiles.choice);
  ASSERT_GE(near.size(), 4U);
  const std::string cut = tiles.building.tiles[near[0]].mesh.name;
  fs::resize_file(copy.path() / cut, fs::file_size(copy.path() / cut) / 2);
  const std::string missing = tiles.building.tiles[near[1]].unknown.name;
  fs::remove(copy.path() / missing);
  const std::string altered = tiles.building.tiles[near[2]].unknown.name;
  std::string bytes = read_bytes(copy.path() / altered, "unknown space");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  write_bytes(copy.path() / altered, bytes);

  // Octrees are not read.
  const std::size_t without_octree = near[3];
  fs::remove(copy.path() / tiles.building.tiles[without_octree].octree.name);

  BuildingSession run(tiles, PoseOrigin::kRecorded);
  std::string said;
  for (int i = 0; i < 60; ++i)
    for (const ObjectNotice& notice : run.show(0).notices) said += notice.text + "\n";
  for (const std::string& file : {cut, missing, altered}) {
    const std::size_t at = said.find(file);
    ASSERT_NE(at, std::string::npos) << file << " is not named in:\n" << said;
    EXPECT_EQ(said.find(file, at + 1), std::string::npos) << "is said once";
  }
  const std::vector<std::size_t> loaded = loaded_tiles(*run.session);
  EXPECT_GE(loaded.size(), near.size() - 3);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(std::find(loaded.begin(), loaded.end(), near[static_cast<std::size_t>(i)]), loaded.end());
  EXPECT_NE(std::find(loaded.begin(), loaded.end(), without_octree), loaded.end());
}

TEST(TileWindow, UnknownSpaceIsOpenTowardsNeighboursAndClosedElsewhere) {
  const fs::path folder = building().folder.path();
  const BuildingInfo info = read_building(folder);
  std::size_t inner = 0, outer = 0;
  for (std::size_t i = 0; i < info.tiles.size(); ++i) {
    const LoadedTile tile = load_tile(info, folder, i, true);
    const Eigen::AlignedBox3d cube = box_of(info.grid, info.tiles[i].index);
    EXPECT_TRUE(tile.mesh.normals.empty() && tile.mesh.colours.empty());
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const TileIndex beside = info.tiles[i].index + side * TileIndex::Unit(axis);
        const bool has_neighbour = std::any_of(info.tiles.begin(), info.tiles.end(),
                                               [&](const BuildingTile& t) { return t.index == beside; });
        const double face_m = (side < 0 ? cube.min() : cube.max())[axis];
        std::size_t beyond = 0;
        for (const Triangle& t : tile.unknown_tree.triangles())
          beyond += std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
            const double at_m =
                tile.unknown_tree.origin()[axis] + static_cast<double>(tile.unknown_tree.vertices()[v][axis]);
            return side * (at_m - face_m) > -0.001;
          });
        (has_neighbour ? inner : outer) += beyond;
      }
  }
  EXPECT_EQ(inner, 0U);
  EXPECT_GT(outer, 0U);
}

TEST(TileWindow, RefusesAPlaceInSpaceThatWasNotScanned) {
  BuildingSession run(window_config(building().folder.path()), PoseOrigin::kRecorded);
  for (int i = 0; i < 40; ++i) (void)run.show(0);
  run.session->make_unknown_solid(run.times);
  const FloorPlace place = floor_below(*run.session, position(building().frames[0]));
  run.session->add_object("pot", utah_teapot(4, 0.2));
  try {
    run.session->place("pot", {.position_world = place.point_world - Vector3d(0.0, 0.0, 0.5)});
    ADD_FAILURE() << "placed below the floor";
  } catch (const PlaceRefused& refused) {
    EXPECT_NE(std::string(refused.what()).find("that space was not scanned"), std::string::npos)
        << refused.what();
  }
  EXPECT_FALSE(run.session->objects()[0]->in_room);
}

TEST(TileWindow, RefusesWhatOnlyARoomCanDo) {
  const TileWindowConfig tiles = window_config(building().folder.path());
  SavedMap map;
  SessionConfig config = session_config(tiles, PoseOrigin::kTracked);
  config.map_updates.emplace();
  StaticMap octree(0.04);
  EXPECT_NE(test::error_of([&] { Session(map, config, &octree); }).find("commit changes"), std::string::npos);
  TileWindowConfig wrong = tiles;
  wrong.apply_after_s = -1.0;
  EXPECT_THROW(Session(map, session_config(wrong, PoseOrigin::kTracked)), Error);
  TileWindowConfig without = tiles;
  without.choice.has_unknown = false;
  BuildingSession run(without, PoseOrigin::kRecorded);
  EXPECT_THROW(run.session->make_unknown_solid(run.times), Error);
}

}  // namespace
}  // namespace roomradar::tile_window_test
