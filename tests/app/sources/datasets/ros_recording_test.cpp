// ros_recording_test.cpp: bags of ROS 1: our own, those of a RealSense, those of TUM's form.
#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "tests/app/sources/containers/written_bag.hpp"
#include "tests/app/sources/containers/written_rvl.hpp"

namespace roomradar::ros_recording_test {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::contains;
using test::error_of;
using test::read_all;
using test::ros_camera_info;
using test::ros_image;
using test::ros_imu;
using test::ros_tf;
using test::RosBytes;
using test::some_frame;
using test::TemporaryFolder;
using test::write_text;
using test::written_rvl;
using test::WrittenBag;

constexpr int kFrames = 6;

fs::path write_own_bag(const fs::path& folder) {
  RecordingWriter writer(folder, RecordingFormat::kRosBag);
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = some_frame(i);
    if (i == 3) frame.T_world_camera.reset();
    if (i == 4) frame.colour.resize(0, 0);
    writer.write(frame);
  }
  writer.close();
  return folder / "recording.bag";
}

/// Expects the frames of write_own_bag(), bit for bit in depth, colour and poses.
void expect_own_frames(const fs::path& path) {
  const auto source = open_folder(path);
  EXPECT_EQ(source->frame_count(), kFrames);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames))
      << (all.faults.empty() ? "" : all.faults[0]);
  for (int i = 0; i < kFrames; ++i) {
    const Frame& got = all.frames[static_cast<std::size_t>(i)];
    const Frame want = some_frame(i);
    EXPECT_EQ(got.depth_m.pixels, want.depth_m.pixels);
    EXPECT_EQ(got.depth_camera, want.depth_camera);
    EXPECT_EQ(got.colour_camera, want.colour_camera);
    EXPECT_TRUE(got.T_colour_depth.isApprox(want.T_colour_depth, 1e-12));
    EXPECT_NEAR(got.stamp_s, want.stamp_s, 1e-9);
    ASSERT_TRUE(got.down_camera);
    EXPECT_TRUE(got.down_camera->isApprox(*want.down_camera, 1e-9));
    ASSERT_EQ(got.T_world_camera.has_value(), i != 3);
    if (i != 3) {
      EXPECT_EQ(got.T_world_camera->matrix(), want.T_world_camera->matrix());
    }
    ASSERT_EQ(got.colour.empty(), i == 4);
    if (i == 4) continue;
    EXPECT_EQ(got.colour.pixels, want.colour.pixels);
    EXPECT_NEAR(got.colour_after_depth_s, want.colour_after_depth_s, 1e-8);
  }
}

TEST(RosBag, KeepsDepthColourAndPosesBitForBit) {
  const TemporaryFolder folder;
  expect_own_frames(write_own_bag(folder.path()));
  expect_own_frames(folder.path());  // with the cameras of camera.json
}

TEST(RosBag, BesideAFolderInTumFormIsNotTakenForIt) {
  const TemporaryFolder folder;
  write_own_bag(folder.path() / "bag");
  RecordingWriter writer(folder.path() / "tum", RecordingFormat::kTum);
  for (int i = 0; i < 2; ++i) writer.write(some_frame(i));
  writer.close();
  fs::copy(folder.path() / "bag/recording.bag", folder.path() / "tum/recording.bag");
  EXPECT_EQ(open_folder(folder.path() / "tum")->frame_count(), 2);
}

TEST(RosBag, ReadsCompressedChunks) {
  const TemporaryFolder folder;
  const std::string bag = read_bytes(write_own_bag(folder.path()), "a bag");
  for (const char* compression : {"bz2", "lz4"}) {
    write_text(folder.path() / "packed.bag", test::with_compressed_chunks(bag, compression));
    expect_own_frames(folder.path() / "packed.bag");
  }
}

TEST(RosBag, SeeksWithoutReadingBetween) {
  const TemporaryFolder folder;
  const auto source = open_folder(write_own_bag(folder.path()));
  Frame frame;
  ASSERT_TRUE(source->seek(5));
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.depth_m.pixels, some_frame(5).depth_m.pixels);
  EXPECT_FALSE(source->seek(6));
}

/// A RealSense's own file: units of 0.1 mm, colour of another size, extrinsics as topics, an accelerometer.
TEST(RosBag, ReadsARealSensesOwnFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "realsense.bag";
  WrittenBag bag(path);
  const std::string depth = "/device_0/sensor_0/Depth_0", colour = "/device_0/sensor_1/Color_0",
                    accel = "/device_0/sensor_2/Accel_0";
  Eigen::Isometry3d T_colour_depth = Eigen::Isometry3d::Identity();
  T_colour_depth.translation() << 0.0148, 0.0002, 0.0003;
  Eigen::Isometry3d T_accel_depth = Eigen::Isometry3d::Identity();
  T_accel_depth.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto extrinsics = [&](const std::string& stream, const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    bag.write(stream + "/tf/0", "geometry_msgs/Transform", 0.001,
              RosBytes{}.doubles({T.translation().x(), T.translation().y(), T.translation().z(), q.x(), q.y(),
                                  q.z(), q.w()}));
  };
  extrinsics(depth, Eigen::Isometry3d::Identity());
  extrinsics(colour, T_colour_depth);
  extrinsics(accel, T_accel_depth);
  bag.write("/device_0/sensor_0/option/Depth Units/value", "std_msgs/Float32", 0.001,
            RosBytes{}.add(0.0001F));
  bag.write(depth + "/info/camera_info", "sensor_msgs/CameraInfo", 0.001, ros_camera_info(0, 4, 3, 5));
  bag.write(colour + "/info/camera_info", "sensor_msgs/CameraInfo", 0.001, ros_camera_info(0, 6, 2, 7));
  for (int i = 0; i < 3; ++i) {
    const double received_s = 0.1 + i / 30.0, stamp_s = 1.6e9 + received_s;
    std::string units;
    for (int p = 0; p < 12; ++p) units += std::string{static_cast<char>(p), static_cast<char>(40 + i)};
    bag.write(accel + "/imu/data", "sensor_msgs/Imu", received_s, ros_imu(stamp_s, "0", {9.8, 0, 0}));
    bag.write(depth + "/image/data", "sensor_msgs/Image", received_s,
              ros_image(stamp_s, "0", 4, 3, "mono16", 2, units));
    bag.write("/device_0/sensor_0/Infrared_1/image/data", "sensor_msgs/Image", received_s,
              ros_image(stamp_s, "0", 4, 3, "mono8", 1, std::string(12, 'i')));
    bag.write(colour + "/image/data", "sensor_msgs/Image", received_s + 0.004,
              ros_image(stamp_s + 0.004, "0", 6, 2, "rgb8", 3, std::string(36, static_cast<char>(i))));
  }
  bag.close();
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 3U);
  const Frame& frame = all.frames[1];
  EXPECT_EQ(frame.depth_m.at(2, 1), static_cast<float>(41 * 256 + 6) / 10000.0F);
  EXPECT_EQ(frame.depth_camera, (Intrinsics{4, 3, 5, 5, 2, 1.5}));
  EXPECT_EQ(frame.colour_camera, (Intrinsics{6, 2, 7, 7, 3, 1}));
  EXPECT_EQ(frame.colour.at(0, 0), (Rgb{1, 1, 1}));
  EXPECT_NEAR(frame.colour_after_depth_s, 0.004, 1e-6);
  EXPECT_TRUE(frame.T_colour_depth.isApprox(T_colour_depth, 1e-9));
  ASSERT_TRUE(
      frame.down_camera);  // the support force points to the accelerometer's +x, which is the camera's -y
  EXPECT_TRUE(frame.down_camera->isApprox(Eigen::Vector3d(0, 1, 0), 1e-9)) << frame.down_camera->transpose();
  EXPECT_FALSE(frame.T_world_camera);
}

/// TUM's form: a motion capture moves /kinect in /world, the cameras are fixed to it.
TEST(RosBag, InterpolatesPosesOfTheDepthCameraInTf) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "tum.bag";
  WrittenBag bag(path);
  Eigen::Isometry3d T_kinect_depth = Eigen::Isometry3d::Identity();
  T_kinect_depth.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T_kinect_depth.translation() << 0, 0.02, 0;
  const auto T_world_kinect = [](double s) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() << s, 2, 3;
    T.linear() = Eigen::AngleAxisd(0.1 * s, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return T;
  };
  for (int i = 0; i < 100; ++i) {
    const double s = 100.0 + 0.01 * i;
    bag.write("/tf", "tf/tfMessage", s + 0.002, ros_tf(s, "/world", "/kinect", T_world_kinect(s)));
    if (i % 5 == 0)
      bag.write("/tf", "tf/tfMessage", s + 0.002, ros_tf(s, "/kinect", "/openni_depth", T_kinect_depth));
  }
  const std::string metres(48, '\x3f');  // floats of 0.747 m
  for (const double s : {100.205, 100.5, 105.0}) {
    bag.write("/camera/depth/camera_info", "sensor_msgs/CameraInfo", s, ros_camera_info(s, 4, 3, 5));
    bag.write("/camera/depth/image", "sensor_msgs/Image", s + 0.03,
              ros_image(s, "/openni_depth", 4, 3, "32FC1", 4, metres));
  }
  bag.close();
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 3U);
  for (int i = 0; i < 2; ++i) {
    const Frame& frame = all.frames[static_cast<std::size_t>(i)];
    EXPECT_NEAR(frame.stamp_s, i == 0 ? 100.205 : 100.5, 1e-6) << "of the header, not of the reception";
    ASSERT_TRUE(frame.T_world_camera);
    EXPECT_TRUE(frame.T_world_camera->isApprox(T_world_kinect(frame.stamp_s) * T_kinect_depth, 1e-6));
    EXPECT_NEAR(frame.depth_m.at(0, 0), 0.747, 0.001);
  }
  EXPECT_FALSE(all.frames[2].T_world_camera) << "the motion capture had ended";
}

TEST(RosBag, ReadsCompressedImages) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "packed.bag";
  WrittenBag bag(path);
  cv::Mat depth_mm(3, 4, CV_16UC1, cv::Scalar(1234));
  std::vector<std::uint8_t> png, jpeg;
  cv::imencode(".png", depth_mm, png);
  cv::imencode(".jpg", cv::Mat(16, 16, CV_8UC3, cv::Scalar(0, 0, 200)), jpeg);
  RosBytes depth;
  depth.header(1, "c")
      .text("16UC1; compressedDepth png")
      .text(std::string(12, '\0') + std::string(png.begin(), png.end()));
  RosBytes colour;
  colour.header(1, "c").text("rgb8; jpeg compressed bgr8").text(std::string(jpeg.begin(), jpeg.end()));
  bag.write("/camera/depth/image_raw/compressedDepth", "sensor_msgs/CompressedImage", 1, depth);
  bag.write("/camera/depth/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 5));
  bag.write("/camera/color/image_raw/compressed", "sensor_msgs/CompressedImage", 1, colour);
  bag.write("/camera/color/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 16, 16, 20));
  bag.close();
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 1U);
  EXPECT_EQ(all.frames[0].depth_m.at(3, 2), 1.234F);
  EXPECT_NEAR(all.frames[0].colour.at(8, 8).r, 200, 3);
}

TEST(RosBag, ReadsRvl) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "rvl.bag";
  WrittenBag bag(path);
  Image<std::uint16_t> units(4, 3, 1234);
  units.at(0, 0) = 0;
  const auto write = [&](double stamp_s, const std::string& format, float a, float b,
                         const std::string& rvl) {
    RosBytes depth;
    depth.header(stamp_s, "c").text(format).text(bytes_of(0) + bytes_of(a) + bytes_of(b) + rvl);
    bag.write("/camera/depth/image_raw/compressedDepth", "sensor_msgs/CompressedImage", stamp_s, depth);
  };
  write(1, "16UC1; compressedDepth rvl", 0, 0, written_rvl(units));
  write(2, "32FC1; compressedDepth rvl", 4000, -366, written_rvl(units));  // 4000 / (1234 + 366) = 2.5 m
  write(3, "16UC1; compressedDepth rvl", 0, 0, written_rvl(units).substr(0, 10));
  write(4, "16UC1; compressedDepth rvl", 0, 0, written_rvl(Image<std::uint16_t>(400, 300)));
  bag.write("/camera/depth/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 5));
  bag.close();
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 2U);
  EXPECT_EQ(all.frames[0].depth_m.at(3, 2), 1.234F);
  EXPECT_EQ(all.frames[0].depth_m.at(0, 0), 0.0F);
  EXPECT_EQ(all.frames[1].depth_m.at(3, 2), 2.5F);
  ASSERT_EQ(all.faults.size(), 2U);
  EXPECT_TRUE(contains(all.faults[0], "is cut short")) << all.faults[0];
  EXPECT_TRUE(contains(all.faults[1], "is 400 x 300; the recording's other depth images are 4 x 3"))
      << all.faults[1];
}

TEST(RosBag, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  const auto message_of = [&] { return error_of([&] { (void)open_folder(path); }); };
  {
    WrittenBag bag(path);
    bag.write("/scan", "sensor_msgs/LaserScan", 1, {});
    bag.close();
  }
  EXPECT_TRUE(contains(message_of(), "no depth images")) << message_of();
  EXPECT_TRUE(contains(message_of(), "/scan"));
  write_text(path, "#ROSBAG V1.2\n");
  EXPECT_TRUE(contains(message_of(), "a version other than 2.0"));
}

TEST(RosBag, WithoutCameraInfoCamerasAreAssumedAndNamed) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  WrittenBag bag(path);
  const std::string millimetre(std::size_t{2} * 8 * 6, '\x04');  // 0x0404
  bag.write("/depth", "sensor_msgs/Image", 1, ros_image(1, "", 8, 6, "16UC1", 2, millimetre));
  bag.close();
  test::ReadAll all;
  const std::string said =
      test::decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
  ASSERT_EQ(all.frames.size(), 1U) << said;
  EXPECT_NEAR(all.frames[0].depth_m.at(0, 0), 1.028, 1e-4);
  EXPECT_GT(all.frames[0].depth_camera.fx_px, 0.0);
  EXPECT_TRUE(contains(said, "--camera")) << said;
}

TEST(RosBag, ReadsDepthInTheEncodingsOfOtherDrivers) {
  const auto depth_of = [](const char* encoding, int pixel_bytes, const auto& first, const auto& second) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "a.bag";
    std::string pixels;
    for (int i = 0; i < 6; ++i)
      for (const auto& value : {first, second})
        pixels.append(reinterpret_cast<const char*>(&value), static_cast<std::size_t>(pixel_bytes));
    WrittenBag bag(path);
    bag.write("/depth", "sensor_msgs/Image", 1, ros_image(1, "", 4, 3, encoding, pixel_bytes, pixels));
    bag.close();
    const test::ReadAll all = read_all(*open_folder(path));
    EXPECT_EQ(all.frames.size(), 1U) << encoding;
    return all.frames.empty() ? std::pair(0.0F, 0.0F)
                              : std::pair(all.frames[0].depth_m.at(0, 0), all.frames[0].depth_m.at(1, 0));
  };
  EXPECT_EQ(depth_of("16SC1", 2, std::int16_t{1500}, std::int16_t{-1}), std::pair(1.5F, 0.0F));
  EXPECT_EQ(depth_of("Z16", 2, std::uint16_t{1500}, std::uint16_t{40000}), std::pair(1.5F, 40.0F));
  EXPECT_EQ(depth_of("64FC1", 8, 1.5, std::numeric_limits<double>::quiet_NaN()), std::pair(1.5F, 0.0F));
}

TEST(RosBag, TheTopicOfDepthCanBeChosen) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  {
    WrittenBag bag(path);
    for (const char camera : {'1', '2'}) {
      const std::string name = std::string("/camera") + camera + "/depth";
      bag.write(name + "/camera_info", "sensor_msgs/CameraInfo", 1,
                ros_camera_info(1, 4, 3, camera == '1' ? 5 : 6));
      bag.write(name + "/image", "sensor_msgs/Image", 1,
                ros_image(1, "d", 4, 3, "16UC1", 2, std::string(24, camera == '1' ? '\4' : '\5')));
    }
    bag.close();
  }
  SourceOptions options;
  for (const auto& [topic, depth_m, f_px] : {std::tuple("", 1.028F, 5.0),
                                             {"/camera1/depth/image", 1.028F, 5.0},
                                             {"/camera2/depth/image", 1.285F, 6.0}}) {
    options.depth_topic = topic;
    const test::ReadAll all = read_all(*open_folder(path, options));
    ASSERT_EQ(all.frames.size(), 1U) << topic;
    EXPECT_NEAR(all.frames[0].depth_m.at(0, 0), depth_m, 1e-4);
    EXPECT_EQ(all.frames[0].depth_camera.fx_px, f_px);
  }
  options.depth_topic = "/camera3/depth/image";
  const std::string said = error_of([&] { (void)open_folder(path, options); });
  EXPECT_TRUE(contains(said, "--depth-topic must be one of /camera1/depth/image, /camera2/depth/image"))
      << said;
  const fs::path images = folder.path() / "images";
  fs::create_directories(images / "depth");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(images, options); }),
                       "has no topics; leave out --depth-topic"));
}

TEST(RosBag, ReadsABagThatWasCutShortUpToItsLastWholeChunk) {
  const TemporaryFolder folder, second;
  const std::string whole = read_bytes(write_own_bag(folder.path()), "a bag");
  const fs::path path = second.path() / "cut.bag";
  write_text(path, whole.substr(0, whole.size() - 3));
  expect_own_frames(path);  // the connections are in the chunk, too
  for (std::size_t size = 0; size < std::min<std::size_t>(whole.size(), 9000); size += 61) {
    write_text(path, whole.substr(0, size));
    EXPECT_GT(error_of([&] { (void)open_folder(path); }).size(), 10U) << size;
  }
}

// ---- header stamps, and topics that differ ----

constexpr int kStamped = 30;
constexpr double kReceived_s = 1'700'000'000.25;

/// Writes depth (1 m + i cm) and colour (red i), received at 20 Hz, colour 5 ms after depth. The functions return the
/// header's stamps of image i by its time of reception.
void write_stamped(const fs::path& path, const std::function<double(int, double)>& depth_stamp,
                   const std::function<double(int, double)>& colour_stamp) {
  WrittenBag bag(path);
  bag.write("/camera/depth/camera_info", "sensor_msgs/CameraInfo", kReceived_s, ros_camera_info(0, 4, 3, 5));
  bag.write("/camera/color/camera_info", "sensor_msgs/CameraInfo", kReceived_s, ros_camera_info(0, 4, 3, 5));
  for (int i = 0; i < kStamped; ++i) {
    const double at_s = kReceived_s + 0.05 * i;
    std::string units;
    for (int p = 0; p < 12; ++p) units += bytes_of(static_cast<std::uint16_t>(1000 + 10 * i));
    bag.write("/camera/depth/image_raw", "sensor_msgs/Image", at_s,
              ros_image(depth_stamp(i, at_s), "d", 4, 3, "16UC1", 2, units));
    bag.write("/camera/color/image_raw", "sensor_msgs/Image", at_s + 0.005,
              ros_image(colour_stamp(i, at_s + 0.005), "c", 4, 3, "rgb8", 3, std::string(36, static_cast<char>(i))));
  }
  bag.close();
}

/// Expects all frames, each with its colour, at 20 Hz in the order of reception; returns the decisions.
std::string expect_stamped(const std::function<double(int, double)>& depth_stamp,
                           const std::function<double(int, double)>& colour_stamp) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  write_stamped(path, depth_stamp, colour_stamp);
  test::ReadAll all;
  const std::string said =
      test::decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
  EXPECT_EQ(all.frames.size(), static_cast<std::size_t>(kStamped)) << said;
  for (std::size_t i = 0; i < std::min<std::size_t>(all.frames.size(), kStamped); ++i) {
    const Frame& frame = all.frames[i];
    EXPECT_NEAR(frame.depth_m.at(1, 1), 1.0 + 0.01 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(frame.stamp_s - all.frames[0].stamp_s, 0.05 * static_cast<double>(i), 0.011) << i << said;
    EXPECT_FALSE(frame.colour.empty()) << i << said;
    if (frame.colour.empty()) break;
    EXPECT_EQ(frame.colour.at(0, 0).r, i);
  }
  return said;
}

TEST(RosBag, HeadersWithoutAStampAreReplacedByTheTimeOfReception) {
  const auto right = [](int, double at_s) { return at_s - 0.02; };
  const auto none = [](int, double) { return 0.0; };
  const auto sometimes = [&](int i, double at_s) { return i % 3 == 1 ? 0.0 : right(i, at_s); };
  const auto first = [&](int i, double at_s) { return i == 0 ? 0.0 : right(i, at_s); };
  const std::string said = expect_stamped(right, right);
  EXPECT_FALSE(contains(said, "stamp") || contains(said, "clock")) << said;
  EXPECT_TRUE(contains(expect_stamped(none, none), "times of reception are used"));
  EXPECT_TRUE(contains(expect_stamped(right, none), "the colour images have no time stamps"));
  EXPECT_TRUE(contains(expect_stamped(none, right), "the depth images have no time stamps"));
  EXPECT_TRUE(contains(expect_stamped(sometimes, right), "10 depth images have no usable time stamp"));
  EXPECT_TRUE(contains(expect_stamped(right, sometimes), "10 colour images have no usable time stamp"));
  EXPECT_TRUE(contains(expect_stamped(first, right), "1 depth image has no usable time stamp"));
}

TEST(RosBag, AClockThatIsSetWhileRecordingIsBridged) {
  const auto set_by = [](double step_s) {
    return [step_s](int i, double at_s) { return at_s - 0.02 + (i >= 15 ? step_s : 0.0); };
  };
  for (const double step_s : {-3600.0, -1.0, 1.0, 3600.0}) {
    const std::string said = expect_stamped(set_by(step_s), set_by(step_s));
    EXPECT_TRUE(contains(said, step_s < 0 ? "was set back" : "was set forward")) << step_s << said;
  }
  const auto own_clock = [](int, double at_s) { return at_s - kReceived_s + 77.0; };  // since the camera was switched on
  const auto right = [](int, double at_s) { return at_s - 0.02; };
  EXPECT_TRUE(contains(expect_stamped(own_clock, right), "clocks of colour and depth differ"));
}

TEST(RosBag, DepthThatIsRegisteredToColourIsPreferred) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  const auto write = [&](std::initializer_list<const char*> depth_topics) {
    WrittenBag bag(path);
    bag.write("/camera/color/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 7));
    for (const char* topic : depth_topics)
      bag.write(fs::path(topic).parent_path() / "camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 5));
    for (int i = 0; i < 3; ++i) {
      for (const char* topic : depth_topics)
        bag.write(topic, "sensor_msgs/Image", 1 + i / 30.0, ros_image(1 + i / 30.0, "d", 4, 3, "16UC1", 2, std::string(24, '\4')));
      bag.write("/camera/color/image_raw", "sensor_msgs/Image", 1 + i / 30.0,
                ros_image(1 + i / 30.0, "c", 4, 3, "rgb8", 3, std::string(36, 'x')));
    }
    bag.close();
    test::ReadAll all;
    const std::string said =
        test::decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
    EXPECT_EQ(all.frames.size(), 3U);
    return said;
  };
  for (const char* registered :
       {"/camera/aligned_depth_to_color/image_raw", "/camera/depth_registered/image_raw", "/camera/depth/hw_registered/image_rect"}) {
    const std::string said = write({"/camera/depth/image_rect_raw", registered});
    EXPECT_TRUE(contains(said, std::string("of 2 topics with depth, ") + registered + " is used, which is registered")) << said;
    EXPECT_FALSE(contains(said, "place of the colour camera")) << said;
  }
  EXPECT_TRUE(contains(write({"/camera/depth/image_rect_raw"}), "the place of the colour camera beside the depth camera is not stated"));
}

TEST(RosBag, ImagesThatCannotBeReadArePassedOver) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.bag";
  WrittenBag bag(path);
  bag.write("/camera/depth/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 5));
  bag.write("/camera/color/camera_info", "sensor_msgs/CameraInfo", 1, ros_camera_info(1, 4, 3, 5));
  for (int i = 0; i < 100; ++i) {
    const double at_s = 1 + i / 30.0;
    const bool is_lost = (i >= 20 && i < 50) || i >= 70;
    bag.write("/camera/depth/image_raw", "sensor_msgs/Image", at_s,
              ros_image(at_s, "d", 4, 3, "16UC1", 2, std::string(is_lost ? 3 : 24, '\4')));
    bag.write("/camera/color/image_raw", "sensor_msgs/Image", at_s,
              ros_image(at_s, "c", 4, 3, "rgb8", 3, std::string(i % 2 == 0 ? 5 : 36, 'x')));
  }
  bag.close();
  test::ReadAll all;
  const std::string said =
      test::decisions_about([&](const SourceOptions& options) { return open_folder(path, options); }, &all);
  ASSERT_EQ(all.frames.size(), 40U) << said;
  EXPECT_EQ(all.faults.size(), 60U);
  EXPECT_EQ(all.frames[20].index, 50);
  EXPECT_TRUE(all.frames[0].colour.empty());
  EXPECT_FALSE(all.frames[1].colour.empty());
  EXPECT_TRUE(contains(said, "60 depth images cannot be read") && contains(said, "20 colour images cannot be read")) << said;
}

/// A bag of 5 GB whose pixels are holes of a sparse file. Says time and memory.
TEST(RosBag, OpensAndSeeksInFiveGigabytes) {
  if (!std::getenv("ROOMRADAR_LONG_TESTS")) GTEST_SKIP() << "takes some seconds; set ROOMRADAR_LONG_TESTS";
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "large.bag";
  constexpr int kImages = 4300, kWidth = 640, kHeight = 480, kPixels_bytes = kWidth * kHeight * 4;
  const auto u32 = [](std::uint32_t v) { return std::string(reinterpret_cast<const char*>(&v), 4); };
  const auto field = [&](const std::string& text) {
    return u32(static_cast<std::uint32_t>(text.size())) + text;
  };
  const auto time = [&](double s) {
    const std::uint64_t t = ros_time(s);
    return std::string(reinterpret_cast<const char*>(&t), 8);
  };
  {
    std::ofstream file(path, std::ios::binary);
    const auto put_head = [&](const std::string& header, std::uint32_t data) {
      file << u32(static_cast<std::uint32_t>(header.size())) << header << u32(data);
    };
    file << "#ROSBAG V2.0\n";
    const auto connection = [&](std::uint32_t number, const std::string& topic, const std::string& type) {
      const std::string data = field("type=" + type);
      put_head(field("op=\x07") + field("conn=" + u32(number)) + field("topic=" + topic),
               static_cast<std::uint32_t>(data.size()));
      file << data;
    };
    connection(0, "/camera/depth/image", "sensor_msgs/Image");
    connection(1, "/camera/depth/camera_info", "sensor_msgs/CameraInfo");
    const auto chunk = [&](std::uint32_t number, double s, const std::string& start, std::uint32_t hole) {
      const std::string head = field("op=\x02") + field("conn=" + u32(number)) + field("time=" + time(s));
      const auto data = static_cast<std::uint32_t>(start.size()) + hole;
      const std::uint32_t size = 8 + static_cast<std::uint32_t>(head.size()) + data;
      put_head(field("op=\x05") + field("compression=none") + field("size=" + u32(size)), size);
      put_head(head, data);
      file << start;
      file.seekp(hole, std::ios::cur);
      put_head(
          field("op=\x04") + field("ver=" + u32(1)) + field("conn=" + u32(number)) + field("count=" + u32(1)),
          12);
      file << time(s) << u32(0);
    };
    chunk(1, 1, ros_camera_info(1, kWidth, kHeight, 525).bytes, 0);
    for (int i = 0; i < kImages; ++i) {
      RosBytes start;
      start.header(1 + i / 30.0, "c").add(std::uint32_t{kHeight}).add(std::uint32_t{kWidth}).text("32FC1");
      start.add(std::uint8_t{0}).add(std::uint32_t{kWidth * 4}).add(std::uint32_t{kPixels_bytes});
      chunk(0, 1 + i / 30.0, start.bytes, kPixels_bytes);
    }
  }
  EXPECT_GT(fs::file_size(path), 5'000'000'000U);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto ms = [](auto from, auto to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  };
  const auto begin = now();
  const auto source = open_folder(path);
  const auto opened = now();
  ASSERT_EQ(source->frame_count(), kImages);
  Frame frame;
  double most_ms = 0.0;
  for (int i = 0; i < 100; ++i) {
    const auto from = now();
    ASSERT_TRUE(source->seek(i * 7919 % kImages));
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
    most_ms = std::max(most_ms, ms(from, now()));
    EXPECT_EQ(frame.index, i * 7919 % kImages);
  }
  const double resident_mb = static_cast<double>(resident_bytes()) * 1e-6;
  std::printf("5 GB: opened in %.0f ms, seek and read in at most %.1f ms, %.0f MB resident\n",
              ms(begin, opened), most_ms, resident_mb);
  EXPECT_LT(resident_mb, 200.0);
}

}  // namespace
}  // namespace roomradar::ros_recording_test
