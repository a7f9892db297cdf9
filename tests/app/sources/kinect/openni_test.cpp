// openni_test.cpp: OpenNI2's dummy device, live, and recorded by OpenNI2 itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "app/sources/kinect/openni_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/file_io.hpp"
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
  const std::string images = (folder.path() / "depth").string();
  int status = 1;
  for (int attempt = 0; attempt < 5 && status != 0; ++attempt) {
    std::filesystem::remove(path);
    status = std::system(("timeout -s KILL 10 " ROOMRADAR_OPENNI_RECORDER " " + path + " " + images).c_str());
  }
  ASSERT_EQ(status, 0) << "OpenNI2's recorder failed five times";
  std::map<std::uint64_t, std::vector<std::uint16_t>> depth_mm;  // by stamp, us
  const std::string bytes = read_bytes(images, "depth images");
  ByteReader reader(bytes, images);
  while (reader.left() > 0) {
    std::vector<std::uint16_t>& pixels = depth_mm[reader.number<std::uint64_t>()];
    for (int p = 0; p < 320 * 240; ++p) pixels.push_back(reader.number<std::uint16_t>());
  }
  const auto all = test::read_all(*open_folder(path));
  ASSERT_GE(all.frames.size(), 3U) << (all.faults.empty() ? "" : all.faults[0]);
  EXPECT_TRUE(all.faults.empty());
  // The recorder may begin with any of the images read, and counts time from it.
  std::optional<double> recorder_began_us;
  std::size_t compared = 0;
  for (const Frame& frame : all.frames)
    for (const auto& [stamp_us, pixels] : depth_mm) {
      const bool is_equal = std::equal(
          pixels.begin(), pixels.end(), frame.depth_m.pixels.begin(), frame.depth_m.pixels.end(),
          [](std::uint16_t mm, float depth_m) { return depth_m == static_cast<float>(mm) / 1000.0F; });
      if (!is_equal) continue;
      ++compared;
      const double began_us = static_cast<double>(stamp_us) - 1e6 * frame.stamp_s;
      EXPECT_NEAR(began_us, recorder_began_us.value_or(began_us), 1000.0);
      recorder_began_us = began_us;
    }
  EXPECT_GE(compared, 3U);
  EXPECT_EQ(all.frames.front().colour.width, 320);
}

}  // namespace
}  // namespace roomradar::openni_test
