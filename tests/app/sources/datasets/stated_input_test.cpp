// stated_input_test.cpp: camera.json, options and unreadable images mean the same for recordings of every kind.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_kinds.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace roomradar::stated_input_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::decisions_about;
using test::error_of;
using test::ReadAll;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

/// A small recording of one kind: of tests/fuzz/corpus/TARGET/NAME, as a file or as a folder of files.
struct Kind {
  std::string target, name, file{};
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.target << "/" << kind.name; }

std::vector<Kind> kinds() {
  std::vector<Kind> all = {{"bag", "own", "recording.bag"},    {"db3", "small", "recording.db3"},
                           {"mcap", "scan", "recording.mcap"}, {"klg", "small", "recording.klg"},
                           {"oni", "NONE", "recording.oni"},   {"rtabmap", "small", "recording.db"},
                           {"sens", "zlib", "recording.sens"}};
  for (const char* name : {"fakenect", "icl", "numbered", "record3d", "redwood", "seven-scenes", "stray", "tum"})
    all.push_back({"recording", name});
  return all;
}

/// Writes the recording into a folder, which holds nothing else.
void write_recording(const Kind& kind, const fs::path& folder) {
  const std::string bytes =
      read_bytes(fs::path(ROOMRADAR_SOURCE_DIR) / "tests/fuzz/corpus" / kind.target / kind.name, "a recording", std::uintmax_t{1} << 20U);
  if (!kind.file.empty()) return write_text(folder / kind.file, bytes);
  const fs::path files = test::folder_with(bytes);
  fs::copy(files, folder, fs::copy_options::recursive);
  for (const char* name : {"camera.json", "camera-intrinsics.txt"}) fs::remove(folder / name);
}

nlohmann::json camera_json_of(const Intrinsics& camera, double fx_px) {
  CameraRig rig;
  rig.depth_camera = camera;
  rig.depth_camera.fx_px = fx_px;
  nlohmann::json root = json_of(rig);
  root["format"] = "roomradar camera";
  root["version"] = 1;
  return root;
}

class EveryKind : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    write_recording(GetParam(), folder_.path());
    facts_ = read_facts(folder_.path());
    decisions_about([&](const SourceOptions& options) { return open_folder(folder_.path(), options); }, &before_);
    ASSERT_FALSE(before_.frames.empty());
  }
  [[nodiscard]] ReadAll read(SourceOptions options = {}) const {
    options.input = std::make_shared<InputReport>();
    return read_all(*open_folder(folder_.path(), options));
  }
  void state(const std::string& field, const nlohmann::json& value, const fs::path& file) const {
    nlohmann::json root = camera_json_of(before_.frames[0].depth_camera, 77.0);
    if (!field.empty()) root[field] = value;
    write_text(file, root.dump());
  }
  /// Expects the depth of all frames to be `factor` times that before.
  void expect_depth(const ReadAll& all, double factor) const {
    ASSERT_EQ(all.frames.size(), before_.frames.size());
    for (std::size_t i = 0; i < all.frames.size(); ++i)
      for (std::size_t p = 0; p < all.frames[i].depth_m.pixels.size(); ++p)
        ASSERT_NEAR(all.frames[i].depth_m.pixels[p], factor * static_cast<double>(before_.frames[i].depth_m.pixels[p]), 1e-4);
  }
  /// Expects poses of inverse matrices.
  void expect_inverse_poses(const ReadAll& all) const {
    ASSERT_EQ(all.frames.size(), before_.frames.size());
    const Eigen::Isometry3d &W = facts_.T_world_statedworld, &C = facts_.T_statedcamera_camera;
    for (std::size_t i = 0; i < all.frames.size(); ++i) {
      const auto &is = all.frames[i].T_world_camera, &was = before_.frames[i].T_world_camera;
      ASSERT_EQ(is.has_value(), was.has_value());
      if (!was) continue;
      const Eigen::Isometry3d stated = W.inverse() * *was * C.inverse();
      EXPECT_TRUE(is->isApprox(W * stated.inverse() * C, 1e-6)) << i;
    }
  }

  TemporaryFolder folder_, beside_;
  RecordingFacts facts_;
  ReadAll before_;
};

TEST_P(EveryKind, CameraJsonInItsFolderStatesCameraUnitAndPoses) {
  state("", {}, folder_.path() / "camera.json");
  ReadAll all = read();
  EXPECT_EQ(all.frames.at(0).depth_camera.fx_px, 77.0);
  expect_depth(all, 1.0);
  state("depth_unit_m", 2.0 * facts_.depth_unit_m, folder_.path() / "camera.json");
  expect_depth(read(), 2.0);
  state("poses_convention", "inverse", folder_.path() / "camera.json");
  expect_inverse_poses(read());
}

TEST_P(EveryKind, OptionsStateThem) {
  state("depth_unit_m", 2.0 * facts_.depth_unit_m, beside_.path() / "other.json");
  SourceOptions options;
  options.camera_file = beside_.path() / "other.json";
  ReadAll all = read(options);
  EXPECT_EQ(all.frames.at(0).depth_camera.fx_px, 77.0);
  expect_depth(all, 2.0);
  options.depth_unit_m = 3.0 * facts_.depth_unit_m;  // before the file
  expect_depth(read(options), 3.0);

  options = {};
  const Intrinsics& camera = before_.frames[0].depth_camera;
  write_text(beside_.path() / "matrix.txt", "66 0 " + std::to_string(camera.cx_px) + "\n0 66 " +
                                                std::to_string(camera.cy_px) + "\n0 0 1\n");
  options.camera_file = beside_.path() / "matrix.txt";
  all = read(options);
  EXPECT_EQ(all.frames.at(0).depth_camera.fx_px, 66.0);
  expect_depth(all, 1.0);

  options = {};
  options.pose_convention = parse_pose_convention("inverse");
  expect_inverse_poses(read(options));

  options = {};
  options.stamps = StampChoice::kIndex;
  all = read(options);
  ASSERT_EQ(all.frames.size(), before_.frames.size());
  for (std::size_t i = 0; i < all.frames.size(); ++i)
    EXPECT_NEAR(all.frames[i].stamp_s, static_cast<double>(all.frames[i].index) / 30.0, 1e-9);
}

TEST_P(EveryKind, WrongValuesAreNamedByFileAndField) {
  const auto message_of = [&](const std::string& field, const nlohmann::json& value) {
    state(field, value, folder_.path() / "camera.json");
    return error_of([&] { (void)read(); });
  };
  for (const nlohmann::json& value : {nlohmann::json(0), nlohmann::json(-0.001), nlohmann::json("mm"), nlohmann::json()}) {
    const std::string message = message_of("depth_unit_m", value);
    EXPECT_TRUE(contains(message, "camera.json") && contains(message, "depth_unit_m")) << value << message;
  }
  for (const nlohmann::json& value : {nlohmann::json("upside down"), nlohmann::json(1), nlohmann::json("")}) {
    const std::string message = message_of("poses_convention", value);
    EXPECT_TRUE(contains(message, "camera.json") && contains(message, "poses_convention")) << value << message;
  }
  SourceOptions options;
  options.camera_file = beside_.path() / "none.json";
  EXPECT_TRUE(contains(error_of([&] { (void)read(options); }), "none.json"));
  write_text(beside_.path() / "matrix.txt", "1 2 3");
  options.camera_file = beside_.path() / "matrix.txt";
  fs::remove(folder_.path() / "camera.json");
  EXPECT_TRUE(contains(error_of([&] { (void)read(options); }), "matrix.txt"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, ::testing::ValuesIn(kinds()), [](const auto& each) {
  std::string name = each.param.target + each.param.name;
  std::erase_if(name, [](char c) { return c == '-'; });
  return name;
});

}  // namespace
}  // namespace roomradar::stated_input_test
