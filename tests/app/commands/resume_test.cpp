// resume_test.cpp: the program, killed at any moment, resumes and produces the map it would have made.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_folder.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::resume_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = "sim:table?frames=40&width=128";
// Shorter: closing loops takes a time that grows with the square of the frames.
constexpr const char* kTrackedSource = "sim:table?frames=30&width=160";

bool is_long_test() { return std::getenv("ROOMRADAR_LONG_TESTS") != nullptr; }

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ResumeTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path map() const { return temporary_.path() / "map"; }
  [[nodiscard]] fs::path unfinished() const { return temporary_.path() / "map.unfinished"; }
  [[nodiscard]] std::string said() const { return text_of(temporary_.path() / "said"); }

  /// Starts the program; said() returns its output.
  [[nodiscard]] pid_t start(std::vector<std::string> arguments) const {
    const int said = open((temporary_.path() / "said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const pid_t child = test::start_program(std::move(arguments), said);
    close(said);
    return child;
  }
  [[nodiscard]] int run(const std::vector<std::string>& arguments) const {
    return test::status_of(start(arguments));
  }

  // Uses recorded poses in tests that are not about tracking, which takes three times as long.
  [[nodiscard]] std::vector<std::string> scan(const fs::path& to, bool resume,
                                              const std::string& poses = "recorded") const {
    std::vector<std::string> arguments = {"prescan",
                                          poses == "tracked" ? kTrackedSource : kSource,
                                          "--map",
                                          to,
                                          "--resolution",
                                          "0.04",
                                          "--checkpoint-every",
                                          checkpoint_every_s_,
                                          "--poses",
                                          poses};
    arguments.emplace_back(resume ? "--resume" : "--replace");
    return arguments;
  }
  /// Starts a scan and kills it as soon as moment() returns true. Returns false if the scan ended before.
  [[nodiscard]] bool cut_off(bool resume, const std::function<bool()>& moment,
                             const std::string& poses = "recorded") const {
    const pid_t child = start(scan(map(), resume, poses));
    while (!moment()) {
      if (waitpid(child, nullptr, WNOHANG) == child) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, SIGKILL);
    return test::status_of(child) == 128 + SIGKILL;
  }
  [[nodiscard]] fs::path temporary_folder() const { return temporary_.path(); }
  /// Returns the words of the last command that said() names, as a shell splits them.
  [[nodiscard]] std::vector<std::string> words_of_named_command() const {
    const std::string text = said();
    const std::size_t at = text.rfind("\n  roomradar ");
    if (at == std::string::npos) return {};
    const std::string line = text.substr(at + 3, text.find('\n', at + 1) - at - 3);
    FILE* shell = popen(("printf '%s\\n' " + line).c_str(), "r");
    std::vector<std::string> words(1);
    for (int c = fgetc(shell); c != EOF; c = fgetc(shell)) {
      if (c == '\n')
        words.emplace_back();
      else
        words.back() += static_cast<char>(c);
    }
    pclose(shell);
    words.pop_back();
    return words;
  }
  /// Number of the newest checkpoint, 0 if there is none.
  [[nodiscard]] int newest() const { return newest(map()); }
  [[nodiscard]] static int newest(const fs::path& map) {
    int number = 0;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(map.string() + ".unfinished", ignored)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("checkpoint-")) number = std::max(number, std::stoi(name.substr(11)));
    }
    return number;
  }
  /// Returns true if the newest checkpoint is of the second pass.
  [[nodiscard]] bool is_fusing() const {
    const std::string manifest =
        text_of(unfinished() / ("checkpoint-" + std::to_string(newest())) / "manifest.json");
    return manifest.find("\"stage\": \"fuse\"") != std::string::npos;
  }
  /// Returns the map of the tracked scan that nothing cuts off, made once for all tests.
  [[nodiscard]] fs::path uncut_tracked_map() const {
    const fs::path uncut = shared_->path() / "uncut";
    if (!fs::exists(uncut)) {
      EXPECT_EQ(run(scan(uncut, false, "tracked")), 0) << said();
    }
    return uncut;
  }
  /// Returns map.json without what tells one revision of a map from another of the same content.
  static std::string described(const fs::path& map) {
    nlohmann::json json = nlohmann::json::parse(text_of(map / "map.json"));
    for (const char* key : {"id", "revision", "parent_revision"}) json.erase(key);
    return json.dump();
  }
  static void expect_very_same_map(const fs::path& a, const fs::path& b) {
    EXPECT_EQ(described(a), described(b));
    for (const char* file : {"octree.bin", "mesh.ply", "places.bin", "trajectory.txt", "unknown.bin"})
      EXPECT_TRUE(text_of(a / file) == text_of(b / file)) << file;
  }
  /// Keyframes are stored rounded, so poses computed after resuming deviate as if by noise.
  static void expect_same_map_up_to_noise(const fs::path& a, const fs::path& b) {
    const std::vector<TimedPose> poses_a = read_trajectory(a / "trajectory.txt");
    const std::vector<TimedPose> poses_b = read_trajectory(b / "trajectory.txt");
    ASSERT_EQ(poses_a.size(), poses_b.size());
    for (std::size_t i = 0; i < poses_a.size(); ++i)
      EXPECT_LT((poses_a[i].T_world_camera.translation() - poses_b[i].T_world_camera.translation()).norm(),
                0.005)
          << i;
    const SavedMap map_a = load_map(a), map_b = load_map(b);
    EXPECT_NEAR(static_cast<double>(map_a.info.counts.occupied_leaves),
                static_cast<double>(map_b.info.counts.occupied_leaves),
                0.02 * static_cast<double>(map_a.info.counts.occupied_leaves));
    EXPECT_TRUE(diff_maps(map_a.octree.load(), map_b.octree.load(), Eigen::Isometry3d::Identity()).empty());
  }

  static void SetUpTestSuite() {
    shared_ = new test::TemporaryFolder;
    setenv("TMPDIR", shared_->path().c_str(), 1);  // programs that are killed leave temporary files there
  }
  static void TearDownTestSuite() { delete shared_; }

  test::TemporaryFolder temporary_;
  std::string checkpoint_every_s_ = "0.01";
  static inline test::TemporaryFolder* shared_ = nullptr;  // not an object: forks would delete the folder
};

TEST_F(ResumeTest, KilledAgainAndAgainTheMapIsTheSame) {
  const fs::path uncut = uncut_tracked_map();
  std::mt19937 random(1);
  const int kills = is_long_test() ? 12 : 6;
  int killed = 0;
  for (bool resume = false; killed < kills; resume = true, ++killed) {
    // Waits for a new checkpoint, then for a random time, so the kill mostly hits the writing of the next
    // one.
    const int before = newest();
    std::optional<std::chrono::steady_clock::time_point> end;
    const auto moment = [&] {
      const auto now = std::chrono::steady_clock::now();
      if (!end && newest() > before) end = now + std::chrono::milliseconds(random() % 60);
      return end && now >= *end;
    };
    const bool cut = cut_off(resume, moment, "tracked");
    if (!cut) break;
    if (fs::exists(map())) expect_same_map_up_to_noise(map(), uncut);  // killed after it was put in place
  }
  if (killed == kills) {
    ASSERT_EQ(run(scan(map(), true, "tracked")), 0) << said();
  }
  EXPECT_GT(killed, 2);
  ASSERT_TRUE(fs::exists(map())) << said();
  expect_same_map_up_to_noise(map(), uncut);
  EXPECT_FALSE(fs::exists(unfinished()));
}

TEST_F(ResumeTest, KilledWhileFusingAndWritingTheMapIsTheVerySame) {
  const fs::path uncut = uncut_tracked_map();
  // Fusing takes 0.2 s here, in which 24 intervals between checkpoints must pass more than once.
  checkpoint_every_s_ = "0.001";
  ASSERT_TRUE(cut_off(
      false, [&] { return is_fusing() && fs::exists(unfinished() / "checkpoint.writing"); }, "tracked"));
  ASSERT_EQ(run(scan(map(), true, "tracked")), 0) << said();
  expect_very_same_map(map(), uncut);
}

TEST_F(ResumeTest, TheMapThatIsThereStaysUntilTheNewOneIsWhole) {
  ASSERT_EQ(run({"prescan", "sim:table?frames=10&width=128&seed=5", "--map", map(), "--resolution", "0.08"}),
            0);
  const std::string before = text_of(map() / "map.json");
  ASSERT_TRUE(cut_off(false, [&] { return newest() > 0; }));
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
  EXPECT_EQ(text_of(map() / "map.json"), before);
  ASSERT_EQ(run(scan(map(), true)), 0) << said();
  EXPECT_NE(text_of(map() / "map.json"), before);
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
}

TEST_F(ResumeTest, KilledAtAnyMomentThereIsTheOldMapOrTheNew) {
  const fs::path old = temporary_.path() / "old", uncut = temporary_.path() / "uncut";
  ASSERT_EQ(run({"prescan", "sim:table?frames=10&width=128&seed=5", "--map", old, "--resolution", "0.08"}),
            0);
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_EQ(run(scan(uncut, false)), 0) << said();
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begun;
  const std::string old_info = described(old), new_info = described(uncut);
  fs::copy(old, map());

  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int resumed = 0, replaced = 0;
  for (int killed = 0; killed < (is_long_test() ? 100 : 6);) {
    const bool resume = newest() > 0;
    const pid_t child = start(scan(map(), resume));
    std::this_thread::sleep_for(share(random) * whole);
    kill(child, SIGKILL);
    const int status = test::status_of(child);
    ASSERT_TRUE(status == 0 || status == 128 + SIGKILL) << said();
    killed += status == 0 ? 0 : 1;
    resumed += resume ? 1 : 0;
    EXPECT_EQ(verify_map(map()), std::vector<std::string>{});
    const std::string info = described(map());
    ASSERT_TRUE(info == old_info || info == new_info) << killed << " killed";
    if (info == old_info) continue;
    expect_very_same_map(map(), uncut);
    ++replaced;
    fs::remove_all(map());
    fs::copy(old, map());
  }
  RecordProperty("resumed", resumed);
  RecordProperty("replaced", replaced);
  ASSERT_EQ(run(scan(map(), newest() > 0)), 0) << said();
  expect_very_same_map(map(), uncut);
  EXPECT_GT(resumed, 0);
}

TEST_F(ResumeTest, OtherSettingsAreRefusedAndADamagedCheckpointIsPassedOver) {
  ASSERT_TRUE(cut_off(false, [&] { return newest() > 0; }));
  EXPECT_EQ(
      run({"prescan", kSource, "--map", map(), "--resolution", "0.05", "--poses", "recorded", "--resume"}),
      1);
  EXPECT_NE(said().find("resolution"), std::string::npos) << said();
  EXPECT_EQ(run({"prescan", "sim:wall?frames=40&width=128", "--map", map(), "--resolution", "0.04", "--poses",
                 "recorded", "--resume"}),
            1);
  EXPECT_NE(said().find("source"), std::string::npos) << said();

  for (const auto& entry : fs::directory_iterator(unfinished())) {
    if (!entry.path().filename().string().starts_with("checkpoint-")) continue;
    fs::resize_file(entry.path() / "state.bin", fs::file_size(entry.path() / "state.bin") / 2);
  }
  ASSERT_EQ(run(scan(map(), true)), 0) << said();
  EXPECT_NE(said().find("state.bin: is damaged"), std::string::npos) << said();
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
}

TEST_F(ResumeTest, CtrlCEndsItInWordsAndItGoesOnFromThere) {
  const pid_t child = start(scan(map(), false));
  while (newest() == 0 && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGINT);
  EXPECT_EQ(test::status_of(child), 1);
  EXPECT_NE(said().find("--resume continues"), std::string::npos) << said();
  EXPECT_NE(said().find("stops after the next frame"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(map()));
  EXPECT_GT(newest(), 0);
  EXPECT_EQ(run(scan(map(), true)), 0) << said();
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
}

TEST_F(ResumeTest, TheCommandThatIsNamedContinuesTheScan) {
  const fs::path map = temporary_folder() / "it's a $map", whole = temporary_folder() / "whole";
  const auto words = [](const fs::path& to) {
    return std::vector<std::string>{"prescan",
                                    "sim:table?frames=100&width=128",
                                    "--resolution=0.04",
                                    "--map",
                                    to,
                                    "--poses",
                                    "recorded",
                                    "--frames",
                                    "0:79",
                                    "--up",
                                    "0,0,1",
                                    "--hold-out",
                                    "9",
                                    "--texture",
                                    "off",
                                    "--checkpoint-every",
                                    "0.01"};
  };
  const pid_t child = start(words(map));
  while (newest(map) == 0 && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGINT);
  ASSERT_EQ(test::status_of(child), 1) << said();
  const std::vector<std::string> named = words_of_named_command();
  ASSERT_GT(named.size(), 2U) << said();
  EXPECT_EQ(named.front(), "roomradar");
  EXPECT_EQ(named.back(), "--resume");
  ASSERT_EQ(run({named.begin() + 1, named.end()}), 0) << said();
  ASSERT_EQ(run(words(whole)), 0) << said();
  expect_very_same_map(map, whole);
}

TEST_F(ResumeTest, ASecondCtrlCNamesTheCommandToo) {
  const pid_t child =
      start({"prescan", "sim:table?frames=400&width=640", "--map", map(), "--resolution", "0.02"});
  while (newest() == 0 && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGSTOP);  // both arrive before the next frame is over
  kill(child, SIGINT);
  kill(child, SIGCONT);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  kill(child, SIGINT);
  const int status = test::status_of(child);
  if (status == 1) GTEST_SKIP() << "the scan had ended by the first one";
  EXPECT_EQ(status, 128 + SIGINT);
  EXPECT_NE(said().find("ended at once"), std::string::npos) << said();
  const std::vector<std::string> named = words_of_named_command();
  ASSERT_GT(named.size(), 2U) << said();
  EXPECT_EQ(named.back(), "--resume");
}

TEST_F(ResumeTest, CtrlCBeforeTheFirstCheckpointKeepsTheFramesSoFar) {
  std::vector<std::string> words = {"prescan",
                                    "sim:table?frames=100&width=128",
                                    "--map",
                                    map(),
                                    "--resolution",
                                    "0.04",
                                    "--poses",
                                    "recorded",
                                    "--checkpoint-every",
                                    "1000",
                                    "--report",
                                    temporary_.path() / "report.json"};
  const pid_t child = start(words);
  while (said().find("expected:") == std::string::npos && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGINT);
  EXPECT_EQ(test::status_of(child), 1);
  EXPECT_NE(said().find("--resume continues"), std::string::npos) << said();
  EXPECT_EQ(newest(), 1);
  words.emplace_back("--resume");
  ASSERT_EQ(run(words), 0) << said();
  const auto report = nlohmann::json::parse(text_of(temporary_.path() / "report.json"));
  EXPECT_GT(report.at("frames_resumed"), 0) << "it begins after the frames of the checkpoint";
}

TEST_F(ResumeTest, GoesOnThoughNoMoreCheckpointsAreWanted) {
  ASSERT_TRUE(cut_off(false, [&] { return newest() > 0; }));
  const auto resume = [&](const char* resolution_m) {
    return run({"prescan", kSource, "--map", map(), "--resolution", resolution_m, "--checkpoint-every", "0",
                "--poses", "recorded", "--resume"});
  };
  EXPECT_EQ(resume("0.05"), 1) << "it is looked at";
  EXPECT_NE(said().find("resolution"), std::string::npos) << said();
  ASSERT_EQ(resume("0.04"), 0) << said();
  EXPECT_FALSE(fs::exists(unfinished()));
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
}

TEST_F(ResumeTest, ASourceThatIsNotThereGivesUpNothing) {
  ASSERT_TRUE(cut_off(false, [&] { return newest() > 0; }));
  EXPECT_EQ(run({"prescan", temporary_.path() / "no-such-folder", "--map", map()}), 1);
  EXPECT_GT(newest(), 0) << "a slip of the pen takes no scan away";
}

TEST_F(ResumeTest, ACapThatIsTooLowGivesUpNothing) {
  ASSERT_TRUE(cut_off(false, [&] { return newest() > 0; }));
  std::vector<std::string> words = scan(map(), false);
  words.insert(words.end(), {"--max-memory", "1"});
  EXPECT_EQ(run(words), 1);
  EXPECT_NE(said().find("too little to begin with"), std::string::npos) << said();
  EXPECT_GT(newest(), 0);
}

TEST_F(ResumeTest, ACalibrationThatCameMeanwhileIsAnotherScan) {
  const fs::path recording = temporary_.path() / "recording";
  ASSERT_EQ(run({"record", kSource, recording}), 0) << said();
  const auto words = [&](bool resume) {
    std::vector<std::string> all = scan(map(), resume);
    all[1] = recording;
    return all;
  };
  const pid_t child = start(words(false));
  while (newest() == 0 && waitpid(child, nullptr, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGKILL);
  ASSERT_EQ(test::status_of(child), 128 + SIGKILL);
  nlohmann::json calibration = nlohmann::json::parse(text_of(recording / "camera.json"));
  calibration.update({{"format", "roomradar calibration"}, {"version", 1}});
  for (const char* lens : {"depth_lens", "colour_lens"})
    calibration[lens] = {{"k1", 0.01}, {"k2", 0}, {"p1", 0}, {"p2", 0}, {"k3", 0}};
  calibration["depth_correction"] = {
      {"inverse_scale", 1.0}, {"columns", 0}, {"rows", 0}, {"offset_per_m", nlohmann::json::array()}};
  std::ofstream(recording / "calibration.json") << calibration;
  EXPECT_EQ(run(words(true)), 1);
  EXPECT_NE(said().find("was begun with calibration \"none\""), std::string::npos) << said();
  fs::remove(recording / "calibration.json");
  EXPECT_EQ(run(words(true)), 0) << said();
}

TEST_F(ResumeTest, NothingToResumeIsSaid) {
  EXPECT_EQ(run(scan(map(), true)), 1);
  EXPECT_NE(said().find("nothing to resume"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(map()));
}

TEST_F(ResumeTest, AFolderOfSomebodyElseUnderTheCheckpointsNameIsLeftAlone) {
  for (const char* name : {"map.unfinished", "map.unfinished.done"}) {
    const fs::path mine = temporary_.path() / name / "thesis.txt";
    fs::create_directory(mine.parent_path());
    std::ofstream(mine) << "years of work";
    EXPECT_EQ(run(scan(map(), false)), 1);
    EXPECT_NE(said().find("thesis.txt"), std::string::npos) << said();
    EXPECT_EQ(text_of(mine), "years of work");
    fs::remove_all(mine.parent_path());
  }
  std::ofstream(unfinished()) << "a file";
  EXPECT_EQ(run(scan(map(), false)), 1);
  EXPECT_EQ(text_of(unfinished()), "a file");
}

TEST_F(ResumeTest, ASecondScanOfTheMapIsRefusedBeforeTheFirstCheckpointToo) {
  const pid_t first =
      start({"prescan", "sim:table?frames=5000&width=128", "--map", map(), "--checkpoint-every", "1000"});
  while (!fs::exists(unfinished() / "work.json")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(first, SIGSTOP);  // at work, without using the processor
  for (const bool resume : {false, true}) {
    EXPECT_EQ(run(scan(map(), resume)), 1);
    EXPECT_NE(said().find("another roomradar is at work"), std::string::npos) << said();
  }
  kill(first, SIGKILL);
  test::status_of(first);
  EXPECT_EQ(newest(), 0);
  EXPECT_EQ(run({"prescan", "sim:table?frames=5&width=128", "--map", map(), "--resolution", "0.08"}), 0)
      << said();
}

TEST_F(ResumeTest, AScanThatCannotBeginLeavesNothing) {
  EXPECT_EQ(run({"prescan", kSource, "--map", map(), "--max-memory", "1"}), 1);
  EXPECT_FALSE(fs::exists(unfinished()));
}

TEST_F(ResumeTest, AnotherSessionIsAddedAndTheWorldStays) {
  const auto scan_table = [&](const char* source, bool resume) {
    std::vector<std::string> arguments = {"prescan", source, "--map", map(), "--resolution", "0.03"};
    if (resume) arguments.emplace_back("--resume");
    return arguments;
  };
  ASSERT_EQ(run(scan_table("sim:table?frames=40&width=160", false)), 0) << said();
  const SavedMap before = load_map(map());
  before.octree.load();  // before its folder is replaced
  const std::string json = text_of(map() / "map.json");
  EXPECT_EQ(run(scan_table("sim:shelf?frames=15&width=160", true)), 1);
  EXPECT_NE(said().find("cannot be registered to the map"), std::string::npos) << said();
  EXPECT_EQ(text_of(map() / "map.json"), json);
  fs::remove_all(unfinished());  // a slow machine may have written a checkpoint

  // The same walk again with less noise, and with a new crate.
  ASSERT_EQ(run(scan_table("sim:table?frames=40&width=160&noise=0.7&crate=1", true)), 0) << said();
  const SavedMap after = load_map(map());
  const std::string extended = text_of(map() / "map.json");
  EXPECT_EQ(run(scan_table("sim:table?frames=40&width=160&noise=0.7&crate=1", true)), 0) << said();
  EXPECT_NE(said().find("nothing to resume"), std::string::npos) << said();
  EXPECT_EQ(text_of(map() / "map.json"), extended);
  EXPECT_EQ(after.info.frames_fused, before.info.frames_fused + 40);
  EXPECT_GT(after.keyframe_database.load().keyframes.size(),
            before.keyframe_database.load().keyframes.size());
  EXPECT_EQ(after.trajectory.size(), before.trajectory.size() + 40);
  EXPECT_TRUE(after.info.T_world_recorded.isApprox(before.info.T_world_recorded, 1e-12));
  EXPECT_NEAR(after.octree.load().resolution_m(), 0.03, 1e-12);
  for (std::size_t i = 0; i < before.trajectory.size(); ++i)
    EXPECT_TRUE(after.trajectory[i].T_world_camera.isApprox(before.trajectory[i].T_world_camera, 1e-9));
  const std::vector<Change> changes =
      diff_maps(before.octree.load(), after.octree.load(), Eigen::Isometry3d::Identity());
  ASSERT_LE(changes.size(), 1U);
  for (const Change& change : changes) EXPECT_LT(change.box_world.sizes().maxCoeff(), 0.5);
}

TEST_F(ResumeTest, ARecordingIsKnownHoweverItsFolderIsSpelled) {
  const fs::path recording = temporary_.path() / "walk";
  ASSERT_EQ(
      run({"simulate", recording, "--room", "table?width=160", "--frames", "20", "--format", "7scenes"}), 0)
      << said();
  const auto scan_as = [&](const fs::path& spelled, bool resume) {
    std::vector<std::string> arguments = {"prescan",      spelled, "--map",   map(),
                                          "--resolution", "0.04",  "--poses", "recorded"};
    if (resume) arguments.insert(arguments.end(), {"--resume", "--report", temporary_.path() / "again.json"});
    return arguments;
  };
  ASSERT_EQ(run(scan_as(recording, false)), 0) << said();
  const std::string json = text_of(map() / "map.json");
  for (const fs::path& spelled : {recording / "", recording / ".." / "walk", fs::relative(recording)}) {
    EXPECT_EQ(run(scan_as(spelled, true)), 0) << said();
    EXPECT_NE(said().find("nothing to resume"), std::string::npos) << spelled << ": " << said();
    EXPECT_EQ(nlohmann::json::parse(text_of(temporary_.path() / "again.json"))["held_already"], true);
    fs::remove(temporary_.path() / "again.json");
    EXPECT_EQ(text_of(map() / "map.json"), json) << spelled;
  }
}

TEST_F(ResumeTest, StopsBeforeTheCapAndKeepsWhatItHas) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own, by which a scan needs more to begin with";
#endif
  const auto scan_under = [&](const std::string& cap) {
    return std::vector<std::string>{
        "prescan", "sim:table?frames=300&width=320", "--map", map(), "--max-memory", cap};
  };
  EXPECT_EQ(run(scan_under("1")), 1);
  const std::size_t at = said().find("at least ");
  ASSERT_NE(at, std::string::npos) << said();
  EXPECT_FALSE(fs::exists(map()));
  EXPECT_EQ(run(scan_under(std::to_string(std::stoi(said().substr(at + 9))))), 1);
  EXPECT_NE(said().find("expected: octree"), std::string::npos) << said();
  EXPECT_NE(said().find("stopped by --max-memory"), std::string::npos) << said();
  EXPECT_EQ(run({"map", "verify", map()}), 0) << said();
  const MapInfo info = load_map_info(map());
  EXPECT_GE(info.frames_fused, 1);
  EXPECT_LT(info.frames_fused, 300);
  EXPECT_FALSE(fs::exists(unfinished()));
  std::vector<std::string> more = scan_under("4000");
  more.emplace_back("--resume");
  EXPECT_EQ(run(more), 1);
  EXPECT_NE(said().find("was stopped by --max-memory before all of"), std::string::npos) << said();
}

TEST_F(ResumeTest, AMapIsAddedToAsAWholeOrNotAtAllWhereMemoryIsShort) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own, by which a scan needs more to begin with";
#endif
  const auto words = [&](const std::string& source, const std::vector<std::string>& rest) {
    std::vector<std::string> all = {"prescan", source, "--map", map(), "--resolution", "0.03"};
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
  };
  ASSERT_EQ(run(words("sim:table?frames=30&width=160", {"--deviation", "0.004"})), 0) << said();
  const std::string json = text_of(map() / "map.json");
  const std::string added = "sim:table?frames=100&width=320&noise=0.7";
  EXPECT_EQ(run(words(added, {"--resume", "--max-memory", "1"})), 1);
  const std::size_t at = said().find("at least ");
  ASSERT_NE(at, std::string::npos) << said();
  EXPECT_EQ(
      run(words(added, {"--resume", "--max-memory", std::to_string(std::stoi(said().substr(at + 9)) + 10)})),
      1);
  EXPECT_NE(said().find("stopped by --max-memory"), std::string::npos) << said();
  EXPECT_NE(said().find("keeps its cells of 0.03 m and its --deviation of 0.004 m"), std::string::npos)
      << said();
  EXPECT_EQ(text_of(map() / "map.json"), json);
  EXPECT_FALSE(fs::exists(unfinished()));
}

}  // namespace
}  // namespace roomradar::resume_test
