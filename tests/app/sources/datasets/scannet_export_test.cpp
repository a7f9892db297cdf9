// scannet_export_test.cpp: recordings of ScanNet as its two export programs write them.
#include <gtest/gtest.h>

#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::scannet_export_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::decisions_about;
using test::error_of;
using test::ReadAll;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

constexpr int kFrames = 3;

/// Four lines of four numbers, as np.savetxt(fmt='%f') writes a matrix.
std::string matrix_text(const std::vector<double>& m) {
  std::string text;
  char number[64];
  for (std::size_t i = 0; i < m.size(); ++i) {
    std::snprintf(number, sizeof number, i % 4 == 3 ? "%f\n" : "%f ", m[i]);
    text += number;
  }
  return text;
}

std::vector<double> identity(double x = 0.0) { return {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }
std::vector<double> intrinsic(double fx, double fy, double cx, double cy) {
  return {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

/// As ScanNet's SensReader/python/SensorData.py writes it: export_depth_images(), export_color_images(),
/// export_poses(), export_intrinsics(), with frame_skip=10.
void write_python_export(const fs::path& folder) {
  for (const char* name : {"color", "depth", "pose", "intrinsic"}) fs::create_directories(folder / name);
  for (int i = 0; i < kFrames; ++i) {
    const std::string number = std::to_string(10 * i);
    cv::imwrite((folder / "depth" / (number + ".png")).string(), cv::Mat(12, 16, CV_16UC1, cv::Scalar(1500 + i)));
    cv::imwrite((folder / "color" / (number + ".jpg")).string(), cv::Mat(24, 36, CV_8UC3, cv::Scalar(9, 99, 199)));
    write_text(folder / "pose" / (number + ".txt"), matrix_text(identity(0.5 * i)));
  }
  write_text(folder / "pose" / "10.txt", matrix_text(std::vector<double>(16, -HUGE_VAL)));
  write_text(folder / "intrinsic" / "intrinsic_color.txt", matrix_text(intrinsic(40, 41, 17, 11)));
  write_text(folder / "intrinsic" / "extrinsic_color.txt", matrix_text(identity(0.04)));
  write_text(folder / "intrinsic" / "intrinsic_depth.txt", matrix_text(intrinsic(20, 21, 7.5, 5.5)));
  write_text(folder / "intrinsic" / "extrinsic_depth.txt", matrix_text(identity(0.01)));
}

std::string said_about(const fs::path& folder, ReadAll* all = nullptr) {
  return decisions_about([&](const SourceOptions& options) { return open_folder(folder, options); }, all);
}

TEST(ScanNetExport, ByPythonHasItsCamerasAndPoses) {
  const TemporaryFolder folder;
  write_python_export(folder.path());
  ReadAll all;
  const std::string said = said_about(folder.path(), &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(all.frames[0].depth_camera, (Intrinsics{16, 12, 20, 21, 7.5, 5.5}));
  EXPECT_EQ(all.frames[0].colour_camera, (Intrinsics{36, 24, 40, 41, 17, 11}));
  EXPECT_NEAR(all.frames[0].T_colour_depth.translation().x(), -0.03, 1e-9);
  EXPECT_EQ(all.frames[2].depth_m.at(5, 5), 1.502F);
  EXPECT_NEAR(all.frames[2].stamp_s, 20 / 30.0, 1e-9);
  EXPECT_NEAR(all.frames[2].T_world_camera->translation().x(), 1.0, 1e-9);
  EXPECT_FALSE(all.frames[1].T_world_camera) << "-inf: tracking was lost";
  EXPECT_TRUE(contains(said, "1 recorded pose")) << said;
  EXPECT_FALSE(contains(said, "is assumed: focal")) << said;
}

TEST(ScanNetExport, WithoutIntrinsicSaysWhichCameraIsAssumed) {
  const TemporaryFolder folder;
  write_python_export(folder.path());
  fs::remove_all(folder.path() / "intrinsic");
  const std::string said = said_about(folder.path());
  EXPECT_TRUE(contains(said, "no camera is stated")) << said;
  EXPECT_TRUE(contains(said, "--camera FILE")) << said;
}

TEST(ScanNetExport, NamesAMatrixThatIsNone) {
  const TemporaryFolder folder;
  write_python_export(folder.path());
  const auto message_of = [&](const std::string& text) {
    write_text(folder.path() / "intrinsic" / "intrinsic_depth.txt", text);
    return error_of([&] { (void)open_folder(folder.path()); });
  };
  EXPECT_TRUE(contains(message_of("20 0 7.5"), "intrinsic_depth.txt: has 3 numbers"));
  EXPECT_TRUE(contains(message_of(matrix_text(intrinsic(-20, 21, 7.5, 5.5))), "intrinsic_depth.txt: fx"));
  EXPECT_TRUE(contains(message_of("x 1"), "'x' is not a number"));
}

// Colour that was made smaller after the export, as many who train networks do, without its matrix.
TEST(ScanNetExport, ColourOfAnotherSizeThanItsMatrixIsFittedAndSaid) {
  const TemporaryFolder folder;
  write_python_export(folder.path());
  for (int i = 0; i < kFrames; ++i)
    cv::imwrite((folder.path() / "color" / (std::to_string(10 * i) + ".jpg")).string(),
                cv::Mat(12, 16, CV_8UC3, cv::Scalar(9, 99, 199)));
  ReadAll all;
  const std::string said = said_about(folder.path(), &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(all.frames[0].colour_camera.fx_px, 40 * 16 / 35.0, 0.1);
  EXPECT_NEAR(all.frames[0].colour_camera.fy_px, 41 * 12 / 23.0, 0.1);
  EXPECT_TRUE(contains(said, "intrinsic_color.txt is of images of about 35 x 23")) << said;
}

/// As ScanNet's SensReader/c++/src/sensorData.h writes it: saveToImages() with saveAsPGM() and savePoseFile().
void write_cpp_export(const fs::path& folder) {
  const auto inline_text = [](const std::vector<double>& m) {
    std::string text;
    for (const double value : m) text += std::to_string(value) + " ";
    return text;
  };
  write_text(folder / "_info.txt",
             "m_versionNumber = 4\nm_sensorName = StructureSensor (calibrated)\nm_colorWidth = 36\nm_colorHeight = 24\n"
             "m_depthWidth = 16\nm_depthHeight = 12\nm_depthShift = 4000\nm_calibrationColorIntrinsic = " +
                 inline_text(intrinsic(40, 41, 17, 11)) +
                 "\nm_calibrationColorExtrinsic = " + inline_text(identity(0.04)) +
                 "\nm_calibrationDepthIntrinsic = " + inline_text(intrinsic(20, 21, 7.5, 5.5)) +
                 "\nm_calibrationDepthExtrinsic = " + inline_text(identity(0.01)) + "\nm_frames.size = 3\n");
  for (int i = 0; i < kFrames; ++i) {
    const std::string stem = "frame-00000" + std::to_string(i);
    std::string pgm = "P5\n16 12\n65535\n";
    for (int p = 0; p < 16 * 12; ++p) pgm += std::string{static_cast<char>((6000 + i) >> 8), static_cast<char>((6000 + i) & 255)};
    write_text(folder / (stem + ".depth.pgm"), pgm);
    cv::imwrite((folder / (stem + ".color.jpg")).string(), cv::Mat(24, 36, CV_8UC3, cv::Scalar(9, 99, 199)));
    write_text(folder / (stem + ".pose.txt"), "1 0 0 " + std::to_string(i) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  }
  write_text(folder / "frame-000001.pose.txt", "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf");
}

TEST(ScanNetExport, ByCppHasItsUnitCamerasAndPoses) {
  const TemporaryFolder folder;
  write_cpp_export(folder.path());
  ReadAll all;
  const std::string said = said_about(folder.path(), &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(all.frames[0].depth_camera, (Intrinsics{16, 12, 20, 21, 7.5, 5.5}));
  EXPECT_EQ(all.frames[0].colour_camera, (Intrinsics{36, 24, 40, 41, 17, 11}));
  EXPECT_NEAR(all.frames[0].T_colour_depth.translation().x(), -0.03, 1e-9);
  EXPECT_EQ(all.frames[2].depth_m.at(5, 5), 6002.0F / 4000.0F);
  EXPECT_NEAR(all.frames[2].T_world_camera->translation().x(), 2.0, 1e-12);
  EXPECT_FALSE(all.frames[1].T_world_camera);
  EXPECT_TRUE(contains(said, "1 recorded pose")) << said;
  EXPECT_FALSE(contains(said, "is assumed: focal")) << said;
}

TEST(ScanNetExport, NamesAFieldOfItsInfoThatIsWrong) {
  const TemporaryFolder folder;
  write_cpp_export(folder.path());
  const std::string info = "m_depthWidth = 16\nm_depthHeight = 12\nm_depthShift = 4000\nm_colorWidth = 0\n"
                           "m_calibrationDepthIntrinsic = 20 0 7.5 0 0 21 5.5 0 0 0 1 0 0 0 0 1\n"
                           "m_calibrationColorExtrinsic = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
                           "m_calibrationDepthExtrinsic = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = info;
    text.replace(text.find(from), from.size(), to);
    write_text(folder.path() / "_info.txt", text);
    return error_of([&] { (void)open_folder(folder.path()); });
  };
  write_text(folder.path() / "_info.txt", info);
  EXPECT_EQ(read_all(*open_folder(folder.path())).frames.size(), 3U);
  EXPECT_TRUE(contains(with("m_depthShift = 4000", ""), "_info.txt: m_depthShift must be 1 number"));
  EXPECT_TRUE(contains(with("4000", "0"), "m_depthShift must be above 0"));
  EXPECT_TRUE(contains(with("= 20 0 7.5", "= 20"), "m_calibrationDepthIntrinsic must be 16 numbers"));
  EXPECT_TRUE(contains(with("= 20 0", "= -20 0"), "m_calibrationDepthIntrinsic: fx"));
  EXPECT_TRUE(contains(with("m_depthHeight = 12", "m_depthHeight = 16"), "states images of 16 x 16, but they are 16 x 12"));
}

}  // namespace
}  // namespace roomradar::scannet_export_test
