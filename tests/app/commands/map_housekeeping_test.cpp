// map_housekeeping_test.cpp: maps are listed, copied, renamed, deleted, packed and unpacked, whole or not at
// all; hostile packages are refused, and leave nothing behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <minizip/zip.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/objects/kept_objects.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_package.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::map_housekeeping_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScan = "sim:table?frames=12&width=128&path=view";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const fs::path& path, const std::string& text) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// Returns all files below a folder with their contents.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
  return files;
}

/// Returns the names in a folder, sorted.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::exists(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// An entry of a package that a test makes.
struct Item {
  std::string name;
  std::string bytes{};
  unsigned mode = S_IFREG | 0644;
};

void write_zip(const fs::path& path, const std::vector<Item>& items) {
  fs::remove(path);
  zipFile zip = zipOpen64(path.c_str(), APPEND_STATUS_CREATE);
  ASSERT_NE(zip, nullptr);
  for (const Item& item : items) {
    zip_fileinfo facts{};
    facts.external_fa = uLong{item.mode} << 16U;
    ASSERT_EQ(zipOpenNewFileInZip4_64(zip, item.name.c_str(), &facts, nullptr, 0, nullptr, 0, nullptr,
                                      Z_DEFLATED, Z_DEFAULT_COMPRESSION, 0, -MAX_WBITS, DEF_MEM_LEVEL,
                                      Z_DEFAULT_STRATEGY, nullptr, 0, /*versionMadeBy=*/3U << 8U, 0, 0),
              ZIP_OK);
    ASSERT_EQ(zipWriteInFileInZip(zip, item.bytes.data(), static_cast<unsigned>(item.bytes.size())), ZIP_OK);
    ASSERT_EQ(zipCloseFileInZip(zip), ZIP_OK);
  }
  ASSERT_EQ(zipClose(zip, nullptr), ZIP_OK);
}

/// One map for all tests, with an object and a file of visits. Each test works in a folder of its own, which
/// is the current one, and in which maps/kitchen is a copy of the map.
class MapHousekeeping : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    said_at_ = at("said");
    setenv("XDG_DATA_HOME", at("data").c_str(), 1);
    ASSERT_EQ(program({"prescan", kScan, "--map", scanned(), "--resolution", "0.05"}), 0) << said();
    const std::string model = std::string(64, 'a') + ".model";
    write_text(scanned() / "objects" / model, "a model");
    write_kept_objects(scanned() / "objects", {KeptObject{.name = "pot", .model = model}});
    write_text(scanned() / "visits.note", "of a later version\n");
  }
  static void TearDownTestSuite() {
    fs::current_path("/");
    delete folder_;
  }
  void SetUp() override {
    fs::create_directories(work() / "maps");
    fs::copy(scanned(), work() / "maps/kitchen", fs::copy_options::recursive);
    fs::current_path(work());
  }
  void TearDown() override {
    fs::current_path(folder_->path());
    fs::remove_all(work());
    fs::remove_all(at("data"));
  }

  static fs::path at(const char* name) { return fs::canonical(folder_->path()) / name; }
  static fs::path scanned() { return at("scanned"); }
  static fs::path work() { return at("work"); }
  static fs::path trash() { return at("data") / "Trash"; }
  static std::string said() { return text_of(said_at_); }
  static bool has_said(const std::string& text) { return said().find(text) != std::string::npos; }

  static pid_t start(const std::vector<std::string>& arguments) {
    const int output = open(said_at_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const pid_t child = test::start_program(arguments, output);
    close(output);
    return child;
  }
  static int program(const std::vector<std::string>& arguments) { return test::status_of(start(arguments)); }

  /// Expects that the program fails with this message, and changes nothing in the test's folder.
  static void expect_refused(const std::vector<std::string>& arguments, const std::string& message) {
    const auto before = contents(work());
    const auto names = names_in(work());
    const auto maps = names_in(work() / "maps");
    EXPECT_EQ(program(arguments), 1) << said();
    EXPECT_TRUE(has_said("roomradar: ")) << said();
    EXPECT_TRUE(has_said(message)) << message << "\n" << said();
    EXPECT_EQ(names_in(work()), names);
    EXPECT_EQ(names_in(work() / "maps"), maps);
    EXPECT_TRUE(contents(work()) == before) << said();
  }

  /// Starts the program and kills it after some time. Returns false if it had ended before.
  static bool was_killed(const std::vector<std::string>& arguments, std::chrono::microseconds after) {
    const pid_t child = start(arguments);
    std::this_thread::sleep_for(after);
    kill(child, SIGKILL);
    return test::status_of(child) == 128 + SIGKILL;
  }

  /// Entries of a package of the map.
  static std::vector<Item> items() {
    std::vector<Item> items;
    for (const auto& [name, bytes] : contents(scanned())) items.push_back({"kitchen/" + name, bytes});
    return items;
  }
  static void expect_hostile(const std::vector<Item>& all, const std::string& message) {
    write_zip("hostile.rrm", all);
    expect_refused({"map", "unpack", "hostile.rrm"}, message);
    EXPECT_TRUE(has_said("hostile.rrm")) << said();
  }
  static void expect_hostile_with(const Item& item, const std::string& message) {
    std::vector<Item> all = items();
    all.push_back(item);
    expect_hostile(all, message);
  }

 private:
  static inline test::TemporaryFolder* folder_ = nullptr;
  static inline fs::path said_at_;
};

TEST_F(MapHousekeeping, ListsTheMapsOfAFolder) {
  fs::create_directories("maps/notes");
  write_text("maps/hall.partial-123/map.json", "{}");
  ASSERT_EQ(program({"map", "list"}), 0) << said();
  EXPECT_TRUE(has_said("kitchen")) << said();
  EXPECT_TRUE(has_said("sim:table")) << said();
  EXPECT_FALSE(has_said("notes")) << said();
  EXPECT_FALSE(has_said("hall")) << said();

  ASSERT_EQ(program({"map", "list", work() / "maps", "--json"}), 0) << said();
  const nlohmann::json list = nlohmann::json::parse(said());
  ASSERT_EQ(list.at("maps").size(), 1U);
  const nlohmann::json& map = list["maps"][0];
  std::uintmax_t bytes = 0;
  for (const auto& [name, text] : contents(scanned())) bytes += text.size();
  EXPECT_EQ(map.at("name"), "kitchen");
  EXPECT_EQ(map.at("kind"), "room");
  EXPECT_EQ(map.at("bytes"), bytes);
  EXPECT_EQ(map.at("triangles"), load_map_info(scanned()).triangles);
  EXPECT_EQ(map.at("objects"), 1);
  EXPECT_EQ(map.at("source"), load_map_info(scanned()).source);
  EXPECT_TRUE(map.at("fault").is_null());
  EXPECT_EQ(map.at("saved").get<std::string>().size(), std::string("2026-12-01T12:00:00Z").size());
}

TEST_F(MapHousekeeping, TheListGoesOnAfterADamagedMapAndKnowsBuildings) {
  fs::copy(scanned(), "maps/broken", fs::copy_options::recursive);
  fs::resize_file("maps/broken/mesh.ply", 100);
  fs::create_directories("maps/museum");
  write_building(BuildingInfo{}, "maps/museum");
  EXPECT_EQ(program({"map", "list"}), 1);
  for (const char* text : {"damaged: see below", "roomradar: maps/broken/mesh.ply: ", "kitchen",
                           "building of 0 recordings", "sim:table"})
    EXPECT_TRUE(has_said(text)) << text << "\n" << said();

  write_text("maps/kitchen/objects/objects.json", "{");
  fs::remove_all("maps/broken");
  EXPECT_EQ(program({"map", "list", "maps"}), 1);
  EXPECT_TRUE(has_said("objects.json: ")) << said();
}

TEST_F(MapHousekeeping, AFolderWithoutMapsIsSaid) {
  fs::create_directories("empty");
  EXPECT_EQ(program({"map", "list", "empty"}), 0);
  EXPECT_TRUE(has_said("empty: there are no maps in it; ")) << said();
  expect_refused({"map", "list", "nowhere"}, "nowhere: there is no such folder");
  expect_refused({"map", "list", "maps/kitchen"}, "maps/kitchen: is a map itself");
  fs::current_path("empty");
  EXPECT_EQ(program({"map", "list"}), 0);
  EXPECT_TRUE(has_said("maps: there are no maps in it; ")) << said();
}

TEST_F(MapHousekeeping, ACopyHasAllButLitter) {
  write_text("maps/kitchen/visits/deep/down/1.bin", std::string(1000, 'v'));
  const auto before = contents("maps/kitchen");
  test::add_litter("maps/kitchen");
  ASSERT_EQ(program({"map", "copy", "maps/kitchen/", "elsewhere/copy"}), 0) << said();
  EXPECT_TRUE(has_said("elsewhere/copy: a copy of maps/kitchen/")) << said();
  EXPECT_TRUE(contents("elsewhere/copy") == before);
  EXPECT_TRUE(verify_map("elsewhere/copy").empty());
  EXPECT_EQ(names_in("elsewhere"), std::vector<std::string>{"copy"});
  EXPECT_EQ(fs::last_write_time("elsewhere/copy/map.json"), fs::last_write_time("maps/kitchen/map.json"));
}

TEST_F(MapHousekeeping, ACopyIsRefusedWhereItWouldHarm) {
  fs::create_directories("taken");
  fs::create_directories("no map");
  write_text("museum/building.json", "{}");
  write_text("a file", "x");
  expect_refused({"map", "copy", "maps/kitchen", "taken"}, "taken: exists already");
  expect_refused({"map", "copy", "maps/kitchen", "a file"}, "a file: exists already");
  expect_refused({"map", "copy", "maps/kitchen", "maps/kitchen"}, "maps/kitchen: exists already");
  expect_refused({"map", "copy", "maps/kitchen", "maps/kitchen/copy"}, "lies in the folder of a map");
  expect_refused({"map", "copy", "maps/kitchen", "maps/kitchen/objects/copy"},
                 "lies in the map maps/kitchen");
  expect_refused({"map", "copy", "nowhere", "copy"}, "nowhere: there is no such map folder");
  expect_refused({"map", "copy", "a file", "copy"}, "a file: is not a folder");
  expect_refused({"map", "copy", "no map", "copy"}, "no map: has no map.json");
  expect_refused({"map", "copy", "museum", "copy"}, "museum: is the map of a building");
  EXPECT_EQ(program({"map", "copy", "maps/kitchen"}), 2);

  fs::create_symlink("/etc/hostname", "maps/kitchen/objects/link");
  EXPECT_EQ(program({"map", "copy", "maps/kitchen", "copy"}), 1);
  EXPECT_TRUE(has_said("maps/kitchen/objects/link: ")) << said();
  EXPECT_FALSE(fs::exists("copy"));
  for (const std::string& name : names_in(work()))
    EXPECT_EQ(name.find(".partial"), std::string::npos) << name;
}

TEST_F(MapHousekeeping, RenamesAMap) {
  const auto before = contents("maps/kitchen");
  ASSERT_EQ(program({"map", "rename", "maps/kitchen", "new/place/hall"}), 0) << said();
  EXPECT_TRUE(has_said("maps/kitchen: is now new/place/hall")) << said();
  EXPECT_TRUE(contents("new/place/hall") == before);
  EXPECT_FALSE(fs::exists("maps/kitchen"));

  fs::create_directories("maps/taken");
  fs::create_directory_symlink("new/place/hall", "link");
  fs::create_directories("no map");
  const std::string hall = "new/place/hall";
  expect_refused({"map", "rename", hall, "maps/taken"}, "maps/taken: exists already");
  expect_refused({"map", "rename", hall, hall + "/objects/inner"}, "lies in the map " + hall);
  expect_refused({"map", "rename", "no map", "maps/other"}, "no map: has no map.json");
  expect_refused({"map", "rename", "link", "maps/other"}, "link: is a link");
  write_text(hall + ".unfinished/work.json", "{}");
  expect_refused({"map", "rename", hall, "maps/other"}, hall + ".unfinished");
}

TEST_F(MapHousekeeping, RenamingBringsBackWhatAKilledSaveMovedAside) {
  const auto before = contents("maps/kitchen");
  const pid_t ended = start({"--version"});
  ASSERT_EQ(test::status_of(ended), 0);
  const std::string aside = "maps/kitchen.before-" + std::to_string(ended);
  fs::rename("maps/kitchen", aside);
  fs::copy(scanned(), "maps/other", fs::copy_options::recursive);
  expect_refused({"map", "rename", "maps/other", "maps/kitchen"}, aside);
  ASSERT_EQ(program({"map", "rename", aside, "maps/kitchen"}), 0) << said();
  EXPECT_TRUE(contents("maps/kitchen") == before);
}

TEST_F(MapHousekeeping, RenamesToAnotherFileSystem) {
  std::string pattern = "/dev/shm/roomradar-test-XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr) GTEST_SKIP() << "/dev/shm cannot be used";
  const fs::path other = pattern;
  struct stat here {
  }, there{};
  ASSERT_EQ(stat(work().c_str(), &here), 0);
  ASSERT_EQ(stat(other.c_str(), &there), 0);
  const auto before = contents("maps/kitchen");
  if (here.st_dev != there.st_dev) {
    EXPECT_EQ(program({"map", "rename", "maps/kitchen", other / "hall"}), 0) << said();
    EXPECT_FALSE(fs::exists("maps/kitchen"));
    EXPECT_TRUE(names_in("maps").empty());
    EXPECT_TRUE(contents(other / "hall") == before);
    // The trash is here, the map there.
    EXPECT_EQ(program({"map", "delete", other / "hall"}), 0) << said();
    EXPECT_TRUE(names_in(other).empty());
    EXPECT_TRUE(contents(trash() / "files/hall") == before);
  }
  fs::remove_all(other);
  if (here.st_dev == there.st_dev) GTEST_SKIP() << "/dev/shm is on the same file system";
}

TEST_F(MapHousekeeping, ADeletedMapIsInTheTrashAndComesBack) {
  const auto before = contents("maps/kitchen");
  const std::string map =
      "maps/my k\xC3\xBC"
      "che";
  fs::rename("maps/kitchen", map);
  ASSERT_EQ(program({"map", "delete", map}), 0) << said();
  const fs::path place = trash() /
                         "files/my k\xC3\xBC"
                         "che";
  EXPECT_TRUE(has_said(place.string())) << said();
  EXPECT_TRUE(has_said("`roomradar map rename ")) << said();
  EXPECT_FALSE(fs::exists(map));
  EXPECT_TRUE(contents(place) == before);
  const fs::path note = trash() /
                        "info/my k\xC3\xBC"
                        "che.trashinfo";
  EXPECT_EQ(text_of(note).rfind(
                "[Trash Info]\nPath=" + work().string() + "/maps/my%20k%C3%BCche\nDeletionDate=20", 0),
            0U)
      << text_of(note);

  fs::copy(scanned(), map, fs::copy_options::recursive);  // another one of that name
  ASSERT_EQ(program({"map", "delete", map}), 0) << said();
  EXPECT_EQ(names_in(trash() / "files").size(), 2U);
  EXPECT_TRUE(fs::exists(trash() / "files/my k\xC3\xBC"
                                   "che-2/map.json"));
  EXPECT_EQ(names_in(trash() / "info").size(), 2U);

  ASSERT_EQ(program({"map", "rename", place, map}), 0) << said();
  EXPECT_TRUE(contents(map) == before);
  EXPECT_FALSE(fs::exists(note));
  const fs::path second = trash() /
                          "files/my k\xC3\xBC"
                          "che-2";
  EXPECT_EQ(program({"map", "delete", second}), 1);
  EXPECT_TRUE(has_said("lies in the trash already")) << said();
  EXPECT_EQ(program({"map", "delete", second, "--for-good"}), 0) << said();
  EXPECT_TRUE(names_in(trash() / "files").empty());
  EXPECT_TRUE(names_in(trash() / "info").empty());
}

TEST_F(MapHousekeeping, OnlyMapsAreDeleted) {
  fs::create_directories("no map");
  write_text("no map/letter.txt", "dear");
  write_text("museum/building.json", "{}");
  fs::copy(scanned(), "mixed", fs::copy_options::recursive);
  write_text("mixed/letter.txt", "dear");
  fs::create_directory_symlink("maps/kitchen", "link");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--for-good"}}) {
    const auto refused = [&](const std::string& map, const std::string& message) {
      std::vector<std::string> words = {"map", "delete", map};
      words.insert(words.end(), more.begin(), more.end());
      expect_refused(words, message);
    };
    refused("no map", "no map: has no map.json");
    refused("museum", "museum: is the map of a building");
    refused("mixed", "mixed: holds \"letter.txt\", which is not part of a map");
    refused("link", "link: is a link");
    refused("nowhere", "nowhere: there is no such map folder");
  }
  EXPECT_FALSE(fs::exists(trash()));

  write_text("maps/kitchen.unfinished/work.json", "{}");
  fs::resize_file("maps/kitchen/mesh.ply", 10);  // a damaged map may be deleted, too
  test::add_litter("maps/kitchen");
  ASSERT_EQ(program({"map", "delete", "maps/kitchen", "--for-good"}), 0) << said();
  EXPECT_TRUE(has_said("maps/kitchen.unfinished: ")) << said();
  EXPECT_EQ(names_in("maps"), std::vector<std::string>{"kitchen.unfinished"});
  EXPECT_FALSE(fs::exists(trash()));
}

TEST_F(MapHousekeeping, WithoutXdgTheTrashIsInTheHomeFolder) {
  const char* const set = std::getenv("HOME");
  const std::string home = set == nullptr ? "" : set;
  unsetenv("XDG_DATA_HOME");
  setenv("HOME", (work() / "home").c_str(), 1);
  EXPECT_EQ(program({"map", "delete", "maps/kitchen"}), 0) << said();
  EXPECT_TRUE(fs::exists(work() / "home/.local/share/Trash/files/kitchen/map.json"));
  EXPECT_TRUE(fs::exists(work() / "home/.local/share/Trash/info/kitchen.trashinfo"));
  setenv("XDG_DATA_HOME", at("data").c_str(), 1);
  set == nullptr ? unsetenv("HOME") : setenv("HOME", home.c_str(), 1);
}

TEST_F(MapHousekeeping, AMapGoesThroughAFile) {
  const auto before = contents("maps/kitchen");
  ASSERT_EQ(program({"map", "pack", "maps/kitchen", "kitchen.rrm"}), 0) << said();
  const std::string packed = text_of("kitchen.rrm");
  EXPECT_EQ(packed.find(work().string()), std::string::npos);

  ASSERT_EQ(program({"map", "unpack", "kitchen.rrm"}), 0) << said();
  EXPECT_TRUE(has_said("kitchen: unpacked from kitchen.rrm")) << said();
  EXPECT_TRUE(contents("kitchen") == before);
  EXPECT_EQ(program({"map", "verify", "kitchen"}), 0) << said();
  EXPECT_EQ(program({"map", "objects", "kitchen"}), 0) << said();
  EXPECT_TRUE(has_said("pot")) << said();
  expect_refused({"map", "unpack", "kitchen.rrm"}, "kitchen: exists already");
  expect_refused({"map", "unpack", "kitchen.rrm", "--map", "maps/kitchen"}, "maps/kitchen: exists already");
  expect_refused({"map", "unpack", "kitchen.rrm", "--map", "maps/kitchen/inner"}, "in the folder of a map");
  ASSERT_EQ(program({"map", "unpack", "kitchen.rrm", "--map", "new/hall"}), 0) << said();
  EXPECT_TRUE(contents("new/hall") == before);

  // The same map gives the same bytes, whenever and wherever its files were written.
  test::add_litter("kitchen");
  ASSERT_EQ(program({"map", "pack", "kitchen", "again.rrm"}), 0) << said();
  EXPECT_TRUE(text_of("again.rrm") == packed);
  write_text("again.rrm", "an earlier one");
  ASSERT_EQ(program({"map", "pack", "kitchen/.", "again.rrm"}), 0) << said();
  EXPECT_TRUE(text_of("again.rrm") == packed);
}

TEST_F(MapHousekeeping, PackingIsRefusedWhereItWouldHarm) {
  fs::create_directories("folder.rrm");
  expect_refused({"map", "pack", "maps/kitchen", "photo.jpg"}, "photo.jpg: ");
  expect_refused({"map", "pack", "maps/kitchen", "folder.rrm"}, "folder.rrm: exists and is not a file");
  expect_refused({"map", "pack", "maps/kitchen", "maps/kitchen/m.rrm"}, "lies in the folder of a map");
  expect_refused({"map", "pack", "maps/kitchen", "maps/kitchen/objects/m.rrm"},
                 "lies in the map maps/kitchen");
  expect_refused({"map", "pack", "maps/kitchen", "nowhere/m.rrm"}, "nowhere/m.rrm: cannot be written");
  expect_refused({"map", "pack", "nowhere", "m.rrm"}, "nowhere: there is no such map folder");
  write_text("maps/kitchen/letter.txt", "dear");
  expect_refused({"map", "pack", "maps/kitchen", "m.rrm"},
                 "holds \"letter.txt\", which is not part of a map");
  fs::remove("maps/kitchen/letter.txt");
  std::ofstream("maps/kitchen/mesh.ply", std::ios::app) << "x";
  expect_refused({"map", "pack", "maps/kitchen", "m.rrm"}, "mesh.ply: ");
}

TEST_F(MapHousekeeping, NamesThatLeadOutOfTheFolderAreRefused) {
  for (const char* name :
       {"../evil", "kitchen/../../evil", "kitchen/objects/../../../evil", "/tmp/evil", "kitchen//evil",
        "kitchen/./evil", "kitchen\\..\\evil", "kitchen/objects/a\\b", "kitchen/objects/a\nb", ".."})
    expect_hostile_with({name, "x"}, "leads out of a map's folder or has invalid characters");
  for (const char* name : {"hall/map.json", "evil", "__MACOSX/x"})
    expect_hostile_with({name, "x"}, std::string("holds \"") + name + "\", which");
  for (const char* name : {"kitchen/.bashrc", "kitchen/letter.txt", "kitchen/objects", "kitchen/map.json/x",
                           "kitchen/mesh.ply/x", "kitchen/other/", "kitchen"})
    expect_hostile_with({name}, "which no map has");
  EXPECT_FALSE(fs::exists("/tmp/evil"));
}

TEST_F(MapHousekeeping, LinksAndNamesThatComeTwiceAreRefused) {
  expect_hostile_with({"kitchen/visits.link", "/etc/passwd", S_IFLNK | 0777}, "which is a link or a device");
  expect_hostile_with({"kitchen/visits.pipe", "", S_IFIFO | 0644}, "which is a link or a device");
  expect_hostile_with({"kitchen/map.json", "{}"}, "which it has twice");
  std::vector<Item> all = items();
  all.push_back({"kitchen/visits", "x"});
  all.push_back({"kitchen/visits/1", "x"});
  expect_hostile(all, "which lies in a file");
  std::swap(all[all.size() - 1], all[all.size() - 2]);
  expect_hostile(all, "which it has twice");
}

TEST_F(MapHousekeeping, PackagesOfOtherProgramsWithFoldersAreRead) {
  std::vector<Item> all = items();
  all.insert(all.begin(), {"kitchen/", "", S_IFDIR | 0755});
  all.push_back({"kitchen/objects/", "", S_IFDIR | 0755});
  write_zip("zipped.rrm", all);
  ASSERT_EQ(program({"map", "unpack", "zipped.rrm"}), 0) << said();
  EXPECT_TRUE(contents("kitchen") == contents(scanned()));
}

TEST_F(MapHousekeeping, APackageWithoutASoundMapIsRefused) {
  std::vector<Item> all = items();
  std::erase_if(all, [](const Item& item) { return item.name == "kitchen/map.json"; });
  expect_hostile(all, "holds no map.json");
  all = items();
  for (Item& item : all)
    if (item.name == "kitchen/mesh.ply") item.bytes.back() = static_cast<char>(item.bytes.back() ^ 1);
  expect_hostile(all, "holds a damaged map: mesh.ply: ");
  all = items();
  std::erase_if(all, [](const Item& item) { return item.name == "kitchen/octree.bin"; });
  expect_hostile(all, "holds a damaged map: octree.bin: ");
  expect_hostile({{"kitchen/map.json", "{}"}}, "holds a damaged map: map.json: ");
  write_text("text.rrm", "no package");
  expect_refused({"map", "unpack", "text.rrm"}, "text.rrm: is not a packed map");
  write_text("empty.rrm", "");
  expect_refused({"map", "unpack", "empty.rrm"}, "empty.rrm: is not a packed map");
  expect_refused({"map", "unpack", "nowhere.rrm"}, "nowhere.rrm: is missing");
  expect_refused({"map", "unpack", "maps"}, "maps: is a folder");
}

TEST_F(MapHousekeeping, BombsAreRefusedBeforeTheyAreWritten) {
  constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20U;
  EXPECT_EQ(max_unpacked_bytes(0), 64 * kMegabyte);
  EXPECT_EQ(max_unpacked_bytes(3 * kMegabyte), (3000 + 64) * kMegabyte);
  EXPECT_EQ(max_unpacked_bytes(std::numeric_limits<std::uint64_t>::max()), 64 * 1024 * kMegabyte);

  std::vector<Item> all = items();
  for (int i = 0; i < 10000; ++i) all.push_back({"kitchen/visits/" + std::to_string(i)});
  expect_hostile(all, "would unpack to more than 10000 files");

  // The last entry of the list states nearly 4 GB; the package is smaller than 3 MB.
  all = items();
  all.push_back({"kitchen/visits.bomb", "x"});
  write_zip("bomb.rrm", all);
  std::string bytes = text_of("bomb.rrm");
  ASSERT_LT(bytes.size(), 3 * kMegabyte);
  constexpr std::size_t kUnpackedSizeAt = 24;  // in an entry of the list
  const std::size_t entry = bytes.rfind("PK\x01\x02");
  ASSERT_NE(entry, std::string::npos);
  bytes.replace(entry + kUnpackedSizeAt, 4, "\xF0\xFF\xFF\xFF");
  write_text("bomb.rrm", bytes);
  expect_refused({"map", "unpack", "bomb.rrm"}, "bomb.rrm: would unpack to more than");

  // It states 2 bytes, and has 1.
  bytes.replace(entry + kUnpackedSizeAt, 4, std::string("\x02\0\0\0", 4));
  write_text("bomb.rrm", bytes);
  expect_refused({"map", "unpack", "bomb.rrm"}, "bomb.rrm: is cut short or damaged at visits.bomb");
}

TEST_F(MapHousekeeping, ACutPackageIsNamedAndLeavesNothing) {
  ASSERT_EQ(program({"map", "pack", "maps/kitchen", "whole.rrm"}), 0) << said();
  const std::string whole = text_of("whole.rrm");
  std::vector<std::size_t> lengths = {whole.size() - 1, whole.size() - 2, whole.size() - 12,
                                      whole.size() - 22, whole.size() - 23};
  for (std::size_t i = 0; i < 30; ++i) lengths.push_back(whole.size() * i / 30);
  for (const std::size_t length : lengths) {
    write_text("cut.rrm", whole.substr(0, length));
    expect_refused({"map", "unpack", "cut.rrm"}, "cut.rrm: ");
    EXPECT_TRUE(has_said("`roomradar map pack`")) << said();
    if (HasFailure()) FAIL() << "cut at " << length << " of " << whole.size();
  }
}

TEST_F(MapHousekeeping, AnAlteredPackageGivesTheSameMapOrNone) {
  ASSERT_EQ(program({"map", "pack", "maps/kitchen", "whole.rrm"}), 0) << said();
  const std::string whole = text_of("whole.rrm");
  const auto before = contents(scanned());
  for (std::size_t i = 0; i < 40; ++i) {
    // The first half of the places anywhere, the second half in the list of files at the end.
    const std::size_t place =
        i < 20 ? whole.size() * i / 20
               : whole.size() - 1 - (i - 20) * std::min<std::size_t>(whole.size(), 900) / 20;
    std::string altered = whole;
    altered[place] = static_cast<char>(altered[place] ^ 0x11);
    write_text("altered.rrm", altered);
    const int status = program({"map", "unpack", "altered.rrm", "--map", "unpacked"});
    ASSERT_TRUE(status == 0 || status == 1) << status << " at " << place << ": " << said();
    if (status == 1) {
      EXPECT_TRUE(has_said("altered.rrm")) << said();
      EXPECT_EQ(names_in(work()), (std::vector<std::string>{"altered.rrm", "maps", "whole.rrm"})) << place;
    } else if (contents("unpacked") != before) {  // a name of a file that is not in the checksums may differ
      EXPECT_TRUE(verify_map("unpacked").empty()) << place;
      EXPECT_EQ(contents("unpacked").size(), before.size()) << place;
    }
    fs::remove_all("unpacked");
  }
}

TEST_F(MapHousekeeping, AKilledCopyIsWholeOrAbsent) {
  const auto before = contents("maps/kitchen");
  for (int i = 0; i < 12; ++i) {
    was_killed({"map", "copy", "maps/kitchen", "maps/copy"}, std::chrono::microseconds(2500 * i));
    EXPECT_TRUE(contents("maps/kitchen") == before);
    if (!fs::exists("maps/copy")) continue;
    EXPECT_TRUE(contents("maps/copy") == before) << i;
    fs::remove_all("maps/copy");
  }
  ASSERT_EQ(program({"map", "copy", "maps/kitchen", "maps/copy"}), 0) << said();
  EXPECT_EQ(names_in("maps"), (std::vector<std::string>{"copy", "kitchen"}));  // nothing of the killed ones
}

TEST_F(MapHousekeeping, AKilledPackIsWholeOrAbsent) {
  ASSERT_EQ(program({"map", "pack", "maps/kitchen", "whole.rrm"}), 0) << said();
  const std::string whole = text_of("whole.rrm");
  for (int i = 0; i < 12; ++i) {
    was_killed({"map", "pack", "maps/kitchen", "kitchen.rrm"}, std::chrono::microseconds(4000 * i));
    if (!fs::exists("kitchen.rrm")) continue;
    EXPECT_TRUE(text_of("kitchen.rrm") == whole) << i;
    fs::remove("kitchen.rrm");
  }
  for (int i = 0; i < 8; ++i) {
    was_killed({"map", "unpack", "whole.rrm", "--map", "maps/unpacked"}, std::chrono::microseconds(4000 * i));
    if (!fs::exists("maps/unpacked")) continue;
    EXPECT_TRUE(contents("maps/unpacked") == contents(scanned())) << i;
    fs::remove_all("maps/unpacked");
  }
}

TEST_F(MapHousekeeping, AKilledDeletionLeavesTheMapHereOrInTheTrash) {
  const auto before = contents("maps/kitchen");
  for (int i = 0; i < 10; ++i) {
    was_killed({"map", "delete", "maps/kitchen"}, std::chrono::microseconds(1000 * i));
    if (fs::exists("maps/kitchen")) {
      EXPECT_TRUE(contents("maps/kitchen") == before) << i;
      EXPECT_TRUE(names_in(trash() / "files").empty()) << i;
      continue;
    }
    const std::vector<std::string> names = names_in(trash() / "files");
    ASSERT_EQ(names.size(), 1U) << i;
    EXPECT_TRUE(fs::exists(trash() / "info" / (names[0] + ".trashinfo")));
    ASSERT_EQ(program({"map", "rename", trash() / "files" / names[0], "maps/kitchen"}), 0) << said();
    EXPECT_TRUE(contents("maps/kitchen") == before) << i;
  }
}

}  // namespace
}  // namespace roomradar::map_housekeeping_test
