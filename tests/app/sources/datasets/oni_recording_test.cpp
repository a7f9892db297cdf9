// oni_recording_test.cpp: .oni files, written by their format.
#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/containers/oni_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::oni_recording_test {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

std::string oni_text(const std::string& text) {
  return bytes_of(static_cast<std::uint32_t>(text.size() + 1)) + text + '\0';
}

std::string record(std::uint32_t type, std::uint32_t node, const std::string& fields,
                   const std::string& payload = "") {
  return bytes_of(std::uint32_t{0x0052494E}) + bytes_of(type) + bytes_of(node) +
         bytes_of(static_cast<std::uint32_t>(28 + fields.size())) +
         bytes_of(static_cast<std::uint32_t>(payload.size())) + bytes_of(std::uint64_t{0}) + fields + payload;
}

std::string node(std::uint32_t id, std::uint32_t kind, const std::string& codec, std::uint32_t width,
                 std::uint32_t height) {
  const std::string mode = bytes_of(width) + bytes_of(height) + bytes_of(std::uint32_t{30});
  return record(13, id,
                oni_text("a node") + bytes_of(kind) + codec + bytes_of(std::uint32_t{0}) +
                    std::string(24, '\0')) +
         record(6, id, oni_text("xnMapOutputMode") + bytes_of(std::uint32_t{12}) + mode);
}

std::string integer(std::uint32_t id, const std::string& name, std::uint64_t value) {
  return record(3, id, oni_text(name) + bytes_of(std::uint32_t{8}) + bytes_of(value));
}

std::string frame(std::uint32_t id, std::uint64_t stamp_us, const std::string& data) {
  return record(10, id, bytes_of(stamp_us) + bytes_of(std::uint32_t{1}), data);
}

/// Compresses values as OpenNI does, with every kind of code: differences of 4, 8 and 16 bits, and
/// repetitions.
std::string compressed(const std::vector<std::uint16_t>& values) {
  std::string bytes = bytes_of(values.front());
  int open = -1;  // upper 4 bits of a byte that waits for its lower ones
  const auto close = [&] {
    if (open >= 0) bytes += static_cast<char>(open << 4 | 0x0D);
    open = -1;
  };
  for (std::size_t i = 1; i < values.size(); ++i) {
    const int difference = values[i - 1] - values[i];
    if (difference == 0 && i + 1 < values.size() && values[i + 1] == values[i] && open < 0) {
      std::size_t twice = 1;
      while (twice < 14 && i + 2 * twice + 1 < values.size() && values[i + 2 * twice] == values[i] &&
             values[i + 2 * twice + 1] == values[i])
        ++twice;
      bytes += static_cast<char>(0xE0 + twice);
      i += 2 * twice - 1;
    } else if (difference >= -6 && difference <= 6) {
      if (open < 0) {
        open = difference + 6;
      } else {
        bytes += static_cast<char>(open << 4 | (difference + 6));
        open = -1;
      }
    } else {
      bytes += static_cast<char>(open < 0 ? 0xFF : open << 4 | 0x0F);
      open = -1;
      if (difference >= -63 && difference <= 63)
        bytes += static_cast<char>(difference + 192);
      else
        bytes += std::string{static_cast<char>(values[i] >> 8), static_cast<char>(values[i] & 0xFF)};
    }
  }
  close();
  return bytes;
}

std::vector<std::uint16_t> some_depth(int i) {
  std::vector<std::uint16_t> depth_mm(80, 1000);
  for (int p = 0; p < 80; ++p)
    depth_mm[static_cast<std::size_t>(p)] = static_cast<std::uint16_t>(p < 10   ? 0
                                                                       : p < 20 ? 1000 + p
                                                                       : p < 30 ? 1000 + 40 * (p % 2)
                                                                       : p < 35 ? 3000 + 700 * p
                                                                                : 2000 + i);
  return depth_mm;
}

/// File of two frames of 10 x 8; `codec` of the depth.
std::string oni(const std::string& codec, bool is_mirrored = false) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(8, 16, CV_8UC3, cv::Scalar(9, 99, 199)), jpeg);
  std::string file = "NI10" + std::string("\1\0\1\0\0\0\0\0", 8) + std::string(12, '\0');
  file += node(1, 2, codec, 10, 8) + node(2, 3, "JPEG", 16, 8);
  if (is_mirrored) file += integer(1, "xnMirror", 1) + integer(2, "xnMirror", 1);
  for (int i = 0; i < 2; ++i) {
    const std::vector<std::uint16_t> depth_mm = some_depth(i);
    std::string data;
    if (codec == "NONE") {
      data.assign(reinterpret_cast<const char*>(depth_mm.data()), 160);
    } else if (codec == "16zP") {
      data = compressed(depth_mm);
    } else {  // the table holds the values that occur; pixels are its indices
      std::vector<std::uint16_t> table = depth_mm;
      std::sort(table.begin(), table.end());
      table.erase(std::unique(table.begin(), table.end()), table.end());
      std::vector<std::uint16_t> indices;
      for (const std::uint16_t mm : depth_mm)
        indices.push_back(
            static_cast<std::uint16_t>(std::lower_bound(table.begin(), table.end(), mm) - table.begin()));
      data = bytes_of(static_cast<std::uint16_t>(table.size())) +
             std::string(reinterpret_cast<const char*>(table.data()), 2 * table.size()) + compressed(indices);
    }
    const std::uint64_t stamp_us = 1'000'000U + 33'000U * static_cast<unsigned>(i);
    file += frame(1, stamp_us, data) + frame(2, stamp_us + 4000, {jpeg.begin(), jpeg.end()});
  }
  return file + record(11, 0, "");
}

TEST(Oni, GivesDepthOfAllCodecsAndColour) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.oni";
  for (const char* codec : {"NONE", "16zP", "16zT"}) {
    write_text(path, oni(codec));
    const auto all = read_all(*open_folder(path));
    ASSERT_EQ(all.frames.size(), 2U) << codec << (all.faults.empty() ? "" : all.faults[0]);
    for (int i = 0; i < 2; ++i) {
      const std::vector<std::uint16_t> depth_mm = some_depth(i);
      for (std::size_t p = 0; p < depth_mm.size(); ++p)
        ASSERT_EQ(all.frames[static_cast<std::size_t>(i)].depth_m.pixels[p],
                  static_cast<float>(depth_mm[p]) / 1000.0F)
            << codec << " " << p;
    }
    EXPECT_NEAR(all.frames[1].stamp_s, 1.033, 1e-9);
    EXPECT_NEAR(all.frames[1].colour_after_depth_s, 0.004, 1e-9);
    EXPECT_NEAR(all.frames[1].colour.at(5, 5).r, 199, 3);
    EXPECT_NEAR(all.frames[1].depth_camera.fx_px, 570.3 / 64, 0.01);  // a PrimeSense's at this width
  }
}

TEST(Oni, MirrorsMirroredImagesBack) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.oni";
  write_text(path, oni("16zT", /*is_mirrored=*/true));
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 2U);
  EXPECT_EQ(all.frames[0].depth_m.at(9, 1), 1.010F);
  EXPECT_EQ(all.frames[0].depth_m.at(0, 1), 1.019F);
}

TEST(Oni, ReadsWhatIsLeftAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.oni";
  const auto message_of = [&](const std::string& bytes) {
    write_text(path, bytes);
    return error_of([&] { (void)open_folder(path); });
  };
  const std::string whole = oni("16zT");
  write_text(path, whole.substr(0, whole.size() - 40));
  EXPECT_EQ(read_all(*open_folder(path)).frames.size(), 2U);
  for (std::size_t size = 4; size < 400; size += 7)
    EXPECT_GT(message_of(whole.substr(0, size)).size(), 10U) << size;
  EXPECT_TRUE(contains(message_of(oni("ABCD")), "compressed by 'ABCD'"));
  EXPECT_TRUE(contains(message_of("NI10" + std::string(30, '\7')), "unsupported version"));
  // Data of a frame that are damaged are a fault of that frame.
  std::string damaged = whole;
  damaged[damaged.find("\xE5", damaged.size() / 2)] = '\0';
  write_text(path, damaged);
  const auto all = read_all(*open_folder(path));
  EXPECT_EQ(all.frames.size() + all.faults.size(), 2U);
  EXPECT_TRUE(contains(error_of([] { (void)decompress_oni_depth("\5\0", true, 4, "depth"); }), "cut short"));
  EXPECT_TRUE(
      contains(error_of([] { (void)decompress_oni_depth(std::string("\1\0\xE7", 3), false, 4, "depth"); }),
               "too many"));
}

}  // namespace
}  // namespace roomradar::oni_recording_test
