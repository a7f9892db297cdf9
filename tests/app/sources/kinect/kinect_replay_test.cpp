// kinect_replay_test.cpp: recordings that pause, end early or have broken frames, replayed by fakenect
// through libfreenect's interface.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_fingerprint.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::kinect_replay_test {
namespace {

namespace fs = std::filesystem;
using test::contains;

struct Outcome {
  int status = -1;
  std::vector<std::string> frames;
  long skipped = 0;
  long waited = 0;
  std::string rest;  ///< messages, and lines printed by fakenect
};

/// Runs `line` in a shell, killed after 300 s, enough for a busy machine with sanitizers.
Outcome shell(const std::string& line) {
  Outcome outcome;
  FILE* pipe = popen(("timeout -s KILL 300 sh -c \"" + line + "\" 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  std::string all;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) all.append(buffer, n);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  std::istringstream lines(all);
  for (std::string text; std::getline(lines, text);) {
    if (text.starts_with("frame "))
      outcome.frames.push_back(text);
    else if (text == "skipped")
      ++outcome.skipped;
    else if (text == "waiting")
      ++outcome.waited;
    else
      outcome.rest += text + "\n";
  }
  return outcome;
}

std::string fakenect(const fs::path& recording) {
  return "FAKENECT_LOOP=0 fakenect '" + recording.string() + "' ";
}

Outcome replay(const fs::path& recording, const std::string& frames = "") {
  return shell(fakenect(recording) + "'" ROOMRADAR_REPLAY_DUMP "' kinect:0 " + frames);
}

/// A simulated room, recorded once; each test damages a copy.
class KinectReplay : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    recorded_ = shell("'" ROOMRADAR_PROGRAM "' record 'sim:table?frames=8&moving=hand' '" +
                      (folder_->path() / "whole").string() + "' --format fakenect");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  void SetUp() override {
    if (std::system("command -v fakenect > /dev/null") != 0) GTEST_SKIP() << "fakenect is not installed";
    ASSERT_EQ(recorded_.status, 0) << recorded_.rest;
    recording_ = copy_.path() / "r";
    fs::copy(folder_->path() / "whole", recording_, fs::copy_options::recursive);
    std::ifstream list(recording_ / "INDEX.txt");
    for (std::string line; std::getline(list, line);) lines_.push_back(line);
    for (const std::string& line : lines_)
      if (line[0] == 'd') depth_files_.push_back(line);
    ASSERT_EQ(depth_files_.size(), 8U);
  }

  void write_index() const {
    std::ofstream list(recording_ / "INDEX.txt");
    for (const std::string& line : lines_) list << line << '\n';
  }

  /// Delays everything from the depth image with this number on, by time of day.
  void pause_before(std::size_t depth_image, double pause_s) {
    bool later = false;
    for (std::string& line : lines_) {
      later = later || line == depth_files_[depth_image];
      if (!later) continue;
      double time_s = 0.0;
      ASSERT_EQ(std::sscanf(line.c_str() + 2, "%lf", &time_s), 1);
      char renamed[96];
      std::snprintf(renamed, sizeof renamed, "%c-%.6f%s", line[0], time_s + pause_s,
                    line.substr(line.find('-', 2)).c_str());
      fs::rename(recording_ / line, recording_ / renamed);
      line = renamed;
    }
    write_index();
  }

  [[nodiscard]] std::vector<std::string> by_folder() const {
    std::vector<std::string> frames;
    for (const Frame& frame : test::read_all(*open_folder(recording_)).frames)
      frames.push_back(test::fingerprint(frame));
    return frames;
  }

  static inline test::TemporaryFolder* folder_ = nullptr;
  static inline Outcome recorded_;
  test::TemporaryFolder copy_;
  fs::path recording_;
  std::vector<std::string> lines_, depth_files_;
};

TEST_F(KinectReplay, AScanOfADeviceCanHoldFramesOut) {
  const Outcome outcome =
      shell(fakenect(recording_) +
            "'" ROOMRADAR_PROGRAM "' prescan kinect:0 --resolution 0.04 --hold-out 4 --map '" +
            (copy_.path() / "map").string() + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_TRUE(contains(outcome.rest, "2 frames held out: depth against the mesh")) << outcome.rest;
  EXPECT_FALSE(fs::exists(copy_.path() / "map.unfinished"));
}

TEST_F(KinectReplay, AScanOfADeviceThatIsStoppedForMemoryTakesInTheRestLater) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer takes memory of its own, by which a scan needs more to begin with";
#endif
  const fs::path map = copy_.path() / "map", unfinished = copy_.path() / "map.unfinished";
  const fs::path walk = copy_.path() / "walk";  // so fast that each frame is a keyframe, and stays in memory
  ASSERT_EQ(shell("'" ROOMRADAR_PROGRAM "' record 'sim:table?frames=14&rate=3' '" + walk.string() +
                  "' --format fakenect")
                .status,
            0);
  const std::string scan = fakenect(walk) + "'" ROOMRADAR_PROGRAM "' prescan kinect:0 --resolution 0.04" +
                           " --checkpoint-every 0.01 --map '" + map.string() + "'";
  const Outcome too_little = shell(scan + " --max-memory 1");
  const std::size_t at = too_little.rest.find("at least ");
  ASSERT_NE(at, std::string::npos) << too_little.rest;
  const std::string cap = std::to_string(std::stoi(too_little.rest.substr(at + 9)));
  const Outcome stopped = shell(scan + " --max-memory " + cap);
  EXPECT_EQ(stopped.status, 1) << stopped.rest;
  EXPECT_TRUE(contains(stopped.rest, "stopped by --max-memory")) << stopped.rest;
  EXPECT_TRUE(contains(stopped.rest, "--resume scans them again")) << stopped.rest;
  EXPECT_TRUE(fs::exists(map / "octree.bin"));
  EXPECT_TRUE(fs::exists(unfinished / "spool" / "list.bin"));
  const Outcome rest = shell(scan + " --resume");
  EXPECT_EQ(rest.status, 0) << rest.rest;
  const std::size_t count = rest.rest.find(" frames tracked");
  ASSERT_NE(count, std::string::npos) << rest.rest;
  const int tracked = std::stoi(rest.rest.substr(rest.rest.rfind("map: ", count) + 5));
  EXPECT_GE(tracked, 8) << "those that were kept, and maybe the device's once more: " << rest.rest;
  EXPECT_FALSE(fs::exists(unfinished));
}

TEST_F(KinectReplay, AScanWhoseDeviceIsGoneForGoodBecomesAMap) {
  const fs::path map = copy_.path() / "map", unfinished = copy_.path() / "map.unfinished";
  const std::string scan =
      "'" ROOMRADAR_PROGRAM "' prescan kinect:0 --resolution 0.04 --map '" + map.string() + "'";
  if (shell("'" ROOMRADAR_PROGRAM "' record kinect:0 '" + (copy_.path() / "real").string() + "' --frames 0:0")
          .status == 0)
    GTEST_SKIP() << "a Kinect is plugged in";
  pause_before(5, 3000.0);
  const fs::path script = copy_.path() / "script";
  test::write_text(script, scan +
                               " & pid=$!\n"
                               "until test -e '" +
                               (unfinished / "spool" / "4.images").string() +
                               "'; do sleep 0.1; done\n"
                               "sleep 2\n"  // the list follows its images
                               "kill -KILL $pid; wait $pid\n");
  const Outcome killed = shell(fakenect(recording_) + "sh '" + script.string() + "'");
  EXPECT_EQ(killed.status, 128 + SIGKILL) << killed.rest;
  ASSERT_TRUE(fs::exists(unfinished / "spool" / "list.bin")) << killed.rest;
  EXPECT_EQ(shell(scan).status, 1) << "without --resume what was scanned would be lost";
  const Outcome without = shell(scan + " --resume");
  EXPECT_EQ(without.status, 0) << without.rest;
  EXPECT_TRUE(contains(without.rest, "The map is made from the frames scanned before")) << without.rest;
  EXPECT_TRUE(contains(without.rest, "5 of 5 frames tracked")) << without.rest;
  EXPECT_FALSE(fs::exists(unfinished));
}

TEST_F(KinectReplay, OneThatPausesIsWaitedForAndLosesNothing) {
  pause_before(4, 2.5);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, by_folder());
  EXPECT_EQ(outcome.frames.size(), 8U);
  EXPECT_GE(outcome.waited, 1);
  EXPECT_EQ(outcome.skipped, 0);
}

TEST_F(KinectReplay, AReaderThatLeavesInALongPauseDoesNotWaitForItsEnd) {
  pause_before(4, 3000.0);  // ten times the shell's time limit
  const Outcome outcome = replay(recording_, "3");
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames.size(), 3U);
}

TEST_F(KinectReplay, CtrlCEndsARecordingInALongPauseAndKeepsWhatWasWritten) {
  pause_before(4, 3000.0);
  const fs::path to = copy_.path() / "again", script = copy_.path() / "script";
  test::write_text(script, "'" ROOMRADAR_PROGRAM "' record kinect:0 '" + to.string() +
                               "' --format tum & pid=$!\n"
                               "until test \"$(grep -c png '" +
                               to.string() +
                               "/depth.txt' 2>/dev/null)\" -ge 3 2>/dev/null; do sleep 0.1; done\n"
                               "kill -INT $pid; wait $pid\n");
  const Outcome outcome = shell(fakenect(recording_) + "sh '" + script.string() + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  const std::size_t read = test::read_all(*open_folder(to)).frames.size();
  EXPECT_TRUE(read == 3 || read == 4) << read;  // the fourth is paired once the fifth has arrived
}

TEST_F(KinectReplay, OneWhoseListWasCutAfterALineEndsThere) {
  lines_.resize(lines_.size() / 2);
  write_index();
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, by_folder());
  EXPECT_GE(outcome.frames.size(), 3U);
}

// fakenect would open the name that is left, and end the process.
TEST_F(KinectReplay, OneWhoseListWasCutWithinALineEndsBeforeThatLine) {
  const auto last_depth = std::find(lines_.begin(), lines_.end(), depth_files_.back());
  lines_.erase(last_depth + 1, lines_.end());
  write_index();
  fs::resize_file(recording_ / "INDEX.txt", fs::file_size(recording_ / "INDEX.txt") - 20);
  const auto folder = by_folder();
  EXPECT_EQ(folder.size(), 7U);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, folder);
}

TEST_F(KinectReplay, LinesOfAnotherFormAreNotOpened) {
  fs::copy(recording_ / depth_files_[0], copy_.path() / "elsewhere.pgm");
  const std::string tail = depth_files_[2].substr(depth_files_[2].rfind('-'));
  for (const std::string& line : {std::string("d-../../elsewhere.pgm"), std::string("../elsewhere.pgm"),
                                  "d-later" + tail, std::string("d-1e400-12.pgm"), std::string("missing")})
    lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(lines_.size() / 2), line);
  fs::copy(recording_ / depth_files_[0], recording_ / ("d-later" + tail));
  write_index();
  const auto folder = by_folder();
  EXPECT_EQ(folder.size(), 8U);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, folder);
  EXPECT_EQ(outcome.skipped, 0);
}

TEST_F(KinectReplay, BrokenDepthImagesArePassedOverAsTheyAreFromTheFolder) {
  test::cut_to(recording_ / depth_files_[1], 0.5);
  fs::resize_file(recording_ / depth_files_[3], 0);
  fs::remove(recording_ / depth_files_[4]);
  test::write_text(recording_ / depth_files_[6], std::string(700'000, 'x'));  // contains no line break
  const auto folder = by_folder();
  EXPECT_EQ(folder.size(), 4U);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, folder);
  EXPECT_EQ(outcome.skipped, 4);
}

TEST_F(KinectReplay, TheLastImageOfARecorderThatWasKilledIsPassedOver) {
  test::cut_to(recording_ / depth_files_.back(), 0.9);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames, by_folder());
  EXPECT_EQ(outcome.skipped, 1);
}

TEST_F(KinectReplay, BrokenColourAndGravityCostNoDepth) {
  for (const std::string& line : lines_)
    if (line[0] == 'r') test::cut_to(recording_ / line, 0.3);
  for (const std::string& line : lines_)
    if (line[0] == 'a') fs::resize_file(recording_ / line, 0);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 0) << outcome.rest;
  EXPECT_EQ(outcome.frames.size(), 8U);
}

TEST_F(KinectReplay, OneWithoutAWholeImageIsRefused) {
  for (const std::string& line : depth_files_) test::cut_to(recording_ / line, 0.4);
  const Outcome outcome = replay(recording_);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.rest, "contains no complete depth image")) << outcome.rest;
}

TEST_F(KinectReplay, OnlyDeviceZeroAndRawDepthAreThere) {
  const std::string program = fakenect(recording_) + "'" ROOMRADAR_PROGRAM "' record ";
  const std::string to = " '" + (copy_.path() / "x").string() + "'";
  EXPECT_TRUE(contains(shell(program + "kinect:1" + to).rest, "there is no such Kinect"));
  EXPECT_TRUE(contains(shell(program + "kinect:0?depth=mm" + to).rest, "raw depth only"));
  EXPECT_TRUE(contains(shell(program + "kinect:0?depth=best" + to).rest, "?depth=registered"));
}

}  // namespace
}  // namespace roomradar::kinect_replay_test
