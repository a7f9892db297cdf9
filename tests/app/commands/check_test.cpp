// check_test.cpp: `roomradar check`, and the options that state what a recording does not.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/sources/datasets/dataset_readers.hpp"
#include "tests/support/forked_program.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::check_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Outcome {
  int status = -1;
  std::string out;  ///< stdout and stderr combined
};

Outcome roomradar(const std::vector<std::string>& arguments) {
  int ends[2];
  Outcome outcome;
  if (pipe2(ends, O_CLOEXEC) != 0) return outcome;
  const pid_t child = test::start_program(arguments, ends[1]);
  close(ends[1]);
  char buffer[4096];
  for (ssize_t n = 0; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    outcome.out.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  outcome.status = test::status_of(child);
  return outcome;
}

/// Runs `check RECORDING --json` with further arguments.
json checked(const fs::path& recording, std::vector<std::string> more, int status) {
  more.insert(more.begin(), {"check", recording.string(), "--json"});
  const Outcome outcome = roomradar(more);
  EXPECT_EQ(outcome.status, status) << outcome.out;
  const json parsed = json::parse(outcome.out, nullptr, false);
  EXPECT_FALSE(parsed.is_discarded()) << outcome.out;
  return parsed;
}

bool has_advice(const json& found, const std::string& topic) {
  return std::any_of(found["input"].begin(), found["input"].end(), [&](const json& decision) {
    return decision["topic"] == topic && decision["advice"] == true;
  });
}

/// Records a walk through a simulated room once for all tests here.
class Check : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(::testing::TempDir()) / ("roomradar_check_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    for (const char* format : {"tum", "7scenes"}) {
      const Outcome made = roomradar({"record", "sim:table?frames=60&width=160&rate=15",
                                      (folder_ / format).string(), "--format", format});
      ASSERT_EQ(made.status, 0) << made.out;
    }
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }
  /// Returns a copy of the recording that a test may change.
  static fs::path copy_of(const char* format) {
    const fs::path copy = folder_ / "copy";
    fs::remove_all(copy);
    fs::copy(folder_ / format, copy, fs::copy_options::recursive);
    return copy;
  }
  static json prescanned(const fs::path& recording, std::vector<std::string> more) {
    const fs::path report = folder_ / "report.json";
    more.insert(more.begin(),
                {"prescan", recording.string(), "--map", (folder_ / "map").string(), "--resolution", "0.04",
                 "--texture", "off", "--report", report.string(), "--replace"});
    const Outcome outcome = roomradar(more);
    EXPECT_EQ(outcome.status, 0) << outcome.out;
    std::ifstream file(report);
    return json::parse(file, nullptr, false);
  }
  inline static fs::path folder_;
};

TEST_F(Check, ASoundRecordingNeedsNothing) {
  for (const char* format : {"tum", "7scenes"}) {
    const json found = checked(folder_ / format, {}, 0);
    EXPECT_EQ(found["frames"], 60);
    EXPECT_EQ(found["poses_agree"], true);
    EXPECT_EQ(found["poses_convention"], "stated");
    EXPECT_EQ(found["pose_part"], 1.0);
    EXPECT_LT(found["pose_difference_mm"], 20.0);
    EXPECT_EQ(found["cameras_origin"], "stated by a file");
  }
  const Outcome text = roomradar({"check", (folder_ / "tum").string()});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("TUM RGB-D recording"), std::string::npos) << text.out;
}

TEST_F(Check, InversePosesAreRecognisedAndUsed) {
  const fs::path recording = copy_of("7scenes");
  for (const fs::directory_entry& entry : fs::directory_iterator(recording)) {
    if (!entry.path().filename().string().ends_with(".pose.txt")) continue;
    const Eigen::Matrix4d T = read_pose_file(entry.path()).T_world_camera->inverse().matrix();
    std::ofstream file(entry.path());
    file.precision(12);
    for (int row = 0; row < 4; ++row)
      file << T(row, 0) << ' ' << T(row, 1) << ' ' << T(row, 2) << ' ' << T(row, 3) << '\n';
  }
  const json found = checked(recording, {}, 1);
  EXPECT_EQ(found["poses_convention"], "inverse");
  EXPECT_TRUE(has_advice(found, "poses"));
  EXPECT_EQ(checked(recording, {"--poses-convention", "inverse"}, 0)["poses_convention"], "inverse");

  const json good = prescanned(folder_ / "7scenes", {"--poses", "recorded"});
  const json mended = prescanned(recording, {"--poses", "recorded"});
  EXPECT_NEAR(mended["map"]["triangles"].get<double>(), good["map"]["triangles"].get<double>(),
              0.02 * good["map"]["triangles"].get<double>());
  EXPECT_TRUE(has_advice(mended, "poses"));
  EXPECT_FALSE(has_advice(good, "poses"));
}

TEST_F(Check, PosesThatCannotBeRightAreNotUsed) {
  const fs::path recording = copy_of("7scenes");
  for (const fs::directory_entry& entry : fs::directory_iterator(recording))
    if (entry.path().filename().string().ends_with(".pose.txt"))
      std::ofstream(entry.path()) << "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  EXPECT_EQ(checked(recording, {}, 1)["poses_agree"], false);
  const Outcome outcome = roomradar({"prescan", recording.string(), "--map", (folder_ / "none").string(),
                                     "--poses", "recorded", "--texture", "off"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("agrees under no convention"), std::string::npos) << outcome.out;
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(Check, UnitAndCameraCanBeStatedAndAreQuestioned) {
  const fs::path recording = folder_ / "tum";
  json found = checked(recording, {"--depth-unit", "0.001"}, 1);  // in truth 1/5000 m
  EXPECT_TRUE(has_advice(found, "unit")) << found.dump(1);
  EXPECT_EQ(found["depth_unit_m"], 0.001);
  EXPECT_EQ(checked(recording, {"--depth-unit", "0.0002"}, 0)["depth_unit_origin"], "stated by an option");

  std::ifstream file(recording / "camera.json");
  json camera = json::parse(file);
  for (const char* which : {"depth", "colour"})
    for (const char* side : {"fx_px", "fy_px"})
      if (camera.contains(which)) camera[which][side] = camera[which][side].get<double>() * 1.4;
  std::ofstream(folder_ / "longer.json") << camera;
  found = checked(recording, {"--camera", (folder_ / "longer.json").string()}, 1);
  EXPECT_TRUE(has_advice(found, "camera")) << found.dump(1);

  const fs::path stated = copy_of("tum");
  json sized = json::parse(std::ifstream(recording / "camera.json"));
  sized["depth_unit_m"] = 0.001;
  std::ofstream(stated / "camera.json") << sized;
  EXPECT_EQ(checked(stated, {}, 1)["depth_unit_m"], 0.001);
  const json scanned = prescanned(stated, {"--depth-unit", "0.0002"});  // the option has the last word
  EXPECT_FALSE(has_advice(scanned, "unit"));
  EXPECT_EQ(scanned["settings"]["depth_unit"], 0.0002);
}

TEST_F(Check, WrongUsageAndMissingRecordingsAreNamed) {
  EXPECT_EQ(roomradar({"check", (folder_ / "tum").string(), "--stamps", "hours"}).status, 2);
  EXPECT_EQ(roomradar({"check", (folder_ / "tum").string(), "--depth-unit", "0"}).status, 2);
  EXPECT_EQ(roomradar({"check", (folder_ / "tum").string(), "--poses-convention", "sideways"}).status, 2);
  const Outcome none = roomradar({"check", (folder_ / "not-here").string()});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.out.find("not-here"), std::string::npos);
}

TEST_F(Check, RealRecordingsGiveNoFalseAlarm) {
  for (const char* name : {"kitchen", "fr1_rpy", "stray", "record3d", "hall", "turntable"}) {
    const auto recording = test::recording(name);
    if (!recording)
      GTEST_SKIP() << "recording '" << name << "' is not here; set ROOMRADAR_DATA to its folder";
    const json found = checked(*recording, {}, 0);
    EXPECT_EQ(found["camera_is_still"], name == std::string("turntable")) << name;
  }
}

}  // namespace
}  // namespace roomradar::check_test
