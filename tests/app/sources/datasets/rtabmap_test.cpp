// rtabmap_test.cpp: RTAB-Map's databases, written by its tables.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::rtabmap_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;

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
  for (int i = 1; i <= 4; ++i) {
    const std::string depth = i == 1   ? png(depth_mm)
                              : i == 2 ? png(cv::Mat(12, 16, CV_8UC4, depth_m.data))
                              : i == 3 ? std::string()
                                       : "DRVL...";
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
  EXPECT_EQ(source->frame_count(), 3) << "one node has no depth";
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), 2U);
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_TRUE(contains(all.faults[0], "RVL"));
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
