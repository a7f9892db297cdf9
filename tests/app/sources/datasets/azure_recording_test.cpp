// azure_recording_test.cpp: recordings by k4arecorder, a real one and written ones.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "app/sources/containers/matroska.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::azure_recording_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

std::string big_endian(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = bytes; i-- > 0;) text += static_cast<char>(value >> (8 * i) & 0xFFU);
  return text;
}

/// An identifier, as written in the standard, with its size in 8 bytes and its data.
std::string element(std::uint64_t id, const std::string& data) {
  const std::size_t id_bytes = id > 0xFFFFFF ? 4 : id > 0xFFFF ? 3 : id > 0xFF ? 2 : 1;
  return big_endian(id, id_bytes) + big_endian(std::uint64_t{1} << 56U | data.size(), 8) + data;
}
std::string element(std::uint64_t id, std::uint64_t number) { return element(id, big_endian(number, 8)); }

/// Video track with a bitmap header of this four-character code; without video if `code` is empty.
std::string track(std::uint64_t number, const std::string& name, const std::string& code, int width_px = 0,
                  int height_px = 0) {
  std::string data = element(0xD7, number) + element(0x536E, name);
  if (!code.empty())
    data += element(0x86, "V_MS/VFW/FOURCC") +
            element(0x63A2, std::string(16, '\0') + code + std::string(20, '\0')) +
            element(0xE0, element(0xB0, static_cast<std::uint64_t>(width_px)) +
                              element(0xBA, static_cast<std::uint64_t>(height_px)));
  return element(0xAE, data);
}

std::string block_data(int track, int ticks, const std::string& data) {
  return static_cast<char>(0x80 | track) + big_endian(static_cast<std::uint16_t>(ticks), 2) + '\0' + data;
}

std::string attachment(const std::string& name, const std::string& data) {
  return element(0x1941A469, element(0x61A7, element(0x466E, name) + element(0x465C, data)));
}

/// File with ticks of 1 us.
std::string matroska_file(const std::string& tracks, const std::string& attachments,
                          const std::string& clusters) {
  return element(0x1A45DFA3, element(0x4282, "matroska")) +
         element(0x18538067, element(0x1549A966, element(0x2AD7B1, 1000)) + element(0x1654AE6B, tracks) +
                                 attachments + clusters);
}

const std::string kCalibration = R"({"CalibrationInformation":{"Cameras":[
 {"Location":"CALIBRATION_CameraLocationD0",
  "Intrinsics":{"ModelParameters":[0.5,0.5,0.5,0.5,0,0,0,0,0,0,0,0,0,0]},
  "Rt":{"Rotation":[1,0,0,0,1,0,0,0,1],"Translation":[0,0,0]}},
 {"Location":"CALIBRATION_CameraLocationPV0",
  "Intrinsics":{"ModelParameters":[0.5,0.5,0.5,0.6,0,0,0,0,0,0,0,0,0,0]},
  "Rt":{"Rotation":[1,0,0,0,1,0,0,0,1],"Translation":[-0.032,0,0]}}],
 "InertialSensors":[{"SensorType":"CALIBRATION_InertialSensorType_Accelerometer",
  "Rt":{"Rotation":[0,0,1,1,0,0,0,1,0],"Translation":[0,0,0]}}]}})";

/// Depth of frame `i`: 1000 + i mm everywhere, except 0 and 65535 in the first two pixels.
std::string depth_data(int i) {
  std::string data;
  for (int p = 0; p < 320 * 288; ++p)
    data += big_endian(p == 0 ? 0U : p == 1 ? 65535U : 1000U + static_cast<unsigned>(i), 2);
  return data;
}

std::string imu_data(double stamp_s, const Eigen::Vector3f& acceleration) {
  std::string data(40, '\0');
  const auto stamp_ns =
      static_cast<std::uint64_t>(std::llround((stamp_s + 7.0) * 1e9));  // a clock of its own
  std::memcpy(data.data(), &stamp_ns, 8);
  std::memcpy(data.data() + 8, acceleration.data(), 12);
  return data;
}

std::string jpeg() {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", cv::Mat(720, 1280, CV_8UC3, {9, 99, 199}), bytes);
  return {bytes.begin(), bytes.end()};
}

/// Recording of two frames 1/30 s apart, colour 5 ms after depth.
std::string recording(const std::string& calibration = kCalibration, const std::string& depth_code = "b16g",
                      int width_px = 320) {
  const std::string tracks = track(1, "COLOR", "MJPG", 1280, 720) +
                             track(2, "DEPTH", depth_code, width_px, 288) + track(4, "IMU", "");
  std::string clusters;
  for (int i = 0; i < 2; ++i)
    clusters += element(
        0x1F43B675,
        element(0xE7, static_cast<std::uint64_t>(500'000 + 33'333 * i)) +
            element(0xA0, element(0xA1, block_data(4, -1000, imu_data(0.499 + i / 30.0, {0, 9.81F, 0})))) +
            element(0xA3, block_data(2, 0, depth_data(i))) + element(0xA3, block_data(1, 5000, jpeg())));
  return matroska_file(tracks, attachment("calibration.json", calibration), clusters);
}

TEST(AzureRecording, GivesDepthColourCamerasAndGravity) {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.mkv", recording());
  const auto source = open_folder(folder.path() / "a.mkv");
  EXPECT_EQ(source->frame_count(), 2);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), 2U);
  const Frame& frame = all.frames[1];
  EXPECT_NEAR(frame.stamp_s, 0.533333, 1e-9);
  EXPECT_NEAR(frame.colour_after_depth_s, 0.005, 1e-9);
  EXPECT_EQ(frame.depth_m.at(0, 0), 0.0F);
  EXPECT_EQ(frame.depth_m.at(1, 0), 0.0F);
  EXPECT_EQ(frame.depth_m.at(2, 0), 1.001F);
  // Half of the binned sensor's 512 px, less the crop of 96 and 90 px and half a pixel.
  EXPECT_EQ(frame.depth_camera, (Intrinsics{320, 288, 256, 256, 159.5, 165.5}));
  EXPECT_EQ(frame.colour_camera, (Intrinsics{1280, 720, 640, 576, 639.5, 359.5}));
  EXPECT_EQ(frame.T_colour_depth.translation().x(), -0.032);
  EXPECT_NEAR(frame.colour.at(9, 9).r, 199, 3);
  // The accelerometer's y is the depth camera's x. It measures the support force.
  ASSERT_TRUE(frame.down_camera);
  EXPECT_TRUE(frame.down_camera->isApprox(Eigen::Vector3d(-1, 0, 0), 1e-6)) << frame.down_camera->transpose();
}

TEST(AzureRecording, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  const auto message_of = [&](const std::string& bytes) {
    write_text(folder.path() / "a.mkv", bytes);
    return error_of([&] { (void)open_folder(folder.path() / "a.mkv"); });
  };
  EXPECT_TRUE(contains(message_of(recording("{")), "calibration.json: is not JSON"));
  EXPECT_TRUE(contains(message_of(recording("{}")), "'CalibrationInformation' is missing"));
  EXPECT_TRUE(contains(message_of(recording(kCalibration, "MJPG")), "of the kind 'MJPG'"));
  EXPECT_TRUE(contains(message_of(recording(kCalibration, "b16g", 333)),
                       "no mode of the device has images of 333 x 288"));
  EXPECT_TRUE(
      contains(message_of(matroska_file(track(1, "VIDEO", "MJPG", 8, 8), "", "")), "no track DEPTH"));
  EXPECT_TRUE(contains(message_of(element(0x1A45DFA3, "")), "contains no segment"));
}

TEST(AzureRecording, ReadsAFileThatWasCutShortUpToItsLastWholeBlock) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.mkv";
  const std::string whole = recording();
  const std::size_t second = whole.rfind(std::string("\x1F\x43\xB6\x75", 4));
  write_text(path, whole.substr(0, second + 90'000));  // within the second depth image
  EXPECT_EQ(read_all(*open_folder(path)).frames.size(), 1U);
  for (std::size_t size = 0; size < 3000; size += 7) {  // within the tracks and the calibration
    write_text(path, whole.substr(0, size));
    EXPECT_GT(error_of([&] { (void)open_folder(path); }).size(), 10U) << size;
  }
}

TEST(AzureRecording, RealRecordingHasADepthImageOfItsRoom) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "azure");
  const auto all = read_all(*open_folder(folder / "recording.mkv"));
  ASSERT_EQ(all.frames.size(), 1U);
  const Frame& frame = all.frames[0];
  EXPECT_EQ(frame.depth_m.width, 640);
  EXPECT_EQ(frame.depth_m.height, 576);
  EXPECT_EQ(frame.colour.width, 1280);
  EXPECT_NEAR(frame.stamp_s, 0.463945, 1e-6);
  EXPECT_NEAR(frame.T_colour_depth.translation().x(), -0.0321, 1e-4);
  std::size_t measured = 0;
  for (const float depth : frame.depth_m.pixels) measured += depth > 0.25F && depth < 6.0F;
  EXPECT_GT(measured, frame.depth_m.pixels.size() / 3);
  EXPECT_FALSE(frame.down_camera) << "its one acceleration is 0.46 s away";
}

}  // namespace
}  // namespace roomradar::azure_recording_test
