// numbered_recordings_test.cpp: Stray Scanner, Redwood, Open3D and ICL-NUIM: written recordings.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::numbered_recordings_test {
namespace {

namespace fs = std::filesystem;
using test::add_litter;
using test::contains;
using test::decisions_about;
using test::ReadAll;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

std::string padded(int i) { return std::string(5, '0') + std::to_string(i); }

// ---- folders of numbered images ----

struct Written {
  std::string depth_name, colour_name;
};

/// Frame i has a depth of 1 m + i cm and red i.
void write_numbered(const fs::path& folder, const std::function<Written(int)>& name) {
  for (const char* kind : {"depth", "color"}) fs::create_directories(folder / kind);
  for (int i = 0; i < 12; ++i) {
    write_depth_file(DepthImage(16, 12, 1.0F + 0.01F * static_cast<float>(i)), DepthEncoding::kMillimetres,
                     folder / "depth" / name(i).depth_name);
    write_colour_file(ColourImage(16, 12, {static_cast<std::uint8_t>(i), 0, 0}), folder / "color" / name(i).colour_name);
  }
}

/// Expects the twelve frames with their own colour; returns the decisions.
std::string expect_twelve(const fs::path& folder) {
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder, options); }, &all);
  EXPECT_EQ(all.frames.size(), 12U) << said;
  for (std::size_t i = 0; i < all.frames.size(); ++i) {
    EXPECT_NEAR(all.frames[i].depth_m.at(0, 0), 1.0 + 0.01 * static_cast<double>(i), 1e-4);
    EXPECT_TRUE(!all.frames[i].colour.empty() && all.frames[i].colour.at(0, 0).r == i) << i << "\n" << said;
  }
  return said;
}

TEST(NumberedImages, NamesMayBeOfManyForms) {
  const std::vector<std::function<Written(int)>> forms = {
      [](int i) { return Written{std::to_string(i) + ".PNG", std::to_string(i) + ".PNG"}; },
      [](int i) { return Written{"img (" + std::to_string(i) + ").png", "img (" + std::to_string(i) + ").png"}; },
      [](int i) { return Written{"img_" + padded(i) + "_depth16.png", "img_" + padded(i) + "_rgb8.png"}; },
      [](int i) {
        const std::string name = "2024-03-05_12-00-0" + std::to_string(i / 6) + "_" + std::to_string(100 + 100 * (i % 6)) + ".png";
        return Written{name, name};
      }};
  for (const auto& form : forms) {
    const TemporaryFolder folder;
    write_numbered(folder.path(), form);
    (void)expect_twelve(folder.path());
  }
}

TEST(NumberedImages, NamesMayBeTimes) {
  for (const double unit_per_s : {1e3, 1e6, 1e9}) {
    const TemporaryFolder folder;
    write_numbered(folder.path(), [=](int i) {
      const auto name = [=](double s) { return std::to_string(static_cast<std::int64_t>(s * unit_per_s)) + ".png"; };
      return Written{name(1.7e9 + i / 10.0), name(1.7e9 + i / 10.0 + 0.004)};
    });
    ReadAll all;
    (void)decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    ASSERT_EQ(all.frames.size(), 12U);
    EXPECT_NEAR(all.frames[11].stamp_s - all.frames[0].stamp_s, 1.1, 1e-3);
    (void)expect_twelve(folder.path());
  }
}

TEST(NumberedImages, ColourThatCannotBeReadCostsOnlyColour) {
  const TemporaryFolder folder;
  write_numbered(folder.path(), [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
  for (const auto& file : fs::directory_iterator(folder.path() / "color")) write_text(file.path(), "404 Not Found");
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_EQ(all.frames.size(), 12U);
  EXPECT_TRUE(contains(said, "no colour image can be read, so depth is used without colour")) << said;
}

TEST(NumberedImages, MissingDepthIsCounted) {
  const TemporaryFolder folder;
  write_numbered(folder.path(), [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
  for (const int i : {3, 4}) fs::remove(folder.path() / "depth" / (padded(i) + ".png"));
  ReadAll all;
  const std::string said = decisions_about(
      [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_EQ(all.frames.size(), 10U);
  EXPECT_TRUE(contains(said, "2 colour images have no depth image of the same number")) << said;
}

TEST(NumberedImages, FoldersInFoldersAreEntered) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "__MACOSX");
  write_numbered(folder.path() / "archive" / "scan", [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
  write_text(folder.path() / "archive" / "scan" / "camera-intrinsics.txt", "14 0 7.5\n0 14 5.5\n0 0 1\n");
  EXPECT_FALSE(contains(expect_twelve(folder.path()), "no camera is stated"));
  fs::copy(folder.path() / "archive", folder.path() / "second", fs::copy_options::recursive);
  fs::copy(folder.path() / "archive" / "scan", folder.path() / "third", fs::copy_options::recursive);
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "third is a recording; give one of them"));
}

TEST(NumberedImages, DepthOfAnotherFormIsNamed) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "depth");
  write_text(folder.path() / "depth" / "0.tiff", "II");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "depth must be 16 bit grey images"));
}

TEST(NumberedImages, FoldersMayHaveOtherNames) {
  for (const auto& [depth, colour] :
       {std::pair("Depth", "RGB"), {"depth_images", "rgb_images"}, {"depths", "colors"}}) {
    const TemporaryFolder folder;
    write_numbered(folder.path(), [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
    fs::rename(folder.path() / "depth", folder.path() / "moved");
    fs::rename(folder.path() / "moved", folder.path() / depth);
    fs::rename(folder.path() / "color", folder.path() / "moved");
    fs::rename(folder.path() / "moved", folder.path() / colour);
    (void)expect_twelve(folder.path());
  }
}

TEST(NumberedImages, AListOfPosesBesideThemIsRead) {
  const auto read = [](const std::string& first, int lines) {
    const TemporaryFolder folder;
    write_numbered(folder.path(), [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
    std::string text;
    for (int i = 0; i < lines; ++i)
      text += (first.empty() ? "" : std::to_string(i + std::stoi(first)) + " ") + "1 0 0 " +
              std::to_string(0.1 * i) + " 0 1 0 0 0 0 1 0 0 0 0 1\n";
    write_text(folder.path() / "traj.txt", text);
    ReadAll all;
    const std::string said = decisions_about(
        [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    EXPECT_EQ(all.frames.size(), 12U) << said;
    std::vector<double> x_m;
    for (const Frame& frame : all.frames)
      if (frame.T_world_camera) x_m.push_back(frame.T_world_camera->translation().x());
    return std::pair(said, x_m);
  };
  for (const char* first : {"", "0"}) {
    const auto [said, x_m] = read(first, 12);
    ASSERT_EQ(x_m.size(), 12U) << said;
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(x_m[i] - x_m[0], 0.1 * static_cast<double>(i), 1e-9);
  }
  const auto [said_of_eleven, of_eleven] = read("", 11);
  EXPECT_TRUE(of_eleven.empty() &&
              contains(said_of_eleven, "11 lines for 12 depth images; the poses are not used"))
      << said_of_eleven;
  const auto [said_of_late, of_late] = read("4", 12);  // numbers 4 to 15
  EXPECT_TRUE(of_late.size() == 8 && contains(said_of_late, "4 of 12 poses of traj.txt begin with no number"))
      << said_of_late;
}

// ---- Stray Scanner ----

constexpr int kVideoFrames = 30;

void write_stray(const fs::path& folder) {
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / "confidence");
  cv::VideoWriter video((folder / "rgb.mp4").string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 30,
                        {64, 48});
  std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw, fx\n";
  for (int i = 0; i < kVideoFrames; ++i) {
    DepthImage depth_m(16, 12, 1.0F + 0.001F * static_cast<float>(i));
    write_depth_file(depth_m, DepthEncoding::kMillimetres,
                     folder / "depth" / (padded(i).substr(padded(i).size() - 6) + ".png"));
    MaskImage confidence(16, 12, 2);
    confidence.at(3, 2) = 0;
    confidence.at(4, 2) = 1;
    write_mask_file(confidence, folder / "confidence" / (padded(i).substr(padded(i).size() - 6) + ".png"));
    video.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar(20, 100, 8 * i)));
    odometry += std::to_string(100.0 + i / 60.0) + ", " + std::to_string(i) + ", 1, 2, " + std::to_string(i) +
                ", 0, 0, 0, 1, ,\n";
  }
  write_text(folder / "odometry.csv", odometry);
  write_text(folder / "camera_matrix.csv", "50.0, 0.0, 31.5\n0.0, 52.0, 23.5\n0.0, 0.0, 1.0");
}

TEST(StrayScanner, GivesSureDepthColourOfTheVideoAndPoses) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  add_litter(folder.path());
  const auto source = open_folder(folder.path());
  EXPECT_EQ(source->frame_count(), kVideoFrames);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kVideoFrames));
  const Frame& frame = all.frames[7];
  EXPECT_NEAR(frame.stamp_s, 100.0 + 7 / 60.0, 1e-6);
  EXPECT_EQ(frame.depth_m.at(0, 0), 1.007F);
  EXPECT_EQ(frame.depth_m.at(3, 2), 0.0F) << "confidence 0";
  EXPECT_EQ(frame.depth_m.at(4, 2), 1.007F) << "confidence 1";
  EXPECT_EQ(frame.depth_camera, (Intrinsics{16, 12, 12.5, 13, 7.5, 5.5}));
  EXPECT_EQ(frame.colour_camera, (Intrinsics{64, 48, 50, 52, 31.5, 23.5}));
  EXPECT_NEAR(frame.colour.at(30, 20).r, 56, 6);
  // The recorded camera looks along +z of a world with y up: y of ours is -z of the recorded, z is its y.
  EXPECT_TRUE((*frame.T_world_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, -8, 2)));
  EXPECT_TRUE(frame.down_camera->isApprox(Eigen::Vector3d(0, -1, 0)));
}

TEST(StrayScanner, ABadConfidenceImageCostsNoDepth) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  write_text(folder.path() / "confidence" / "000007.png", "cut");
  write_mask_file(MaskImage(8, 6, 2), folder.path() / "confidence" / "000009.png");
  ReadAll all;
  const std::string said = decisions_about(
      [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kVideoFrames)) << said;
  EXPECT_EQ(all.frames[7].depth_m.at(3, 2), 1.007F);
  EXPECT_EQ(all.frames[8].depth_m.at(3, 2), 0.0F);
  EXPECT_TRUE(contains(said, "2 confidence images cannot be read; all depth of their frames is used"))
      << said;
}

TEST(StrayScanner, SeeksInTheVideo) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  const auto source = open_folder(folder.path());
  Frame frame;
  for (const int i : {25, 3, 4, 29, 0}) {
    ASSERT_TRUE(source->seek(i));
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
    EXPECT_NEAR(frame.colour.at(30, 20).r, 8 * i, 6) << i;
  }
}

TEST(StrayScanner, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  const auto with = [&](const char* file, const std::string& text) {
    const TemporaryFolder broken;
    fs::copy(folder.path(), broken.path(), fs::copy_options::recursive);
    write_text(broken.path() / file, text);
    return error_of([&] { (void)open_folder(broken.path()); });
  };
  EXPECT_TRUE(contains(with("camera_matrix.csv", "1, 2"), "must be a 3 x 3 matrix"));
  EXPECT_TRUE(contains(with("camera_matrix.csv", "-1,0,1\n0,1,1\n0,0,1"), "fx"));
}

TEST(StrayScanner, DepthIsReadWithoutPosesAndVideo) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  const auto whole = read_all(*open_folder(folder.path()));
  // Without text: without the file.
  const auto with = [&](const char* file, const std::string& text, ReadAll& all) {
    const TemporaryFolder broken;
    fs::copy(folder.path(), broken.path(), fs::copy_options::recursive);
    fs::remove(broken.path() / file);
    if (!text.empty()) write_text(broken.path() / file, text);
    return decisions_about([&](const SourceOptions& options) { return open_folder(broken.path(), options); },
                           &all);
  };
  ReadAll all;
  EXPECT_TRUE(contains(with("odometry.csv", "timestamp\n1, x, 3", all), "1 lines of odometry.csv"));
  ASSERT_EQ(all.frames.size(), whole.frames.size());
  EXPECT_FALSE(all.frames[0].T_world_camera);
  EXPECT_FALSE(all.frames[0].colour.empty());
  EXPECT_TRUE(contains(with("odometry.csv", "", all), "odometry.csv is missing"));
  ASSERT_EQ(all.frames.size(), whole.frames.size());
  EXPECT_FALSE(all.frames[0].T_world_camera);
  EXPECT_EQ(all.frames[0].depth_camera, whole.frames[0].depth_camera);
  EXPECT_TRUE(contains(with("camera_matrix.csv", "", all), "that of an iPhone is assumed"));
  EXPECT_TRUE(all.frames[0].T_world_camera->isApprox(*whole.frames[0].T_world_camera, 1e-12));
  EXPECT_TRUE(
      contains(with("depth/000007.png", "", all), "1 of 30 frames of odometry.csv have no depth image"));
  EXPECT_TRUE(contains(with("rgb.mp4", "nothing", all), "cannot be opened as a video"));
  ASSERT_EQ(all.frames.size(), whole.frames.size());
  EXPECT_TRUE(all.frames[0].colour.empty());
  EXPECT_EQ(all.frames[0].depth_m.pixels, whole.frames[0].depth_m.pixels);
  EXPECT_TRUE(all.frames[0].T_world_camera->isApprox(*whole.frames[0].T_world_camera, 1e-12));
}

// Stray Scanner, StrayScanner/Helpers/OdometryEncoder.swift, add(): the columns of three versions, the last without its
// values; frame numbers have leading zeros.
TEST(StrayScanner, ReadsTheColumnsOfAllVersions) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  const std::string heading = "timestamp, frame, x, y, z, qx, qy, qz, qw";
  const auto frames_with = [&](const std::string& columns, const std::string& values, const char* end) {
    std::string text = heading + columns + end;
    for (int i = 0; i < kVideoFrames; ++i) {
      const std::string number = padded(i);
      text += std::to_string(100.0 + i / 60.0) + ", " + number.substr(number.size() - 6) + ", 1, 2, " +
              std::to_string(i) + ", 0, 0, 0, 1" + values + end;
    }
    write_text(folder.path() / "odometry.csv", text);
    ReadAll all;
    const std::string said = decisions_about(
        [&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    EXPECT_FALSE(contains(said, "odometry.csv")) << said;
    return all.frames;
  };
  const std::vector<Frame> plain = frames_with("", "", "\n");
  ASSERT_EQ(plain.size(), static_cast<std::size_t>(kVideoFrames));
  EXPECT_NEAR(plain[9].stamp_s, 100.0 + 9 / 60.0, 1e-6);
  for (const auto& [columns, values] :
       {std::pair(", fx, fy, cx, cy", ", 50.0, 52.0, 31.5, 23.5"),
        std::pair(", fx, fy, cx, cy, distortion_center_x, distortion_center_y", ", 50.0, 52.0, 31.5, 23.5, , ")})
    for (const char* end : {"\n", "\r\n"}) {
      const std::vector<Frame> frames = frames_with(columns, values, end);
      ASSERT_EQ(frames.size(), plain.size());
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(frames[i].stamp_s, plain[i].stamp_s);
        EXPECT_TRUE(frames[i].T_world_camera->isApprox(*plain[i].T_world_camera, 1e-12));
      }
    }
}

TEST(StrayScanner, ImagesAfterTheLastWholeRowHaveNoPose) {
  const TemporaryFolder folder;
  write_stray(folder.path());
  std::string rows = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";
  for (int i = 0; i < 20; ++i)
    rows += std::to_string(100.0 + i / 60.0) + ", " + std::to_string(i) + ", 1, 2, 3, 0, 0, 0, 1\n";
  rows += "100.333333, 20, 1, 2, 3, 0, 0";  // the app was ended within it
  write_text(folder.path() / "odometry.csv", rows);
  fs::remove(folder.path() / "rgb.mp4");
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kVideoFrames));
  EXPECT_TRUE(all.frames[19].T_world_camera);
  EXPECT_FALSE(all.frames[20].T_world_camera);
  for (std::size_t i = 1; i < all.frames.size(); ++i) EXPECT_NEAR(all.frames[i].stamp_s, 100.0 + static_cast<double>(i) / 60.0, 1e-4);
  EXPECT_TRUE(contains(said, "1 lines of odometry.csv are cut short")) << said;
  EXPECT_TRUE(contains(said, "10 depth images have no line in odometry.csv")) << said;
  EXPECT_TRUE(contains(said, "rgb.mp4 is missing")) << said;
}

// ---- Redwood, Open3D, ICL-NUIM ----

void write_images(const fs::path& folder, const char* colour, DepthEncoding encoding) {
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / colour);
  for (int i = 0; i < 12; ++i) {  // 10 and 11 come after 9
    write_depth_file(DepthImage(64, 48, 1.0F + 0.01F * static_cast<float>(i)), encoding,
                     folder / "depth" / (std::to_string(i) + ".png"));
    write_colour_file(ColourImage(128, 96, {static_cast<std::uint8_t>(i), 0, 0}),
                      folder / colour / (std::to_string(i) + ".png"));
  }
}

TEST(Redwood, GivesThePosesOfItsLog) {
  const TemporaryFolder folder;
  write_images(folder.path(), "image", DepthEncoding::kMillimetres);
  std::string log;
  for (int i = 0; i < 11; ++i)
    log += std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i + 1) + "\n1 0 0 " +
           std::to_string(i) + "\n0 0 -1 5\n0 1 0 6\n0 0 0 1\n";
  write_text(folder.path() / "livingroom.log", log);
  add_litter(folder.path());
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 12U);
  const Frame& frame = all.frames[10];
  EXPECT_NEAR(frame.stamp_s, 10 / 30.0, 1e-9);
  EXPECT_NEAR(frame.depth_m.at(0, 0), 1.1, 1e-6);
  EXPECT_EQ(frame.colour.at(0, 0).r, 10);
  EXPECT_EQ(frame.depth_camera, (Intrinsics{64, 48, 52.5, 52.5, 31.5, 23.5}));
  EXPECT_EQ(frame.colour_camera, (Intrinsics{128, 96, 105, 105, 63.5, 47.5}));
  EXPECT_TRUE((*frame.T_world_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(10, 4, 6)));
  EXPECT_FALSE(all.frames[11].T_world_camera) << "the log has 11 poses";

  const auto said = [&](ReadAll& read) {
    return decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &read);
  };
  ReadAll read;
  write_text(folder.path() / "livingroom.log", log.substr(0, 60));
  EXPECT_TRUE(contains(said(read), "1 poses are read, up to a fault"));
  ASSERT_EQ(read.frames.size(), 12U);
  EXPECT_TRUE(read.frames[0].T_world_camera);
  EXPECT_FALSE(read.frames[1].T_world_camera);
  // A lost pose is no pose; the number in its heading says whose it is, also where images are missing.
  write_text(folder.path() / "livingroom.log", log.substr(0, log.find("3 3 4")) +
                                                   "3 3 4\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n" +
                                                   log.substr(log.find("4 4 5")));
  write_text(folder.path() / "capture.log", "2024-05-01 12:00:00 capture started\n");
  fs::remove(folder.path() / "depth" / "5.png");
  EXPECT_TRUE(contains(said(read), "1 recorded pose is lost"));
  ASSERT_EQ(read.frames.size(), 11U);
  EXPECT_FALSE(read.frames[3].T_world_camera);
  EXPECT_NEAR(read.frames[4].T_world_camera->translation().x(), 4.0, 1e-12);
  EXPECT_NEAR(read.frames[5].T_world_camera->translation().x(), 6.0, 1e-12);
}

TEST(Redwood, TakesTheIntrinsicsOfOpen3d) {
  const TemporaryFolder folder;
  write_images(folder.path(), "color", DepthEncoding::kMillimetres);
  write_text(folder.path() / "intrinsic.json",
             R"({"width":128,"height":96,"intrinsic_matrix":[110,0,0,0,112,0,63.5,47.5,1]})");
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 12U);
  EXPECT_EQ(all.frames[0].depth_camera, (Intrinsics{64, 48, 55, 56, 31.5, 23.5}));
  write_text(folder.path() / "intrinsic.json", R"({"width":128,"height":96,"intrinsic_matrix":[110]})");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path()); }), "must be 9 numbers"));
}

// Open3D, RGBDVideoReader::SaveFrames() and RGBDVideoMetadata::ConvertToJsonValue(), of a RealSense L515, whose unit is
// 0.25 mm.
TEST(Redwood, TakesUnitAndRateOfOpen3dsVideos) {
  const TemporaryFolder folder;
  for (int i = 0; i < 4; ++i) {
    const std::string number = "0000" + std::to_string(i);
    fs::create_directories(folder.path() / "depth");
    fs::create_directories(folder.path() / "color");
    cv::imwrite((folder.path() / "depth" / (number + ".png")).string(), cv::Mat(48, 64, CV_16UC1, cv::Scalar(6000 + i)));
    cv::imwrite((folder.path() / "color" / (number + ".jpg")).string(), cv::Mat(48, 64, CV_8UC3, cv::Scalar(9, 99, 199)));
  }
  const auto with = [&](const char* scale, const char* file = "intrinsic.json") {
    write_text(folder.path() / file, std::string(R"({"color_format":"RS2_FORMAT_RGB8","depth_format":"RS2_FORMAT_Z16",)") +
                                         R"("depth_scale":)" + scale + R"(,"device_name":"Intel RealSense L515","fps":15.0,)" +
                                         R"("height":48,"intrinsic_matrix":[60.0,0.0,0.0,0.0,61.0,0.0,31.5,23.5,1.0],)" +
                                         R"("serial_number":"f0","stream_length_usec":266666,"width":64})");
  };
  with("4000.0");
  auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 4U);
  EXPECT_EQ(all.frames[3].depth_m.at(0, 0), 6003.0F / 4000.0F);
  EXPECT_EQ(all.frames[3].depth_camera, (Intrinsics{64, 48, 60, 61, 31.5, 23.5}));
  EXPECT_NEAR(all.frames[3].stamp_s, 0.2, 1e-12);
  for (const char* scale : {"0", "-4000", "\"4000\""}) {
    with(scale);
    const std::string message = error_of([&] { (void)open_folder(folder.path()); });
    EXPECT_TRUE(contains(message, "intrinsic.json") && contains(message, "depth_scale")) << message;
  }
  fs::remove(folder.path() / "intrinsic.json");
  with("999.9999491", "camera_intrinsic.json");  // as a float gives it
  all = read_all(*open_folder(folder.path()));
  EXPECT_EQ(all.frames[3].depth_m.at(0, 0), 6.003F);
}

/// Frame `number` of the log is at x = number.
std::string logged(std::int64_t number, const std::string& heading) {
  return heading + "\n1 0 0 " + std::to_string(number) + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
}

// Open3D, TrajectoryIO.cpp, ReadPinholeCameraTrajectoryFromLOG() and its writer: three integers before each pose.
TEST(Redwood, PosesBelongToTheFramesThatTheirHeadingsNumber) {
  const auto read = [](const fs::path& folder, std::string& said) {
    ReadAll all;
    said = decisions_about([&](const SourceOptions& options) { return open_folder(folder, options); }, &all);
    return all.frames;
  };
  const auto x_of = [](const Frame& frame) { return frame.T_world_camera ? frame.T_world_camera->translation().x() : -1.0; };
  std::string said;
  {  // some frames were not logged
    const TemporaryFolder folder;
    write_images(folder.path(), "color", DepthEncoding::kMillimetres);
    std::string log;
    for (const int i : {0, 1, 2, 5, 6, 20}) log += logged(i, std::to_string(i) + " " + std::to_string(i) + " 21");
    write_text(folder.path() / "trajectory.log", log);
    const auto frames = read(folder.path(), said);
    ASSERT_EQ(frames.size(), 12U);
    EXPECT_EQ(x_of(frames[2]), 2.0);
    EXPECT_EQ(x_of(frames[3]), -1.0);
    EXPECT_EQ(x_of(frames[5]), 5.0);
    EXPECT_TRUE(contains(said, "1 poses of trajectory.log are of frames without a depth image")) << said;
  }
  for (const char* heading : {"0 0 1", "-1 -1 -1"}) {  // headings that do not count
    const TemporaryFolder folder;
    write_images(folder.path(), "color", DepthEncoding::kMillimetres);
    std::string log;
    for (int i = 0; i < 12; ++i) log += logged(i, heading);
    write_text(folder.path() / "trajectory.log", log);
    const auto frames = read(folder.path(), said);
    ASSERT_EQ(frames.size(), 12U);
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(x_of(frames[i]), static_cast<double>(i)) << heading << "\n" << said;
  }
  {  // as Redwood's scans: files from 1 on, with a stamp in their names; headings from 0 on
    const TemporaryFolder folder;
    write_images(folder.path(), "image", DepthEncoding::kMillimetres);
    std::string log;
    for (int i = 11; i >= 0; --i) {
      char name[64];
      std::snprintf(name, sizeof name, "%07d-%012d.png", i + 1, 33369 * i);
      fs::rename(folder.path() / "depth" / (std::to_string(i) + ".png"), folder.path() / "depth" / name);
      std::snprintf(name, sizeof name, "%07d-%012d.png", i + 1, 33369 * i + 8000);
      fs::rename(folder.path() / "image" / (std::to_string(i) + ".png"), folder.path() / "image" / name);
    }
    for (int i = 0; i < 12; ++i) log += logged(i, std::to_string(i) + " " + std::to_string(i) + " " + std::to_string(i + 1));
    write_text(folder.path() / "trajectory.log", log);
    fs::remove(folder.path() / "depth" / "0000005-000000133476.png");
    const auto frames = read(folder.path(), said);
    ASSERT_EQ(frames.size(), 11U);
    for (std::size_t i = 0; i < 11; ++i) {
      const auto number = static_cast<double>(i < 4 ? i : i + 1);
      EXPECT_EQ(x_of(frames[i]), number);
      EXPECT_NEAR(frames[i].depth_m.at(0, 0), 1.0 + 0.01 * number, 1e-6);
      EXPECT_EQ(frames[i].colour.at(0, 0).r, number);
    }
    EXPECT_TRUE(contains(said, "1 poses of trajectory.log")) << said;
  }
  {  // the first image was deleted
    const TemporaryFolder folder;
    write_images(folder.path(), "color", DepthEncoding::kMillimetres);
    fs::remove(folder.path() / "depth" / "0.png");
    std::string log;
    for (int i = 0; i < 12; ++i) log += logged(i, std::to_string(i) + " " + std::to_string(i) + " 12");
    write_text(folder.path() / "trajectory.log", log);
    const auto frames = read(folder.path(), said);
    ASSERT_EQ(frames.size(), 11U);
    EXPECT_EQ(x_of(frames[0]), 1.0);
  }
}

TEST(Redwood, TakesPosesOfFilesWithoutATrajectory) {
  const TemporaryFolder folder;
  write_numbered(folder.path(), [](int i) { return Written{padded(i) + ".png", padded(i) + ".png"}; });
  write_text(folder.path() / "intrinsic.json",
             R"({"width": 16, "height": 12, "intrinsic_matrix": [14, 0, 0, 0, 14, 0, 7.5, 5.5, 1]})");
  fs::create_directories(folder.path() / "pose");
  write_text(folder.path() / "pose" / (padded(3) + ".txt"), "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n");
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 12U);
  ASSERT_TRUE(all.frames[3].T_world_camera);
  EXPECT_TRUE(all.frames[3].T_world_camera->translation().isApprox(Eigen::Vector3d(5, 6, 7)));
  EXPECT_FALSE(all.frames[2].T_world_camera);
}

TEST(Redwood, AFileThatIsNoTrajectoryIsNotTakenForOne) {
  const TemporaryFolder folder;
  write_images(folder.path(), "color", DepthEncoding::kMillimetres);
  for (const char* text : {"", "2024-05-01 12:00:00 started\n", "1 2 3\n4 5 6\n", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"}) {
    write_text(folder.path() / "a.log", text);
    ReadAll all;
    const std::string said =
        decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
    ASSERT_EQ(all.frames.size(), 12U) << text;
    EXPECT_FALSE(all.frames[0].T_world_camera);
  }
}

TEST(IclNuim, MirrorsItsLeftHandedFrames) {
  const TemporaryFolder folder;
  write_images(folder.path(), "rgb", DepthEncoding::kTum);
  // Rotated by 90 degrees about x: in its frames (x right, y up, z forward), forward becomes -y.
  write_text(folder.path() / "livingRoom.gt.freiburg",
             "1 1 2 3 0.70710678118 0 0 0.70710678118\n2 1 2 3 0 0 0 0\n");
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 12U);
  EXPECT_NEAR(all.frames[3].depth_m.at(0, 0), 1.03, 1e-6);
  EXPECT_NEAR(all.frames[3].depth_camera.fy_px, 48.0, 1e-9);
  const Eigen::Isometry3d& T = *all.frames[1].T_world_camera;
  // A point 1 m ahead is at (1, 2 - 1, 3) of the recorded world, which is mirrored in y.
  EXPECT_TRUE((T * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, -1, 3), 1e-6)) << T.matrix();
  // A point 1 m below the axis has recorded y -1, which the rotation turns to -z.
  EXPECT_TRUE((T * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(1, -2, 2), 1e-6)) << T.matrix();
  EXPECT_GT(T.linear().determinant(), 0.999);
  EXPECT_FALSE(all.frames[2].T_world_camera);
}

}  // namespace
}  // namespace roomradar::numbered_recordings_test
