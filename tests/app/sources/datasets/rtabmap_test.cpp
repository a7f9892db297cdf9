// rtabmap_test.cpp: RTAB-Map's databases, written by its tables.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/containers/written_rvl.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::rtabmap_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::decisions_about;
using test::error_of;
using test::ReadAll;
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

// ---- sessions and the optimised graph ----

/// Row by row 3 x 4, as Transform of RTAB-Map.
std::vector<float> at(float x, float y = 0.0F) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, 0}; }

struct WrittenNode {
  int id = 0, map_id = 0;
  std::vector<float> pose{};
  std::string calibration = camera(32, 24);
  int depth_width_px = 16;
};

/// RTAB-Map, corelib/src/Compression.cpp, compressData2(): zlib, then rows, columns and OpenCV's type.
template <typename Value>
std::string compressed(const std::vector<Value>& values, std::int32_t type) {
  uLongf size = compressBound(values.size() * sizeof(Value));
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(values.data()),
                     values.size() * sizeof(Value)),
            Z_OK);
  packed.resize(size);
  const std::int32_t tail[3] = {1, static_cast<std::int32_t>(values.size()), type};
  return packed + std::string(reinterpret_cast<const char*>(tail), sizeof tail);
}

void bind_bytes(sqlite3_stmt* statement, int column, const std::string& bytes) {
  sqlite3_bind_blob(statement, column, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
}

/// Tables as of RTAB-Map's corelib/src/resources/DatabaseSchema.sql, Admin.opt_ids and opt_poses as written by
/// DBDriverSqlite3::saveOptimizedPosesQuery().
void write_sessions(const fs::path& path, const std::vector<WrittenNode>& nodes,
                    const std::map<int, std::vector<float>>& optimised) {
  fs::remove(path);
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database,
               "CREATE TABLE Node(id INTEGER NOT NULL, map_id INTEGER NOT NULL, weight INTEGER, stamp FLOAT, pose BLOB,"
               "PRIMARY KEY (id));"
               "CREATE TABLE Data(id INTEGER NOT NULL, image BLOB, depth BLOB, calibration BLOB, PRIMARY KEY (id));"
               "CREATE TABLE Link(from_id INTEGER, to_id INTEGER);"
               "CREATE TABLE Admin(version TEXT, opt_cloud BLOB, opt_ids BLOB, opt_poses BLOB)",
               nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  for (const WrittenNode& node : nodes) {
    sqlite3_prepare_v2(database, "INSERT INTO Node VALUES(?, ?, 0, ?, ?)", -1, &insert, nullptr);
    sqlite3_bind_int(insert, 1, node.id);
    sqlite3_bind_int(insert, 2, node.map_id);
    sqlite3_bind_double(insert, 3, 100.0 + node.id);
    bind_bytes(insert, 4, floats(node.pose));
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
    sqlite3_prepare_v2(database, "INSERT INTO Data VALUES(?, ?, ?, ?)", -1, &insert, nullptr);
    sqlite3_bind_int(insert, 1, node.id);
    bind_bytes(insert, 2, png(cv::Mat(24, 32, CV_8UC3, cv::Scalar(9, 99, 199))));
    bind_bytes(insert, 3, png(cv::Mat(node.depth_width_px * 3 / 4, node.depth_width_px, CV_16UC1, cv::Scalar(1500))));
    bind_bytes(insert, 4, node.calibration);
    EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_finalize(insert);
  }
  std::vector<std::int32_t> ids;
  std::vector<float> poses;
  for (const auto& [id, pose] : optimised) {
    ids.push_back(id);
    poses.insert(poses.end(), pose.begin(), pose.end());
  }
  sqlite3_prepare_v2(database, "INSERT INTO Admin VALUES('0.21.4', NULL, ?, ?)", -1, &insert, nullptr);
  if (!optimised.empty()) {
    bind_bytes(insert, 1, compressed(ids, 4));    // CV_32SC1
    bind_bytes(insert, 2, compressed(poses, 5));  // CV_32FC1
  }
  EXPECT_EQ(sqlite3_step(insert), SQLITE_DONE);
  sqlite3_finalize(insert);
  sqlite3_close(database);
}

/// x of the robot's pose per frame, in the order of time; NAN without a pose.
std::vector<double> x_of_frames(const fs::path& path, std::string& said, ReadAll* read = nullptr) {
  ReadAll all;
  said = decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
  std::vector<double> x;
  for (const Frame& frame : all.frames) x.push_back(frame.T_world_camera ? frame.T_world_camera->translation().x() : NAN);
  if (read) *read = std::move(all);
  return x;
}

TEST(Rtabmap, OptimisedPosesGoBeforeOdometryAndMoveTheNodesBesideTheGraph) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  std::vector<WrittenNode> nodes;
  for (int i = 1; i <= 6; ++i) nodes.push_back({i, 0, at(static_cast<float>(i))});
  nodes[4].pose.clear();                       // neither here
  nodes[5].pose = std::vector<float>(12, 0.0F);  // nor there: RTAB-Map's null transform
  std::string said;
  write_sessions(path, nodes, {});
  std::vector<double> x = x_of_frames(path, said);
  ASSERT_EQ(x.size(), 6U);
  EXPECT_NEAR(x[3], 4.0, 1e-6);
  EXPECT_TRUE(std::isnan(x[4]) && std::isnan(x[5]));
  EXPECT_TRUE(contains(said, "2 recorded poses")) << said;
  write_sessions(path, nodes, {{1, at(1.0F)}, {3, at(3.5F)}});
  x = x_of_frames(path, said);
  ASSERT_EQ(x.size(), 6U);
  EXPECT_NEAR(x[0], 1.0, 1e-6);
  EXPECT_NEAR(x[1], 2.0, 1e-6) << "moved like node 1";
  EXPECT_NEAR(x[2], 3.5, 1e-6);
  EXPECT_NEAR(x[3], 4.5, 1e-6) << "moved like node 3";
}

TEST(Rtabmap, SessionsAreNotLaidOverEachOther) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  std::vector<WrittenNode> nodes;
  for (int i = 1; i <= 3; ++i) nodes.push_back({i, 0, at(static_cast<float>(i))});
  for (int i = 4; i <= 8; ++i) nodes.push_back({i, 1, at(static_cast<float>(i - 3))});
  std::string said;
  write_sessions(path, nodes, {});
  std::vector<double> x = x_of_frames(path, said);
  ASSERT_EQ(x.size(), 8U);
  EXPECT_TRUE(std::isnan(x[0]) && std::isnan(x[2]));
  EXPECT_NEAR(x[3], 1.0, 1e-6);
  EXPECT_TRUE(contains(said, "holds 2 sessions") && contains(said, "3 frames are used without a pose")) << said;
  write_sessions(path, nodes, {{1, at(1)}, {2, at(2)}, {3, at(3)}, {4, at(11)}, {8, at(15)}});
  x = x_of_frames(path, said);
  EXPECT_NEAR(x[0], 1.0, 1e-6);
  for (std::size_t i = 3; i < 8; ++i) EXPECT_NEAR(x[i], 8.0 + static_cast<double>(i), 1e-6);
  EXPECT_TRUE(contains(said, "the optimised poses join them")) << said;
  write_sessions(path, nodes, {{1, at(1)}, {3, at(3)}});  // session 1 was never joined
  x = x_of_frames(path, said);
  EXPECT_NEAR(x[1], 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(x[3]) && std::isnan(x[7]));
  EXPECT_TRUE(contains(said, "5 frames are used without a pose")) << said;
}

TEST(Rtabmap, OptimisedPosesThatAreDamagedAreNotUsed) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  std::string said;
  for (const char* change : {"opt_poses = X'00'", "opt_ids = NULL", "opt_ids = opt_poses", "opt_poses = opt_ids"}) {
    write_sessions(path, {{1, 0, at(1)}, {2, 0, at(2)}}, {{1, at(5)}, {2, at(6)}});
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    sqlite3_exec(database, ("UPDATE Admin SET " + std::string(change)).c_str(), nullptr, nullptr, nullptr);
    sqlite3_close(database);
    const std::vector<double> x = x_of_frames(path, said);
    ASSERT_EQ(x.size(), 2U) << change;
    EXPECT_NEAR(x[1], 2.0, 1e-6) << change;
  }
}

// ---- cameras of the nodes ----

/// As camera(), with P of rectified images, for which K and D do not hold.
std::string rectified_camera(double f_px) {
  const std::int32_t head[11] = {0, 21, 4, 0, 32, 24, 9, 5, 9, 12, 12};
  std::string bytes(reinterpret_cast<const char*>(head), sizeof head);
  const double numbers[9 + 5 + 9 + 12] = {40, 0, 15.5, 0, 42, 11.5, 0, 0, 1, 0.3, -0.2, 0, 0, 0, 1, 0, 0, 0, 1, 0,
                                          0,  0, 1,    f_px, 0, 15, 0, 0, f_px, 11, 0, 0, 0, 1, 0};
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
  return bytes + floats({0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0.2F});
}

TEST(Rtabmap, ImagesAreRectifiedWherePIsStated) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  write_sessions(path, {{1, 0, at(1), rectified_camera(36)}}, {});
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 1U);
  EXPECT_EQ(all.frames[0].colour_camera, (Intrinsics{32, 24, 36, 36, 15, 11}));
  for (const float depth : all.frames[0].depth_m.pixels) EXPECT_EQ(depth, 1.5F) << "no lens is removed";
}

TEST(Rtabmap, NodesOfAnotherCameraAreNamed) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  std::vector<WrittenNode> nodes = {{1, 0, at(1), camera(64, 48), 32}};
  for (int i = 2; i <= 5; ++i) nodes.push_back({i, 0, at(static_cast<float>(i))});
  std::string said;
  ReadAll all;
  write_sessions(path, nodes, {});
  (void)x_of_frames(path, said, &all);
  EXPECT_TRUE(contains(said, "1 of 5 nodes have a camera of another size")) << said;
  EXPECT_EQ(all.frames.size(), 4U);
  EXPECT_EQ(all.frames.at(0).depth_camera, (Intrinsics{16, 12, 20, 21, 7.5, 5.5}));
  nodes[0] = {1, 0, at(1), rectified_camera(30)};
  nodes[1].calibration = "";
  write_sessions(path, nodes, {});
  (void)x_of_frames(path, said, &all);
  EXPECT_EQ(all.frames.size(), 5U);
  EXPECT_TRUE(contains(said, "the focal length of 3 of 5 nodes differs, by up to 33 %")) << said;
}

TEST(Rtabmap, TheFirstNodeMayBeDamaged) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.db";
  std::vector<WrittenNode> nodes;
  for (int i = 1; i <= 40; ++i) nodes.push_back({i, 0, at(static_cast<float>(i))});
  write_sessions(path, nodes, {});
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database,
               "UPDATE Data SET depth = X'00', image = X'01' WHERE id <= 2;"
               "UPDATE Data SET calibration = X'02' WHERE id = 1;"
               "UPDATE Data SET depth = X'89504e47' WHERE id BETWEEN 5 AND 34;"
               "UPDATE Data SET image = X'ff' WHERE id >= 38",
               nullptr, nullptr, nullptr);
  sqlite3_close(database);
  ReadAll all;
  std::string said;
  (void)x_of_frames(path, said, &all);
  EXPECT_EQ(all.frames.size(), 8U) << said;
  EXPECT_EQ(all.faults.size(), 32U);
  EXPECT_TRUE(contains(said, "32 depth images cannot be read") && contains(said, "3 colour images")) << said;
  EXPECT_TRUE(all.frames.back().colour.empty());
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
