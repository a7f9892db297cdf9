// kept_objects_test.cpp: objects that a run leaves in a room stand there in the next one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "app/objects/kept_objects.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::kept_objects_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScan = "sim:table?seed=1&frames=90&width=160&rate=15";
constexpr const char* kView = "sim:table?seed=7&frames=75&width=160&path=view";
constexpr const char* kOtherDay = "sim:table?seed=3&frames=30&width=160&path=view";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = text_of(entry.path());
  return files;
}

/// One map for all tests; each works on a copy.
class KeptObjects : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    said_at_ = folder_->path() / "said";
    ASSERT_EQ(program({"prescan", kScan, "--map", scanned(), "--resolution", "0.02"}), 0) << said();
  }
  static void TearDownTestSuite() { delete folder_; }
  void SetUp() override { fs::copy(scanned(), map(), fs::copy_options::recursive); }
  void TearDown() override {
    fs::remove_all(map());
    fs::remove_all(at("session"));
  }

  static fs::path at(const char* name) { return folder_->path() / name; }
  static fs::path scanned() { return at("scanned"); }
  static fs::path map() { return at("map"); }
  static fs::path objects() { return map() / "objects"; }
  static std::string said() { return text_of(said_at_); }

  static pid_t start(const std::vector<std::string>& arguments) {
    const int output = open(said_at_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const pid_t child = test::start_program(arguments, output);
    close(output);
    return child;
  }
  static int program(const std::vector<std::string>& arguments) { return test::status_of(start(arguments)); }
  static int play(const std::string& source, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"run", source, "--map", map(), "--report", at("report.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return program(arguments);
  }
  static nlohmann::json reported() { return nlohmann::json::parse(text_of(at("report.json"))).at("objects"); }

 private:
  static inline test::TemporaryFolder* folder_ = nullptr;
  static inline fs::path said_at_;
};

TEST_F(KeptObjects, StandInTheNextRunWhereTheyStood) {
  ASSERT_EQ(play(kView), 0) << said();
  const std::vector<KeptObject> first = read_kept_objects(objects());
  ASSERT_EQ(first.size(), 1U) << said();
  ASSERT_TRUE(reported()[0].at("at_rest").get<bool>());
  // What is kept is the end of the run, not an earlier moment of the fall.
  const auto end_m = reported()[0].at("position_m").get<std::vector<double>>();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(first[0].T_world_object.translation()[axis], end_m[static_cast<std::size_t>(axis)], 1e-9);

  ASSERT_EQ(play(kOtherDay), 0) << said();
  EXPECT_NE(said().find("objects kept in the room: " + first[0].name), std::string::npos) << said();
  const std::vector<KeptObject> second = read_kept_objects(objects());
  ASSERT_EQ(second.size(), 1U);  // no second teapot
  EXPECT_EQ(second[0].name, first[0].name);
  EXPECT_EQ(second[0].model, first[0].model);
  EXPECT_LT((second[0].T_world_object.translation() - first[0].T_world_object.translation()).norm(), 1e-3);
  EXPECT_TRUE(reported()[0].at("at_rest").get<bool>());

  // An object that is asked for comes in addition, with a name of its own.
  ASSERT_EQ(play(kView, {"--object", "teapot,size=0.1"}), 0) << said();
  EXPECT_EQ(read_kept_objects(objects()).size(), 2U);
}

TEST_F(KeptObjects, NoneLeavesThoseOfTheMapAsTheyAre) {
  ASSERT_EQ(play(kView), 0) << said();
  const auto before = contents(map());
  ASSERT_EQ(play(kView, {"--objects", "none"}), 0) << said();
  EXPECT_EQ(said().find("objects kept"), std::string::npos);
  EXPECT_EQ(contents(map()), before);

  ASSERT_EQ(play(kOtherDay, {"--objects", at("elsewhere")}), 0) << said();
  EXPECT_EQ(contents(map()), before);
  EXPECT_TRUE(fs::exists(at("elsewhere") / "objects.json"));
}

TEST_F(KeptObjects, AScriptsObjectTakesThePlaceOfThatName) {
  std::ofstream(at("script.txt")) << "frame 0 add pot teapot size 0.2\nframe 0 drop pot view\n"
                                     "frame 0 add pan teapot size 0.1\nframe 0 drop pan view\n";
  for (int day = 0; day < 2; ++day) {
    ASSERT_EQ(play(kView, {"--script", at("script.txt")}), 0) << said();
    ASSERT_EQ(read_kept_objects(objects()).size(), 2U);
  }
  EXPECT_NE(said().find("replaced by the script's objects of the same name: pot, pan"), std::string::npos)
      << said();

  ASSERT_EQ(program({"map", "objects", map(), "remove", "pan"}), 0) << said();
  ASSERT_EQ(program({"map", "objects", map(), "rename", "pot", "kettle"}), 0) << said();
  ASSERT_EQ(program({"map", "objects", map()}), 0);
  EXPECT_EQ(said().find("pan"), std::string::npos);
  EXPECT_EQ(said().rfind("frame 0 stand kettle ", 0), 0U) << said();
  EXPECT_EQ(contents(objects()).size(), 2U);  // the list, and one model
  EXPECT_EQ(program({"map", "objects", map(), "remove", "pan"}), 1);
  EXPECT_EQ(program({"map", "objects", map(), "rename", "kettle"}), 2);
}

TEST_F(KeptObjects, SurviveAnExtensionOfTheMap) {
  ASSERT_EQ(play(kView), 0) << said();
  const auto before = contents(objects());
  ASSERT_EQ(program({"prescan", "sim:table?seed=1&frames=120&width=160&rate=15", "--map", map(), "--resume"}),
            0)
      << said();
  EXPECT_EQ(contents(objects()), before);
  EXPECT_EQ(program({"map", "verify", map()}), 0) << said();
  ASSERT_EQ(play(kOtherDay), 0) << said();
  EXPECT_TRUE(reported()[0].at("at_rest").get<bool>());
}

TEST_F(KeptObjects, AScanThatReplacesTheMapSaysThatTheyGo) {
  ASSERT_EQ(play(kView), 0) << said();
  ASSERT_EQ(program({"prescan", kScan, "--map", map(), "--resolution", "0.04", "--replace"}), 0) << said();
  EXPECT_NE(said().find("without 1 object that stood in it"), std::string::npos) << said();
  EXPECT_TRUE(read_kept_objects(objects()).empty());
}

TEST_F(KeptObjects, AMergedMapHasThoseOfBothRooms) {
  ASSERT_EQ(play(kView), 0) << said();
  const std::vector<KeptObject> first = read_kept_objects(objects());
  ASSERT_EQ(first.size(), 1U);
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
  T_a_b.translation() = Eigen::Vector3d(0.0, 0.25, 0.0);
  const fs::path other = at("other");
  add_kept_objects(objects(), Eigen::Isometry3d::Identity(), other);
  add_kept_objects(objects(), T_a_b, other);
  add_kept_objects(objects(), T_a_b, other);  // there already
  const std::vector<KeptObject> both = read_kept_objects(other);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].name, first[0].name);
  EXPECT_TRUE(both[0].T_world_object.isApprox(first[0].T_world_object, 1e-12));
  EXPECT_EQ(both[1].name, first[0].name + "2");
  EXPECT_TRUE((T_a_b * first[0].T_world_object).isApprox(both[1].T_world_object, 1e-12));
  EXPECT_EQ(contents(other).size(), 2U);  // the list, and one model
  fs::remove_all(other);
}

TEST_F(KeptObjects, AKilledRunLosesNoneOfThem) {
  ASSERT_EQ(play(kView), 0) << said();
  const std::vector<KeptObject> first = read_kept_objects(objects());
  const int kills = std::getenv("ROOMRADAR_LONG_TESTS") != nullptr ? 40 : 4;
  for (int i = 0; i < kills; ++i) {
    const pid_t child = start({"run", kView, "--map", map(), "--at-end", "loop", "--object", "teapot"});
    std::this_thread::sleep_for(std::chrono::milliseconds(900 + 450 * i));
    kill(child, SIGKILL);
    (void)test::status_of(child);
    const std::vector<KeptObject> left = read_kept_objects(objects());
    ASSERT_GE(left.size(), 1U);
    EXPECT_EQ(left[0].name, first[0].name);
    EXPECT_LT((left[0].T_world_object.translation() - first[0].T_world_object.translation()).norm(), 2e-3);
  }
}

TEST_F(KeptObjects, ADamagedListIsNamedAndKept) {
  ASSERT_EQ(play(kView), 0) << said();
  const std::string list = text_of(objects() / "objects.json");
  for (const std::string& damaged :
       {list.substr(0, list.size() / 2), std::string("{}"),
        std::string(list).replace(list.find("0."), 2, "1e999"),
        std::string(list).replace(list.find("\"name\": \""), 9, "\"name\": \"a ")}) {
    std::ofstream(objects() / "objects.json") << damaged;
    EXPECT_EQ(play(kOtherDay), 1);
    EXPECT_NE(said().find("objects.json: "), std::string::npos) << said();
    EXPECT_NE(said().find("--objects none"), std::string::npos) << said();
    EXPECT_EQ(text_of(objects() / "objects.json"), damaged);
  }
  std::ofstream(objects() / "objects.json") << list;
  for (const auto& entry : fs::directory_iterator(objects()))
    if (entry.path().extension() == ".model") fs::remove(entry.path());
  EXPECT_EQ(play(kOtherDay), 1);
  EXPECT_NE(said().find(".model is missing"), std::string::npos) << said();
}

TEST_F(KeptObjects, ARecordedRunReplaysWithThem) {
  ASSERT_EQ(play(kView), 0) << said();
  ASSERT_EQ(play(kOtherDay, {"--record-session", at("session")}), 0) << said();
  fs::remove_all(objects());  // a replay does not need the map's
  ASSERT_EQ(program({"run", at("session"), "--report", at("report.json")}), 0) << said();
  const nlohmann::json replay = nlohmann::json::parse(text_of(at("report.json"))).at("replay");
  EXPECT_EQ(replay.at("different"), 0);
  EXPECT_EQ(replay.at("same"), replay.at("recorded"));
  EXPECT_FALSE(fs::exists(objects()));
}

TEST_F(KeptObjects, GoWhereTheThingOnWhichTheyStoodWasCarried) {
  const std::string room = at("random").string(), day = "sim:random?seed=1&width=160";
  const std::vector<std::string> how = {"--map", room, "--poses", "recorded"};
  const auto with_map = [&](std::vector<std::string> words) {
    words.insert(words.end(), how.begin(), how.end());
    return program(words);
  };
  ASSERT_EQ(with_map({"prescan", day, "--texture", "off", "--resolution", "0.02"}), 0) << said();
  // One on the sofa, one on the floor.
  std::ofstream(at("script.txt")) << "frame 0 add pot teapot size 0.12\nframe 0 drop pot at -0.2 -0.25 0.47\n"
                                     "frame 0 add far teapot size 0.12\nframe 0 drop far at 0.9 0.9 0.01\n";
  ASSERT_EQ(with_map({"run", day + "&frames=60", "--script", at("script.txt")}), 0) << said();
  const std::vector<KeptObject> before = read_kept_objects(fs::path(room) / "objects");
  ASSERT_EQ(before.size(), 2U) << said();
  const std::string other = day + "&moved=0.4";
  ASSERT_EQ(with_map({"prescan", other, "--texture", "off", "--resume"}), 0) << said();
  EXPECT_NE(said().find("pot: moved by "), std::string::npos) << said();
  EXPECT_EQ(said().find("far: "), std::string::npos) << said();
  ASSERT_EQ(with_map({"run", other + "&frames=60"}), 0) << said();
  const std::vector<KeptObject> after = read_kept_objects(fs::path(room) / "objects");
  ASSERT_EQ(after.size(), 2U);
  const Eigen::Vector3d shift_m =
      after[0].T_world_object.translation() - before[0].T_world_object.translation();
  EXPECT_GT(shift_m.head<2>().norm(), 0.3);
  EXPECT_LT(std::abs(shift_m.z()), 0.01);  // at the height of the seat
  EXPECT_LT((after[1].T_world_object.translation() - before[1].T_world_object.translation()).norm(), 1e-3);
  fs::remove_all(room);
}

}  // namespace
}  // namespace roomradar::kept_objects_test
