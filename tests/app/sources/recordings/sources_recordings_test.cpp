// sources_recordings_test.cpp: real recordings, read from disk and replayed by fakenect.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "app/sources/formats/frame_range.hpp"
#include "app/sources/kinect/kinect_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "tests/app/sources/sources_fingerprint.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::sources_recordings_test {
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

TEST(RealRecordings, CupIsOfItsOwnSizeAndHasNoPoses) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "cup");
  const auto source = open_folder(folder);
  EXPECT_EQ(source->frame_count(), 207);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.depth_camera, (Intrinsics{640, 360, 347, 347, 319.5, 179.5}));
  EXPECT_EQ(frame.colour_camera.height_px, 360);
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
              std::cos(15.0 * M_PI / 180));  // tilted up by the 9.8 degrees that its motor reports
    EXPECT_LT(frame.down_camera->z(), 0);    // looking up: gravity points backwards
  }
  EXPECT_GE(with_colour, 34);
  EXPECT_EQ(with_gravity, 35);  // the first depth image precedes the first reading
}

TEST(RealRecordings, PlanesWallsArePlumb) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "fakenect-planes/planes");
  const auto all = read_all(*open_folder(folder));
  const Frame& frame = all.frames.at(5);
  // Plane of the whiteboard's left half, by least squares on z = a x + b y + c.
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
  EXPECT_LT(off_plumb_deg, 4.0);  // 2.5 measured; 22 with the opposite sign of z
}

/// Brightness gradient around each pixel, relative to the image's mean.
Image<float> edge_strength(const ColourImage& colour) {
  Image<float> strength(colour.width, colour.height);
  double sum = 0;
  const auto grey = [&](int x, int y) {
    const Rgb p = colour.at(x, y);
    return static_cast<float>(p.r + p.g + p.b);
  };
  for (int y = 1; y + 1 < colour.height; ++y)
    for (int x = 1; x + 1 < colour.width; ++x) {
      const float strong = std::hypot(grey(x + 1, y) - grey(x - 1, y), grey(x, y + 1) - grey(x, y - 1));
      strength.at(x, y) = std::sqrt(strong);
      sum += strength.at(x, y);
    }
  const auto mean = static_cast<float>(sum / static_cast<double>(strength.pixels.size()));
  for (float& value : strength.pixels) value /= mean;
  return strength;
}

/// Projects the near sides of the frame's depth discontinuities into its colour image.
std::vector<Eigen::Vector2d> depth_edges_in_colour(const Frame& frame) {
  std::vector<Eigen::Vector2d> points;
  constexpr int kReach_px = 12;  // the projector's shadow is between near and far
  const DepthImage& depth_m = frame.depth_m;
  for (int y = kReach_px; y + kReach_px < depth_m.height; ++y)
    for (int x = kReach_px; x + kReach_px < depth_m.width; ++x) {
      const float z = depth_m.at(x, y);
      if (z < 0.5F || z > 3.0F) continue;
      bool at_jump = false;
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        float far_m = 0;
        for (int step = 1; step <= kReach_px && far_m == 0.0F; ++step)
          far_m = depth_m.at(x + dx * step, y + dy * step);
        at_jump |= far_m > 1.1F * z;
      }
      if (!at_jump) continue;
      const Eigen::Vector3d p_depth = back_project(frame.depth_camera, x, y, z);
      points.push_back(project(frame.colour_camera, frame.T_colour_depth * p_depth));
    }
  return points;
}

/// Mean edge strength of the colour images at the depth edges, shifted by (dx, dy).
double edge_agreement(const std::vector<Frame>& frames, int dx_px, int dy_px) {
  double sum = 0;
  std::size_t count = 0;
  for (const Frame& frame : frames) {
    const Image<float> strength = edge_strength(frame.colour);
    for (const Eigen::Vector2d& p : depth_edges_in_colour(frame)) {
      const int x = static_cast<int>(std::lround(p.x())) + dx_px;
      const int y = static_cast<int>(std::lround(p.y())) + dy_px;
      if (!strength.contains(x, y)) continue;
      sum += strength.at(x, y);
      ++count;
    }
  }
  return sum / static_cast<double>(count);
}

void expect_best_where_it_is(const std::vector<Frame>& frames, int off_px) {
  const double here = edge_agreement(frames, 0, 0);
  for (const auto& [dx, dy] : {std::pair(off_px, 0), {-off_px, 0}, {0, off_px}, {0, -off_px}})
    EXPECT_GT(here, edge_agreement(frames, dx, dy)) << dx << " " << dy;
}

TEST(RealRecordings, KitchensDepthEdgesMeetItsColourEdges) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  std::vector<Frame> frames(10);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_TRUE(source->seek(static_cast<std::int64_t>(50 * i + 20)));
    ASSERT_EQ(source->next(frames[i]).status, ReadStatus::kFrame);
  }
  expect_best_where_it_is(frames, 3);
}

TEST(RealRecordings, CupsDepthEdgesMeetItsColourEdges) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "cup");
  const auto source = open_folder(folder);
  std::vector<Frame> frames(5);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_TRUE(source->seek(static_cast<std::int64_t>(40 * i)));
    ASSERT_EQ(source->next(frames[i]).status, ReadStatus::kFrame);
  }
  expect_best_where_it_is(frames, 4);
}

TEST(RealRecordings, PlanesDepthEdgesMeetItsColourEdges) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "fakenect-planes/planes");
  const auto all = read_all(*open_folder(folder)).frames;
  expect_best_where_it_is({all.at(3), all.at(10), all.at(28)}, 4);
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
    if (line.starts_with("frame ")) lines.push_back(line);  // fakenect prints its own lines
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

#ifdef ROOMRADAR_REPLAY_DUMP
TEST(Kinect, RecordingOfOurOwnReplaysAsItIsRead) {
  if (std::system("command -v fakenect > /dev/null") != 0) GTEST_SKIP() << "fakenect is not installed";
  const test::TemporaryFolder folder;
  RecordingWriter writer(folder.path() / "r", RecordingFormat::kFakenect);
  for (int i = 0; i < 5; ++i) {
    Frame frame = test::some_frame(i, 640, 480);
    if (i == 2) frame.colour.resize(0, 0);
    writer.write(frame);
  }
  writer.close();
  std::vector<std::string> by_folder;
  for (const Frame& frame : read_all(*open_folder(folder.path() / "r")).frames)
    by_folder.push_back(test::fingerprint(frame));
  ASSERT_EQ(by_folder.size(), 5U);
  EXPECT_EQ(frames_by_fakenect(folder.path() / "r"), by_folder);
}
#endif

TEST(Kinect, AbsentDeviceOrBuildIsSaidSo) {
  const std::string message = test::error_of([] { open_kinect(17); });
  EXPECT_TRUE(test::contains(message, "kinect:17")) << message;
}

}  // namespace
}  // namespace roomradar::sources_recordings_test
