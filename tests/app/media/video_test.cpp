// video_test.cpp: videos and pictures are read back as written; a full disk is detected.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <thread>

#include "app/media/picture_file.hpp"
#include "app/media/video_writer.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::video_test {
namespace {

class InFolder : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("roomradar_video_test_" + std::to_string(::getpid()));
};
using Video = InFolder;
using Picture = InFolder;

/// A bright square on a blue background that moves right by two pixels per frame.
ColourImage square_at(int frame, int width_px, int height_px) {
  ColourImage picture(width_px, height_px, Rgb{20, 40, 160});
  for (int y = 20; y < 40; ++y)
    for (int x = 10 + 2 * frame; x < 30 + 2 * frame; ++x)
      if (picture.contains(x, y)) picture.at(x, y) = {240, 200, 30};
  return picture;
}

TEST_F(Video, EachKindComesBackWithItsFramesAndColours) {
  for (const char* name : {"v.mp4", "v.avi", "v.mkv"}) {
    const std::string path = (folder_ / name).string();
    VideoWriter writer(path, 25.0);
    // odd sizes lose one pixel
    for (int frame = 0; frame < 30; ++frame) writer.write(square_at(frame, 161, 121));
    EXPECT_EQ(writer.frames_written(), 30);
    writer.close();
    writer.close();

    cv::VideoCapture reader(path);
    ASSERT_TRUE(reader.isOpened()) << name;
    EXPECT_NEAR(reader.get(cv::CAP_PROP_FPS), 25.0, 0.1) << name;
    cv::Mat bgr;
    int frames = 0;
    while (reader.read(bgr)) {
      ASSERT_EQ(bgr.size(), cv::Size(160, 120)) << name;
      const cv::Vec3b inside = bgr.at<cv::Vec3b>(30, 20 + 2 * frames);
      const cv::Vec3b outside = bgr.at<cv::Vec3b>(90, 80);
      EXPECT_NEAR(inside[2], 240, 40) << name << " " << frames;
      EXPECT_NEAR(outside[0], 160, 40) << name << " " << frames;
      ++frames;
    }
    EXPECT_EQ(frames, 30) << name;
  }
}

TEST_F(Video, RefusesWhatCannotBeMade) {
  EXPECT_THROW(VideoWriter("film.gif", 30.0), Error);
  EXPECT_THROW(VideoWriter("film", 30.0), Error);
  EXPECT_THROW(VideoWriter(folder_ / "none" / "film.mp4", 30.0), Error);
  EXPECT_THROW(VideoWriter(folder_ / "film.mp4", 0.0), Error);
  EXPECT_THROW(VideoWriter(folder_ / "film.mp4", std::nan("")), Error);
  std::filesystem::create_directory(folder_ / "folder.mp4");
  EXPECT_THROW(VideoWriter(folder_ / "folder.mp4", 30.0), Error);
}

TEST_F(Video, TheFirstPictureFixesTheSize) {
  VideoWriter writer(folder_ / "v.avi", 30.0);
  EXPECT_THROW(writer.write(ColourImage(1, 1)), Error);
  writer.write(square_at(0, 160, 120));
  writer.write(square_at(1, 320, 240));
  writer.close();
  EXPECT_THROW(writer.write(square_at(1, 160, 120)), Error);
  cv::VideoCapture reader((folder_ / "v.avi").string());
  cv::Mat bgr;
  for (int frame = 0; frame < 2; ++frame) {
    ASSERT_TRUE(reader.read(bgr)) << frame;
    EXPECT_EQ(bgr.size(), cv::Size(160, 120)) << frame;
  }
  EXPECT_NEAR(bgr.at<cv::Vec3b>(15, 10)[2], 240, 40) << "half its former size";
}

TEST_F(Video, WhatWasThereStaysUntilTheNewOneIsWhole) {
  const auto path = folder_ / "v.avi";
  std::ofstream(path) << "a video that was there";
  {
    VideoWriter writer(path, 30.0);
    for (int frame = 0; frame < 3; ++frame) writer.write(square_at(frame, 160, 120));
    EXPECT_EQ(std::filesystem::file_size(path), 22U);
  }  // destroyed without close(): the frames written so far are a complete video
  EXPECT_EQ(cv::VideoCapture(path.string()).get(cv::CAP_PROP_FRAME_COUNT), 3.0);
  const std::filesystem::directory_iterator files(folder_);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(Video, GoesAsFastAsItsPicturesWereTaken) {
  const auto frames_of = [&](std::initializer_list<double> stamps_s) {
    VideoWriter writer(folder_ / "v.avi", 30.0);
    for (const double stamp_s : stamps_s) writer.write_at(square_at(1, 160, 120), stamp_s);
    return writer.frames_written();
  };
  EXPECT_EQ(frames_of({7.0, 7.0 + 1 / 30.0, 7.0 + 2 / 30.0, 7.0 + 3 / 30.0}), 4);
  EXPECT_EQ(frames_of({7.0, 7.0 + 1 / 15.0, 7.0 + 2 / 15.0, 7.0 + 3 / 15.0}), 7) << "half the rate";
  EXPECT_EQ(frames_of({7.0, 7.0 + 1 / 60.0, 7.0 + 2 / 60.0, 7.0 + 3 / 60.0, 7.0 + 4 / 60.0}), 3) << "twice";
  EXPECT_EQ(frames_of({7.0, 7.5}), 16) << "frames that were dropped";
  EXPECT_EQ(frames_of({7.0, 7.0 + 1 / 30.0, 3600.0, 3600.0 + 1 / 30.0, 2.0, 2.0 + 1 / 30.0}), 6) << "jumps";
  EXPECT_EQ(frames_of({7.0, std::nan(""), 7.0}), 3);
}

TEST_F(Video, WhatGoesThroughAPipeIsNotWaitedForAgain) {
  const auto path = folder_ / "v.avi";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::size_t bytes = 0;
  std::thread reader([&] {
    std::ifstream file(path, std::ios::binary);
    for (char c = 0; file.get(c);) ++bytes;
  });
  {
    VideoWriter writer(path, 30.0);
    for (int frame = 0; frame < 3; ++frame) writer.write(square_at(frame, 160, 120));
    writer.close();
  }
  reader.join();
  EXPECT_GT(bytes, 1000U);
}

TEST_F(Video, NothingWrittenMakesNoFile) {
  VideoWriter writer(folder_ / "v.mp4", 30.0);
  writer.close();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "v.mp4"));
}

/// Runs `work` in a child process whose files may not exceed a limit, as on a full disk. Returns true if it
/// throws Error.
template <typename Work>
bool throws_on_a_full_disk(Work&& work, rlim_t limit_bytes) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{limit_bytes, limit_bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int status = 0;
    try {
      work();
    } catch (const Error&) {
      status = 42;
    } catch (...) {
      status = 43;
    }
    ::_exit(status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 42;
}

TEST_F(Video, AFullDiskIsAnErrorAtTheLatestWhenItIsClosed) {
  for (const char* name : {"v.mp4", "v.avi", "v.mkv"}) {
    const auto write_all = [&] {
      VideoWriter writer(folder_ / name, 30.0);
      std::srand(1);
      for (int frame = 0; frame < 40; ++frame) {
        ColourImage noise(320, 240);
        for (Rgb& pixel : noise.pixels) pixel.r = pixel.g = pixel.b = static_cast<std::uint8_t>(std::rand());
        writer.write(noise);
      }
      writer.close();
    };
    std::ofstream(folder_ / name) << "a video that was there";
    EXPECT_TRUE(throws_on_a_full_disk(write_all, 100'000)) << name;
    EXPECT_EQ(std::filesystem::file_size(folder_ / name), 22U) << name;
    EXPECT_FALSE(throws_on_a_full_disk(write_all, RLIM_INFINITY)) << name;
    EXPECT_GT(std::filesystem::file_size(folder_ / name), 100'000U) << name;
  }
}

TEST_F(Picture, ColourComesBackExactly) {
  const ColourImage picture = square_at(3, 77, 55);
  const std::string path = (folder_ / "p.png").string();
  write_png(picture, path);
  const cv::Mat bgr = cv::imread(path, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(bgr.size(), cv::Size(77, 55));
  for (int y = 0; y < 55; ++y) {
    for (int x = 0; x < 77; ++x) {
      const cv::Vec3b pixel = bgr.at<cv::Vec3b>(y, x);
      ASSERT_EQ((Rgb{pixel[2], pixel[1], pixel[0]}), picture.at(x, y));
    }
  }
}

TEST_F(Picture, AMaskComesBackExactly) {
  MaskImage mask(9, 7);
  mask.at(3, 2) = 255;
  const std::string path = (folder_ / "m.png").string();
  write_png(mask, path);
  const cv::Mat grey = cv::imread(path, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(grey.type(), CV_8UC1);
  EXPECT_EQ(grey.at<unsigned char>(2, 3), 255);
  EXPECT_EQ(cv::countNonZero(grey), 1);
}

TEST_F(Picture, RefusesEmptyImagesMissingFoldersAndFullDisks) {
  EXPECT_THROW(write_png(ColourImage{}, folder_ / "e.png"), Error);
  EXPECT_THROW(write_png(MaskImage{}, folder_ / "e.png"), Error);
  EXPECT_THROW(write_png(square_at(0, 20, 20), folder_ / "none" / "p.png"), Error);
  EXPECT_TRUE(throws_on_a_full_disk([&] { write_png(square_at(0, 640, 480), folder_ / "f.png"); }, 100));
  EXPECT_FALSE(
      throws_on_a_full_disk([&] { write_png(square_at(0, 640, 480), folder_ / "f.png"); }, RLIM_INFINITY));
}

}  // namespace
}  // namespace roomradar::video_test
