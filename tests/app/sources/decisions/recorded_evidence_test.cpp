// recorded_evidence_test.cpp: recordings on disk whose poses are of another convention, opened as a scan
// does.
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::recorded_evidence_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::decisions_about;
using test::read_all;
using test::ReadAll;
using test::TemporaryFolder;
using test::write_text;

using ChangePose = std::function<Eigen::Isometry3d(Eigen::Isometry3d)>;

const std::vector<Frame>& walk() {
  static const std::vector<Frame> frames = [] {
    SimulatedSource source(parse_sim_spec("sim:table?frames=120&width=320&seed=4"));
    return read_all(source).frames;
  }();
  return frames;
}

void record(const fs::path& folder, RecordingFormat format, const ChangePose& change) {
  RecordingWriter writer(folder, format);
  for (Frame frame : walk()) {
    frame.T_world_camera = change(*frame.T_world_camera);
    writer.write(frame);
  }
  writer.close();
}

/// Opens the recording as a scan does; returns what was decided.
std::string open_and_compare(const fs::path& folder, ReadAll& all,
                             std::optional<PoseConvention> convention = {}) {
  return decisions_about(
      [&](SourceOptions options) {
        options.questions = Questions::kDepth;
        options.pose_convention = convention;
        return open_folder(folder, options);
      },
      &all);
}

/// Expects the motion of the simulated camera.
void expect_right_poses(const ReadAll& all, const std::string& said) {
  ASSERT_EQ(all.frames.size(), walk().size());
  for (std::size_t i = 0; i + 10 < walk().size(); i += 10) {
    ASSERT_TRUE(all.frames[i].T_world_camera) << said;
    const Eigen::Isometry3d is = all.frames[i].T_world_camera->inverse() * *all.frames[i + 10].T_world_camera;
    const Eigen::Isometry3d was = walk()[i].T_world_camera->inverse() * *walk()[i + 10].T_world_camera;
    EXPECT_TRUE(is.isApprox(was, 1e-3)) << i << "\n" << said;
  }
}

const Eigen::Isometry3d kOpengl(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));

TEST(RecordedEvidence, OtherConventionsOfPosesAreFoundByDepth) {
  const std::vector<std::pair<std::string, ChangePose>> changes = {
      {"", [](const Eigen::Isometry3d& T) { return T; }},
      {"world to camera", [](const Eigen::Isometry3d& T) { return T.inverse(); }},
      {"OpenGL", [](const Eigen::Isometry3d& T) { return T * kOpengl; }},
      {"millimetres", [](Eigen::Isometry3d T) {
         T.translation() *= 1000.0;
         return T;
       }}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto& [words, change] = changes[i];
    const TemporaryFolder folder;
    record(folder.path(), i % 2 == 0 ? RecordingFormat::kTum : RecordingFormat::kSevenScenes, change);
    ReadAll all;
    const std::string said = open_and_compare(folder.path(), all);
    expect_right_poses(all, said);
    if (words.empty())
      EXPECT_FALSE(contains(said, "poses")) << said;
    else
      EXPECT_TRUE(contains(said, words)) << said;
    // The user's word goes before.
    const std::string stated = open_and_compare(folder.path(), all, parse_pose_convention("stated"));
    ASSERT_TRUE(all.frames.at(40).T_world_camera) << stated;
    EXPECT_TRUE(all.frames[40].T_world_camera->isApprox(change(*walk()[40].T_world_camera), 1e-3)) << stated;
  }
}

TEST(RecordedEvidence, QuaternionsThatBeginWithWAreFoundByDepth) {
  const TemporaryFolder folder;
  record(folder.path(), RecordingFormat::kTum, [](const Eigen::Isometry3d& T) { return T; });
  std::istringstream lines(read_bytes(folder.path() / "groundtruth.txt", "poses", std::uintmax_t{1} << 24U));
  std::string changed;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string s, x, y, z, qx, qy, qz, qw;
    words >> s >> x >> y >> z >> qx >> qy >> qz >> qw;
    for (const std::string& word : {s, x, y, z, qw, qx, qy}) changed += word + " ";
    changed += qz + "\n";
  }
  write_text(folder.path() / "groundtruth.txt", changed);
  ReadAll all;
  const std::string said = open_and_compare(folder.path(), all);
  expect_right_poses(all, said);
  EXPECT_TRUE(contains(said, "w x y z")) << said;
}

TEST(RecordedEvidence, PosesThatAreAllTheSameAreNotUsed) {
  const TemporaryFolder folder;
  record(folder.path(), RecordingFormat::kSevenScenes,
         [](const Eigen::Isometry3d&) { return Eigen::Isometry3d::Identity(); });
  ReadAll all;
  const std::string said = open_and_compare(folder.path(), all);
  ASSERT_EQ(all.frames.size(), walk().size());
  for (const Frame& frame : all.frames) EXPECT_FALSE(frame.T_world_camera);
  EXPECT_TRUE(contains(said, "poses")) << said;
  (void)open_and_compare(folder.path(), all, parse_pose_convention("stated"));
  EXPECT_TRUE(all.frames.at(40).T_world_camera);
}

}  // namespace
}  // namespace roomradar::recorded_evidence_test
