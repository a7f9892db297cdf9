// rtabmap_test.cpp: RTAB-Map's databases, written by its tables.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/containers/written_rvl.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::rtabmap_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::written_rvl;

std::string png(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string floats(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

std::string camera(int width_px, int height_px, int copies = 1) {
  const std::int32_t head[11] = {0, 21, 4, 0, width_px, height_px, 9, 5, 0, 0, 12};
  const double numbers[14] = {40, 0, 15.5, 0, 42, 11.5, 0, 0, 1, 0, 0, 0, 0, 0};
  // From the robot (x forward, z up) to the camera (z forward, y down), 0.2 m above.
  std::string bytes(reinterpret_cast<const char*>(head), sizeof head);
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  bytes += floats({0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0.2F});
  std::string all;
  for (int i = 0; i < copies; ++i) all += bytes;
  return all;
}

void write_database(const fs::path& path, const std::string& calibration) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(
      database,
      "CREATE TABLE Node(id INTEGER NOT NULL, stamp FLOAT, pose BLOB, PRIMARY KEY (id));"
      "CREATE TABLE Data(id INTEGER NOT NULL, image BLOB, depth BLOB, calibration BLOB, PRIMARY KEY (id));"
      "CREATE TABLE Link(from_id INTEGER, to_id INTEGER)",
      nullptr, nullptr, nullptr);
  cv::Mat depth_mm(12, 16, CV_16UC1, cv::Scalar(1500));
  cv::Mat depth_m(12, 16, CV_32FC1, cv::Scalar(2.5F));
  depth_m.at<float>(0, 0) = NAN;
  const cv::Mat colour(24, 32, CV_8UC3, cv::Scalar(9, 99, 199));
  Image<std::uint16_t> units(16, 12, 1250);
  units.at(0, 0) = 0;
  const std::string rvl = "DEPTHRVL" + written_rvl(units);
  // Inverse depth: 4000 / (1250 + 350) = 2.5 m.
  const std::string inverse = "DEPTHINV" + floats({4000, -350});
  const std::vector<std::string> depth_blobs = {png(depth_mm),
                                                png(cv::Mat(12, 16, CV_8UC4, depth_m.data)),
                                                "",
                                                rvl,
                                                inverse + rvl,
                                                inverse + png(cv::Mat(12, 16, CV_16UC1, units.pixels.data())),
                                                rvl.substr(0, rvl.size() - 4),
                                                "DEPTHRVL" + written_rvl(Image<std::uint16_t>(32, 24))};
  for (int i = 1; i <= static_cast<int>(depth_blobs.size()); ++i) {
    const std::string depth = depth_blobs[static_cast<std::size_t>(i - 1)];
    const std::string image = png(colour),
                      pose = floats({1, 0, 0, static_cast<float>(i), 0, 1, 0, 2, 0, 0, 1, 3});
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO Node VALUES(?, ?, ?)", -1, &insert, nullptr);
    sqlite3_bind_int(insert, 1, i);
    sqlite3_bind_double(insert, 2, 100.0 + i);
    sqlite3_bind_blob(insert, 3, pose.data(), static_cast<int>(pose.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
    sqlite3_prepare_v2(database, "INSERT INTO Data VALUES(?, ?, ?, ?)", -1, &insert, nullptr);
    sqlite3_bind_int(insert, 1, i);
    int column = 2;
    for (const std::string* bytes : {&image, &depth, &calibration})
      sqlite3_bind_blob(insert, column++, bytes->data(), static_cast<int>(bytes->size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  sqlite3_close(database);
}

TEST(Rtabmap, GivesNodesWithDepth) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  write_database(path, camera(32, 24));
  const auto source = open_folder(path);
  EXPECT_EQ(source->frame_count(), 7) << "one node has no depth";
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), 5U);
  ASSERT_EQ(all.faults.size(), 2U);
  EXPECT_TRUE(contains(all.faults[0], "a depth image: is cut short")) << all.faults[0];
  EXPECT_TRUE(contains(all.faults[1], "is 32 x 24; the recording's other depth images are 16 x 12"))
      << all.faults[1];
  for (const std::size_t i : {2U, 3U, 4U}) {
    EXPECT_EQ(all.frames[i].depth_m.at(3, 3), i == 2 ? 1.25F : 2.5F) << "RVL, or inverse depth, " << i;
    EXPECT_EQ(all.frames[i].depth_m.at(0, 0), 0.0F);
  }
  EXPECT_EQ(all.frames[0].depth_m.at(3, 3), 1.5F);
  EXPECT_EQ(all.frames[1].depth_m.at(3, 3), 2.5F);
  EXPECT_EQ(all.frames[1].depth_m.at(0, 0), 0.0F);
  EXPECT_EQ(all.frames[0].stamp_s, 101.0);
  EXPECT_EQ(all.frames[0].depth_camera, (Intrinsics{16, 12, 20, 21, 7.5, 5.5}));
  EXPECT_EQ(all.frames[0].colour_camera, (Intrinsics{32, 24, 40, 42, 15.5, 11.5}));
  EXPECT_EQ(all.frames[0].colour.at(4, 4), (Rgb{199, 99, 9}));
  // A point 1 m ahead of the camera is 1 m along the robot's x.
  EXPECT_TRUE(
      (*all.frames[1].T_world_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(3, 2, 3.2), 1e-6));
}

// RTAB-Map's default: the first image, from which the size is read, is in RVL too.
TEST(Rtabmap, ReadsTheSizeOfRvl) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  write_database(path, camera(32, 24));
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "DELETE FROM Data WHERE id != 4", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 1U);
  EXPECT_EQ(all.frames[0].depth_camera, (Intrinsics{16, 12, 20, 21, 7.5, 5.5}));
  EXPECT_EQ(all.frames[0].depth_m.at(3, 3), 1.25F);
}

TEST(Rtabmap, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  int number = 0;
  const auto message_of = [&](const std::string& calibration) {
    const fs::path path = folder.path() / (std::to_string(number++) + ".db");
    write_database(path, calibration);
    return error_of([&] { (void)open_folder(path); });
  };
  EXPECT_TRUE(contains(message_of(camera(32, 24, 2)), "several cameras"));
  EXPECT_TRUE(contains(message_of(camera(32, 24).substr(0, 60)), "cut short"));
  EXPECT_TRUE(contains(message_of(std::string(200, 'x')), "before 0.18"));
  EXPECT_TRUE(contains(message_of(camera(50, 24)), "does not have the aspect ratio of the colour"));
}

}  // namespace
}  // namespace roomradar::rtabmap_test
