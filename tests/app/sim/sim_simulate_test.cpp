// sim_simulate_test.cpp: a simulated recording on disk is read back as simulated, with the truth beside it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sim/simulate.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar::sim_simulate_test {
namespace {

namespace fs = std::filesystem;

class SimulateTo : public testing::TestWithParam<RecordingFormat> {
 protected:
  fs::path folder_ = fs::path(testing::TempDir()) /
                     ("simulate_" + std::to_string(::getpid()) + "_" + std::string(to_string(GetParam())));
  void TearDown() override { fs::remove_all(folder_); }
};

TEST_P(SimulateTo, IsReadBackAsItWasWithItsTruthBeside) {
  // fakenect replays 640 x 480 only.
  const std::string width = GetParam() == RecordingFormat::kFakenect ? "640" : "160";
  const SimOptions options = parse_sim_spec("sim:table?frames=4&path=view&moving=ball&seed=5&width=" + width);
  std::int64_t reported = 0;
  simulate(folder_, options, GetParam(), [&](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(done, ++reported);
    EXPECT_EQ(total, 4);
  });
  EXPECT_EQ(reported, 4);

  SimulatedSource again(options);
  const auto recorded = open_folder(folder_.string(), {});
  Frame expected, frame;
  const std::vector<TimedPose> poses = read_trajectory(folder_ / "truth" / "trajectory.txt");
  ASSERT_EQ(poses.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(again.next(expected).status, ReadStatus::kFrame);
    ASSERT_EQ(recorded->next(frame).status, ReadStatus::kFrame);
    ASSERT_EQ(frame.depth_m.pixels.size(), expected.depth_m.pixels.size());
    EXPECT_NEAR(frame.depth_camera.fx_px, expected.depth_camera.fx_px, 0.02 * expected.depth_camera.fx_px);
    std::size_t off = 0;
    for (std::size_t pixel = 0; pixel < frame.depth_m.pixels.size(); ++pixel) {
      const float z = expected.depth_m.pixels[pixel];
      off += std::abs(frame.depth_m.pixels[pixel] - z) >
             0.001F + 0.003F * z * z;  // fakenect: the Kinect's raw steps
    }
    EXPECT_LT(off, frame.depth_m.pixels.size() / 1000);
    EXPECT_EQ(frame.colour.pixels, expected.colour.pixels);
    EXPECT_LT((poses[static_cast<std::size_t>(i)].T_world_camera.matrix() - expected.T_world_camera->matrix())
                  .norm(),
              1e-6);
    const std::string name = "00000" + std::to_string(i) + ".png";
    DepthImage exact_m;
    read_depth_file(folder_ / "truth" / "depth" / name, DepthEncoding::kTum, exact_m);
    for (std::size_t pixel = 0; pixel < exact_m.pixels.size(); ++pixel)
      ASSERT_NEAR(exact_m.pixels[pixel], again.truth().depth_m.pixels[pixel], 0.00011);
    const cv::Mat moved = cv::imread((folder_ / "truth" / "moved" / name).string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(moved.total(), again.truth().moved.pixels.size());
    EXPECT_TRUE(std::equal(again.truth().moved.pixels.begin(), again.truth().moved.pixels.end(), moved.data));
  }
  EXPECT_EQ(recorded->next(frame).status, ReadStatus::kEnd);
  const Mesh mesh = read_mesh(folder_ / "truth" / "room.ply");
  EXPECT_GT(mesh.triangles.size(), 2000U);
  const Room room = make_room("table");
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 17)
    EXPECT_NEAR(signed_distance_m(room, mesh.origin + mesh.vertices[i].cast<double>()), 0.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(EachFormat, SimulateTo,
                         testing::Values(RecordingFormat::kTum, RecordingFormat::kSevenScenes,
                                         RecordingFormat::kFakenect),
                         [](const auto& format) {
                           const std::string name(to_string(format.param));
                           return name == "7scenes" ? "SevenScenes" : name;
                         });

TEST(Simulate, WalksOfTheBuildingAreRecordedAndListed) {
  const fs::path folder = fs::path(testing::TempDir()) / ("simulate_walks_" + std::to_string(::getpid()));
  const SimOptions options = parse_sim_spec("sim:building?rooms=4&width=64&frames=3&rate=1");
  std::set<std::string> names;
  simulate_walks(folder, options, 1, 2, RecordingFormat::kTum,
                 [&](const std::string& name, std::int64_t, std::int64_t total) {
                   names.insert(name);
                   EXPECT_EQ(total, 3);
                 });
  EXPECT_EQ(names, (std::set<std::string>{"walk-0001", "walk-0002"}));
  std::ifstream list(folder / "recordings.txt");
  std::vector<std::string> lines;
  for (std::string line; std::getline(list, line);) lines.push_back(line);
  EXPECT_EQ(lines, (std::vector<std::string>{"walk-0001: walk-0001", "walk-0002: walk-0002"}));
  for (const int walk : {1, 2}) {
    const fs::path one = folder / ("walk-000" + std::to_string(walk));
    SimOptions its_options = options;
    its_options.walk = walk;
    SimulatedSource again(its_options);
    Frame frame, expected;
    const auto recorded = open_folder(one.string(), {});
    ASSERT_EQ(recorded->next(frame).status, ReadStatus::kFrame);
    ASSERT_EQ(again.next(expected).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.colour.pixels, expected.colour.pixels);
    EXPECT_EQ(read_trajectory(one / "truth" / "trajectory.txt").size(), 3U);
    // The mesh has what is seen, in the frame of the poses.
    const Mesh mesh = read_mesh(one / "truth" / "room.ply");
    EXPECT_GT(mesh.triangles.size(), 1000U);
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 97)
      EXPECT_NEAR(signed_distance_m(again.room(), mesh.origin + mesh.vertices[i].cast<double>()), 0.0, 1e-5);
    std::ifstream json(one / "truth" / "sim.json");
    const std::string text((std::istreambuf_iterator<char>(json)), {});
    EXPECT_NE(text.find("\"walk\": " + std::to_string(walk)), std::string::npos);
    EXPECT_NE(text.find("\"walk_rooms\""), std::string::npos);
  }
  EXPECT_THROW(simulate_walks(folder, options, 0, 0, RecordingFormat::kTum), Error) << "not empty";
  fs::remove_all(folder);
  EXPECT_THROW(simulate_walks(folder, parse_sim_spec("sim:table"), 0, 0, RecordingFormat::kTum), Error);
  EXPECT_THROW(simulate_walks(folder, options, 0, 10'000, RecordingFormat::kTum), Error);
  EXPECT_THROW(simulate_walks(folder, options, 2, 1, RecordingFormat::kTum), Error);
  EXPECT_FALSE(fs::exists(folder));
}

TEST(Simulate, AFolderThatHoldsSomethingIsLeftAlone) {
  const fs::path folder = fs::path(testing::TempDir()) / ("simulate_full_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "mine.txt") << "keep";
  EXPECT_THROW(simulate(folder, parse_sim_spec("sim:table?frames=1&width=64"), RecordingFormat::kTum), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}), 1);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace roomradar::sim_simulate_test
