// faults_test.cpp: the program with full or read-only disks, and with clocks that go backwards: an error
// message each time, and saved data stays unchanged.
//
// Disks of a few kilobytes are mounted in this process's own namespace; if that is not allowed, the tests are
// skipped.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::faults_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = "sim:table?frames=12&width=128&path=view";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns all files below a folder with their contents.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[fs::relative(entry.path(), folder).string()] =
        entry.is_regular_file() ? text_of(entry.path()) : std::string("a folder");
  return files;
}

/// Returns true if this process may mount disks that only it sees.
bool has_own_mounts() {
  static const bool has = [] {
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
  }();
  return has;
}

class DeferredErrors : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_own_mounts()) GTEST_SKIP() << "no disks can be mounted here";
    fs::create_directory(disk());
  }
  void TearDown() override {
    while (umount2(disk().c_str(), MNT_DETACH) == 0) {
    }
  }

  [[nodiscard]] fs::path disk() const { return temporary_.path() / "disk"; }
  [[nodiscard]] fs::path at(const char* name) const { return temporary_.path() / name; }
  [[nodiscard]] std::string said() const { return text_of(at("said")); }

  void mount_disk(std::size_t kilobytes) const {
    const std::string size = "size=" + std::to_string(kilobytes) + "k";
    ASSERT_EQ(mount("tmpfs", disk().c_str(), "tmpfs", 0, size.c_str()), 0);
  }
  void make_read_only() const {
    ASSERT_EQ(mount(nullptr, disk().c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr), 0);
  }
  void make_room(std::size_t kilobytes) const {
    const std::string size = "size=" + std::to_string(kilobytes) + "k";
    ASSERT_EQ(mount(nullptr, disk().c_str(), nullptr, MS_REMOUNT, size.c_str()), 0);
  }
  /// Fills the disk up to this much free space.
  void fill_disk(std::size_t left_kilobytes) const {
    const std::uintmax_t available = fs::space(disk()).available;
    const std::uintmax_t left = left_kilobytes << 10U;
    if (available > left) std::ofstream(disk() / "filler") << std::string(available - left, 'x');
  }

  /// Runs the program to its end and returns its exit status; said() returns its output.
  [[nodiscard]] int run(std::vector<std::string> arguments) const {
    const int said = open(at("said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const pid_t child = test::start_program(std::move(arguments), said);
    close(said);
    return test::status_of(child);
  }
  [[nodiscard]] int scan(const fs::path& map, const char* resolution = "0.05") const {
    return run({"prescan", kSource, "--map", map, "--resolution", resolution});
  }

  /// Command lines of all commands that write to the disk. `made` is a valid map elsewhere.
  [[nodiscard]] std::vector<std::vector<std::string>> writers(const fs::path& made) const {
    const std::string d = disk();
    return {{"prescan", kSource, "--map", d + "/new", "--resolution", "0.05"},
            {"prescan", kSource, "--map", at("other"), "--resolution", "0.05", "--report", d + "/old.json"},
            {"run", kSource, "--map", made, "--report", d + "/old.json"},
            {"run", kSource, "--map", made, "--video", d + "/v.avi"},
            {"run", kSource, "--map", made, "--pictures", d + "/pictures", "--pictures-stride", "1"},
            {"run", kSource, "--map", made, "--record-session", d + "/session"},
            {"run", kSource, "--map", made, "--commit-changes", "0.5", "--save-map", d + "/map"},
            {"record", kSource, d + "/recording", "--format", "tum"},
            {"record", kSource, d + "/recording-7", "--format", "7scenes"},
            {"simulate", d + "/simulated", "--frames", "3"},
            {"map", "export", made, d + "/old.ply"},
            {"map", "export", made, d + "/m.glb"},
            {"map", "export", made, d + "/old.bt"},
            {"map", "export", made, d + "/m.ot"},
            {"map", "copy", made, d + "/copy"},
            {"map", "pack", made, d + "/m.rrm"},
            {"map", "diff", made, made, "--report", d + "/old.json"},
            {"map", "diff", made, made, "--picture", d + "/old.png"}};
  }

  test::TemporaryFolder temporary_;
};

std::string line_of(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += word + " ";
  return line;
}

TEST_F(DeferredErrors, AFolderThatCannotBeWrittenIsNamedAndStaysAsItIs) {
  ASSERT_EQ(scan(at("made")), 0) << said();
  mount_disk(4096);
  fs::copy(at("made"), disk() / "map", fs::copy_options::recursive);
  for (const char* name : {"old.json", "old.ply", "old.bt", "old.png"}) std::ofstream(disk() / name) << "old";
  const auto before = contents(disk());
  make_read_only();
  std::vector<std::vector<std::string>> all = writers(at("made"));
  all.push_back({"calibrate", "sim:board", "--square", "0.06", "--out", disk() / "camera.json"});
  all.push_back({"prescan", kSource, "--map", disk() / "map", "--resolution", "0.05"});
  for (const auto& words : all) {
    EXPECT_EQ(run(words), 1) << line_of(words) << said();
    EXPECT_NE(said().find("roomradar: " + disk().string()), std::string::npos) << line_of(words) << said();
    EXPECT_EQ(contents(disk()), before) << line_of(words);
  }
}

TEST_F(DeferredErrors, AFullDiskIsSaidAndWhatWasSavedIsWhatItWas) {
  ASSERT_EQ(scan(at("made")), 0) << said();
  for (const auto& words : writers(at("made"))) {
    mount_disk(4096);
    fs::copy(at("made"), disk() / "map", fs::copy_options::recursive);
    for (const char* name : {"old.json", "old.ply", "old.bt", "old.png"})
      std::ofstream(disk() / name) << "old";
    const auto before = contents(disk());
    fill_disk(/*left_kilobytes=*/4);
    const int status = run(words);
    if (status != 0) {  // a short report may fit
      EXPECT_EQ(status, 1) << line_of(words) << said();
      EXPECT_NE(said().find("roomradar: " + disk().string()), std::string::npos) << line_of(words) << said();
      const auto after = contents(disk());
      for (const auto& [name, bytes] : before)
        EXPECT_TRUE(after.contains(name) && after.at(name) == bytes) << line_of(words) << name;
      for (const auto& [name, bytes] : after)
        EXPECT_EQ(name.find(".partial"), std::string::npos) << line_of(words) << name;
    }
    umount2(disk().c_str(), MNT_DETACH);
  }
}

TEST_F(DeferredErrors, AScanThatFindsTheDiskFullAtItsEndGoesOnOnceThereIsRoom) {
  // With recorded poses, a resumed scan produces exactly the same map.
  const auto words = [](const fs::path& map) {
    return std::vector<std::string>{
        "prescan", kSource, "--map", map, "--poses", "recorded", "--resolution", "0.02", "--checkpoint-every",
        "0.0001"};
  };
  ASSERT_EQ(run(words(at("reference"))), 0) << said();
  mount_disk(1400);  // enough for the checkpoints, which are due at each step, not for the map beside them
  EXPECT_EQ(run(words(disk() / "map")), 1);
  EXPECT_NE(said().find("with --resume continues from there"), std::string::npos) << said();
  EXPECT_FALSE(fs::exists(disk() / "map"));
  make_room(32768);
  std::vector<std::string> again = words(disk() / "map");
  again.emplace_back("--resume");
  EXPECT_EQ(run(again), 0) << said();
  EXPECT_EQ(said().find("track 12/12"), std::string::npos) << "that pass was over: " << said();
  EXPECT_TRUE(text_of(disk() / "map" / "octree.bin") == text_of(at("reference") / "octree.bin"));
}

TEST_F(DeferredErrors, ARunThatIsCutShortSavesAndReportsWhatCameBefore) {
  ASSERT_EQ(scan(at("made")), 0) << said();
  mount_disk(128);
  ASSERT_EQ(run({"run", kSource, "--map", at("made"), "--pictures", disk() / "pictures", "--pictures-stride",
                 "1", "--commit-changes", "0.5", "--save-map", at("kept"), "--report", at("report.json")}),
            1);
  EXPECT_NE(said().find("roomradar: " + disk().string()), std::string::npos) << said();
  EXPECT_TRUE(verify_map(at("kept")).empty());
  std::ifstream file(at("report.json"));
  const auto report = nlohmann::json::parse(file);
  EXPECT_GT(report.at("frames_read").get<int>(), 0);
  EXPECT_TRUE(report.contains("committed"));
  EXPECT_NE(report.at("fault").get<std::string>().find(disk().string()), std::string::npos);
}

TEST_F(DeferredErrors, ASessionThatFilledTheDiskReplaysToWhereItCame) {
  ASSERT_EQ(scan(at("made")), 0) << said();
  mount_disk(128);
  ASSERT_EQ(run({"run", kSource, "--map", at("made"), "--record-session", disk() / "session"}), 1) << said();
  make_room(4096);
  EXPECT_EQ(run({"run", disk() / "session"}), 0) << said();
  const std::string words = said();
  EXPECT_NE(words.find("frames the same as recorded"), std::string::npos) << words;
  EXPECT_EQ(words.find("that is not"), std::string::npos) << words;
}

TEST_F(DeferredErrors, ARecordingThatFilledTheDiskIsReadToWhereItCame) {
  mount_disk(128);
  ASSERT_EQ(run({"record", kSource, disk() / "walk", "--format", "tum"}), 1) << said();
  make_room(4096);
  EXPECT_EQ(run({"record", disk() / "walk", at("again"), "--format", "tum"}), 0) << said();
  EXPECT_NE(said().find("frames written"), std::string::npos) << said();
}

/// Moves every second time stamp of a list to 100 s before the previous one.
void turn_back_clock(const fs::path& list) {
  std::ifstream in(list);
  std::string text, line;
  for (int i = 0; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') {
      text += line + "\n";
      continue;
    }
    const std::size_t blank = line.find(' ');
    const double stamp_s = std::stod(line.substr(0, blank)) + (i++ % 2 == 1 ? -100.0 : 0.0);
    text += std::to_string(stamp_s) + line.substr(blank) + "\n";
  }
  std::ofstream(list) << text;
}

TEST_F(DeferredErrors, ARecordingWhoseClockGoesBackIsSaidAndMapped) {
  ASSERT_EQ(run({"record", kSource, at("walk"), "--format", "tum"}), 0) << said();
  turn_back_clock(at("walk") / "depth.txt");
  EXPECT_EQ(run({"prescan", at("walk"), "--map", at("map"), "--resolution", "0.05"}), 0) << said();
  EXPECT_NE(said().find("are of two clocks that differ by 100 s"), std::string::npos) << said();
  EXPECT_EQ(run({"map", "verify", at("map")}), 0) << said();
  EXPECT_EQ(run({"run", at("walk"), "--map", at("map")}), 0) << said();
}

TEST_F(DeferredErrors, ARunInAMapThatDoesNotKnowUpSaysWhichWayThingsFall) {
  ASSERT_EQ(scan(at("map")), 0) << said();
  EXPECT_EQ(run({"run", kSource, "--map", at("map")}), 0) << said();
  EXPECT_EQ(said().find("the up direction"), std::string::npos) << said();
  std::string info = text_of(at("map") / "map.json");
  const std::string known = "\"accelerometer\"";
  ASSERT_NE(info.find(known), std::string::npos);
  info.replace(info.find(known), known.size(), "\"none\"");
  std::ofstream(at("map") / "map.json") << info;
  EXPECT_EQ(run({"run", kSource, "--map", at("map")}), 0) << said();
  EXPECT_NE(said().find("the up direction was not known"), std::string::npos) << said();
}

TEST_F(DeferredErrors, AMapIsReadWholeWhileAnotherProcessSavesItAnew) {
  ASSERT_EQ(scan(at("map")), 0) << said();
  SavedMap a = load_map(at("map"));
  SavedMap b = load_map(at("map"));
  for (const SavedMap* map : {&a, &b}) {  // before its folder is replaced
    map->octree.load();
    map->texture.load();
  }
  b.trajectory.pop_back();
  b.info.source = "another";
  const pid_t child = fork();
  if (child == 0) {
    for (;;) {
      save_map(at("map"), b);
      save_map(at("map"), a);
    }
  }
  int others = 0, overtaken = 0;
  for (int i = 0; i < 200; ++i) {
    try {
      const SavedMap read = load_map(at("map"));
      const bool is_other = read.info.source == "another";
      EXPECT_EQ(read.trajectory.size(), (is_other ? b : a).trajectory.size());
      others += is_other ? 1 : 0;
    } catch (const Error& fault) {  // when reading takes longer than saving
      EXPECT_NE(std::string(fault.what()).find("replaced by another process again and again"),
                std::string::npos)
          << fault.what();
      ++overtaken;
    }
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  if (overtaken > 0) return;
  EXPECT_GT(others, 0);
  EXPECT_LT(others, 200);
}

}  // namespace
}  // namespace roomradar::faults_test
