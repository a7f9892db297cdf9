// record3d_test.cpp: exports by Record3D, a real one and written ones.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "app/sources/containers/exr_depth.hpp"
#include "app/sources/datasets/arkit_axes.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::record3d_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

/// Median distance along the axis of b between points of frame a, moved by the recorded poses, and the depth
/// of frame b where they project; -1 with fewer than 100 such points. Points farther than 0.3 m from the
/// depth of b are hidden and left out.
double median_disagreement_m(const Frame& a, const Frame& b) {
  constexpr double kHidden_m = 0.3;
  const Eigen::Isometry3d T_b_a = b.T_world_camera->inverse() * *a.T_world_camera;
  std::vector<double> distances_m;
  for (int y = 0; y < a.depth_m.height; y += 3)
    for (int x = 0; x < a.depth_m.width; x += 3) {
      const double z = static_cast<double>(a.depth_m.at(x, y));
      if (z <= 0.0) continue;
      const Eigen::Vector3d p_b = T_b_a * back_project(a.depth_camera, x, y, z);
      if (p_b.z() < 0.1) continue;
      const Eigen::Vector2d at = project(b.depth_camera, p_b);
      const int u = static_cast<int>(std::lround(at.x())), v = static_cast<int>(std::lround(at.y()));
      if (!b.depth_m.contains(u, v) || b.depth_m.at(u, v) <= 0.0F) continue;
      const double distance_m = std::abs(static_cast<double>(b.depth_m.at(u, v)) - p_b.z());
      if (distance_m < kHidden_m) distances_m.push_back(distance_m);
    }
  if (distances_m.size() < 100) return -1.0;
  std::nth_element(distances_m.begin(), distances_m.begin() + std::ssize(distances_m) / 2, distances_m.end());
  return distances_m[distances_m.size() / 2];
}

constexpr int kWidth = 6, kHeight = 8;

/// Writes depth 1 + x / 4 + y / 16 + frame m, exact in half floats; pixel (0, 0) is infinite.
void write_exr(const fs::path& path, int frame) {
  std::vector<half> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      pixels.push_back(x + y == 0 ? half::posInf()
                                  : half(static_cast<float>(1.0 + 0.25 * x + 0.0625 * y + frame)));
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  Imf::OutputFile file(path.c_str(), header, 0);
  Imf::FrameBuffer frame_buffer;
  frame_buffer.insert("R", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(pixels.data()), sizeof(half),
                                      kWidth * sizeof(half)));
  file.setFrameBuffer(frame_buffer);
  file.writePixels(kHeight);
}

const std::string kMetadata =
    R"({"w":12,"h":16,"dw":6,"dh":8,"fps":60,"K":[20,0,0,0,22,0,5.5,7.5,1],
        "poses":[[0,0,0,1,1,2,3],[0,0,0,1,1,2,4],[0,0,0,0,0,0,0],[0,0,0,1,1,2,6]],
        "frameTimestamps":[0,0.25,0.5,0.75]})";

void write_export(const fs::path& folder, const std::string& metadata = kMetadata) {
  write_text(folder / "metadata", metadata);
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / "rgb");
  for (int i = 0; i < 3; ++i) {
    write_exr(folder / "depth" / (std::to_string(i) + ".exr"), i);
    cv::imwrite((folder / "rgb" / (std::to_string(i) + ".jpg")).string(),
                cv::Mat(16, 12, CV_8UC3, {9, 99, 199}));
  }
}

TEST(Record3d, GivesDepthInMetresWithTheCameraScaledToIt) {
  const TemporaryFolder folder;
  write_export(folder.path());
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 3U);
  EXPECT_EQ(all.frames[1].stamp_s, 0.25);
  EXPECT_EQ(all.frames[1].depth_m.at(0, 0), 0.0F);
  EXPECT_EQ(all.frames[1].depth_m.at(3, 2), 1.0F + 0.75F + 0.125F + 1.0F);
  EXPECT_EQ(all.frames[1].depth_camera, (Intrinsics{6, 8, 10, 11, 2.5, 3.5}));
  EXPECT_EQ(all.frames[1].colour_camera, (Intrinsics{12, 16, 20, 22, 5.5, 7.5}));
  EXPECT_NEAR(all.frames[1].colour.at(5, 5).r, 199, 3);
}

TEST(ExrDepth, ReadsWhatOpenExrWrites) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "depth.exr").string();
  constexpr int kWide = 37, kHigh = 35;  // blocks of 16 rows, the last one not full
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION})
    for (const auto type : {Imf::HALF, Imf::FLOAT}) {
      std::vector<half> halves;
      std::vector<float> floats;
      for (int i = 0; i < kWide * kHigh; ++i) {
        // 0, denormal halves, small and large numbers, negative ones, not finite ones
        const float value = i == 0   ? 0.0F
                            : i == 1 ? 3e-7F
                            : i == 2 ? 5e-5F
                            : i == 3 ? -1.0F
                            : i == 4 ? INFINITY
                            : i == 5 ? NAN
                            : i == 6 ? 65504.0F
                                     : 0.4F + 0.01F * static_cast<float>(i * i % 997);
        halves.emplace_back(value);
        floats.push_back(value);
      }
      Imf::Header header(kWide, kHigh);
      header.dataWindow() = {{5, -3}, {5 + kWide - 1, -3 + kHigh - 1}};
      header.compression() = compression;
      header.channels().insert("Z", Imf::Channel(type));
      {
        Imf::OutputFile file(path.c_str(), header, 0);
        const std::size_t size = type == Imf::HALF ? sizeof(half) : sizeof(float);
        char* first = type == Imf::HALF ? reinterpret_cast<char*>(halves.data())
                                        : reinterpret_cast<char*>(floats.data());
        Imf::FrameBuffer frame_buffer;
        frame_buffer.insert("Z", Imf::Slice(type, first - static_cast<std::ptrdiff_t>(size) * (5 - 3 * kWide),
                                            size, size * kWide));
        file.setFrameBuffer(frame_buffer);
        file.writePixels(kHigh);
      }
      DepthImage depth_m;
      const std::string bytes = read_bytes(path, "an image");
      decode_exr_depth(bytes, path, depth_m);
      ASSERT_EQ(depth_m.width, kWide);
      ASSERT_EQ(depth_m.height, kHigh);
      for (std::size_t i = 0; i < depth_m.pixels.size(); ++i) {
        const float value = type == Imf::HALF ? static_cast<float>(halves[i]) : floats[i];
        ASSERT_EQ(depth_m.pixels[i], std::isfinite(value) && value > 0.0F ? value : 0.0F)
            << compression << " " << i;
      }
      for (std::size_t size = 0; size < bytes.size(); size += 41)
        EXPECT_GT(error_of([&] { decode_exr_depth(bytes.substr(0, size), path, depth_m); }).size(), 10U)
            << size;
    }
}

TEST(Record3d, TurnsArkitsAxesToZUpAndYDown) {
  const TemporaryFolder folder;
  write_export(folder.path());
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 3U);
  const Frame& frame = all.frames[0];
  // ARKit's camera at rotation 0 looks along -z of its world, which is +y of ours.
  const Eigen::Vector3d ahead = *frame.T_world_camera * Eigen::Vector3d(0, 0, 1);
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d(1, -3 + 1, 2)));
  EXPECT_TRUE(frame.down_camera->isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_FALSE(all.frames[2].T_world_camera) << "a pose of zeros is no pose";
  EXPECT_FALSE(all.frames[2].down_camera);
}

TEST(Record3d, SaysWhatIsWrongWithTheMetadata) {
  const auto message_of = [](const std::string& from, const std::string& to) {
    const TemporaryFolder folder;
    std::string metadata = kMetadata;
    const auto at = metadata.find(from);
    EXPECT_NE(at, std::string::npos);
    write_export(folder.path(), metadata.replace(at, from.size(), to));
    return error_of([&] { (void)open_folder(folder.path()); });
  };
  EXPECT_TRUE(contains(message_of("[20,0,0,0,22,0,5.5,7.5,1]", "[20]"), "K: must be a list of 9 numbers"));
  EXPECT_TRUE(contains(message_of("[20,", "[-20,"), "fx"));
  EXPECT_TRUE(
      contains(message_of("\"dh\":8", "\"dh\":3"), "which does not have the aspect ratio of the colour"));
  EXPECT_TRUE(contains(message_of("\"w\":12,", ""), "'w' is missing"));
  EXPECT_TRUE(contains(message_of("0.75]}", "0.75"), "is it cut short?"));
}

TEST(Record3d, AFrameWithoutAPoseKeepsItsDepth) {
  for (const char* pose : {"[0,0]", "null", "\"lost\""}) {
    const TemporaryFolder folder;
    std::string metadata = kMetadata;
    const std::string from = "[0,0,0,1,1,2,3]";
    write_export(folder.path(), metadata.replace(metadata.find(from), from.size(), pose));
    test::ReadAll all;
    const std::string said = test::decisions_about(
        [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    ASSERT_EQ(all.frames.size(), 3U) << pose;
    EXPECT_FALSE(all.frames[0].T_world_camera);
    EXPECT_TRUE(contains(said, "recorded poses are lost")) << said;
  }
  const TemporaryFolder folder;
  std::string metadata = kMetadata;
  const std::size_t begin = metadata.find("\"poses\""), end = metadata.find("]]", begin);
  write_export(folder.path(), metadata.replace(begin, end + 2 - begin, "\"poses\":null"));
  EXPECT_EQ(read_all(*open_folder(folder.path())).frames.size(), 3U);
}

// All fields that the app writes, with the name that some versions give the file. Poses are shorter than the list of
// images.
TEST(Record3d, ReadsMetadataOfOtherVersions) {
  const TemporaryFolder folder;
  write_export(folder.path());
  fs::remove(folder.path() / "metadata");
  write_text(folder.path() / "metadata.json",
             R"({"w":12,"h":16,"dw":6,"dh":8,"fps":60,"K":[20,0,0,0,22,0,5.5,7.5,1],"initPose":[0,0,0,1,0,0,0],
                 "cameraType":1,"scaledDepthK":[],"perFrameIntrinsicCoeffs":[[20,22,5.5,7.5],[20,22,5.5,7.5]],
                 "poses":[[0,0,0,1,1,2,3],[0,0,0,1,1,2,4]],"frameTimestamps":[0.1,0.35]})");
  test::ReadAll all;
  const std::string said = test::decisions_about(
      [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), 3U);
  EXPECT_EQ(all.frames[1].stamp_s, 0.35);
  EXPECT_EQ(all.frames[1].colour_camera, (Intrinsics{12, 16, 20, 22, 5.5, 7.5}));
  EXPECT_TRUE(all.frames[1].T_world_camera);
  EXPECT_FALSE(all.frames[2].T_world_camera);
  EXPECT_TRUE(contains(said, "1 recorded pose")) << said;
  EXPECT_TRUE(contains(said, "no usable time stamp")) << said;
}

TEST(Record3d, ReadsNumbersInQuotes) {
  const TemporaryFolder folder;
  std::string quoted;  // each number of the metadata in quotes
  for (std::size_t i = 0; i < kMetadata.size();) {
    const std::size_t end = kMetadata.find_first_not_of("0123456789.", i);
    const bool is_name = i > 0 && kMetadata[i - 1] == '"';
    if (end == i || is_name)
      quoted += kMetadata[i++];
    else
      quoted += '"' + kMetadata.substr(i, end - i) + '"', i = end;
  }
  write_export(folder.path(), quoted);
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 3U);
  EXPECT_EQ(all.frames[1].stamp_s, 0.25);
  EXPECT_EQ(all.frames[1].depth_camera, (Intrinsics{6, 8, 10, 11, 2.5, 3.5}));
  EXPECT_TRUE(all.frames[1].T_world_camera.has_value());
}

TEST(Record3d, ReadsDepthThatWasConvertedToPng) {
  const TemporaryFolder folder;
  write_export(folder.path());
  for (int i = 0; i < 3; ++i) {
    const std::string name = (folder.path() / "depth" / std::to_string(i)).string();
    cv::imwrite(name + ".png", cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(1500 + i)));
    fs::remove(name + ".exr");
  }
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 3U);
  EXPECT_EQ(all.frames[2].depth_m.at(3, 2), 1.502F);
}

TEST(Record3d, IsReadWithoutPosesAndStamps) {
  for (const char* rest : {"", R"(,"poses":[],"frameTimestamps":[])", R"(,"poses":null,"frameTimestamps":null)"}) {
    const TemporaryFolder folder;
    write_export(folder.path(), std::string(R"({"w":12,"h":16,"dw":6,"dh":8,"fps":20,"K":[20,0,0,0,22,0,5.5,7.5,1])") +
                                    rest + "}");
    const auto all = read_all(*open_folder(folder.path()));
    ASSERT_EQ(all.frames.size(), 3U);
    EXPECT_FALSE(all.frames[0].T_world_camera);
    EXPECT_NEAR(all.frames[2].stamp_s, 0.1, 1e-12);
  }
}

TEST(Record3d, IsReadWithoutDepthSizeAndCamera) {
  const TemporaryFolder folder;
  write_export(folder.path(), R"({"w":12,"h":16,"fps":60})");
  fs::remove(folder.path() / "depth" / "1.exr");
  write_text(folder.path() / "depth" / "0.exr", "cut");
  test::ReadAll all;
  const std::string said = test::decisions_about(
      [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), 1U) << said;
  EXPECT_EQ(all.frames[0].depth_camera.width_px, kWidth);
  EXPECT_EQ(all.frames[0].depth_camera.height_px, kHeight);
  EXPECT_NEAR(all.frames[0].depth_camera.fx_px, 0.71 * kHeight, 1e-9);
  EXPECT_TRUE(contains(said, "no camera is stated; that of an iPhone is assumed")) << said;
  EXPECT_TRUE(contains(said, "1 colour image has no depth image of the same number")) << said;
  for (int i = 0; i < 3; ++i) write_text(folder.path() / "depth" / (std::to_string(i) + ".exr"), "cut");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "no depth image can be read"));
}

TEST(Record3d, ItsOwnFormIsNamed) {
  const TemporaryFolder folder;
  write_text(folder.path() / "scan.r3d", "PK");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path() / "scan.r3d"); }), "EXR + RGB"));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "EXR + RGB"));
  write_text(folder.path() / "unpacked" / "metadata", kMetadata);
  write_text(folder.path() / "unpacked" / "rgbd" / "0.depth", "bvx2");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path() / "unpacked"); }), "rgbd/N.depth"));
}

TEST(Record3d, SkipsAFrameWhoseImageIsDamaged) {
  const TemporaryFolder folder;
  write_export(folder.path());
  test::cut_to(folder.path() / "depth" / "1.exr", 0.7);
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 2U);
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_TRUE(contains(all.faults[0], "1.exr"));
}

TEST(Record3d, RealExportAgreesWithItsPoses) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "record3d");
  const auto source = open_folder(folder);
  EXPECT_EQ(source->frame_count(), 60);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), 60U);
  for (const Frame& frame : all.frames) {
    EXPECT_EQ(frame.depth_camera.width_px, 192);
    EXPECT_EQ(frame.colour_camera.height_px, 1920);
    EXPECT_GT(frame.down_camera->y(), 0.3) << "the phone is held upright";
  }
  EXPECT_NEAR(all.frames[59].stamp_s, 59 / 60.0, 0.001);
  // Measured with these poses: see the commit. With a wrong axis: more than 0.03 m.
  EXPECT_LT(median_disagreement_m(all.frames[0], all.frames[59]), 0.02);
  EXPECT_GT(median_disagreement_m(all.frames[0], all.frames[59]), 0.0);
}

}  // namespace
}  // namespace roomradar::record3d_test
