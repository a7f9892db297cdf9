// map_folder_test.cpp: a loaded map equals the saved one, and every damage is reported.
#include "mapping/map/map_folder.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>

#include "mapping/map/map_export.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/map_content.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::map_folder_test {
namespace {

using test::error_of;

namespace fs = std::filesystem;

SavedMap a_room() {
  constexpr Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};
  const Eigen::Isometry3d T_world_camera = test::looking_at({0, 0, 0}, {1, 0, 0});
  const test::Scene scene =
      test::nearest_of(test::sphere({1.2, 0.2, 0}, 0.3), test::plane(Eigen::Vector3d::UnitX(), 2.01));
  SavedMap map;
  map.octree = StaticMap(0.0234);
  map.octree.load().fuse(test::exact_frame(scene, kCamera, T_world_camera, Rgb{90, 60, 30}), T_world_camera);
  map.mesh = extract_surface(map.octree.load());
  MapKeyframe place;
  place.frame_index = 7;
  place.T_world_camera = T_world_camera;
  place.points_camera = {{0.1F, 0.2F, 1.5F}};
  place.descriptors = {Descriptor{1, 2, 3}};
  place.preview_camera = {4, 3, 4.0, 4.0, 1.5, 1.0};
  place.preview_depth_mm = {4, 3, 1500};
  map.keyframe_database.load().keyframes = {place};
  for (int i = 0; i < 5; ++i) {
    TimedPose pose{i, i / 30.0, T_world_camera};
    pose.T_world_camera.translation().y() = 0.01 * i;
    map.trajectory.push_back(pose);
  }
  map.info.source = "a test \"room\" in ünïcode";
  map.info.frames_read = 6;
  map.info.frames_fused = 5;
  map.info.up_source = "plane";
  map.info.T_world_recorded.linear() =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  map.info.settings = {{"poses", "recorded"}, {"hold_out", "10"}};
  return map;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
void put_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Returns the id of a process that has ended.
pid_t gone_process() {
  const pid_t gone = fork();
  if (gone == 0) std::_Exit(0);
  EXPECT_GT(gone, 0);
  EXPECT_EQ(waitpid(gone, nullptr, 0), gone);
  return gone;
}

class MapFolder : public ::testing::Test {
 protected:
  MapFolder() { save_map(map_, room_); }

  // Expects load_map, or the first use of all parts, to throw and verify_map to list a message that names the
  // file and the fault.
  void expect_fault(const std::string& file, const std::string& fault) {
    const std::string message = error_of([&] {
      const SavedMap map = load_map(map_);
      map.octree.load();
      map.unknown.load();
    });
    EXPECT_NE(message.find((map_ / file).string()), std::string::npos) << message;
    EXPECT_NE(message.find(fault), std::string::npos) << message;
    const std::vector<std::string> faults = verify_map(map_);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].find((map_ / file).string()), std::string::npos) << faults[0];
    EXPECT_NE(faults[0].find(fault), std::string::npos) << faults[0];
  }
  void edit_info(const std::string& from, const std::string& to) {
    std::string text = text_of(map_ / "map.json");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    put_text(map_ / "map.json", text.replace(at, from.size(), to));
  }
  // Turns the map into one of an earlier format version.
  void make_old(int version) {
    MapInfo info = load_map_info(map_);
    fs::remove(map_ / "octree.bin");
    info.files.erase("octree.bin");
    room_.octree.load().write_ot(map_ / "octree.ot");
    room_.octree.load().write_bt(map_ / "octree.bt");
    for (const char* name : {"octree.ot", "octree.bt"})
      info.files[name] = {fs::file_size(map_ / name), sha256_of_file(map_ / name)};
    info.format_version = version;
    put_text(map_ / "map.json", to_json(info));
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  test::TemporaryFolder folder_;
  fs::path map_ = folder_.path() / "room";
  SavedMap room_ = a_room();
};

TEST_F(MapFolder, ComesBackAsItWasSaved) {
  EXPECT_TRUE(verify_map(map_).empty());
  const SavedMap read = load_map(map_);
  EXPECT_EQ(read.info.source, room_.info.source);
  EXPECT_EQ(read.info.frames_read, 6);
  EXPECT_EQ(read.info.frames_fused, 5);
  EXPECT_EQ(read.info.up_source, "plane");
  EXPECT_EQ(read.info.settings, room_.info.settings);
  EXPECT_TRUE(read.info.T_world_recorded.isApprox(room_.info.T_world_recorded, 1e-15));
  EXPECT_EQ(read.info.resolution_m, 0.0234);
  EXPECT_EQ(read.info.triangles, room_.mesh.triangles.size());
  EXPECT_EQ(read.octree.load().resolution_m(), room_.octree.load().resolution_m());
  const MapCounts before = room_.octree.load().counts(), after = read.octree.load().counts();
  EXPECT_EQ(after.nodes, before.nodes);
  EXPECT_EQ(after.occupied_leaves, before.occupied_leaves);
  EXPECT_EQ(read.info.counts.free_leaves, before.free_leaves);
  EXPECT_TRUE(read.info.counts.occupied_world.isApprox(before.occupied_world));
  EXPECT_EQ(read.mesh.triangles, room_.mesh.triangles);
  EXPECT_EQ(read.mesh.colours, room_.mesh.colours);
  for (std::size_t i = 0; i < read.mesh.vertices.size(); ++i)
    ASSERT_LT(
        (read.mesh.vertices[i].cast<double>() - room_.mesh.origin - room_.mesh.vertices[i].cast<double>())
            .norm(),
        1e-6);
  ASSERT_EQ(read.keyframe_database.load().keyframes.size(), 1U);
  EXPECT_EQ(read.keyframe_database.load().keyframes[0].frame_index, 7);
  ASSERT_EQ(read.trajectory.size(), 5U);
  EXPECT_TRUE(read.trajectory[4].T_world_camera.isApprox(room_.trajectory[4].T_world_camera, 1e-9));
}

TEST_F(MapFolder, ThePictureOfCoverageComesBackAndMayBeMissing) {
  EXPECT_TRUE(load_map(map_).coverage_png.empty());
  EXPECT_FALSE(fs::exists(map_ / "coverage.png"));
  room_.coverage_png = {0x89, 'P', 'N', 'G', 0, 13, 10, 255};
  save_map(map_, room_);
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_EQ(load_map(map_).coverage_png, room_.coverage_png);
  put_text(map_ / "coverage.png", "PNG");
  expect_fault("coverage.png", "cut short");
  fs::remove(map_ / "coverage.png");
  expect_fault("coverage.png", "missing");
}

TEST_F(MapFolder, TheBorderOfUnknownSpaceIsSavedWithTheMapAndOldMapsHaveNone) {
  const SavedMap read = load_map(map_);
  ASSERT_TRUE(read.unknown.load());
  const UnknownSurface expected = unknown_surface(room_.octree.load(), room_.mesh);
  ASSERT_GT(expected.mesh_world.triangles.size(), 100U);
  EXPECT_EQ(read.unknown.load()->mesh_world.vertices, expected.mesh_world.vertices);
  EXPECT_EQ(read.unknown.load()->mesh_world.triangles, expected.mesh_world.triangles);
  EXPECT_TRUE(read.unknown.load()->unknown == expected.unknown);

  nlohmann::json info = nlohmann::json::parse(text_of(map_ / "map.json"));
  info["files"].erase("unknown.bin");
  put_text(map_ / "map.json", info.dump());
  fs::remove(map_ / "unknown.bin");
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_FALSE(load_map(map_).unknown.load());
}

TEST_F(MapFolder, SavingAgainReplacesTheMapAndLeavesNothingBeside) {
  room_.info.source = "another";
  save_map(map_, room_);
  EXPECT_EQ(load_map(map_).info.source, "another");
  EXPECT_EQ(entries(), 1U);
  save_map(map_ / "", room_);  // a trailing slash
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_EQ(entries(), 1U);
}

TEST_F(MapFolder, LitterOfDesktopsDoesNotHinder) {
  test::add_litter(map_);
  EXPECT_EQ(load_map(map_).info.source, room_.info.source);
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_NO_THROW(require_can_become_map(map_, {}));
  room_.info.source = "another";
  save_map(map_, room_);
  EXPECT_EQ(load_map(map_).info.source, "another");
  EXPECT_FALSE(fs::exists(map_ / ".DS_Store"));
  fs::create_directory(folder_.path() / "new");
  test::add_litter(folder_.path() / "new");
  EXPECT_NO_THROW(save_map(folder_.path() / "new", room_));
  put_text(map_ / ".gitignore", "mine");  // hidden, but not litter
  EXPECT_NE(error_of([&] { save_map(map_, room_); }).find(".gitignore"), std::string::npos);
}

TEST_F(MapFolder, FoldersThatAreNoMapsAreNeverOverwritten) {
  const fs::path own = folder_.path() / "photos";
  fs::create_directory(own);
  put_text(own / "holiday.jpg", "beach");
  EXPECT_NE(error_of([&] { save_map(own, room_); }).find("holiday.jpg"), std::string::npos);
  EXPECT_EQ(text_of(own / "holiday.jpg"), "beach");
  put_text(map_ / "notes.txt", "mine");  // a map folder with a file of the user's
  EXPECT_NE(error_of([&] { save_map(map_, room_); }).find("notes.txt"), std::string::npos);
  EXPECT_EQ(text_of(map_ / "notes.txt"), "mine");
  put_text(folder_.path() / "file", "text");
  EXPECT_NE(error_of([&] { save_map(folder_.path() / "file", room_); }).find("not a folder"),
            std::string::npos);
  EXPECT_THROW(save_map("", room_), Error);
  EXPECT_THROW(save_map(folder_.path() / "..", room_), Error);
  fs::create_directory(folder_.path() / "empty");
  EXPECT_NO_THROW(save_map(folder_.path() / "empty", room_));
}

TEST_F(MapFolder, NothingElseBelongsIntoIt) {
  const std::string rule = "lies in the folder of a map";
  for (const char* file : {"x.avi", "map.json"})
    EXPECT_NE(error_of([&] { require_outside_maps(map_ / file); }).find(rule), std::string::npos);
  EXPECT_NO_THROW(require_outside_maps(map_)) << "it may be replaced itself";
  for (const fs::path& path : {map_, map_ / "", map_ / "below", map_ / "below" / ""})
    EXPECT_NE(error_of([&] { require_contents_outside_maps(path); }).find(rule), std::string::npos) << path;
  EXPECT_NO_THROW(require_contents_outside_maps(folder_.path() / "beside"));
  // An empty path does not count as a file in the working directory.
  const fs::path before = fs::current_path();
  fs::current_path(map_);
  EXPECT_NO_THROW(require_outside_maps({}));
  EXPECT_NO_THROW(require_contents_outside_maps({}));
  EXPECT_THROW(require_outside_maps("x.avi"), Error);
  fs::current_path(before);
}

TEST_F(MapFolder, ItsDescriptionIsNoLinkOutOfIt) {
  const fs::path outside = folder_.path() / "outside.json";
  fs::rename(map_ / "map.json", outside);
  fs::create_symlink(outside, map_ / "map.json");
  EXPECT_NE(error_of([&] { (void)load_map(map_); }).find("a link"), std::string::npos);
  ASSERT_EQ(verify_map(map_).size(), 1U);
}

TEST_F(MapFolder, ParentFoldersAreMade) {
  save_map(folder_.path() / "a" / "b" / "c", room_);
  EXPECT_TRUE(verify_map(folder_.path() / "a" / "b" / "c").empty());
}

TEST_F(MapFolder, AMapThatCouldNotBeReadAgainIsNotSavedAndTheOldOneStays) {
  SavedMap large;
  large.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  large.mesh.triangles.assign(kMaxMeshTriangles + 1, Triangle{0, 1, 2});
  const std::string fault = test::error_of([&] { save_map(map_, large); });
  EXPECT_NE(fault.find("2000001 triangles"), std::string::npos) << fault;
  EXPECT_NE(fault.find("--deviation"), std::string::npos) << fault;
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_EQ(load_map(map_).mesh.triangles.size(), room_.mesh.triangles.size());
}

TEST_F(MapFolder, AMapWithoutASurfaceIsNotSavedAndTheOldOneStays) {
  SavedMap empty;
  EXPECT_NE(error_of([&] { save_map(map_, empty); }).find("no surface"), std::string::npos);
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_EQ(entries(), 1U);
}

TEST_F(MapFolder, EachMissingFileIsNamed) {
  for (const char* file : {"octree.bin", "mesh.ply", "places.bin", "trajectory.txt", "unknown.bin"}) {
    const std::string content = text_of(map_ / file);
    fs::remove(map_ / file);
    expect_fault(file, "is missing");
    put_text(map_ / file, content);
  }
  fs::remove(map_ / "map.json");
  expect_fault("map.json", "is missing");
}

TEST_F(MapFolder, EachCutFileIsNamed) {
  for (const char* file : {"octree.bin", "mesh.ply", "places.bin", "trajectory.txt", "unknown.bin"}) {
    const std::string content = text_of(map_ / file);
    for (const std::size_t length : {std::size_t{0}, content.size() / 2, content.size() - 1}) {
      put_text(map_ / file, content.substr(0, length));
      expect_fault(file, "cut short");
    }
    put_text(map_ / file, content + "x");
    expect_fault(file, "altered");
    put_text(map_ / file, content);
  }
  put_text(map_ / "map.json", text_of(map_ / "map.json").substr(0, 200));
  expect_fault("map.json", "not JSON");
}

TEST_F(MapFolder, OneChangedByteAnywhereIsNoticed) {
  for (const char* file : {"octree.bin", "mesh.ply", "places.bin", "trajectory.txt", "unknown.bin"}) {
    const std::string content = text_of(map_ / file);
    for (std::size_t at = 0; at < content.size(); at += 1 + content.size() / 7) {
      std::string altered = content;
      altered[at] = static_cast<char>(altered[at] ^ 1);
      put_text(map_ / file, altered);
      expect_fault(file, "altered");
    }
    put_text(map_ / file, content);
  }
  EXPECT_TRUE(verify_map(map_).empty());
}

TEST_F(MapFolder, KeyframesReadMeanwhileFailAtEachUse) {
  std::string altered = text_of(map_ / "places.bin");
  altered[altered.size() / 2] = static_cast<char>(altered[altered.size() / 2] ^ 1);
  put_text(map_ / "places.bin", altered);
  EXPECT_NE(error_of([&] { static_cast<void>(load_map(map_)); }).find("places.bin"), std::string::npos);
  const SavedMap map = load_map(map_, KeyframeReading::kMeanwhile);
  EXPECT_EQ(map.mesh.triangles, room_.mesh.triangles);
  for (int use = 0; use < 2; ++use)
    EXPECT_NE(error_of([&] { map.keyframe_database.load(); }).find("places.bin"), std::string::npos) << use;
}

TEST_F(MapFolder, AFileThatNoMemoryHoldsIsNotReadThrough) {
  // A sparse file of 8.8 TB uses no disk space; reading all of it would take hours.
  constexpr std::uintmax_t kVast_bytes = std::uintmax_t{1} << 43U;
  std::error_code fault;
  const std::uintmax_t bytes = fs::file_size(map_ / "octree.bin");
  fs::resize_file(map_ / "octree.bin", kVast_bytes, fault);
  if (fault) GTEST_SKIP() << "this file system has no files as large";
  edit_info("\"octree.bin\": {\n      \"bytes\": " + std::to_string(bytes),
            "\"octree.bin\": {\n      \"bytes\": " + std::to_string(kVast_bytes));
  expect_fault("octree.bin", "this machine's memory");
}

TEST_F(MapFolder, VerifyListsEveryFaultAtOnce) {
  fs::remove(map_ / "mesh.ply");
  put_text(map_ / "octree.bin", "x");
  put_text(map_ / "trajectory.txt", "");
  EXPECT_EQ(verify_map(map_).size(), 3U);
}

TEST_F(MapFolder, ALaterFormatIsRefusedWithAdvice) {
  edit_info("\"format_version\": 5", "\"format_version\": 6");
  expect_fault("map.json", "use a later roomradar");
}

TEST_F(MapFolder, MapsOfEarlierFormatsAreReadAndSavedInThisOne) {
  for (const int version : {1, 2}) {
    save_map(map_, room_);
    make_old(version);
    EXPECT_EQ(verify_map(map_), std::vector<std::string>{});
    const SavedMap read = load_map(map_);
    EXPECT_EQ(read.info.format_version, version);
    test::expect_equal(read.octree.load(), room_.octree.load());
    for (const char* name : {"octree.ot", "octree.bt"}) {
      const fs::path exported = folder_.path() / name;
      export_map(map_, exported);
      EXPECT_TRUE(text_of(exported) == text_of(map_ / name)) << name;
    }
    save_map(map_, read);
    EXPECT_EQ(load_map_info(map_).format_version, kMapFormatVersion);
    EXPECT_FALSE(fs::exists(map_ / "octree.ot"));
    EXPECT_EQ(verify_map(map_), std::vector<std::string>{});
    test::expect_equal(load_map(map_).octree.load(), room_.octree.load());
  }
}

TEST_F(MapFolder, AnEarlierFormatWithoutItsOctreeIsRefused) {
  make_old(2);
  fs::remove(map_ / "octree.ot");
  expect_fault("octree.ot", "is missing");
}

TEST_F(MapFolder, TheOctreeIsReadWhenItIsUsed) {
  std::string altered = text_of(map_ / "octree.bin");
  altered[altered.size() / 2] = static_cast<char>(altered[altered.size() / 2] ^ 1);
  put_text(map_ / "octree.bin", altered);
  const SavedMap read = load_map(map_);
  EXPECT_EQ(read.mesh.triangles.size(), room_.mesh.triangles.size());
  EXPECT_NE(error_of([&] { read.octree.load(); }).find("octree.bin: was altered"), std::string::npos);
}

TEST_F(MapFolder, AMapThatWasSavedAgainSaysSoWhenItsOctreeIsUsed) {
  const SavedMap read = load_map(map_), used = load_map(map_);
  used.octree.load();
  save_map(map_, room_);
  EXPECT_NE(error_of([&] { read.octree.load(); }).find("was saved again"), std::string::npos);
  EXPECT_EQ(used.octree.load().counts().nodes, room_.octree.load().counts().nodes);
}

TEST_F(MapFolder, NamesThatLeadOutOfTheFolderAreRefused) {
  put_text(folder_.path() / "secret", "x");
  edit_info("\"mesh.ply\"", "\"../secret\"");
  expect_fault("map.json", "does not list \"mesh.ply\"");
  edit_info("\"../secret\"",
            "\"mesh.ply\": {\"bytes\": 1, \"sha256\": \"" + std::string(64, '0') + "\"}, \"../secret\"");
  expect_fault("map.json", "\"../secret\", which is not part of a map");
}

TEST_F(MapFolder, LinksInPlaceOfFilesAreRefused) {
  fs::rename(map_ / "mesh.ply", folder_.path() / "elsewhere.ply");
  fs::create_symlink(folder_.path() / "elsewhere.ply", map_ / "mesh.ply");
  expect_fault("mesh.ply", "not a plain file");
}

TEST_F(MapFolder, AbsurdNumbersAreRefused) {
  const std::string good = text_of(map_ / "map.json");
  const auto with = [&](const std::string& from, const std::string& to, const std::string& fault) {
    put_text(map_ / "map.json", good);
    edit_info(from, to);
    expect_fault("map.json", fault);
  };
  with("\"resolution_m\": 0.0234", "\"resolution_m\": 1e-9", "resolution_m");
  with("\"resolution_m\": 0.0234", "\"resolution_m\": \"fine\"", "resolution_m");
  with("\"frames_read\": 6", "\"frames_read\": -6", "frames_read");
  with("\"frames_read\": 6", "\"frames_read\": 99999999999999999999999", "frames_read");
  with("\"format\": \"roomradar map\"", "\"format\": \"cake\"", "not the description");
  with("\"settings\": {", "\"settings\": {\"a\": [1], ", "\"a\" is not text");
  with("\"T_world_recorded\": [", "\"T_world_recorded\": [1, ", "16 numbers");
  put_text(map_ / "map.json", std::string(2U << 20U, ' '));
  expect_fault("map.json", "too many for a map's description");
  put_text(map_ / "map.json", std::string(500'000, '['));
  expect_fault("map.json", "not JSON");
  put_text(map_ / "map.json", "[]");
  expect_fault("map.json", "not a JSON object");
  put_text(map_ / "map.json", good);
  edit_info("\"bytes\": ", "\"bytes\": 9000000000000");
  EXPECT_EQ(verify_map(map_).size(), 1U);
}

TEST_F(MapFolder, FoldersThatAreNotThereAreNamed) {
  EXPECT_NE(error_of([&] { static_cast<void>(load_map(folder_.path() / "nowhere")); }).find("nowhere"),
            std::string::npos);
  EXPECT_EQ(verify_map(folder_.path() / "nowhere").size(), 1U);
}

TEST_F(MapFolder, AFullDiskLeavesTheOldMapAndNothingElse) {
  // A limit on file sizes rejects writes as a full disk does. Set in a child process, because the limit
  // cannot be lifted.
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20'000, 20'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = error_of([&] { save_map(map_, room_); });
    std::_Exit(message.find("cannot be written: File too large") != std::string::npos ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "not said why the map cannot be written";
  EXPECT_TRUE(verify_map(map_).empty());
  EXPECT_EQ(entries(), 1U) << "something was left beside the map";
}

TEST_F(MapFolder, WhatAKilledProcessLeftBesideTheMapGoesAndALivingOnesStays) {
  const pid_t gone = gone_process();
  const std::string beside = map_.string() + ".partial-";
  const std::vector<std::string> kept = {beside + std::to_string(getppid()), beside + "1x", beside};
  for (const std::string& folder : kept) fs::create_directory(folder);
  fs::create_directory(beside + std::to_string(gone));
  save_map(map_, room_);
  EXPECT_FALSE(fs::exists(beside + std::to_string(gone)));
  for (const std::string& folder : kept) EXPECT_TRUE(fs::exists(folder)) << folder;
}

TEST_F(MapFolder, WhatASaveKilledBetweenTwoRenamesSetAsideIsNamedAndBroughtBack) {
  const fs::path aside = map_.string() + ".before-" + std::to_string(gone_process());
  save_map(map_, room_);
  fs::rename(map_, aside);
  const std::string fault = error_of([&] { load_map(map_); });
  EXPECT_NE(fault.find("rename"), std::string::npos) << fault;
  EXPECT_NE(fault.find(aside.filename().string()), std::string::npos) << fault;
  { const AtomicFolder never_put_in_place(map_); }
  EXPECT_EQ(verify_map(map_), std::vector<std::string>{});

  fs::create_directory(aside);  // killed after the second rename: the old map is still to be deleted
  save_map(map_, room_);
  EXPECT_EQ(verify_map(map_), std::vector<std::string>{});
  EXPECT_EQ(entries(), 1U);

  // belongs to a running process
  const fs::path living = map_.string() + ".before-" + std::to_string(getppid());
  fs::rename(map_, living);
  EXPECT_NE(error_of([&] { load_map(map_); }).find("no such map"), std::string::npos);
  const fs::path file = map_.string() + ".ply";
  std::ofstream(file) << "ply";
  EXPECT_NE(error_of([&] { load_map(file); }).find("is a file; a map is a folder"), std::string::npos);
}

TEST_F(MapFolder, KilledAtAnyMomentOfSavingItIsTheOldMapOrTheNew) {
  const int kills = std::getenv("ROOMRADAR_LONG_TESTS") != nullptr ? 100 : 40;
  SavedMap other = a_room();
  other.info.source = "another";
  other.trajectory.pop_back();
  const auto start = std::chrono::steady_clock::now();
  save_map(map_, other);
  save_map(map_, room_);
  const auto both_us =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
  std::mt19937 random(5);
  std::uniform_int_distribution<int> moment_us(0, std::max(60'000, 2 * static_cast<int>(both_us.count())));
  int others = 0;
  for (int i = 0; i < kills; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      for (;;) {
        save_map(map_, other);
        save_map(map_, room_);
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(moment_us(random)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ASSERT_EQ(verify_map(map_), std::vector<std::string>{}) << "after kill " << i;
    const MapInfo info = load_map_info(map_);
    const bool is_other = info.source == other.info.source;
    ASSERT_EQ(info.poses, (is_other ? other : room_).trajectory.size());
    others += is_other ? 1 : 0;
  }
  EXPECT_GT(others, 0);
  save_map(map_, room_);
  EXPECT_EQ(std::distance(fs::directory_iterator(map_.parent_path()), {}), 1);  // nothing is left beside it
}

TEST_F(MapFolder, TwoProcessesThatSaveAtOnceLeaveOneWholeMap) {
  std::array<pid_t, 2> children{};
  for (std::size_t i = 0; i < children.size(); ++i) {
    children[i] = fork();
    if (children[i] != 0) continue;
    SavedMap mine = a_room();
    mine.info.source = std::to_string(i);
    for (int k = 0; k < 10; ++k) {
      try {
        save_map(map_, mine);
      } catch (const Error& error) {
        if (std::string(error.what()).empty()) _exit(2);  // saving may fail, with a message
      }
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(verify_map(map_), std::vector<std::string>{});
}

TEST_F(MapFolder, EveryExportIsReadable) {
  const fs::path out = folder_.path() / "out";
  fs::create_directory(out);
  for (const char* extension : {".ply", ".obj", ".stl", ".glb", ".PLY"}) {
    export_map(map_, out / (std::string("room") + extension));
    EXPECT_EQ(read_mesh(out / (std::string("room") + extension)).triangles.size(),
              room_.mesh.triangles.size())
        << extension;
  }
  export_map(map_, out / "room.ot");
  room_.octree.load().write_ot(out / "own.ot");
  EXPECT_TRUE(text_of(out / "room.ot") == text_of(out / "own.ot"));
  EXPECT_EQ(StaticMap::read_ot(out / "room.ot").counts().nodes, room_.octree.load().counts().nodes);
  export_map(map_, out / "room.bt");
  octomap::OcTree plain(0.1);
  EXPECT_TRUE(plain.readBinary((out / "room.bt").string()));
  EXPECT_GT(plain.size(), 100U);
  EXPECT_NE(error_of([&] { export_map(map_, out / "room.dwg"); }).find(".ply .obj .stl or .glb"),
            std::string::npos);
  EXPECT_THROW(export_map(map_, out / "no" / "room.bt"), Error);
  put_text(map_ / "mesh.ply", "broken");
  EXPECT_THROW(export_map(map_, out / "again.obj"), Error);
}

TEST_F(MapFolder, TheDescriptionSaysWhatIsInIt) {
  const std::string text = describe(load_map_info(map_));
  for (const char* word : {"0.0234 m", "5 fused of 6 read", "from a level surface", "triangles", "mesh.ply",
                           "hold_out", "1 keyframes"})
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
}

}  // namespace
}  // namespace roomradar::map_folder_test
