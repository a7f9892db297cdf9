// sources_recordings_test.cpp: real recordings, and the same ones through the Kinect's own library by
// fakenect.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "app/sources/folder_source.hpp"
#include "app/sources/frame_range.hpp"
#include "app/sources/kinect_source.hpp"
#include "tests/app/sources_fingerprint.hpp"
#include "tests/app/sources_support.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar {
namespace {

using test::read_all;

TEST(RealRecordings, KitchenHasFiveHundredFramesWithPoses) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  EXPECT_EQ(source->frame_count(), 500);
  Frame frame;
  std::vector<double> read_ms;
  for (int i = 0; i < 500; ++i) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame) << i;
    read_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    ASSERT_TRUE(frame.T_world_camera) << i;
    const Eigen::Matrix3d R = frame.T_world_camera->linear();
    ASSERT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12) << i;
    for (const float z : frame.depth_m.pixels) ASSERT_TRUE(z >= 0.0F && z < 65.0F);
  }
  EXPECT_EQ(source->next(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(frame.depth_camera, (Intrinsics{640, 480, 585, 585, 320, 240}));
  EXPECT_EQ(frame.colour.width, 640);
  std::nth_element(read_ms.begin(), read_ms.begin() + 250, read_ms.end());
  RecordProperty("median_read_ms", std::to_string(read_ms[250]));
}

TEST(RealRecordings, KitchensLastHundredFramesAreAskedForByRange) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = limit_frames(open_folder(folder), 400, 499);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 400);
  EXPECT_EQ(source->frame_count(), 100);
}

TEST(RealRecordings, CupIsAlignedAndOfItsOwnSize) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "cup");
  const auto source = open_folder(folder);
  EXPECT_EQ(source->frame_count(), 207);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.depth_camera, (Intrinsics{640, 360, 460, 460, 319.5, 179.5}));
  EXPECT_EQ(frame.colour_camera, frame.depth_camera);
  EXPECT_FALSE(frame.T_world_camera);
}

TEST(RealRecordings, PlanesHaveRawDepthAndAnUprightCamera) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "fakenect-planes/planes");
  const auto all = read_all(*open_folder(folder));
  EXPECT_TRUE(all.faults.empty());
  ASSERT_EQ(all.frames.size(), 36U);
  int with_colour = 0, with_gravity = 0;
  for (const Frame& frame : all.frames) {
    with_colour += frame.colour.empty() ? 0 : 1;
    if (!frame.down_camera) continue;
    ++with_gravity;
    EXPECT_GT(frame.down_camera->y(),
              std::cos(15.0 * M_PI / 180));  // tilted up by the 9.8 degrees its motor reports
    EXPECT_LT(frame.down_camera->z(), 0);    // up: gravity points behind it
  }
  EXPECT_GE(with_colour, 34);
  EXPECT_EQ(with_gravity, 35);  // the first depth image came before the first reading
}

TEST(RealRecordings, PlanesWallsArePlumb) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "fakenect-planes/planes");
  const auto all = read_all(*open_folder(folder));
  const Frame& frame = all.frames.at(5);
  // The whiteboard's left half, by least squares on z = a x + b y + c.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (int y = 180; y < 380; ++y)
    for (int x = 240; x < 480; ++x) {
      const double z = frame.depth_m.at(x, y);
      if (z == 0.0) continue;
      const Eigen::Vector3d p = back_project(frame.depth_camera, x, y, z);
      const Eigen::Vector3d row(p.x(), p.y(), 1.0);
      A += row * row.transpose();
      b += row * z;
    }
  const Eigen::Vector3d fit = A.ldlt().solve(b);
  const Eigen::Vector3d normal = Eigen::Vector3d(fit[0], fit[1], -1.0).normalized();
  const double off_plumb_deg = std::abs(std::asin(normal.dot(*frame.down_camera))) * 180 / M_PI;
  EXPECT_LT(off_plumb_deg, 4.0);  // 2.5 measured; with z's sign turned round it is 22
}

#ifdef ROOMRADAR_REPLAY_DUMP
std::vector<std::string> frames_by_fakenect(const std::filesystem::path& folder) {
  const test::TemporaryFolder temporary;
  const auto output = temporary.path() / "frames.txt";
  const std::string command = "FAKENECT_LOOP=0 timeout 60 fakenect '" + folder.string() +
                              "' '" ROOMRADAR_REPLAY_DUMP "' kinect:0 > '" + output.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::vector<std::string> lines;
  std::ifstream file(output);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("frame ")) lines.push_back(line);  // fakenect prints lines of its own
  return lines;
}

class Replay : public testing::TestWithParam<const char*> {};

TEST_P(Replay, GivesTheFramesOfTheFolderAndEnds) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, GetParam());
  if (std::system("command -v fakenect > /dev/null") != 0) GTEST_SKIP() << "fakenect is not installed";
  std::vector<std::string> by_folder;
  for (const Frame& frame : read_all(*open_folder(folder)).frames)
    by_folder.push_back(test::fingerprint(frame));
  EXPECT_FALSE(by_folder.empty());
  EXPECT_EQ(frames_by_fakenect(folder), by_folder);
}
INSTANTIATE_TEST_SUITE_P(RealRecordings, Replay,
                         testing::Values("fakenect-planes/planes", "fakenect-planes/kinectcap"));
#endif

TEST(Kinect, AbsentDeviceOrBuildIsSaidSo) {
  const std::string message = test::error_of([] { open_kinect(17); });
  EXPECT_TRUE(test::contains(message, "kinect:17")) << message;
}

}  // namespace
}  // namespace roomradar
