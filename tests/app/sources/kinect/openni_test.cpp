// openni_test.cpp: OpenNI2's dummy device, live, and recorded by OpenNI2 itself.
#include <OpenNI.h>
#include <gtest/gtest.h>

#include "app/sources/kinect/openni_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::openni_test {
namespace {

using test::contains;
using test::error_of;

constexpr const char* kDummy = "Dummy";

/// Returns a source of the dummy device; null if the driver is not installed. It is never destroyed: the
/// driver's threads use their streams after they were destroyed.
FrameSource* dummy() {
  static FrameSource* const source = []() -> FrameSource* {
    try {
      return open_openni(kDummy).release();
    } catch (const Error&) {
      return nullptr;
    }
  }();
  return source;
}

TEST(Openni, SaysThatNoDeviceIsPluggedIn) {
  const std::string message = error_of([] { (void)open_openni("99"); });
  EXPECT_TRUE(contains(message, "openni:99: is not plugged in")) << message;
  EXPECT_TRUE(contains(error_of([] { (void)open_openni("nothing://"); }), "cannot be opened"));
}

TEST(Openni, DeliversFramesOfTheDummyDevice) {
  FrameSource* const source = dummy();
  if (!source) GTEST_SKIP() << "OpenNI2's dummy device is not installed";
  EXPECT_FALSE(source->frame_count());
  EXPECT_FALSE(source->rewind());
  Frame frame;
  double last_s = -1.0;
  for (int i = 0; i < 8; ++i) {
    const ReadResult result = source->next(frame);
    ASSERT_EQ(result.status, ReadStatus::kFrame) << result.fault;
    EXPECT_EQ(frame.depth_m.width, 320);
    EXPECT_EQ(frame.depth_m.at(0, 0), 2.0F);
    EXPECT_NEAR(frame.depth_camera.fx_px, 285.2, 0.1);
    EXPECT_GT(frame.stamp_s, last_s);
    last_s = frame.stamp_s;
    // The dummy device's streams have clocks of their own, so not every frame has a colour image.
    EXPECT_EQ(frame.colour_camera.width_px, 320);
  }
}

TEST(Openni, ReadsWhatItsRecorderWrites) {
  if (!dummy()) GTEST_SKIP() << "OpenNI2's dummy device is not installed";
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "dummy.oni").string();
  std::map<std::uint64_t, std::vector<std::uint16_t>> depth_mm;  // by stamp, us
  // Never destroyed, as above.
  static auto* const device = new openni::Device;
  static auto* const depth = new openni::VideoStream;
  static auto* const colour = new openni::VideoStream;
  ASSERT_EQ(device->open(kDummy), openni::STATUS_OK);
  depth->create(*device, openni::SENSOR_DEPTH);
  colour->create(*device, openni::SENSOR_COLOR);
  openni::Recorder recorder;
  ASSERT_EQ(recorder.create(path.c_str()), openni::STATUS_OK);
  recorder.attach(*depth);
  recorder.attach(*colour, /*allowLossyCompression=*/true);
  depth->start();
  colour->start();
  recorder.start();
  for (int i = 0; i < 6; ++i) {
    openni::VideoFrameRef image;
    ASSERT_EQ(depth->readFrame(&image), openni::STATUS_OK);
    const auto* pixels = static_cast<const std::uint16_t*>(image.getData());
    depth_mm[image.getTimestamp()].assign(pixels, pixels + image.getDataSize() / 2);
  }
  recorder.stop();
  recorder.destroy();
  const auto all = test::read_all(*open_folder(path));
  ASSERT_GE(all.frames.size(), 3U) << (all.faults.empty() ? "" : all.faults[0]);
  EXPECT_TRUE(all.faults.empty());
  const double first_s = all.frames.front().stamp_s;  // the recorder counts from its first image
  std::size_t compared = 0;
  for (const auto& [stamp_us, pixels] : depth_mm)
    for (const Frame& frame : all.frames) {
      const double recorded_us = 1e6 * (frame.stamp_s - first_s);
      if (std::abs(recorded_us - static_cast<double>(stamp_us - depth_mm.begin()->first)) > 1000.0) continue;
      ++compared;
      for (std::size_t p = 0; p < pixels.size(); ++p)
        ASSERT_EQ(frame.depth_m.pixels[p], static_cast<float>(pixels[p]) / 1000.0F) << p;
    }
  EXPECT_GE(compared, 3U);
  EXPECT_EQ(all.frames.front().colour.width, 320);
}

}  // namespace
}  // namespace roomradar::openni_test
