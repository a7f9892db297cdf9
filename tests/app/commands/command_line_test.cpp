// command_line_test.cpp: the program as users run it: exit status, messages, no lost data.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/forked_program.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::command_line_test {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string out;  ///< stdout and stderr combined
};

Outcome shell(const std::string& line) {
  Outcome outcome;
  FILE* pipe = popen((line + " 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) outcome.out.append(buffer, n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

/// Runs the file of the program.
Outcome file(const std::string& arguments) { return shell(ROOMRADAR_PROGRAM " " + arguments); }

/// Returns the words of a line as a shell does. Knows no special characters but ' and blanks.
std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  bool is_quoted = false, is_word = false;
  for (const char c : line) {
    if (c == ' ' && !is_quoted) {
      is_word = false;
      continue;
    }
    if (!is_word) words.emplace_back();
    is_word = true;
    if (c == '\'')
      is_quoted = !is_quoted;
    else
      words.back().push_back(c);
  }
  return words;
}

/// Runs the program in a fork of this process.
Outcome roomradar(const std::string& arguments) {
  int ends[2];
  Outcome outcome;
  if (pipe2(ends, O_CLOEXEC) != 0) return outcome;
  const pid_t child = test::start_program(words_of(arguments), ends[1]);
  close(ends[1]);
  char buffer[4096];
  for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    outcome.out.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  outcome.status = test::status_of(child);
  return outcome;
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void expect_fault(const Outcome& outcome, int status, const std::string& word) {
  EXPECT_EQ(outcome.status, status) << outcome.out;
  EXPECT_NE(outcome.out.find(word), std::string::npos) << "no \"" << word << "\" in: " << outcome.out;
}

/// Scans a small simulated room once for all tests here.
class CommandLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(::testing::TempDir()) / ("roomradar_cli_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    scanned_ = roomradar("prescan 'sim:table?frames=40&width=160' --map " + map() +
                         " --resolution 0.03 --hold-out 10 --report " + (folder_ / "prescan.json").string());
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  void SetUp() override { fs::remove_all(fs::path(map()) / "objects"); }  // of the test before
  static std::string map() { return (folder_ / "map").string(); }
  /// Returns a copy of the map that a test may damage.
  static fs::path broken_copy() {
    const fs::path copy = folder_ / "broken";
    fs::remove_all(copy);
    fs::copy(map(), copy, fs::copy_options::recursive);
    return copy;
  }
  inline static fs::path folder_;
  inline static Outcome scanned_;
};

TEST_F(CommandLine, AMapHasATextureAndAPage) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  EXPECT_TRUE(fs::exists(fs::path(map()) / "texture.jpg"));
  const fs::path page = folder_ / "room.html";
  EXPECT_EQ(roomradar("map export " + map() + " " + page.string()).status, 0);
  EXPECT_NE(read_text(page).find("\"texture\":\"/9j/"), std::string::npos);  // a JPEG
  expect_fault(roomradar("map export " + map() + " " + page.string() + " --unknown"), 1, "--unknown");
  expect_fault(roomradar("map export " + map() + " " + map() + "/room.html"), 1,
               "lies in the folder of a map");

  const std::string plain = (folder_ / "plain").string();
  ASSERT_EQ(
      roomradar("prescan 'sim:table?frames=40&width=160' --map " + plain + " --resolution 0.03 --texture off")
          .status,
      0);
  EXPECT_FALSE(fs::exists(fs::path(plain) / "texture.jpg"));
  EXPECT_EQ(roomradar("map export " + plain + " " + page.string()).status, 0);
  EXPECT_NE(read_text(page).find("\"colours\":"), std::string::npos);
  expect_fault(roomradar("prescan sim:table --map " + plain + " --texture maybe"), 2, "must be off or on");

  const Outcome diff = roomradar("map diff " + map() + " " + plain + " --html " + page.string());
  EXPECT_EQ(diff.status, 0) << diff.out;
  EXPECT_NE(read_text(page).find("\"name\":\"map and plain\""), std::string::npos);
  expect_fault(roomradar("map diff " + map() + " " + plain + " --html " + (folder_ / "a.htm").string()), 1,
               "must end in .html");
}

TEST_F(CommandLine, PrescanLeavesAMapThatVerifiesAndAReport) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  EXPECT_EQ(roomradar("map verify " + map()).status, 0);
  const nlohmann::json report = nlohmann::json::parse(read_text(folder_ / "prescan.json"));
  for (const char* key :
       {"command", "version", "source", "settings", "renderer", "frames_read", "frames_skipped", "stages",
        "peak_rss_mb", "wall_s", "frames_tracked", "frames_fused", "frames_lost", "ate_rmse_m", "map"})
    EXPECT_TRUE(report.contains(key)) << key;
  for (const char* stage : {"read", "track", "fuse", "surface", "save", "frame"})
    EXPECT_TRUE(report["stages"].contains(stage)) << stage;
  EXPECT_EQ(report["frames_read"], 40);
  EXPECT_GT(report["map"]["triangles"], 1000);
  EXPECT_LT(report["ate_rmse_m"], 0.05);
  EXPECT_EQ(report["frames_tracked"], 40);
  EXPECT_EQ(report["frames_fused"], 36);
  EXPECT_EQ(report["held_out"]["frames"], 4);
  EXPECT_LT(report["held_out"]["median_m"], 0.03);
  EXPECT_GT(report["held_out"]["cover"], 0.5);
}

// Colour that comes 40 ms late is noticed after 100 frames. They are tracked again, counted from 1.
TEST_F(CommandLine, PrescanTracksAgainOnceTheTimesOfTheSensorAreKnown) {
  const fs::path late = folder_ / "late", report = folder_ / "late.json";
  const Outcome scanned =
      roomradar("prescan 'sim:table?seed=3&frames=104&width=240&delay=40' --map " + late.string() +
                " --resolution 0.05 --texture off --report " + report.string());
  ASSERT_EQ(scanned.status, 0) << scanned.out;
  const nlohmann::json found = nlohmann::json::parse(read_text(report));
  EXPECT_EQ(found["tracking_restarts"], 1);
  EXPECT_GT(found["colour_delay_s"], 0.02);
  EXPECT_EQ(found["frames_read"], 104);
  EXPECT_NE(scanned.out.find("track again"), std::string::npos) << scanned.out;
  EXPECT_NE(scanned.out.find("104/104"), std::string::npos) << scanned.out;
  EXPECT_EQ(scanned.out.find("204/104"), std::string::npos) << scanned.out;
}

TEST_F(CommandLine, MapInfoAndEveryExportWork) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const Outcome info = roomradar("map info " + map());
  EXPECT_EQ(info.status, 0);
  EXPECT_NE(info.out.find("0.03"), std::string::npos) << info.out;
  for (const char* extension : {"bt", "ot", "ply", "obj", "stl", "glb"}) {
    const fs::path path = folder_ / (std::string("export.") + extension);
    EXPECT_EQ(roomradar("map export " + map() + " " + path.string()).status, 0) << extension;
    EXPECT_GT(fs::file_size(path), 1000U) << extension;
  }
  expect_fault(roomradar("map export " + map() + " " + (folder_ / "export.xyz").string()), 1, ".ply");
  const fs::path unknown = folder_ / "unknown.ply";
  EXPECT_EQ(roomradar("map export " + map() + " " + unknown.string() + " --unknown").status, 0);
  EXPECT_GT(fs::file_size(unknown), 10000U);
  expect_fault(roomradar("map export " + map() + " " + map() + "/unknown.ply --unknown"), 1, "map");
}

/// Every action available to a user, in sequence.
constexpr const char* kPlayed = R"(frame 0 add pot teapot
time 0 drop pot view height 0.2
frame 5 carry pot 0.2 0.1 1.2
frame 9 turn pot 0 0 30
frame 10 release pot velocity 0.5 0 0.5
frame 12 surfaces skirt
frame 14 surfaces map
frame 15 unknown solid
frame 17 camera hold
frame 21 camera go
frame 22 radar sampled 32
frame 23 quality depth_stride 2 move_every_n_frames 2
frame 24 camera rewind
frame 30 quality from physics shadows off picture_every_n_frames 2
frame 44 quit
)";

TEST_F(CommandLine, ARecordedSessionReplaysToTheSamePicturesAndPoses) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path session = folder_ / "session", script = folder_ / "played.txt";
  std::ofstream(script) << kPlayed;
  const auto pictures = [&](const char* name) { return " --pictures " + (folder_ / name).string(); };
  const Outcome played =
      roomradar("run 'sim:table?frames=15&width=160&path=view&seed=2' --map " + map() +
                " --poses recorded --unknown free --at-end loop --script " + script.string() +
                " --record-session " + session.string() + pictures("played"));
  ASSERT_EQ(played.status, 0) << played.out;
  const fs::path report_path = folder_ / "replay.json";
  const Outcome replayed =
      roomradar("run " + session.string() + pictures("replayed") + " --report " + report_path.string());
  ASSERT_EQ(replayed.status, 0) << replayed.out;
  EXPECT_NE(replayed.out.find("replay: 44 of 44 frames the same as recorded"), std::string::npos)
      << replayed.out;
  const nlohmann::json report = nlohmann::json::parse(read_text(report_path));
  EXPECT_EQ(report["replay"], (nlohmann::json{{"same", 44}, {"different", 0}, {"recorded", 44}}));
  EXPECT_EQ(report["settings"]["unknown"], "free");
  EXPECT_EQ(read_text(folder_ / "played" / "000010.png"), read_text(folder_ / "replayed" / "000010.png"));

  // The same with decisions that depend on a clock: a budget that cannot be met takes the last step of the
  // Pareto front.
  const fs::path hurried = folder_ / "hurried", hurried_report = folder_ / "hurried.json";
  const Outcome in_hurry = file("run 'sim:table?frames=15&width=160&path=view&seed=2' --map " + map() +
                                " --poses recorded --budget-ms 1 --record-session " + hurried.string() +
                                pictures("hurried") + " --report " + hurried_report.string());
  ASSERT_EQ(in_hurry.status, 0) << in_hurry.out;
  EXPECT_NE(in_hurry.out.find("budget 1 ms: with "), std::string::npos) << in_hurry.out;
  const nlohmann::json budget = nlohmann::json::parse(read_text(hurried_report))["budget"];
  EXPECT_EQ(budget["frames"], 15);
  EXPECT_EQ(budget["settings"].back()["step"], budget["steps"].get<int>() - 1);
  const Outcome again = roomradar("run " + hurried.string() + pictures("again"));
  EXPECT_NE(again.out.find("replay: 15 of 15 frames the same as recorded"), std::string::npos) << again.out;
  expect_fault(roomradar("run " + hurried.string() + " --budget-ms 33"), 1, "also has quality events");
  // Without pictures, objects move in the same frames.
  const Outcome unseen = roomradar("run " + session.string());
  EXPECT_NE(unseen.out.find("replay: 44 of 44 frames the same as recorded"), std::string::npos) << unseen.out;

  // Recorded frames already include calibration and range; neither may be applied twice.
  expect_fault(roomradar("run " + session.string() + " --calibration c.json"), 2, "with its recorded frames");
  expect_fault(roomradar("run " + session.string() + " --frames 3:9"), 2, "from its first frame");
  expect_fault(roomradar("run " + session.string() + " --object teapot"), 2, "has its own objects");

  // Differences are reported: dropped from higher up, the pot ends elsewhere.
  std::ofstream(script) << "frame 0 add pot teapot\nframe 0 drop pot view height 0.4\nframe 44 quit\n";
  const Outcome other = roomradar("run " + session.string() + " --script " + script.string());
  EXPECT_EQ(other.status, 0) << other.out;
  EXPECT_EQ(other.out.find("replay: 44 of 44"), std::string::npos) << other.out;
  EXPECT_NE(other.out.find("the first that is not"), std::string::npos) << other.out;
  // A session needs an empty folder, and its frames are a source like others.
  expect_fault(roomradar("run 'sim:table?frames=3&width=160' --map " + map() + " --record-session " +
                         session.string()),
               1, "not empty");
  EXPECT_EQ(roomradar("record " + session.string() + " " + (folder_ / "frames").string()).status, 0);
}

TEST_F(CommandLine, ASessionRecordedWithFormerNamesReplaysTheSame) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path session = folder_ / "old_names", script = folder_ / "old_names.txt";
  std::ofstream(script) << "frame 0 add pot teapot\ntime 0 drop pot view height 0.2\n"
                           "frame 3 quality object_turns 3 picture_turns 2 mesh_sigmas 2\n";
  const Outcome played =
      roomradar("run 'sim:table?frames=12&width=160&path=view&seed=2' --poses recorded --map " + map() +
                " --shadow-every 4 --commit-changes 9 --script " + script.string() + " --record-session " +
                session.string());
  ASSERT_EQ(played.status, 0) << played.out;
  const auto rename = [](std::string& text, const std::string& name, const std::string& old_name) {
    ASSERT_NE(text.find(name), std::string::npos) << name << " is not in " << text;
    EXPECT_EQ(text.find(old_name), std::string::npos) << text;
    for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;)
      text.replace(at, name.size(), old_name);
  };
  for (const char* file : {"session.json", "events.txt"}) {
    std::string text = read_text(session / file);
    const std::map<std::string, std::string> old_names{{"mesh_tolerance_sigmas", "mesh_sigmas"},
                                                       {"move_every_n_frames", "object_turns"},
                                                       {"shadow_every_n_frames", "shadow_turns"},
                                                       {"picture_every_n_frames", "picture_turns"}};
    for (const auto& [name, old_name] : old_names) rename(text, name, old_name);
    if (file == std::string("session.json")) rename(text, "commit_s", "adopt_s");
    std::ofstream(session / file) << text;
  }
  const Outcome replayed = roomradar("run " + session.string());
  EXPECT_EQ(replayed.status, 0) << replayed.out;
  EXPECT_NE(replayed.out.find("replay: 12 of 12 frames the same"), std::string::npos) << replayed.out;
}

TEST_F(CommandLine, ARunThatCannotBeginLeavesNoSession) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path session = folder_ / "not-begun";
  const std::string run =
      "run 'sim:table?frames=2&width=160' --map " + map() + " --record-session " + session.string();
  expect_fault(roomradar(run + " --object /no/such/pot.obj"), 1, "/no/such/pot.obj");
  expect_fault(roomradar(run + " --video " + (folder_ / "film.gif").string()), 1, "film.gif");
  EXPECT_FALSE(fs::exists(session));
  EXPECT_EQ(roomradar(run).status, 0);
}

TEST_F(CommandLine, ASessionThatWasCutOffReplaysToWhereItCame) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path session = folder_ / "cut";
  const Outcome played =
      roomradar("run 'sim:table?frames=12&width=160&path=view&seed=2' --poses recorded --map " + map() +
                " --record-session " + session.string());
  ASSERT_EQ(played.status, 0) << played.out;
  // As if killed: the last frame's entry and the last result are incomplete.
  fs::resize_file(session / "frames" / "list.bin", fs::file_size(session / "frames" / "list.bin") - 9);
  fs::resize_file(session / "results.txt", fs::file_size(session / "results.txt") - 20);
  const Outcome replayed = roomradar("run " + session.string());
  EXPECT_EQ(replayed.status, 0) << replayed.out;
  EXPECT_NE(replayed.out.find("replay: 11 of 11 frames the same"), std::string::npos) << replayed.out;

  // As if the disk had been full: the last remaining result and the last event are cut within a number.
  fs::resize_file(session / "results.txt", fs::file_size(session / "results.txt") - 21);
  std::ofstream(session / "events.txt", std::ios::app) << "frame 12 tur";
  const Outcome cut_again = roomradar("run " + session.string());
  EXPECT_EQ(cut_again.status, 0) << cut_again.out;
  EXPECT_NE(cut_again.out.find("replay: 10 of 10 frames the same"), std::string::npos) << cut_again.out;

  // Killed while the camera was held, with an event after the end: the replay ends with the results.
  const fs::path held = folder_ / "cut-held", script = folder_ / "held.txt";
  std::ofstream(script) << "frame 0 add pot teapot\nframe 5 quality radar_px 32\nframe 8 camera hold\n"
                           "frame 40 quit\n";
  ASSERT_EQ(
      roomradar("run 'sim:table?frames=12&width=160&path=view&seed=2' --poses recorded --at-end stay --map " +
                map() + " --shadows off --script " + script.string() + " --record-session " + held.string())
          .status,
      0);
  std::string events = read_text(held / "events.txt");
  const std::size_t quality = events.find(" quality ");
  ASSERT_NE(quality, std::string::npos) << events;
  EXPECT_NE(events.substr(quality, events.find('\n', quality) - quality).find(" shadows off"),
            std::string::npos)
      << "what an option asks for stays: " << events;
  events.resize(events.find("frame 40 quit"));
  std::ofstream(held / "events.txt") << events;
  const Outcome ended = roomradar("run " + held.string());
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_NE(ended.out.find("replay: 40 of 40 frames the same"), std::string::npos) << ended.out;

  std::ofstream(session / "session.json") << "{ \"format\": \"roomradar session\", \"format_version\": 9 }";
  expect_fault(roomradar("run " + session.string()), 1, "version 9,");
  std::ofstream(session / "session.json") << "{ \"format\": \"roomr";
  expect_fault(roomradar("run " + session.string()), 1, "session.json: is not the settings");
  fs::remove(session / "session.json");
  fs::remove_all(session / "frames");
  expect_fault(roomradar("run " + session.string() + " --map " + map()), 1, session.string());
}

TEST_F(CommandLine, AWindowWithoutADisplaySaysWhatToDo) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const Outcome outcome = shell("env -u DISPLAY -u WAYLAND_DISPLAY " ROOMRADAR_PROGRAM
                                " run 'sim:table?frames=3&width=160' --window --map " +
                                map());
  expect_fault(outcome, 1, "--video");
}

TEST_F(CommandLine, UnknownSpaceIsSolidByDefaultAndNeedsTheMap) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path report_path = folder_ / "solid.json";
  const std::string run =
      "run 'sim:table?frames=20&width=160&path=view&seed=2' --poses recorded --map " + map();
  const Outcome ran = roomradar(run + " --report " + report_path.string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  const auto report = nlohmann::json::parse(read_text(report_path));
  EXPECT_EQ(report["settings"]["unknown"], "solid");
  EXPECT_EQ(report["stages"]["unknown"]["count"], 1);
  EXPECT_GT(report["unknown_triangles"], 100);
  EXPECT_GT(report["unknown_mb"].get<double>(), 12e-6 * report["unknown_triangles"].get<double>());
  EXPECT_EQ(report["objects"][0]["began_in_unknown"], false);
  EXPECT_EQ(report["objects"][0]["rests_on"], "seen static");
  ASSERT_EQ(roomradar(run + " --surfaces skirt --report " + report_path.string()).status, 0);
  EXPECT_EQ(nlohmann::json::parse(read_text(report_path))["settings"]["unknown"], "free");
  expect_fault(roomradar(run + " --surfaces skirt --unknown solid"), 2, "needs --surfaces map");
}

TEST_F(CommandLine, RunChangesNothingOfTheMap) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const auto state = [] {
    std::map<std::string, std::pair<std::string, fs::file_time_type>> files;
    for (const auto& entry : fs::directory_iterator(map()))
      if (entry.is_regular_file())  // not the objects that stay in the room
        files[entry.path().filename().string()] = {read_text(entry.path()), fs::last_write_time(entry)};
    return files;
  };
  const auto before = state();
  ASSERT_GT(before.size(), 4U);
  const Outcome ran =
      roomradar("run 'sim:table?frames=60&width=160&moving=hand&crate=comes' --commit-changes 0.5 --map " +
                map() + " --unknown solid");
  EXPECT_EQ(ran.status, 0) << ran.out;
  EXPECT_TRUE(state() == before);
}

TEST_F(CommandLine, RunFindsItselfAndDropsTheTeapotOnTheTable) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path report_path = folder_ / "run.json";
  const Outcome ran = roomradar("run 'sim:table?frames=60&width=160&path=view&seed=2' --map " + map() +
                                " --poses recorded --report " + report_path.string() + " --pictures " +
                                (folder_ / "pictures").string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  const nlohmann::json report = nlohmann::json::parse(read_text(report_path));
  for (const char* stage :
       {"read", "locate", "expected", "foreground", "mesh", "radar", "physics", "compose", "frame"})
    EXPECT_TRUE(report["stages"].contains(stage)) << stage;
  EXPECT_EQ(report["frames_located"], 60);
  ASSERT_EQ(report["objects"].size(), 1U);
  EXPECT_TRUE(report["objects"][0]["at_rest"]) << report.dump(2);
  EXPECT_EQ(report["settings"]["radar"], "exact");
  EXPECT_LE(report["deepest_penetration_m"], 1e-6);
  EXPECT_TRUE(fs::exists(folder_ / "pictures" / "000000.png"));
}

TEST_F(CommandLine, ARecordingWithoutColourRunsAsOneWithColourDoes) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  std::map<std::string, nlohmann::json> reports;
  for (const std::string colour : {"registered", "none"}) {
    const fs::path recording = folder_ / ("colour_" + colour), report_path = folder_ / (colour + ".json");
    const Outcome recorded =
        roomradar("record 'sim:table?frames=45&width=160&path=view&moving=hand&colour=" + colour + "' " +
                  recording.string());
    ASSERT_EQ(recorded.status, 0) << recorded.out;
    const Outcome ran =
        roomradar("run " + recording.string() + " --objects none --poses recorded --map " + map() +
                  " --report " + report_path.string() + " --pictures " + (folder_ / "colours").string());
    ASSERT_EQ(ran.status, 0) << ran.out;
    EXPECT_TRUE(fs::exists(folder_ / "colours" / "000000.png"));
    fs::remove_all(folder_ / "colours");
    reports[colour] = nlohmann::json::parse(read_text(report_path));
  }
  const auto& with = reports["registered"];
  const auto& without = reports["none"];
  EXPECT_EQ(without["frames_located"], 45);
  EXPECT_GT(without["moved_fraction_mean"], 0.001);
  for (const char* key : {"moved_fraction_mean", "dynamic_triangles_mean", "inferred_triangles_mean"})
    EXPECT_EQ(without[key], with[key]) << key;
  EXPECT_EQ(without["objects"][0]["position_m"], with["objects"][0]["position_m"]);
}

TEST_F(CommandLine, TheSampledRadarHoldsTheTeapotTooBySafeBounds) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path report_path = folder_ / "sampled.json";
  const Outcome ran =
      roomradar("run 'sim:table?frames=60&width=160&path=view&seed=2' --map " + map() +
                " --poses recorded --radar sampled --radar-px 32 --report " + report_path.string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  const nlohmann::json report = nlohmann::json::parse(read_text(report_path));
  EXPECT_EQ(report["settings"]["radar"], "sampled");
  EXPECT_TRUE(report["objects"][0]["at_rest"]) << report.dump(2);
  EXPECT_LE(report["deepest_penetration_m"], 1e-6);  // bounds are valid
}

TEST_F(CommandLine, WhatCameGoesIntoANewMapAndTheOldOneStaysAsItIs) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const auto bytes_of = [](const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.is_regular_file())  // not the objects that stay in the room
        files[entry.path().filename().string()] = read_text(entry.path());
    return files;
  };
  const auto before = bytes_of(map());
  const std::string changed = (folder_ / "changed").string();
  const fs::path report_path = folder_ / "commit.json";
  const Outcome ran = roomradar("run 'sim:table?frames=60&rate=10&width=160&path=view&crate=comes' --map " +
                                map() + " --poses recorded --commit-changes 0.8 --save-map " + changed +
                                " --report " + report_path.string());
  ASSERT_EQ(ran.status, 0) << ran.out;
  EXPECT_EQ(bytes_of(map()), before);
  EXPECT_EQ(roomradar("map verify " + changed).status, 0);
  EXPECT_TRUE(fs::exists(fs::path(changed) / "texture.jpg"));  // carried over to the changed surface
  EXPECT_EQ(roomradar("map export " + changed + " " + (folder_ / "changed.glb").string()).status, 0);
  const nlohmann::json report = nlohmann::json::parse(read_text(report_path));
  ASSERT_EQ(report["committed"].size(), 1U) << report["committed"].dump(2);
  EXPECT_EQ(report["committed"][0]["change"], "came");
  EXPECT_GT(report["committed"][0]["time_s"], 3.7);
  EXPECT_TRUE(report["stages"].contains("changes"));
  const Outcome diff = roomradar("map diff " + map() + " " + changed);
  EXPECT_EQ(diff.status, 0) << diff.out;
  EXPECT_NE(diff.out.find("appeared"), std::string::npos) << diff.out;
  EXPECT_EQ(diff.out.find("vanished"), std::string::npos) << diff.out;

  // It may overwrite the room's own map if the user names it.
  const fs::path own = broken_copy();
  const Outcome again =
      roomradar("run 'sim:table?frames=60&rate=10&width=160&path=view&crate=comes' --map " + own.string() +
                " --poses recorded --commit-changes 0.8 --save-map " + own.string());
  EXPECT_EQ(again.status, 0) << again.out;
  EXPECT_EQ(read_text(own / "octree.bin"), read_text(fs::path(changed) / "octree.bin"))
      << "the same each time";
  EXPECT_EQ(read_text(own / "mesh.ply"), read_text(fs::path(changed) / "mesh.ply"));
}

TEST_F(CommandLine, SavingAMapThatCannotChangeIsRefused) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string run = "run 'sim:table?frames=100000&width=160' --map " + map();
  expect_fault(roomradar(run + " --save-map " + (folder_ / "unused").string()), 1, "--commit-changes");
  expect_fault(roomradar(run + " --commit-changes 1 --save-map " + folder_.string()), 1, folder_.string());
  expect_fault(roomradar(run + " --commit-changes 1 --surfaces holes"), 1, "--surfaces map");
  expect_fault(roomradar(run + " --commit-changes 0"), 2, "86400");
  expect_fault(roomradar(run + " --commit-changes nan"), 2, "86400");
}

TEST_F(CommandLine, TradeSweepsAndWritesItsFiles) {
  const auto path = [](const char* name) { return (folder_ / name).string(); };
  const Outcome traded =
      roomradar("trade --quick --only prescan --rooms wall --settings 2 --repeats 1 --csv " +
                path("trade.csv") + " --html " + path("trade.html") + " --report " + path("trade.json"));
  ASSERT_EQ(traded.status, 0) << traded.out;
  EXPECT_NE(traded.out.find("default"), std::string::npos) << traded.out;
  const std::string csv = read_text(path("trade.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 + 3) << csv;
  const std::string page = read_text(path("trade.html"));
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("seed 1, 1 repeat in each scene"), std::string::npos);
  const nlohmann::json report = nlohmann::json::parse(read_text(path("trade.json")));
  EXPECT_EQ(report["command"], "trade");
  EXPECT_EQ(report["prescan"]["measurements"], 3);
  expect_fault(roomradar("trade --quick --rooms 'table?colour=separate' --settings 1"), 1, "colour=");
  expect_fault(roomradar("trade --rooms 'table?noise=3' --settings 1"), 1, "only its name and seed");
  expect_fault(roomradar("trade --only prescan --rooms 'table?width=320' --settings 1"), 1, "width=");
  expect_fault(roomradar("trade --rooms attic --settings 2 --quick"), 1, "table");
  const std::string half_posed = path("half_posed");
  ASSERT_EQ(roomradar("record 'sim:table?frames=70&width=64&path=view' " + half_posed).status, 0);
  shell("sed -i '68,$d' " + half_posed + "/groundtruth.txt");
  expect_fault(roomradar("trade --only run --quick --rooms wall --settings 1 " + half_posed), 1,
               "not all frames have poses");
  expect_fault(roomradar("trade --html " + path("none/trade.html")), 1, "none/trade.html");
  expect_fault(roomradar("trade --quick --only prescan " + path("none")), 1, "none");
  expect_fault(roomradar("trade --settings 0"), 2, "--settings");
  expect_fault(roomradar("trade --only run --presets " + path("p.json")), 2, "--presets");
  expect_fault(roomradar("trade --compare-published --csv " + path("t.csv")), 2, "--csv");
  expect_fault(roomradar("trade --compare-published --rooms table,wall"), 2, "--compare-published");
  expect_fault(roomradar("trade --repeats x"), 2, "--repeats");
  expect_fault(roomradar("trade --seed 010"), 2, "without leading zeros, not 010");
  expect_fault(roomradar("trade --seed -1"), 2, "must be a whole number");
  expect_fault(roomradar("trade --only prescan --objects 5"), 2, "--objects");
  expect_fault(roomradar("trade --only both"), 2, "prescan");
  expect_fault(roomradar("trade --rooms none"), 2, "--rooms none: leaves nothing");
  expect_fault(roomradar("trade --processes 2"), 2, "--processes: used only with --jobs");
  expect_fault(roomradar("trade --jobs " + path("j") + " --presets " + path("p.json")), 2,
               "leave out --jobs");
  const std::string one = "trade --only prescan --rows " + path("r.json");
  expect_fault(roomradar(one), 2, "--setting and --rows");
  expect_fault(roomradar(one + " --setting default --seed 2"), 2, "--seed: used only for a sweep");
  expect_fault(roomradar("trade --setting default --rows " + path("r.json")), 2, "--only");
  expect_fault(roomradar(one + " --rooms wall --setting fuse_every=5"), 1, "fuse_every=5: the values");
  expect_fault(roomradar(one + " --setting default"), 1, "choose one");
  EXPECT_FALSE(fs::exists(path("j")));
}

TEST_F(CommandLine, WrongUsageIsStatusTwo) {
  EXPECT_EQ(roomradar("").status, 2);
  EXPECT_EQ(roomradar("dance").status, 2);
  EXPECT_EQ(roomradar("prescan").status, 2);
  EXPECT_EQ(roomradar("--help").status, 0);
  EXPECT_EQ(roomradar("prescan --help").status, 0);
  const std::string prescan = "prescan sim:table --map " + (folder_ / "unused").string();
  expect_fault(roomradar(prescan + " --resolution 0"), 2, "0.001");
  expect_fault(roomradar(prescan + " --resolution nan"), 2, "0.001");
  expect_fault(roomradar(prescan + " --resolution -0.01"), 2, "0.001");
  expect_fault(roomradar(prescan + " --frames 9:3"), 2, "A:B");
  expect_fault(roomradar(prescan + " --frames x"), 2, "A:B");
  expect_fault(roomradar(prescan + " --hold-out 1"), 2,
               "--hold-out: must be a whole number between 2 and 1000000, not 1");
  expect_fault(roomradar(prescan + " --map twice"), 2, "--map: is given 2 times; give it once");
  expect_fault(roomradar("prescan sim:table --map"), 2, "--map: needs a value, DIR: folder for the map");
  expect_fault(roomradar("run sim:table --map m --window=3"), 2, "--window: takes no value");
  expect_fault(roomradar("map info m --json=x"), 2, "--json: takes no value");
  expect_fault(roomradar("trade --only foo"), 2, "--only foo: must be prescan or run");
  expect_fault(roomradar("trade --objects 3"), 2, "--objects: must be 1, 5 or 20, not 3");
  expect_fault(roomradar("run sim:table --map m --depth-stride 3"), 2, "--depth-stride 3: must be 1, 2 or 4");
  expect_fault(roomradar("calibrate sim:board --out c.json --rows 1"), 2,
               "--rows: must be a whole number between 3 and 30, not 1");
  for (const char* number : {"nan", "-5", "inf", "1e9", "x"}) {
    expect_fault(roomradar(prescan + " --max-memory " + number), 2, "10000000 (megabytes)");
    expect_fault(roomradar(prescan + " --checkpoint-every " + number), 2, "86400 (seconds)");
  }
  expect_fault(roomradar(prescan + " --poses guessed"), 2,
               "--poses guessed: must be auto, recorded or tracked");
  const std::string run = "run sim:table --map " + map();
  expect_fault(roomradar(run + " --radar roughly"), 2, "--radar roughly: must be exact, sampled or passes");
  expect_fault(roomradar(run + " --object teapot --script s.txt"), 2, "--script says which objects");
  expect_fault(roomradar(run + " --radar-px 0"), 2, "4096");
  expect_fault(roomradar("fallthrough --map " + map()), 2, "--map: used only with a SOURCE");
  expect_fault(roomradar("fallthrough sim:table --map " + map() + " --csv " + (folder_ / "f.csv").string()),
               2, "--csv: used only for simulated rooms");
  expect_fault(roomradar("fallthrough --scenario 1 --video v.avi --html " + (folder_ / "f.html").string()), 2,
               "--html: not available with --scenario");
  expect_fault(roomradar("fallthrough sim:table"), 2, "--map");
  expect_fault(roomradar(prescan + " --presets p.json"), 2, "--preset NAME");
  expect_fault(roomradar(run + " --presets p.json"), 2, "--budget-ms");
  expect_fault(roomradar(run + " --pictures-stride 3"), 2, "--pictures");
  EXPECT_NE(roomradar(run + " --preset fast --presets /no/p.json").out.find("/no/p.json"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "unused"));
}

TEST_F(CommandLine, TheManualHasTheOrderOfTheHelpAndNoneOfTheParsersRanges) {
  const std::string manual = roomradar("--manual").out;
  EXPECT_EQ(manual.find(" in ["), std::string::npos);
  EXPECT_EQ(manual.find(":INT"), std::string::npos);
  const std::string run = manual.substr(manual.find(".SS run"));
  EXPECT_LT(run.find("\n.B \\-\\-window"), run.find("\\-\\-frames \""));
  EXPECT_LT(run.find("\\-\\-object \""), run.find("\\-\\-poses \""));
}

TEST_F(CommandLine, HelpOfEveryOptionEndsWithItsDefault) {
  std::istringstream manual(roomradar("--manual").out);
  std::string option, help;
  int options = 0;
  const auto check = [&] {
    if (option.empty()) return;
    ++options;
    EXPECT_EQ(help.back(), ')') << option << ": " << help;
    EXPECT_TRUE(help.find("(default: ") != std::string::npos || help.find("(required") != std::string::npos)
        << option << ": " << help;
  };
  for (std::string line; std::getline(manual, line) && line != ".SH SCRIPT";) {
    if (line == ".TP" || line.starts_with(".SS")) {
      check();
      option.clear();
      help.clear();
      if (line == ".TP") std::getline(manual, option);
    } else {
      help = help.empty() ? line : help + " " + line;
    }
  }
  check();
  EXPECT_GT(options, 90);
}

/// Returns the number of lines that hold a word.
std::size_t lines_with(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.find(word) != std::string::npos ? 1 : 0;
  return count;
}

TEST_F(CommandLine, AMisspeltWordIsAnsweredWithTheNearestOne) {
  expect_fault(roomradar("hlep"), 2, "roomradar: there is no command 'hlep'; did you mean help?");
  expect_fault(roomradar("presacn x"), 2, "did you mean prescan?");
  expect_fault(roomradar("map exprot M x.ply"), 2,
               "roomradar map: there is no command 'exprot'; did you mean export?");
  expect_fault(roomradar("run x --map y --objct z"), 2,
               "roomradar run: there is no option --objct; did you mean --object?");
  expect_fault(roomradar("run x --map y --vid z"), 2, "did you mean --video?");
  expect_fault(roomradar("--versoin"), 2, "did you mean --version?");
  const Outcome unlike = roomradar("qwertyuiop");
  expect_fault(unlike, 2, "there is no command 'qwertyuiop'; the commands are\n");
  EXPECT_EQ(unlike.out.find("did you mean"), std::string::npos) << unlike.out;
}

TEST_F(CommandLine, AloneInAPipeItNamesTheFirstThreeCommands) {
  const Outcome alone = roomradar("");
  for (const char* line : {"\n  roomradar doctor ", "\n  roomradar prescan kinect:0 --map maps/kitchen ",
                           "\n  roomradar run kinect:0 --map maps/kitchen --window\n"})
    expect_fault(alone, 2, line);
  EXPECT_EQ(alone.out.find("required"), std::string::npos) << alone.out;
  expect_fault(roomradar("map"), 2, "  export ");
}

TEST_F(CommandLine, ANameInPlaceOfACommandIsOpenedInTheStartView) {
  const std::string blind = "env -u DISPLAY -u WAYLAND_DISPLAY ";
  for (const char* start : {" ", " start "}) {
    const Outcome outcome = shell(blind + ROOMRADAR_PROGRAM + start + map());
    EXPECT_EQ(outcome.status, 1) << outcome.out;
    EXPECT_TRUE(outcome.out.find("there is no display") != std::string::npos ||
                outcome.out.find("without a window") != std::string::npos)
        << outcome.out;
  }
  expect_fault(roomradar("/no/such/map"), 2, "there is no command '/no/such/map'");
}

TEST_F(CommandLine, AMissingArgumentIsNamedWithItsMeaning) {
  expect_fault(roomradar("map export " + map()), 2, "roomradar map export: FILE is missing: file to write");
  expect_fault(roomradar("prescan sim:table"), 2, "--map is missing: folder for the map");
  expect_fault(roomradar("map verify a b"), 2, "more arguments than it takes: b");
}

TEST_F(CommandLine, HelpExplainsCommandsAndTopics) {
  for (const char* topic : {"script", "models", "sources", "units", "calibrate", "files"})
    EXPECT_GT(roomradar(std::string("help ") + topic).out.size(), 500U) << topic;
  EXPECT_EQ(roomradar("help").out, roomradar("--help").out);
  EXPECT_EQ(roomradar("help run").out, roomradar("run --help").out);
  EXPECT_EQ(roomradar("help map export").out, roomradar("map export --help").out);
  expect_fault(roomradar("help scirpt"), 2, "did you mean script?");
  expect_fault(roomradar("help kinect"), 2, "no command or topic 'kinect'; known are start, prescan, run, ");
}

TEST_F(CommandLine, EveryHelpHasGroupsOfKnownOptionsAndTwoExamples) {
  for (const char* command : {"start",    "prescan",    "run",         "building",  "serve",     "record",
                              "simulate", "calibrate",  "fallthrough", "farm",      "trade",     "doctor",
                              "map info", "map verify", "map export",  "map merge", "map diff",  "map list",
                              "map copy", "map rename", "map delete",  "map pack",  "map unpack"}) {
    const std::string help = roomradar(std::string(command) + " --help").out;
    EXPECT_GE(lines_with(help, std::string("roomradar ") + command + " ") +
                  lines_with(help, std::string("roomradar ") + command + "\n"),
              command == std::string("doctor") ? 1U : 3U)
        << help;  // usage and two examples
    // Only the help option is left over by the groups.
    const std::size_t rest = help.find("\nOther:\n");
    if (rest == std::string::npos) continue;
    EXPECT_EQ(lines_with(help.substr(rest, help.find("\nExamples:") - rest), "  -"), 1U) << help.substr(rest);
  }
}

TEST_F(CommandLine, CompletionKnowsCommandsOptionsAndChoices) {
  const std::string script = (folder_ / "completion.bash").string();
  std::ofstream(script) << roomradar("--completion bash").out;
  const auto completed = [&](const std::string& words) {
    return shell("bash -c 'source " + script + "; COMP_WORDS=(roomradar " + words +
                 "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _roomradar; echo ${COMPREPLY[*]}'")
        .out;
  };
  EXPECT_EQ(completed("pre"), "prescan\n");
  EXPECT_EQ(completed("map ver"), "verify\n");
  EXPECT_EQ(completed("run x --unk"), "--unknown\n");
  EXPECT_EQ(completed("run x --unknown \"\""), "free solid\n");
  EXPECT_EQ(completed("help scr"), "script\n");
  EXPECT_EQ(completed("map export x --u"), "--unknown\n");
  EXPECT_EQ(shell("bash -n " + script).status, 0);
  const std::string zsh = roomradar("--completion zsh").out;
  EXPECT_EQ(zsh.rfind("#compdef roomradar", 0), 0U);
  // The compatibility needs compdef, which a shell without set-up of its own lacks.
  EXPECT_LT(zsh.find("autoload -U compinit && compinit"), zsh.find("bashcompinit && bashcompinit"));
  EXPECT_EQ(completed("--ver"), "--version\n");
  EXPECT_EQ(completed("run x --preset b"), "balanced\n");
  expect_fault(roomradar("--completion fish"), 2, "--completion fish: must be bash or zsh");
  expect_fault(roomradar("--completion"), 2, "--completion: needs a value");
}

TEST_F(CommandLine, MapInfoListsTheLevelSurfaces) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const nlohmann::json info = nlohmann::json::parse(roomradar("map info --json " + map()).out);
  ASSERT_GE(info["surfaces"].size(), 2U);
  bool has_floor = false, has_table = false;
  for (const nlohmann::json& surface : info["surfaces"]) {
    if (surface["floor"]) {
      has_floor = true;
      EXPECT_NEAR(surface["height_m"], 0.0, 0.02);  // new maps have their floor at z = 0
    }
    has_table |= std::abs(surface["height_m"].get<double>() - 0.74) < 0.03 && surface["area_m2"] > 0.3;
  }
  EXPECT_TRUE(has_floor);
  EXPECT_TRUE(has_table);
  EXPECT_NE(roomradar("map info " + map()).out.find("(floor)"), std::string::npos);
}

TEST_F(CommandLine, ARecordingInPlaceOfAMapIsPointedToCheck) {
  const fs::path recording = folder_ / "a recording";
  ASSERT_EQ(
      roomradar("record 'sim:table?frames=3&width=64' '" + recording.string() + "' --format tum").status, 0);
  const std::string quoted = "'" + recording.string() + "'";
  for (const std::string& command :
       {"map info " + quoted, "map info --json " + quoted, "map verify " + quoted,
        "map export " + quoted + " " + (folder_ / "recording.ply").string()}) {
    const Outcome outcome = roomradar(command);
    expect_fault(outcome, 1, "is a recording (TUM RGB-D recording), not a map");
    expect_fault(outcome, 1, "`roomradar check " + quoted + "`");
  }
}

TEST_F(CommandLine, CausesAreTheTrueOnes) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string run = "run 'sim:table?frames=5&width=160' --map " + map();
  const Outcome video = roomradar(run + " --video /proc/x.mp4");
  expect_fault(video, 1, "/proc/x.mp4: cannot be written: the system makes no files in /proc");
  EXPECT_EQ(video.out.find("full"), std::string::npos) << video.out;
  expect_fault(roomradar(run + " --video /no/such/folder/x.mp4"), 1, "its folder does not exist");
  expect_fault(roomradar(run + " --stream /proc/x"), 1,
               "/proc/x: cannot be written: the system makes no files");
  const Outcome report = roomradar(run + " --report /proc/x.json");
  expect_fault(report, 1, "/proc/x.json: cannot be written: the system makes no files in /proc");
  EXPECT_EQ(report.out.find("frames in"), std::string::npos) << "said after the work: " << report.out;
}

TEST_F(CommandLine, UpIsStatedWhereItIsNotKnown) {
  const std::string scan =
      "prescan 'sim:table?frames=20&width=160' --resolution 0.05 --map " + (folder_ / "up").string();
  expect_fault(roomradar(scan + " --up sideways"), 2, "must be camera, or a direction X,Y,Z");
  expect_fault(roomradar(scan + " --up 0,0,0"), 2, "must be camera, or a direction X,Y,Z");
  const Outcome scanned = roomradar(scan + " --up 0,-1,0");
  EXPECT_EQ(scanned.status, 0) << scanned.out;
  expect_fault(roomradar("map info " + (folder_ / "up").string()), 0, "up              as given by --up");
}

TEST_F(CommandLine, ACameraThatIsHeldDoesNotRunForEver) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string script = (folder_ / "hold.txt").string();
  std::ofstream(script) << "frame 3 camera hold\nframe 6 surfaces skirt\nframe 5 surfaces map\n";
  const std::string report = (folder_ / "hold.json").string();
  const Outcome held = roomradar("run 'sim:table?frames=10&width=160' --map " + map() + " --script " +
                                 script + " --report " + report);
  expect_fault(held, 0, "the camera repeats its frames and no scripted event is left");
  expect_fault(held, 0, "hold.txt:3: is due before an event above it, and waits for that");
  EXPECT_NEAR(nlohmann::json::parse(read_text(report))["frames_read"].get<double>(), 6 + 150, 3);
}

TEST_F(CommandLine, ARunThatDroppedNothingSaysSoAndLeavesNoVideo) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::filesystem::path video = folder_ / "nothing.avi";
  const Outcome run = roomradar("run 'sim:table?frames=10&width=160' --map " + map() +
                                " --objects none --object teapot,size=1.9 --video " + video.string());
  expect_fault(run, 1, "no object could be dropped: ");
  expect_fault(run, 1, video.string() + " is not written");
  EXPECT_FALSE(std::filesystem::exists(video));
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

TEST_F(CommandLine, SourcesThatAreNoneAreNamed) {
  const std::string to = " --map " + (folder_ / "unused").string();
  expect_fault(roomradar("prescan /no/such/folder" + to), 1, "/no/such/folder");
  const fs::path empty = folder_ / "empty";
  fs::create_directories(empty);
  expect_fault(roomradar("prescan " + empty.string() + to), 1, empty.string());
  expect_fault(roomradar("prescan sim:palace" + to), 1, "table");
  expect_fault(roomradar("prescan kinect:x" + to), 1, "kinect:N");
  expect_fault(roomradar("prescan kinect:0?depth=registered --calibration c.json" + to), 1,
               "registered depth");
  expect_fault(roomradar("calibrate kinect:0?depth=registered --square 0.03 --out c.json"), 1,
               "registered depth");
  expect_fault(roomradar("prescan 'sim:table?frames=10' --frames 8:12" + to), 1, "10");
  const fs::path loop = folder_ / "loop";
  fs::create_symlink("loop", loop);
  expect_fault(roomradar("prescan " + loop.string() + to), 1, "cannot be used: ");
  expect_fault(roomradar("prescan 'sim:table?frames=10' --map " + (loop / "map").string()), 1,
               "cannot be used: ");
  EXPECT_FALSE(fs::exists(folder_ / "unused"));
}

TEST_F(CommandLine, WhatCannotBeWrittenOrLoadedIsSaidBeforeTheWork) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string source = "'sim:table?frames=100000&width=160'";  // would take hours if it started
  expect_fault(roomradar("prescan " + source + " --map " + (folder_ / "unused").string() +
                         " --report /no/such/r.json"),
               1, "/no/such/r.json");
  expect_fault(roomradar("run " + source + " --map " + map() + " --report /no/such/r.json"), 1,
               "/no/such/r.json");
  const fs::path script = folder_ / "events.txt";
  std::ofstream(script) << "frame 90000 add pot /no/such/pot.obj\n";
  expect_fault(roomradar("run " + source + " --map " + map() + " --script " + script.string()), 1,
               "/no/such/pot.obj");
}

TEST_F(CommandLine, NothingElseIsPutIntoAMapsFolder) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string source = "'sim:table?frames=100000&width=160'";  // would take hours if it started
  const std::string json = map() + "/map.json", rule = "lies in the folder of a map";
  expect_fault(roomradar("prescan " + source + " --map " + map() + "/below"), 1, rule);
  expect_fault(
      roomradar("prescan " + source + " --map " + (folder_ / "unused").string() + " --report " + json), 1,
      rule);
  expect_fault(roomradar("map diff " + map() + " " + map() + " --report " + json), 1, rule);
  const std::string run = "run " + source + " --map " + map();
  expect_fault(roomradar(run + " --video " + map() + "/ar.avi"), 1, rule);
  for (const char* below : {"", "/", "/below", "/below/"}) {
    expect_fault(roomradar(run + " --pictures " + map() + below), 1, rule);
    expect_fault(roomradar(run + " --record-session " + map() + below), 1, rule);
    expect_fault(roomradar("record " + source + " " + map() + below), 1, rule);
    expect_fault(roomradar("simulate " + map() + below), 1, rule);
  }
  expect_fault(roomradar("map diff " + map() + " " + map() + " --picture " + map() + "/coverage.png"), 1,
               rule);
  expect_fault(roomradar("map export " + map() + " " + map() + "/mesh.ply"), 1, rule);
  EXPECT_EQ(roomradar("map verify " + map()).status, 0);
}

TEST_F(CommandLine, NothingElseIsPutIntoAFolderThatIsToBecomeAMap) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string source = "'sim:table?frames=100000&width=160'";  // would take hours if it started
  const std::string soon = (folder_ / "soon").string(), rule = "which is to be a map";
  fs::create_directory(soon);
  expect_fault(roomradar("prescan " + source + " --map " + soon + "/ --report " + soon + "/r.json"), 1, rule);
  expect_fault(
      roomradar("map merge " + map() + " " + map() + " --map " + soon + " --report " + soon + "/r.json"), 1,
      rule);
  const std::string run = "run " + source + " --map " + map() + " --commit-changes 2 --save-map " + soon;
  for (const char* output : {"--pictures", "--record-session", "--frames-csv", "--report", "--video"})
    expect_fault(roomradar(run + " " + output + " " + soon + "/../soon/new.avi"), 1, rule);
  expect_fault(roomradar(run + " --pictures " + soon), 1, rule);
  EXPECT_TRUE(fs::is_empty(soon));
}

TEST_F(CommandLine, AReportCannotBeAFolderNorAPictureAnythingButPng) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string diff = "map diff " + map() + " " + map();
  expect_fault(roomradar(diff + " --report " + folder_.string()), 1, "a folder has that name");
  const std::string jpg = (folder_ / "picture.jpg").string();
  expect_fault(roomradar(diff + " --picture " + jpg), 1, ".png");
  expect_fault(roomradar("fallthrough sim:table --map " + map() + " --picture " + jpg), 1, ".png");
  expect_fault(roomradar("calibrate sim:board --out " + (folder_ / "c.json").string() + " --plot " + jpg), 1,
               ".png");
  expect_fault(roomradar("fallthrough --scenario 1 --video " + (folder_ / "v.webm").string()), 1, ".mp4");
}

TEST_F(CommandLine, RecordedPosesAreNotTakenForThoseOfAMapThatKnowsNone) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path blind = broken_copy();
  nlohmann::json info = nlohmann::json::parse(read_text(blind / "map.json"));
  ASSERT_EQ(info["settings"]["poses"], "auto");
  for (int i = 0; i < 16; ++i) info["T_world_recorded"][i] = i % 5 == 0 ? 1.0 : 0.0;
  std::ofstream(blind / "map.json") << info;
  const std::string run = "run 'sim:table?frames=2&width=160' --map " + blind.string() + " --poses ";
  expect_fault(roomradar(run + "recorded"), 1, "use --poses tracked");
  expect_fault(roomradar("fallthrough 'sim:table?width=160' --poses recorded --map " + blind.string()), 1,
               "use --poses tracked");
  EXPECT_EQ(roomradar(run + "tracked").status, 0);
}

TEST_F(CommandLine, AMapIsNotJoinedWithItself) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string joined = " --map " + (folder_ / "unused").string();
  expect_fault(roomradar("map merge " + map() + " " + map() + joined), 1, "the same map");
  expect_fault(roomradar("map merge " + map() + " " + broken_copy().string() + joined), 1, "the same map");
  expect_fault(roomradar("map merge " + map() + " " + map() + joined + " --deviation -1"), 2, "--deviation");
  EXPECT_FALSE(fs::exists(folder_ / "unused"));
}

TEST_F(CommandLine, LeavingOutAllFramesIsSaid) {
  expect_fault(
      roomradar("prescan 'sim:table?frames=4&width=160' --frames 1:3 --fuse-every 200 --resolution 0.05 "
                "--map " +
                (folder_ / "left-out").string()),
      1, "no frame was left to be fused");
}

TEST_F(CommandLine, CalibratingPassesOverACalibrationThatIsThere) {
  const fs::path recording = folder_ / "board";
  ASSERT_EQ(roomradar("record 'sim:table?frames=2&width=160' " + recording.string()).status, 0);
  std::ofstream(recording / "calibration.json") << "{";
  expect_fault(roomradar("record " + recording.string() + " " + (folder_ / "copy").string()), 1,
               "calibration.json");
  const Outcome calibrated = roomradar("calibrate " + recording.string() + " --square 0.06 --out " +
                                       (folder_ / "new.json").string());
  EXPECT_EQ(calibrated.status, 1);
  EXPECT_EQ(calibrated.out.find("calibration.json"), std::string::npos) << calibrated.out;
}

TEST_F(CommandLine, ResultsThatAreLostOnTheirWayOutAreAFault) {
  for (const std::string& command : {"map info " + map(), std::string("--help"), std::string("doctor")})
    expect_fault(shell("(" ROOMRADAR_PROGRAM " " + command + " > /dev/full)"), 1, "stdout: ");
}

TEST_F(CommandLine, AMapOfOnesOwnIsNotTakenForAWalksAndReplaced) {
  const fs::path maps = folder_ / "maps_of_mine";
  fs::create_directories(maps);
  fs::copy(map(), maps / "table-1", fs::copy_options::recursive);
  expect_fault(roomradar("fallthrough --scenario 0 --video " + (folder_ / "never.avi").string() + " --maps " +
                         maps.string()),
               1, "is the map of sim:table");
  EXPECT_EQ(roomradar("map verify " + (maps / "table-1").string()).status, 0);
}

TEST_F(CommandLine, FramesAreNotCalibratedASecondTime) {
  const std::string raw = (folder_ / "as_taken").string(), freed = (folder_ / "freed").string(),
                    copy = (folder_ / "freed_copy").string(), session = (folder_ / "freed_played").string(),
                    file = (folder_ / "five_percent.json").string();
  ASSERT_EQ(roomradar("record 'sim:table?frames=2&width=160' " + raw + " --format 7scenes").status, 0);
  nlohmann::json calibration = nlohmann::json::parse(read_text(raw + "/camera.json"));
  const nlohmann::json straight = {{"k1", 0}, {"k2", 0}, {"p1", 0}, {"p2", 0}, {"k3", 0}};
  calibration["format"] = "roomradar calibration";
  calibration["depth_lens"] = calibration["colour_lens"] = straight;
  calibration["depth_correction"] = {
      {"inverse_scale", 1.05}, {"columns", 0}, {"rows", 0}, {"offset_per_m", nlohmann::json::array()}};
  std::ofstream(file) << calibration;
  const std::string by_it = " --calibration " + file;

  const Outcome recorded = roomradar("record " + raw + " " + freed + " --format 7scenes" + by_it);
  ASSERT_EQ(recorded.status, 0) << recorded.out;
  EXPECT_NE(read_text(freed + "/frame-000000.depth.png"), read_text(raw + "/frame-000000.depth.png"));
  ASSERT_EQ(roomradar("record " + freed + " " + copy + " --format 7scenes").status, 0);
  EXPECT_EQ(read_text(copy + "/frame-000000.depth.png"), read_text(freed + "/frame-000000.depth.png"));
  (void)roomradar("run " + freed + " --map " + map() + " --record-session " + session);

  for (const std::string& folder : {freed, copy, session}) {
    const std::string out = (folder_ / "never").string();
    expect_fault(roomradar("record " + folder + " " + out + by_it), 1, "before they were recorded");
    expect_fault(roomradar("prescan " + folder + " --map " + out + by_it), 1, "before they were recorded");
    expect_fault(roomradar("calibrate " + folder + " --square 0.06 --out " + out), 1,
                 "before they were recorded");
    EXPECT_FALSE(fs::exists(out));
  }
  EXPECT_EQ(roomradar("record " + raw + " " + (folder_ / "freed_too").string() + by_it).status, 0);
}

TEST_F(CommandLine, HoldingOutNoFrameIsSaid) {
  const fs::path path = folder_ / "none_held.json";
  const Outcome scanned =
      roomradar("prescan 'sim:table?frames=10&width=160' --resolution 0.05 --hold-out 100 --map " +
                (folder_ / "none_held").string() + " --report " + path.string());
  expect_fault(scanned, 0, "no frame was held out");
  EXPECT_EQ(nlohmann::json::parse(read_text(path))["held_out"], nlohmann::json({{"frames", 0}}));
}

TEST_F(CommandLine, ARecordingWithoutAnyDepthIsRefusedInWords) {
  const fs::path recording = folder_ / "blank";
  ASSERT_EQ(
      roomradar("record 'sim:table?frames=5&width=160' " + recording.string() + " --format 7scenes").status,
      0);
  // Replaces every depth image by one of the same size without measurements, all 0.
  for (const auto& entry : fs::directory_iterator(recording)) {
    if (entry.path().string().ends_with(".depth.png"))
      fs::copy_file(fs::path(ROOMRADAR_SOURCE_DIR) / "tests/data/no_depth_160x120.png", entry.path(),
                    fs::copy_options::overwrite_existing);
  }
  expect_fault(roomradar("prescan " + recording.string() + " --map " + (folder_ / "unused").string()), 1,
               "depth");
  expect_fault(
      roomradar("prescan " + recording.string() + " --poses recorded --map " + (folder_ / "unused").string()),
      1, "depth");
  EXPECT_FALSE(fs::exists(folder_ / "unused"));
}

TEST_F(CommandLine, ABrokenMapIsRefusedAndTheFileNamed) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string run = "run 'sim:table?frames=2&width=160' --map ";
  expect_fault(roomradar(run + (folder_ / "no_map").string()), 1, "no_map");
  for (const char* name :
       {"map.json", "octree.bin", "mesh.ply", "places.bin", "trajectory.txt", "unknown.bin"}) {
    fs::path copy = broken_copy();
    fs::remove(copy / name);
    expect_fault(roomradar(run + copy.string()), 1, name);
    expect_fault(roomradar("map verify " + copy.string()), 1, name);

    copy = broken_copy();
    fs::resize_file(copy / name, fs::file_size(copy / name) / 2);
    expect_fault(roomradar(run + copy.string()), 1, name);

    copy = broken_copy();
    std::string bytes = read_text(copy / name);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x20);
    std::ofstream(copy / name, std::ios::binary) << bytes;
    expect_fault(roomradar("map verify " + copy.string()), 1, name);
  }
  const fs::path later = broken_copy();
  std::string json = read_text(later / "map.json");
  const std::size_t at = json.find("\"format_version\": 5");
  ASSERT_NE(at, std::string::npos) << json.substr(0, 300);
  json.replace(at, 19, "\"format_version\": 9");
  std::ofstream(later / "map.json", std::ios::binary) << json;
  expect_fault(roomradar(run + later.string()), 1, "version");
}

TEST_F(CommandLine, ObjectMeshesThatCannotBeOnesAreNamed) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string run = "run 'sim:table?frames=2&width=160' --map " + map() + " --object ";
  const auto object = [&](const char* name, const std::string& content) {
    const fs::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << content;
    return path.string();
  };
  expect_fault(roomradar(run + "/no/such.obj"), 1, "/no/such.obj");
  expect_fault(roomradar(run + object("no_faces.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), 1, "no_faces.obj");
  expect_fault(roomradar(run + object("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), 1, "nan.obj");
  expect_fault(roomradar(run + object("text.ply", "hello\n")), 1, "text.ply");
  std::string huge =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 10000000\nproperty list uchar int vertex_indices\nend_header\n";
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  huge.append(reinterpret_cast<const char*>(corners), sizeof corners);
  const std::string face("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  huge.reserve(huge.size() + 10'000'000 * face.size());
  for (int i = 0; i < 10'000'000; ++i) huge += face;
  expect_fault(roomradar(run + object("huge.ply", huge)), 1, "huge.ply");
}

TEST_F(CommandLine, SeveralObjectsEachWithASizeAPlaceAndAnAxis) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path box = folder_ / "box,1.obj";  // 300 long, 100 high along y
  std::ofstream(box) << "v 0 0 0\nv 300 0 0\nv 0 100 0\nv 0 0 100\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::string run = "run 'sim:table?frames=3&width=160' --objects none --map " + map();
  const std::string report = " --report " + (folder_ / "objects.json").string();
  const Outcome two =
      roomradar(run + " --object " + box.string() +
                ",size=0.3,at=0.4,1.2,1.0,friction=0.2 --object teapot,mass=2.5,at=-0.3,1.2,1.1" + report);
  ASSERT_EQ(two.status, 0) << two.out;
  const auto objects = nlohmann::json::parse(read_text(folder_ / "objects.json"))["objects"];
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0]["name"], "box,1");
  EXPECT_EQ(objects[1]["name"], "teapot");
  EXPECT_EQ(objects[0]["friction"], 0.2);
  EXPECT_EQ(objects[1]["mass_kg"], 2.5);
  EXPECT_EQ(objects[1]["friction"], 0.5);
  EXPECT_NEAR(objects[0]["position_m"][0].get<double>(), 0.4, 0.1);
  EXPECT_NEAR(objects[0]["middle_m"][2].get<double>() - objects[0]["position_m"][2].get<double>(), 0.05,
              0.02);

  // Where nobody scanned, nothing is put; what came into the room counts.
  expect_fault(roomradar(run + " --object teapot,at=0,-0.2,1"), 1, "that space was not scanned");
  const Outcome one =
      roomradar(run + " --object teapot,at=0,-0.2,1 --object " + box.string() + ",size=0.3,at=0.4,1.2,1.0");
  EXPECT_EQ(one.status, 0) << one.out;
  EXPECT_NE(one.out.find("teapot: not in the room"), std::string::npos) << one.out;

  expect_fault(roomradar(run + " --object " + box.string()), 1, "millimetres, use --object-size 0.3");
  expect_fault(roomradar(run + " --object " + box.string() + " --object teapot"), 1, "box,1.obj,size=0.3");
  EXPECT_EQ(roomradar(run + " --object " + box.string() + " --object-size 0.3 --object-up z").status, 0);
  std::ofstream(folder_ / "large.txt") << "frame 0 add box " << box.string() << "\n";
  expect_fault(roomradar(run + " --script " + (folder_ / "large.txt").string()), 1,
               "use add box " + box.string() + " size 0.3");
  for (const char* bad :
       {"teapot,size=0", "teapot,size=big", "teapot,up=w", "teapot,at=1,2", "teapot,at=1,2,x",
        "teapot,size=0.2,size=0.3", ",size=0.3", "teapot,mass=0", "teapot,mass=-1", "teapot,density=nan",
        "teapot,friction=11", "teapot,restitution=2", "teapot,mass=1,density=1000", "teapot,mass=1,mass=2"})
    expect_fault(roomradar(run + " --object " + bad), 2, "--object");
  for (const char* bad : {"teapot,siz=0.3", "teapot,size=0.3,siz=0.3", "teapot,siz=0.3,size=0.3"})
    expect_fault(roomradar(run + " --object " + bad), 2,
                 "there is no siz=; the keys are size=, up=, at=, mass=");
  expect_fault(roomradar(run + " --object teapt"), 1, "teapt: there is no such file; a model is a file .glb");
  expect_fault(roomradar(run + " --object-up w"), 2, "--object-up w");
  expect_fault(roomradar(run + " --object-size 0.3 --script s.txt"), 2, "--script says how");
}

TEST_F(CommandLine, ATexturedObjectIsReplayedToTheBit) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const fs::path obj = folder_ / "tile.obj";
  std::ofstream(obj)
      << "mtllib tile.mtl\nusemtl t\nv 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nvt 0 0\nvt 1 0\nvt 0 1\n"
         "f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";
  std::ofstream(folder_ / "tile.mtl") << "newmtl t\nmap_Kd tile.bmp\n";
  // A bitmap of 2 x 1 pixels, 24 bits.
  const std::string bmp(
      "BM\x3e\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\2\0\0\0\1\0\0\0\1\0\x18\0\0\0\0\0\x08\0\0\0"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\0\0\0\0\xff\0\0",
      62);
  std::ofstream(folder_ / "tile.bmp", std::ios::binary) << bmp;
  const std::string session = (folder_ / "textured").string();
  const Outcome run =
      roomradar("run 'sim:table?frames=8&width=160' --map " + map() + " --object " + obj.string() +
                ",at=0.4,1.2,1.0 --record-session " + session + " --pictures " + (folder_ / "tile").string());
  ASSERT_EQ(run.status, 0) << run.out;
  EXPECT_EQ(run.out.find("texture "), std::string::npos) << run.out;  // no note on the texture
  for (const char* name : {"tile.obj", "tile.mtl", "tile.bmp"}) fs::remove(folder_ / name);
  const Outcome replay = roomradar("run " + session + " --pictures " + (folder_ / "again").string());
  EXPECT_EQ(replay.status, 0) << replay.out;
  EXPECT_NE(replay.out.find("8 of 8 frames the same"), std::string::npos) << replay.out;

  // A session of version 2 keeps the file of its mesh, and an .obj without an axis has z up.
  std::string settings = read_text(fs::path(session) / "session.json");
  const std::size_t at = settings.find("\"format_version\": 3");
  ASSERT_NE(at, std::string::npos);
  settings.replace(at, 19, "\"format_version\": 3");
  std::ofstream(fs::path(session) / "session.json") << settings;
  std::string events = read_text(fs::path(session) / "events.txt");
  events.replace(events.find("mesh-1.model"), 12, "mesh-1.obj");
  std::ofstream(fs::path(session) / "events.txt") << events;
  std::ofstream(fs::path(session) / "meshes" / "mesh-1.obj")
      << "v 0 0 0\nv 0.2 0 0\nv 0 0 -0.2\nv 0 0.2 0\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const Outcome old = roomradar("run " + session + " --report " + (folder_ / "old.json").string());
  EXPECT_EQ(old.status, 0) << old.out;
  settings.replace(at, 19, "\"format_version\": 4");
  std::ofstream(fs::path(session) / "session.json") << settings;
  expect_fault(roomradar("run " + session), 1, "reads versions 2 and 3");
}

TEST_F(CommandLine, AFullDiskLosesNothing) {
  ASSERT_EQ(scanned_.status, 0) << scanned_.out;
  const std::string before = read_text(folder_ / "map" / "map.json");
  const Outcome full = shell("ulimit -f 64; " ROOMRADAR_PROGRAM
                             " prescan 'sim:table?frames=10&width=160' --resolution 0.03 --map " +
                             map());
  EXPECT_EQ(full.status, 1) << full.out;
  EXPECT_NE(full.out.find("map"), std::string::npos) << full.out;
  EXPECT_EQ(read_text(folder_ / "map" / "map.json"), before);
  EXPECT_EQ(roomradar("map verify " + map()).status, 0);
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
}

TEST_F(CommandLine, AFolderThatIsNotAMapIsLeftAlone) {
  const fs::path precious = folder_ / "precious";
  fs::create_directories(precious);
  std::ofstream(precious / "thesis.txt") << "years of work";
  expect_fault(roomradar("prescan 'sim:table?frames=5&width=160' --map " + precious.string()), 1, "precious");
  EXPECT_EQ(read_text(precious / "thesis.txt"), "years of work");
}

}  // namespace
}  // namespace roomradar::command_line_test
