// tum_list_test.cpp: lists of images in the form of the TUM RGB-D benchmark, as other programs write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::tum_list_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::decisions_about;
using test::ReadAll;
using test::TemporaryFolder;
using test::write_text;

constexpr int kFrames = 40;
constexpr double kBegin_s = 1305031102.0;

/// How a list is written. `stamp` writes the stamp of image i, in s after kBegin_s.
struct ListForm {
  std::string separator = " ", end = "\n", begin = "# timestamp filename\n", name_prefix = "";
  std::string path_prefix = "";               ///< of images, before depth/ and rgb/
  bool is_windows = false, is_quoted = false;  ///< paths with backslashes; in quotes
  std::function<std::string(double stamp_s)> stamp = [](double s) { return std::to_string(kBegin_s + s); };
  std::function<void(std::vector<std::string>&)> order = [](std::vector<std::string>&) {};
};

/// Frame i has a depth of 1 m + i cm, red i, and the pose x = i m.
void write_tum(const fs::path& folder, const ListForm& form) {
  std::vector<std::string> depth, colour, poses;
  for (int i = 0; i < kFrames; ++i) {
    const std::string name = form.name_prefix + std::to_string(i) + ".png";
    fs::create_directories(folder / "depth");
    fs::create_directories(folder / "rgb");
    write_depth_file(DepthImage(8, 6, 1.0F + 0.01F * static_cast<float>(i)), DepthEncoding::kTum, folder / "depth" / name);
    write_colour_file(ColourImage(8, 6, {static_cast<std::uint8_t>(i), 0, 0}), folder / "rgb" / name);
    const auto listed = [&](const std::string& kind) {
      const std::string path = form.path_prefix + kind + (form.is_windows ? "\\" : "/") + name;
      return form.separator + (form.is_quoted ? "\"" + path + "\"" : path);
    };
    depth.push_back(form.stamp(i / 30.0) + listed("depth"));
    colour.push_back(form.stamp(i / 30.0 + 0.01) + listed("rgb"));
    poses.push_back(form.stamp(i / 30.0) + form.separator + std::to_string(i) + " 0 0 0 0 0 1");
  }
  const auto write = [&](const char* name, std::vector<std::string> lines) {
    form.order(lines);
    std::string text = form.begin;
    for (const std::string& line : lines) text += line + form.end;
    write_text(folder / name, text);
  };
  write("depth.txt", depth);
  write("rgb.txt", colour);
  write("groundtruth.txt", poses);
}

/// Expects all frames with their own colour and pose; returns the decisions.
std::string expect_all_frames(const ListForm& form) {
  const TemporaryFolder folder;
  write_tum(folder.path(), form);
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_TRUE(all.faults.empty());
  EXPECT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames)) << said;
  for (std::size_t i = 0; i < std::min<std::size_t>(all.frames.size(), kFrames); ++i) {
    const Frame& frame = all.frames[i];
    EXPECT_NEAR(frame.depth_m.at(0, 0), 1.0 + 0.01 * static_cast<double>(i), 1e-4);
    EXPECT_NEAR(frame.stamp_s - all.frames[0].stamp_s, static_cast<double>(i) / 30.0, 1e-4);
    EXPECT_TRUE(!frame.colour.empty() && frame.T_world_camera) << i << "\n" << said;
    if (frame.colour.empty() || !frame.T_world_camera) return said;
    EXPECT_EQ(frame.colour.at(0, 0).r, i);
    EXPECT_NEAR(frame.colour_after_depth_s, 0.01, 1e-4);
    EXPECT_NEAR(frame.T_world_camera->translation().x(), static_cast<double>(i), 1e-2);
  }
  return said;
}

TEST(TumList, ByteOrderMarkCarriageReturnsTabsAndBlanksAreRead) {
  const std::string plain = expect_all_frames({});
  for (const char* separator : {" ", "\t", "  \t "})
    for (const char* end : {"\n", "\r\n", " \r\n"})
      for (const char* begin : {"# timestamp filename\n", "\xef\xbb\xbf# timestamp filename\r\n", "\xef\xbb\xbf", "\n"}) {
        ListForm form;
        form.separator = separator;
        form.end = end;
        form.begin = begin;
        EXPECT_EQ(expect_all_frames(form), plain);
      }
}

TEST(TumList, NamesMayHaveBlanks) {
  ListForm form;
  form.name_prefix = "image of camera 2 ";
  EXPECT_FALSE(contains(expect_all_frames(form), "left out"));
  form.end = " \r\n";
  EXPECT_FALSE(contains(expect_all_frames(form), "left out"));
}

TEST(TumList, NanosecondsAndMillisecondsAreRecognised) {
  const auto scaled = [](double per_s, const char* format) {
    ListForm form;
    form.stamp = [=](double s) {
      char text[64];
      std::snprintf(text, sizeof text, format, (kBegin_s + s) * per_s);
      return std::string(text);
    };
    return form;
  };
  EXPECT_TRUE(contains(expect_all_frames(scaled(1e9, "%.0f")), "nanoseconds"));
  EXPECT_TRUE(contains(expect_all_frames(scaled(1e6, "%.0f")), "microseconds"));
  EXPECT_TRUE(contains(expect_all_frames(scaled(1e3, "%.3f")), "milliseconds"));
  EXPECT_FALSE(contains(expect_all_frames(scaled(1, "%.6f")), "stamps"));
}

TEST(TumList, LinesMayHaveAnyOrder) {
  ListForm form;
  form.order = [](std::vector<std::string>& lines) { std::shuffle(lines.begin(), lines.end(), std::mt19937(3)); };
  EXPECT_TRUE(contains(expect_all_frames(form), "not listed in the order of their stamps"));
  form.order = [](std::vector<std::string>& lines) { std::reverse(lines.begin(), lines.end()); };
  EXPECT_TRUE(contains(expect_all_frames(form), "not listed in the order of their stamps"));
}

TEST(TumList, CommasQuotesAndPathsOfOtherMachinesAreRead) {
  const auto with = [](const char* separator, const char* prefix, const char* begin) {
    ListForm form;
    form.separator = separator;
    form.path_prefix = prefix;
    form.begin = begin;
    return form;
  };
  for (const char* separator : {",", ", ", ";", "; "}) (void)expect_all_frames(with(separator, "", ""));
  EXPECT_FALSE(contains(expect_all_frames(with(",", "", "timestamp,filename\n")), "left out"));
  for (const char* prefix : {"/home/me/recordings/desk/", "C:/desk/", "../desk/"})
    EXPECT_TRUE(contains(expect_all_frames(with(" ", prefix, "")), "only their last two parts are used"));
  ListForm windows;
  windows.is_windows = true;
  (void)expect_all_frames(windows);
  ListForm quoted;
  quoted.is_quoted = true;
  (void)expect_all_frames(quoted);
}

TEST(TumList, RepeatedLinesAreUsedOnce) {
  ListForm form;
  form.order = [](std::vector<std::string>& lines) {
    const std::vector<std::string> once = lines;
    lines.insert(lines.end(), once.begin(), once.end());
  };
  EXPECT_TRUE(contains(expect_all_frames(form), "40 lines of depth.txt repeat others; each is used once"));
}

TEST(TumList, WithoutListsNamesAreStamps) {
  const TemporaryFolder folder;
  for (int i = 0; i < 10; ++i)
    for (const char* kind : {"depth", "rgb"}) {
      fs::create_directories(folder.path() / kind);
      const fs::path file = folder.path() / kind / (std::to_string(kBegin_s + 0.04 * i) + ".png");
      if (kind == std::string("depth"))
        write_depth_file(DepthImage(8, 6, 1.0F), DepthEncoding::kTum, file);
      else
        write_colour_file(ColourImage(8, 6, {1, 2, 3}), file);
    }
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), 10U) << said;
  EXPECT_NEAR(all.frames[9].stamp_s, kBegin_s + 0.36, 1e-5);
  EXPECT_NEAR(all.frames[9].depth_m.at(0, 0), 1.0, 1e-4);
  EXPECT_FALSE(all.frames[9].colour.empty());
  EXPECT_TRUE(contains(said, "depth.txt is missing; the names of the images are taken as their stamps")) << said;
}

TEST(TumList, PosesOfAnotherClockAreNamed) {
  const TemporaryFolder folder;
  write_tum(folder.path(), {});
  write_text(folder.path() / "groundtruth.txt", "0.0 1 0 0 0 0 0 1\n0.1 2 0 0 0 0 0 1\n1.3 3 0 0 0 0 0 1\n");
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_TRUE(contains(said, "only 0 of 40 frames have a recorded pose near in time")) << said;
  EXPECT_TRUE(contains(said, "is it another clock?")) << said;
  EXPECT_FALSE(contains(said, "gravity")) << said;
}

TEST(TumList, PosesInOtherFormsAreReadAndNamed) {
  struct Form {
    std::string words;
    std::function<std::string(const std::string& stamp, const std::string& x)> line;
  };
  const std::vector<Form> forms{
      {"9 numbers per line", [](auto& s, auto& x) { return s + " " + x + " 0 0 0 0 0 1 0.5"; }},
      {"13 numbers per line", [](auto& s, auto& x) { return s + " 1 0 0 " + x + " 0 1 0 0 0 0 1 0"; }},
      {"17 numbers per line",
       [](auto& s, auto& x) { return s + " 1 0 0 " + x + " 0 1 0 0 0 0 1 0 0 0 0 1"; }},
      {"7 numbers per line", [](auto&, auto& x) { return x + " 0 0 0 0 0 1"; }},
      {"12 numbers per line", [](auto&, auto& x) { return "1 0 0 " + x + " 0 1 0 0 0 0 1 0"; }},
      {"16 numbers per line", [](auto&, auto& x) { return "1 0 0 " + x + " 0 1 0 0 0 0 1 0 0 0 0 1"; }}};
  for (const Form& form : forms) {
    const TemporaryFolder folder;
    write_tum(folder.path(), {});
    std::string text;
    for (int i = 0; i < kFrames; ++i)
      text += form.line(std::to_string(kBegin_s + i / 30.0), std::to_string(i)) + "\n";
    write_text(folder.path() / "groundtruth.txt", text);
    ReadAll all;
    const std::string said = decisions_about(
        [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    EXPECT_TRUE(contains(said, form.words)) << said;
    ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames)) << said;
    for (int i = 0; i < kFrames; ++i) {
      const Frame& frame = all.frames[static_cast<std::size_t>(i)];
      ASSERT_TRUE(frame.T_world_camera) << form.words;
      EXPECT_NEAR(frame.T_world_camera->translation().x(), i, 1e-3) << form.words;
    }
  }
}

TEST(TumList, PosesWithoutStampsAreNotGuessedIfTheirNumberDiffers) {
  const TemporaryFolder folder;
  write_tum(folder.path(), {});
  write_text(folder.path() / "groundtruth.txt", "1 0 0 0 0 0 1\n2 0 0 0 0 0 1\n");
  ReadAll all;
  const std::string said = decisions_about(
      [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_TRUE(contains(said, "2 lines for 40 depth images; the poses are not used")) << said;
  EXPECT_FALSE(all.frames.front().T_world_camera);
}

TEST(TumList, BonnsDatasetHasItsOwnCamera) {
  const TemporaryFolder folder;
  const fs::path recording = folder.path() / "rgbd_bonn_balloon";
  write_tum(recording, {});
  EXPECT_TRUE(contains(
      decisions_about([&](const SourceOptions& options) { return open_folder(recording, options); }), "the Xtion of the BONN dataset"));
}

}  // namespace
}  // namespace roomradar::tum_list_test
