// map_history_test.cpp: earlier revisions of a map, as a user has them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/forked_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::map_history_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScan = "sim:table?seed=1&frames=60&width=160&rate=15";
constexpr const char* kVisit = "sim:table?frames=60&rate=10&width=160&path=view&crate=comes";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The files of the map itself, without the log of its revisions and the objects in it.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !name.starts_with("visits")) files[name] = text_of(entry.path());
  }
  return files;
}

/// One map for all tests; each works on a copy.
class MapHistory : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    ASSERT_EQ(program({"prescan", kScan, "--map", scanned(), "--resolution", "0.02", "--poses", "recorded"}),
              0)
        << said();
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { fs::copy(scanned(), map(), fs::copy_options::recursive); }
  void TearDown() override { fs::remove_all(map()); }

  static fs::path at(const char* name) { return folder_->path() / name; }
  static fs::path scanned() { return at("scanned"); }
  static std::string map() { return at("map").string(); }
  static std::string said() { return text_of(at("said")); }

  static pid_t start(const std::vector<std::string>& arguments) {
    const int output = open(at("said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const pid_t child = test::start_program(arguments, output);
    close(output);
    return child;
  }
  static int program(const std::vector<std::string>& arguments) { return test::status_of(start(arguments)); }
  static int visit() {
    return program({"run", kVisit, "--map", map(), "--poses", "recorded", "--commit-changes", "0.8",
                    "--save-map", map(), "--objects", "none"});
  }
  static bool has_said(const std::string& words) { return said().find(words) != std::string::npos; }

 private:
  static inline test::TemporaryFolder* folder_ = nullptr;
};

TEST_F(MapHistory, AScanDoesNotReplaceAMapUnlessTold) {
  const auto before = contents(map());
  EXPECT_EQ(program({"prescan", kScan, "--map", map()}), 1);
  for (const char* way : {"--resume", "--replace", "another map"}) EXPECT_TRUE(has_said(way)) << said();
  EXPECT_EQ(contents(map()), before);
  EXPECT_FALSE(fs::exists(map() + ".unfinished"));
  ASSERT_EQ(program({"prescan", "sim:table?seed=2&frames=40&width=160&rate=15", "--map", map(), "--replace",
                     "--resolution", "0.02", "--poses", "recorded"}),
            0)
      << said();
  EXPECT_NE(contents(map()), before);
  ASSERT_EQ(program({"map", "undo", map()}), 0) << said();
  EXPECT_EQ(contents(map()), before);
}

TEST_F(MapHistory, AVisitIsLoggedUndoneAndRestored) {
  const auto before = contents(map());
  ASSERT_EQ(visit(), 0) << said();
  const auto after = contents(map());
  ASSERT_NE(after, before);
  ASSERT_EQ(program({"map", "log", map()}), 0);
  EXPECT_TRUE(has_said("map@1")) << said();
  EXPECT_TRUE(has_said("run of sim:table?frames=60")) << said();
  EXPECT_TRUE(has_said("1 appeared")) << said();
  ASSERT_EQ(program({"map", "log", map(), "--json"}), 0);
  const nlohmann::json log = nlohmann::json::parse(said());
  ASSERT_EQ(log.size(), 2U);
  EXPECT_EQ(log[1].at("changes").at(0).at("kind"), "appeared");

  ASSERT_EQ(program({"map", "undo", map()}), 0) << said();
  EXPECT_EQ(contents(map()), before);
  EXPECT_EQ(program({"map", "undo", map()}), 1);
  EXPECT_TRUE(has_said("nothing to undo")) << said();
  ASSERT_EQ(program({"map", "restore", map() + "@2"}), 0) << said();
  EXPECT_EQ(contents(map()), after);
  EXPECT_EQ(program({"map", "verify", map()}), 0) << said();
}

TEST_F(MapHistory, AnEarlierRevisionIsOpenedLikeAMap) {
  ASSERT_EQ(visit(), 0) << said();
  ASSERT_EQ(program({"map", "diff", map() + "@1", map() + "@2"}), 0) << said();
  EXPECT_TRUE(has_said("appeared")) << said();
  ASSERT_EQ(program({"run", kScan, "--map", map() + "@1", "--frames", "0:5", "--poses", "recorded"}), 0)
      << said();
  ASSERT_EQ(program({"map", "export", map() + "@1", at("old.ply")}), 0) << said();
  EXPECT_EQ(text_of(at("old.ply")).size(), text_of(scanned() / "mesh.ply").size());
  EXPECT_EQ(program({"map", "info", map() + "@7"}), 1);
  EXPECT_TRUE(has_said("has no revision 7, but 1 to 2")) << said();
  EXPECT_EQ(program({"map", "restore", map()}), 1);
  EXPECT_TRUE(has_said("@2")) << said();
  ASSERT_EQ(program({"map", "prune", map(), "--keep", "1"}), 0) << said();
  EXPECT_EQ(program({"map", "info", map() + "@1"}), 1);
  EXPECT_EQ(program({"map", "undo", map()}), 1);
  EXPECT_TRUE(has_said("pruned")) << said();
}

TEST_F(MapHistory, AMapHasAnIdentityAndNoPathsOfTheMachine) {
  const auto described = [&] { return nlohmann::json::parse(text_of(at("map") / "map.json")); };
  const nlohmann::json before = described();
  EXPECT_EQ(before.at("id").get<std::string>().size(), 36U);
  EXPECT_EQ(before.at("revision"), 1);
  EXPECT_EQ(before.at("parent_revision"), 0);
  ASSERT_EQ(program({"record", kScan, at("recording")}), 0) << said();
  ASSERT_EQ(program({"prescan", at("recording"), "--map", map(), "--resume"}), 0) << said();
  const nlohmann::json after = described();
  EXPECT_EQ(after.at("id"), before.at("id"));
  EXPECT_EQ(after.at("created"), before.at("created"));
  EXPECT_EQ(after.at("revision"), 2);
  EXPECT_EQ(after.at("parent_revision"), 1);
  ASSERT_EQ(after.at("sessions").size(), 2U);
  EXPECT_EQ(after.at("sessions")[1].at("source"), "recording");
  EXPECT_EQ(after.at("sessions")[1].at("frames_read"), 60);
  for (const char* file : {"map.json", "visits.jsonl"})
    EXPECT_EQ(text_of(at("map") / file).find(at("map").parent_path().string()), std::string::npos) << file;
  // The same recording is known again, without its path in the map.
  ASSERT_EQ(program({"prescan", at("recording"), "--map", map(), "--resume"}), 0);
  EXPECT_TRUE(has_said("already contains")) << said();
  EXPECT_EQ(described(), after);
  fs::remove_all(at("recording"));
}

TEST_F(MapHistory, WhatAKilledPruneLeftHindersNothing) {
  ASSERT_EQ(visit(), 0) << said();
  for (const char* left : {"visits.bin.new", "visits.jsonl.partial-12345"})
    std::ofstream(at("map") / left) << "cut";
  EXPECT_EQ(program({"map", "verify", map()}), 0) << said();
  ASSERT_EQ(program({"map", "prune", map(), "--keep", "2"}), 0) << said();
  ASSERT_EQ(program({"map", "undo", map()}), 0) << said();
  for (const char* left : {"visits.bin.new", "visits.jsonl.partial-12345"})
    EXPECT_FALSE(fs::exists(at("map") / left)) << left;
}

TEST_F(MapHistory, KilledWhileItSavesTheMapIsWhole) {
  const auto before = contents(map());
  ASSERT_EQ(visit(), 0) << said();
  const auto after = contents(map());
  for (int i = 0; i < 12; ++i) {
    const pid_t child = start({"map", "restore", map() + (i % 2 == 0 ? "@1" : "@2")});
    usleep(static_cast<useconds_t>(20'000 * i));
    kill(child, SIGKILL);
    test::status_of(child);
    const auto now = contents(map());
    EXPECT_TRUE(now == before || now == after) << i;
    EXPECT_EQ(program({"map", "verify", map()}), 0) << said();
  }
  ASSERT_EQ(program({"map", "restore", map() + "@1"}), 0) << said();
  EXPECT_EQ(contents(map()), before);
}

}  // namespace
}  // namespace roomradar::map_history_test
