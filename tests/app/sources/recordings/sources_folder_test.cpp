// sources_folder_test.cpp: recordings on disk, intact and damaged.
#include <gtest/gtest.h>

#include <algorithm>

#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/system/folders.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::sources_folder_test {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::cut_to;
using test::error_of;
using test::decisions_about;
using test::read_all;
using test::ReadAll;
using test::some_frame;
using test::TemporaryFolder;
using test::write_text;

constexpr int kFrames = 6;

void write_recording(const fs::path& folder, RecordingFormat format, int count = kFrames, int width_px = 16,
                     int height_px = 12) {
  RecordingWriter writer(folder, format);
  for (int i = 0; i < count; ++i) writer.write(some_frame(i, width_px, height_px));
  writer.close();
}

std::string name_of(const fs::path& folder, int frame, const char* kind) {
  std::string number = std::to_string(frame);
  number.insert(0, 6 - number.size(), '0');
  return (folder / ("frame-" + number + "." + kind)).string();
}

void write_numbered(const fs::path& folder) {
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / "color");
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = some_frame(i);
    write_depth_file(frame.depth_m, DepthEncoding::kMillimetres,
                     folder / "depth" / ("0000" + std::to_string(i) + ".png"));
    write_colour_file(frame.colour, folder / "color" / ("0000" + std::to_string(i) + ".png"));
  }
}

/// Expects the frames in `folder` to equal those of some_frame(), depth up to `depth_step_m`.
void expect_some_frames(const fs::path& folder, double depth_step_m, bool with_pose, bool with_gravity,
                        double gravity_step) {
  const auto source = open_folder(folder);
  EXPECT_EQ(source->frame_count(), kFrames);
  const auto all = read_all(*source);
  EXPECT_TRUE(all.faults.empty());
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const Frame& got = all.frames[static_cast<std::size_t>(i)];
    const Frame want = some_frame(i, got.depth_m.width, got.depth_m.height);
    EXPECT_EQ(got.index, i);
    for (std::size_t p = 0; p < want.depth_m.pixels.size(); ++p) {
      ASSERT_NEAR(got.depth_m.pixels[p], want.depth_m.pixels[p], depth_step_m) << i << " " << p;
      ASSERT_EQ(got.depth_m.pixels[p] == 0.0F, want.depth_m.pixels[p] == 0.0F);
    }
    EXPECT_EQ(got.colour.pixels, want.colour.pixels);
    EXPECT_EQ(got.depth_camera, want.depth_camera);
    EXPECT_EQ(got.colour_camera, want.colour_camera);
    EXPECT_TRUE(got.T_colour_depth.isApprox(want.T_colour_depth, 1e-12));
    ASSERT_EQ(got.T_world_camera.has_value(), with_pose);
    if (with_pose) {
      EXPECT_TRUE(got.T_world_camera->isApprox(*want.T_world_camera, 1e-9));
    }
    ASSERT_EQ(got.down_camera.has_value(), with_gravity);
    if (with_gravity) {
      EXPECT_TRUE(got.down_camera->isApprox(*want.down_camera, gravity_step));
    }
  }
}

// ---- round trips ----

TEST(RecordingRoundTrip, TumKeepsDepthColourPosesGravityAndStamps) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  expect_some_frames(folder.path(), 0.000101, true, true, 1e-8);
  const auto all = read_all(*open_folder(folder.path()));
  for (int i = 0; i < kFrames; ++i) {
    const Frame& got = all.frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(got.stamp_s, some_frame(i).stamp_s);  // thirds of a second, too
    EXPECT_NEAR(got.colour_after_depth_s, some_frame(i).colour_after_depth_s, 1e-12);
  }
}

TEST(RecordingRoundTrip, LitterOfDesktopsIsNotRead) {
  for (const RecordingFormat format :
       {RecordingFormat::kTum, RecordingFormat::kSevenScenes, RecordingFormat::kRosBag}) {
    const TemporaryFolder folder;
    write_recording(folder.path(), format);
    const auto clean = read_all(*open_folder(folder.path()));
    test::add_litter(folder.path());
    const auto littered = read_all(*open_folder(folder.path()));
    EXPECT_TRUE(littered.faults.empty()) << littered.faults[0];
    ASSERT_EQ(littered.frames.size(), clean.frames.size()) << static_cast<int>(format);
    EXPECT_EQ(littered.frames.back().depth_m.pixels, clean.frames.back().depth_m.pixels);
  }
  const TemporaryFolder numbered, empty;
  write_numbered(numbered.path());
  const auto clean = read_all(*open_folder(numbered.path()));
  test::add_litter(numbered.path());
  EXPECT_EQ(read_all(*open_folder(numbered.path())).frames.size(), clean.frames.size());
  test::add_litter(empty.path());
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(empty.path()); }), "the folder is empty"));
  EXPECT_NO_THROW(write_recording(empty.path(), RecordingFormat::kTum))
      << "into a folder that is empty but for it";
}

TEST(RecordingRoundTrip, AFolderOfBonnsDatasetHasItsCamera) {
  const TemporaryFolder folder;
  const fs::path recording = folder.path() / "rgbd_bonn_balloon";
  write_recording(recording, RecordingFormat::kTum, kFrames, 64, 48);
  fs::remove(recording / "camera.json");
  const auto all = read_all(*open_folder(recording));
  ASSERT_FALSE(all.frames.empty());
  EXPECT_NEAR(all.frames[0].depth_camera.fx_px, 54.2822841, 1e-9);
  EXPECT_EQ(all.frames[0].colour_camera, all.frames[0].depth_camera);
}

TEST(RecordingRoundTrip, SevenScenesKeepsDepthColourAndPoses) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  expect_some_frames(folder.path(), 0.000501, true, false, 0);
}

TEST(RecordingRoundTrip, FakenectKeepsDepthToTheRawStepColourAndGravity) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kFakenect, kFrames, 640, 480);
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (int i = 0; i < kFrames; ++i) {
    const Frame& got = all.frames[static_cast<std::size_t>(i)];
    const Frame want = some_frame(i, 640, 480);
    for (std::size_t p = 0; p < want.depth_m.pixels.size(); ++p) {
      const float z = want.depth_m.pixels[p];
      if (z > 9.9F) continue;
      ASSERT_NEAR(got.depth_m.pixels[p], z, 0.5 * 0.003 * z * z + 1e-4);  // half a step of 1/350 z^2
    }
    EXPECT_EQ(got.colour.pixels, want.colour.pixels);
    EXPECT_EQ(got.depth_camera, want.depth_camera);
    EXPECT_TRUE(got.down_camera->isApprox(*want.down_camera, 1.0 / 819));
    EXPECT_NEAR(got.colour_after_depth_s, want.colour_after_depth_s, 1e-6);
    EXPECT_FALSE(got.T_world_camera);
  }
  // Raw depth that was written once is read back bit-identical when written again.
  const TemporaryFolder second;
  RecordingWriter writer(second.path(), RecordingFormat::kFakenect);
  for (const Frame& frame : all.frames) writer.write(frame);
  writer.close();
  const auto again = read_all(*open_folder(second.path()));
  for (std::size_t i = 0; i < all.frames.size(); ++i)
    EXPECT_EQ(again.frames[i].depth_m.pixels, all.frames[i].depth_m.pixels);
}

TEST(RecordingRoundTrip, FakenectShortensAGapThatItsClockCannotTell) {
  const TemporaryFolder folder;
  const std::vector<double> stamps_s = {0.0, 0.033, 50.0, 50.033, 150.0, 179.0};
  {
    RecordingWriter writer(folder.path(), RecordingFormat::kFakenect);
    for (std::size_t i = 0; i < stamps_s.size(); ++i) {
      Frame frame = some_frame(static_cast<int>(i), 640, 480);
      frame.stamp_s = 10.0 + stamps_s[i];
      writer.write(frame);
    }
    writer.close();
  }
  const auto all = read_all(*open_folder(folder.path()));
  EXPECT_TRUE(all.faults.empty());
  ASSERT_EQ(all.frames.size(), stamps_s.size());
  for (std::size_t i = 1; i < stamps_s.size(); ++i)
    EXPECT_NEAR(all.frames[i].stamp_s - all.frames[i - 1].stamp_s,
                std::min(stamps_s[i] - stamps_s[i - 1], 30.0), 1e-6)
        << i;
}

TEST(RecordingRoundTrip, FakenectDoesNotKeepAGravityThatIsNotKnownAnyMore) {
  const TemporaryFolder folder;
  {
    RecordingWriter writer(folder.path(), RecordingFormat::kFakenect);
    for (int i = 0; i < 5; ++i) {
      Frame frame = some_frame(i, 640, 480);
      if (i < 1 || i == 2 || i == 3) frame.down_camera.reset();
      writer.write(frame);
    }
    writer.close();
  }
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(all.frames[i].down_camera.has_value(), i == 1 || i == 4) << i;
}

TEST(RecordingRoundTrip, TumDoesNotGiveAFrameTheGravityOfItsNeighbour) {
  const TemporaryFolder folder;
  RecordingWriter writer(folder.path(), RecordingFormat::kTum);
  for (int i = 0; i < 4; ++i) {
    Frame frame = some_frame(i);
    frame.stamp_s = 100.0 + i / 30.0;
    if (i == 1 || i == 2) frame.down_camera.reset();
    writer.write(frame);
  }
  writer.close();
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(all.frames[i].down_camera.has_value(), i == 0 || i == 3) << i;
}

TEST(RecordingRoundTrip, FramesAmongOthersThatCameWithoutColourComeBackWithout) {
  for (const auto format : {RecordingFormat::kTum, RecordingFormat::kSevenScenes}) {
    const TemporaryFolder folder;
    RecordingWriter writer(folder.path(), format);
    for (int i = 0; i < 16; ++i) {
      Frame frame = some_frame(i);
      frame.stamp_s = 100.0 + i / 15.0;
      frame.colour_after_depth_s = 0.025;  // max difference that a device pairs when depth images are lost
      if (i > 2 && i < 15) frame.colour.resize(0, 0);
      writer.write(frame);
    }
    writer.close();
    const auto all = read_all(*open_folder(folder.path()));
    ASSERT_EQ(all.frames.size(), 16U) << to_string(format);
    for (std::size_t i = 0; i < 16; ++i)
      EXPECT_EQ(all.frames[i].colour.empty(), i > 2 && i < 15) << to_string(format) << ' ' << i;
  }
}

TEST(RecordingRoundTrip, FramesWithoutPoseOrColourComeBackWithout) {
  for (const auto format : {RecordingFormat::kTum, RecordingFormat::kSevenScenes}) {
    const TemporaryFolder folder;
    RecordingWriter writer(folder.path(), format);
    for (int i = 0; i < 3; ++i) {
      Frame frame = some_frame(i);
      frame.colour.resize(0, 0);
      frame.down_camera.reset();
      if (i == 1) frame.T_world_camera.reset();
      writer.write(frame);
    }
    writer.close();
    const auto all = read_all(*open_folder(folder.path()));
    ASSERT_EQ(all.frames.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(all.frames[i].T_world_camera.has_value(), i != 1) << to_string(format);
      EXPECT_TRUE(all.frames[i].colour.empty());
      EXPECT_FALSE(all.frames[i].down_camera);
    }
  }
}

TEST(FolderSource, AMapOrASessionIsCalledWhatItIs) {
  const TemporaryFolder folder;
  write_text(folder.path() / "map" / "map.json", "{}");
  write_text(folder.path() / "session" / "session.json", "{}");
  write_text(folder.path() / "session" / "events.txt", "");
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path() / "map"); }),
                       "is a saved map, not a recording; give the recording or the device as SOURCE"));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(folder.path() / "session"); }),
                       "is a recorded session, not a recording; `roomradar run` replays it"));
}

TEST(RecordingWriter, RefusesWhatItCannotKeep) {
  const TemporaryFolder folder;
  write_text(folder.path() / "full" / "something.txt", "x");
  EXPECT_TRUE(contains(error_of([&] { RecordingWriter(folder.path() / "full", RecordingFormat::kTum); }),
                       "not empty"));
  EXPECT_TRUE(contains(error_of([&] {
                         RecordingWriter(folder.path() / "full" / "something.txt" / "x",
                                         RecordingFormat::kTum);
                       }),
                       "cannot be made"));
  EXPECT_TRUE(contains(error_of([&] { RecordingWriter("/proc/recording", RecordingFormat::kTum); }),
                       "the folder cannot be made: /proc cannot hold files; choose another place"));
  RecordingWriter writer(folder.path() / "new", RecordingFormat::kTum);
  writer.write(some_frame(1));
  EXPECT_TRUE(contains(error_of([&] { writer.write(some_frame(0)); }), "not later"));
  EXPECT_TRUE(contains(error_of([&] { writer.write(some_frame(2, 8, 6)); }), "cameras"));
  Frame wrong = some_frame(2);
  wrong.depth_m.resize(4, 4);
  EXPECT_TRUE(contains(error_of([&] { writer.write(wrong); }), "4 x 4"));
  EXPECT_EQ(writer.frames_written(), 1);
  RecordingWriter raw(folder.path() / "raw", RecordingFormat::kFakenect);
  EXPECT_TRUE(contains(error_of([&] { raw.write(some_frame(0)); }), "640 x 480"));
  EXPECT_TRUE(fs::is_empty(folder.path() / "raw"));  // another format can be written there
}

TEST(RecordingWriter, SaysThatTheDiskIsFull) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryFolder folder;
  for (const auto& [format, file] : {std::pair(RecordingFormat::kTum, "groundtruth.txt"),
                                     {RecordingFormat::kSevenScenes, "frame-000000.depth.png"}}) {
    const fs::path target = folder.path() / to_string(format);
    RecordingWriter writer(target, format);
    fs::create_symlink("/dev/full", target / file);
    const std::string message = error_of([&] {
      for (int i = 0; i < 200; ++i) writer.write(some_frame(i));
      writer.close();
    });
    EXPECT_TRUE(contains(message, "disk full") || contains(message, "No space left")) << message;
  }
}

// ---- format detection ----

TEST(OpenFolder, SaysWhatItLookedFor) {
  const TemporaryFolder folder;
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path() / "none"); }), "no such folder"));
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path()); }), "empty"));
  write_text(folder.path() / "notes.txt", "hello");
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path() / "notes.txt"); }), "neither a folder nor"));
  const std::string unknown = error_of([&] { open_folder(folder.path()); });
  for (const char* wanted : {"INDEX.txt", "depth.txt", "frame-XXXXXX", "depth/NNNNN.png"})
    EXPECT_TRUE(contains(unknown, wanted));
}

TEST(OpenFolder, RefusesRecordingsWithoutFrames) {
  const TemporaryFolder tum, numbered, raw;
  write_text(tum.path() / "depth.txt", "# nothing\n");
  fs::create_directories(numbered.path() / "depth");
  write_text(raw.path() / "INDEX.txt", "");
  for (const auto* folder : {&tum, &numbered, &raw})
    EXPECT_TRUE(contains(error_of([&] { open_folder(folder->path()); }), "no frames"));
}

TEST(OpenFolder, ReadsNumberedFoldersInMillimetres) {
  const TemporaryFolder folder;
  write_numbered(folder.path());
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  SourceOptions known;
  known.depth_camera = Intrinsics{16, 12, 14, 14, 8, 6};
  const auto aligned = read_all(*open_folder(folder.path(), known));
  EXPECT_EQ(aligned.frames.at(2).colour_camera, *known.depth_camera);
  EXPECT_TRUE(aligned.frames.at(2).T_colour_depth.matrix().isIdentity());
  EXPECT_NEAR(all.frames[2].stamp_s, 2 / 30.0, 1e-12);
  EXPECT_NEAR(all.frames[2].depth_m.at(3, 1), some_frame(2).depth_m.at(3, 1), 0.000501);
  EXPECT_EQ(all.frames[2].colour.pixels, some_frame(2).colour.pixels);
  EXPECT_FALSE(all.frames[2].T_world_camera);
}

// ---- faults of single frames ----

/// Damages frame 3 of a 7-Scenes recording by `act` and returns the message with which it is skipped.
template <typename Act>
std::string skipped_after(const Act& act) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  act(folder.path());
  const auto all = read_all(*open_folder(folder.path()));
  EXPECT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames - 1));
  EXPECT_EQ(all.faults.size(), 1U);
  if (all.faults.size() != 1 || all.frames.size() != kFrames - 1) return {};
  EXPECT_EQ(all.frames[3].index, 4);  // the skipped frame counts
  EXPECT_TRUE(contains(all.faults[0], "frame 3")) << all.faults[0];
  EXPECT_TRUE(contains(all.faults[0], "3")) << all.faults[0];
  return all.faults[0];
}

/// Damages the colour image or the pose of frame 3 of a 7-Scenes recording by `act`, and returns the lines that
/// say so. The frame is delivered without colour, or without a pose.
template <typename Act>
std::string said_after(const Act& act) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  act(folder.path());
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_TRUE(all.faults.empty());
  if (all.frames.size() != kFrames) return {};
  EXPECT_TRUE(all.frames[3].colour.empty() != !all.frames[3].T_world_camera) << "either is missing";
  for (std::size_t i = 0; i < all.frames.size(); ++i)
    EXPECT_TRUE(i == 3 || (!all.frames[i].colour.empty() && all.frames[i].T_world_camera)) << i;
  return said;
}

TEST(BadFrame, MissingFilesAreNamed) {
  EXPECT_TRUE(contains(skipped_after([](const fs::path& f) { fs::remove(name_of(f, 3, "depth.png")); }),
                       "depth image of number 3 is missing"));
  EXPECT_TRUE(contains(said_after([](const fs::path& f) { fs::remove(name_of(f, 3, "color.png")); }),
                       "the colour image of 1 of 6 frames is missing, the first: number 3"));
  EXPECT_TRUE(contains(said_after([](const fs::path& f) { fs::remove(name_of(f, 3, "pose.txt")); }),
                       "the pose of 1 of 6 frames is missing, the first: number 3"));
}

TEST(BadFrame, FilesCutShortAreNamed) {
  for (const std::string kind : {"depth.png", "color.png"}) {
    for (const double part : {0.0, 0.05, 0.5, 0.95}) {
      const auto cut = [&](const fs::path& f) { cut_to(name_of(f, 3, kind.c_str()), part); };
      const std::string fault = kind == "depth.png" ? skipped_after(cut) : said_after(cut);
      EXPECT_TRUE(contains(fault, part == 0 ? "is empty" : part < 0.1 ? "" : "cut short")) << fault;
      EXPECT_TRUE(contains(fault, kind)) << fault;
    }
  }
  EXPECT_TRUE(
      contains(said_after([](const fs::path& f) { cut_to(name_of(f, 3, "pose.txt"), 0.5); }), "4 x 4"));
}

TEST(BadFrame, JpegCutShortIsNotFilledWithGrey) {
  const std::string fault = said_after([](const fs::path& f) {
    fs::remove(name_of(f, 3, "color.png"));
    cv::imwrite(name_of(f, 3, "color.jpg"), cv::Mat(12, 16, CV_8UC3, cv::Scalar(1, 2, 3)));
    cut_to(name_of(f, 3, "color.jpg"), 0.8);
  });
  EXPECT_TRUE(contains(fault, "cut short")) << fault;
}

TEST(BadFrame, DamagedPixelsAreNoticed) {
  const std::string fault = skipped_after([](const fs::path& f) {
    std::fstream file(name_of(f, 3, "depth.png"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(60);
    file.write("\0\0\0\0\0\0\0\0", 8);
  });
  EXPECT_TRUE(contains(fault, "damaged") || contains(fault, "decoded")) << fault;
}

TEST(BadFrame, WrongKindsAreNamed) {
  EXPECT_TRUE(contains(
      said_after([](const fs::path& f) { write_text(name_of(f, 3, "color.png"), "this is text\n"); }),
      "looks like text"));
  EXPECT_TRUE(contains(skipped_after([](const fs::path& f) {
                         fs::copy_file(name_of(f, 3, "color.png"), name_of(f, 3, "depth.png"),
                                       fs::copy_options::overwrite_existing);
                       }),
                       "16 bit grey PNG"));
  EXPECT_TRUE(contains(skipped_after([](const fs::path& f) {
                         cv::imwrite(name_of(f, 3, "depth.png"), cv::Mat(12, 16, CV_8UC1, cv::Scalar(7)));
                       }),
                       "8 bit grey PNG"));
  EXPECT_TRUE(contains(skipped_after([](const fs::path& f) {
                         write_depth_file(some_frame(3, 8, 6).depth_m, DepthEncoding::kMillimetres,
                                          name_of(f, 3, "depth.png"));
                       }),
                       "8 x 6"));
  EXPECT_TRUE(
      contains(said_after([](const fs::path& f) { write_text(name_of(f, 3, "pose.txt"), "1 0 0 x"); }),
               "'x' is not a number"));
  EXPECT_TRUE(contains(said_after([](const fs::path& f) {
                         write_text(name_of(f, 3, "pose.txt"), "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n");
                       }),
                       "rigid"));
}

TEST(BadFrame, HeaderThatPromisesTooMuchTakesNoMemory) {
  const std::string fault = skipped_after([](const fs::path& f) {
    std::fstream file(name_of(f, 3, "depth.png"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(16);
    file.write("\x7f\xff\xff\xff\x7f\xff\xff\xff", 8);
  });
  EXPECT_TRUE(contains(fault, "2147483647")) << fault;
}

TEST(BadFrame, SizeThatTheFileCannotHoldTakesNoMemory) {
  // 16,384 x 16,384 pixels, written after a marker in the file.
  const auto fault_with_size = [](const char* kind, const std::string& mark, std::string_view size) {
    return said_after([&](const fs::path& f) {
      fs::remove(name_of(f, 3, "color.png"));
      cv::imwrite(name_of(f, 3, kind), cv::Mat(12, 16, CV_8UC3, cv::Scalar(1, 2, 3)));
      std::fstream file(name_of(f, 3, kind), std::ios::in | std::ios::out | std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      ASSERT_NE(bytes.find(mark), std::string::npos);
      file.seekp(static_cast<std::streamoff>(bytes.find(mark) + mark.size()));
      file.write(size.data(), static_cast<std::streamsize>(size.size()));
    });
  };
  const std::string png = fault_with_size("color.png", "IHDR", {"\0\0\x40\0\0\0\x40\0", 8});
  EXPECT_TRUE(contains(png, "cannot hold 16384 x 16384")) << png;
  const std::string jpeg = fault_with_size("color.jpg", {"\xff\xc0\0\x11\x08", 5}, {"\x40\0\x40\0", 4});
  EXPECT_TRUE(contains(jpeg, "cannot hold 16384 x 16384")) << jpeg;
}

TEST(BadFrame, AnyNumberInARowIsPassedOver) {
  const TemporaryFolder folder;
  constexpr int kMany = 40;
  write_recording(folder.path(), RecordingFormat::kSevenScenes, kMany);
  for (int i = 2; i < 25; ++i) write_text(name_of(folder.path(), i, "depth.png"), "");
  for (int i = 35; i < kMany; ++i) write_text(name_of(folder.path(), i, "depth.png"), "");
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_EQ(all.faults.size(), 28U);
  ASSERT_EQ(all.frames.size(), 12U);
  EXPECT_EQ(all.frames[2].index, 25);
  EXPECT_TRUE(contains(said, "28 depth images cannot be read")) << said;
}

/// Damages images 20 to 49 and 70 to 99 of a recording of 100, and every second colour image.
void lose_images(const fs::path& folder, const std::vector<fs::path>& depth, const std::vector<fs::path>& colour) {
  ASSERT_EQ(depth.size(), 100U) << folder;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if ((i >= 20 && i < 50) || i >= 70) test::cut_to(depth[i], i % 2 == 0 ? 0.0 : 0.6);
    if (i % 2 == 0 && i < colour.size()) test::cut_to(colour[i], 0.4);
  }
}

TEST(BadFrame, ThirtyInARowCostNothingElseInFoldersOfEveryForm) {
  const auto files_in = [](const fs::path& folder, const std::string& ending, const std::string& begin = "") {
    std::vector<fs::path> files;
    for (const auto& each : fs::directory_iterator(folder))
      if (each.path().filename().string().ends_with(ending) && each.path().filename().string().starts_with(begin))
        files.push_back(each.path());
    std::sort(files.begin(), files.end());
    return files;
  };
  const auto expect_rest = [](const fs::path& folder) {
    ReadAll all;
    const std::string said =
        decisions_about([&](const SourceOptions& options) { return open_folder(folder, options); }, &all);
    ASSERT_EQ(all.frames.size(), 40U) << folder << said;
    EXPECT_EQ(all.faults.size(), 60U);
    EXPECT_EQ(all.frames[19].index, 19);
    EXPECT_EQ(all.frames[20].index, 50);
    EXPECT_EQ(std::count_if(all.frames.begin(), all.frames.end(), [](const Frame& frame) { return frame.colour.empty(); }),
              20);
    EXPECT_TRUE(contains(said, "60 depth images cannot be read")) << said;
    EXPECT_TRUE(contains(said, "20 colour images cannot be read")) << said;
  };
  {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kTum, 100);
    lose_images(folder.path(), files_in(folder.path() / "depth", ".png"), files_in(folder.path() / "rgb", ".png"));
    expect_rest(folder.path());
  }
  {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kSevenScenes, 100);
    lose_images(folder.path(), files_in(folder.path(), "depth.png"), files_in(folder.path(), "color.png"));
    expect_rest(folder.path());
  }
  {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kFakenect, 100, 640, 480);
    lose_images(folder.path(), files_in(folder.path(), ".pgm", "d-"), files_in(folder.path(), ".ppm", "r-"));
    expect_rest(folder.path());
  }
  for (const bool is_redwood : {false, true}) {  // numbered images, without and with Open3D's camera
    const TemporaryFolder folder;
    fs::create_directories(folder.path() / "depth");
    fs::create_directories(folder.path() / "color");
    for (int i = 0; i < 100; ++i) {
      const Frame frame = some_frame(i);
      const std::string name = std::to_string(1000 + i) + ".png";
      write_depth_file(frame.depth_m, DepthEncoding::kMillimetres, folder.path() / "depth" / name);
      write_colour_file(frame.colour, folder.path() / "color" / name);
    }
    if (is_redwood)
      write_text(folder.path() / "intrinsic.json", R"({"width":16,"height":12,"intrinsic_matrix":[15,0,0,0,15,0,7,5,1]})");
    lose_images(folder.path(), files_in(folder.path() / "depth", ".png"), files_in(folder.path() / "color", ".png"));
    expect_rest(folder.path());
  }
}

TEST(BadFrame, RecordingWithNoneButBadOnesIsRefused) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes, 3);
  for (int i = 0; i < 3; ++i) write_text(name_of(folder.path(), i, "depth.png"), "text");
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path()); }), "none of its 3 images can be read"));
  for (int i = 0; i < 3; ++i)  // images whose headers are right, but not depth
    fs::copy_file(name_of(folder.path(), i, "color.png"), name_of(folder.path(), i, "depth.png"),
                  fs::copy_options::overwrite_existing);
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path()); }), "none of its 3 depth images can be read"));
}

TEST(BadFrame, ALineThatWasNotWrittenToItsEndIsLeftOut) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  std::ofstream(folder.path() / "depth.txt", std::ios::app) << "100.25\n";
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  EXPECT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_TRUE(contains(said, "1 line of depth.txt is left out") && contains(said, "must be a stamp and a file name"))
      << said;
}

// ---- depth and poses ----

TEST(SevenScenes, DepthWithNothingMeasuredIsAFrame) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  cv::imwrite(name_of(folder.path(), 3, "depth.png"), cv::Mat(12, 16, CV_16UC1, cv::Scalar(65535)));
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (const float z : all.frames[3].depth_m.pixels) EXPECT_EQ(z, 0.0F);
}

TEST(SevenScenes, PoseThatIsNotANumberIsNoPose) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  write_text(name_of(folder.path(), 1, "pose.txt"),
             "nan nan nan nan\nnan nan nan nan\nnan nan nan nan\nnan nan nan nan\n");
  write_text(name_of(folder.path(), 2, "pose.txt"), "1 0 0 inf\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  write_text(name_of(folder.path(), 3, "pose.txt"), "-1.#IND 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < all.frames.size(); ++i)
    EXPECT_EQ(all.frames[i].T_world_camera.has_value(), i < 1 || i > 3) << i;
}

TEST(SevenScenes, PosesOfOtherFormsAreReadOrLost) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  write_text(name_of(folder.path(), 0, "pose.txt"), "");
  write_text(name_of(folder.path(), 1, "pose.txt"), "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n");
  write_text(name_of(folder.path(), 2, "pose.txt"), "0 -1 0 1\n1 0 0 2\n0 0 1 3\n");                  // 3 x 4
  write_text(name_of(folder.path(), 3, "pose.txt"), "0 1 0 0\n-1 0 0 0\n0 0 1 0\n1 2 3 1\n");          // transposed
  write_text(name_of(folder.path(), 4, "pose.txt"), "0 -2 0 1\n2 0 0 2\n0 0 2 3\n0 0 0 1\n");          // scaled
  write_text(name_of(folder.path(), 5, "pose.txt"), "0 -1 0 1\r\n1 0 0 2\r\n0 0 1 3\r\n0 0 0 1\r\n");  // of Windows
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T.translation() << 1, 2, 3;
  for (const std::size_t i : {0U, 1U, 4U}) EXPECT_FALSE(all.frames[i].T_world_camera) << i;
  for (const std::size_t i : {2U, 3U, 5U}) {
    ASSERT_TRUE(all.frames[i].T_world_camera) << i;
    EXPECT_TRUE(all.frames[i].T_world_camera->isApprox(T, 1e-9)) << i;
  }
  EXPECT_TRUE(contains(said, "3 recorded poses are lost")) << said;
  EXPECT_TRUE(contains(said, "stored column by column")) << said;
}

TEST(SevenScenes, RotationIsMadeExact) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  write_text(name_of(folder.path(), 1, "pose.txt"), "1.0002 0 0 0.5\n0 0.9998 0.0001 0\n0 0 1 0\n0 0 0 1\n");
  const auto all = read_all(*open_folder(folder.path()));
  const Eigen::Matrix3d R = all.frames[1].T_world_camera->linear();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((R - Eigen::Matrix3d::Identity()).norm(), 1e-4);
}

// ---- TUM lists ----

TEST(Tum, BadLinesAreLeftOutAndCounted) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  const auto stamp = [](int i) { return std::to_string(some_frame(i).stamp_s); };
  const auto line = [&](int i) { return stamp(i) + " depth/" + stamp(i) + ".png\n"; };
  const auto reading = [&](const std::string& list, ReadAll& all) {
    write_text(folder.path() / "depth.txt", list);
    return decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  };
  struct Case {
    std::string list, said;
    std::vector<int> frames;
  };
  for (const Case& c :
       {Case{line(0) + "abc depth/" + stamp(1) + ".png\n" + line(2), "line 2: 'abc' is not a number", {0, 1, 2}},
        Case{line(0) + line(2) + line(1) + line(3), "listed before an earlier one; sorted", {0, 1, 2, 3}},
        Case{line(0) + stamp(1) + "\n" + line(2), "line 2: must be a stamp and a file name", {0, 2}},
        Case{line(0) + stamp(1) + " ../../secret.png\n" + line(2), "must lie in", {0, 2}},
        Case{line(0) + stamp(1) + " depth/none.png\n" + line(2), "none.png: is missing", {0, 2}}}) {
    ReadAll all;
    const std::string said = reading(c.list, all);
    ASSERT_EQ(all.frames.size(), c.frames.size()) << c.said;
    for (std::size_t i = 0; i < c.frames.size(); ++i)
      EXPECT_NEAR(all.frames[i].stamp_s, some_frame(c.frames[i]).stamp_s, 1e-6) << c.said;
    EXPECT_TRUE(contains(said, c.said)) << said;
  }
}

TEST(Tum, APoseWithoutARotationIsNone) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  const auto stamp = [](int i) { return std::to_string(some_frame(i).stamp_s); };
  write_text(folder.path() / "groundtruth.txt",
             stamp(0) + " 1 2 3 0 0 0 1\n" + stamp(1) + " 0 0 0 0 0 0 0\n" + stamp(2) + " 1 2 3 0 0 0 1\n");
  const auto frames = read_all(*open_folder(folder.path())).frames;
  ASSERT_GE(frames.size(), 3U);
  EXPECT_TRUE(frames[0].T_world_camera);
  // Interpolated between its neighbours if they are close enough, and never at the origin.
  EXPECT_TRUE(!frames[1].T_world_camera || frames[1].T_world_camera->translation().norm() > 1.0);
  EXPECT_TRUE(frames[2].T_world_camera);
}

TEST(OpenFolder, AFrameThatCannotBeReadLeavesTheLastOneWhole) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  const auto source = open_folder(folder.path());
  Frame frame, before;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  before = frame;
  for (const auto& image : fs::directory_iterator(folder.path() / "depth")) fs::resize_file(image.path(), 20);
  ASSERT_EQ(source->next(frame).status, ReadStatus::kSkipped);
  EXPECT_EQ(frame.index, before.index);
  EXPECT_EQ(frame.stamp_s, before.stamp_s);
  EXPECT_EQ(frame.depth_m.pixels, before.depth_m.pixels);
}

TEST(Tum, AFrameWhoseColourLineIsBadHasNoColour) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  std::string list;
  for (int i = 0; i < kFrames; ++i) {
    const std::string stamp = std::to_string(some_frame(i).stamp_s + some_frame(i).colour_after_depth_s);
    list += i == 2 ? "oops\n" : stamp + " rgb/" + stamp + ".png\n";
  }
  write_text(folder.path() / "rgb.txt", list);
  ReadAll all;
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); }, &all);
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < all.frames.size(); ++i) EXPECT_EQ(all.frames[i].colour.empty(), i == 2) << i;
  EXPECT_TRUE(contains(said, "rgb.txt, line 3")) << said;
}

TEST(Tum, ListsThatAreMissingOrBrokenAreNamed) {
  const auto fails = [](const auto& act) {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kTum);
    act(folder.path());
    return error_of([&] { open_folder(folder.path()); });
  };
  const auto rename_images = [](const fs::path& images) {
    int number = 0;
    for (const fs::path& file : entries_of(images)) fs::rename(file, images / ("image " + std::to_string(number++) + "x.png"));
  };
  EXPECT_TRUE(contains(fails([&](const fs::path& f) {
                         fs::remove(f / "depth.txt");
                         rename_images(f / "depth");
                       }),
                       "depth.txt: is missing"));
  EXPECT_TRUE(contains(fails([&](const fs::path& f) {
                         fs::remove(f / "rgb.txt");
                         rename_images(f / "rgb");
                       }),
                       "rgb.txt: is missing"));
  const auto says = [](const auto& act) {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kTum);
    act(folder.path());
    return decisions_about([&](const SourceOptions& options) { return open_folder(folder.path(), options); });
  };
  for (const char* list : {"depth.txt", "rgb.txt"})
    EXPECT_TRUE(contains(says([&](const fs::path& f) { fs::remove(f / list); }), std::string(list) + " is missing"));
  EXPECT_TRUE(contains(says([](const fs::path& f) { write_text(f / "groundtruth.txt", "1 2 3\n"); }),
                       "groundtruth.txt, line 1: has 3 numbers"));
  EXPECT_TRUE(contains(says([](const fs::path& f) { write_text(f / "accelerometer.txt", "#\n1 2 3 down\n"); }),
                       "line 2: 'down' is not a number"));
}

TEST(Tum, PoseIsInterpolatedBetweenNearStampsOnly) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kTum);
  const double s2 = some_frame(2).stamp_s;
  const auto row = [](double stamp_s, double x, double angle_rad) {
    return std::to_string(stamp_s) + " " + std::to_string(x) + " 0 0 0 0 " +
           std::to_string(std::sin(angle_rad / 2)) + " " + std::to_string(std::cos(angle_rad / 2)) + "\n";
  };
  write_text(folder.path() / "groundtruth.txt",
             row(s2 - 0.01, 1.0, 0.2) + row(s2 + 0.03, 2.0, 0.6) + row(s2 + 0.2, 3.0, 0.6));
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < all.frames.size(); ++i)
    ASSERT_EQ(all.frames[i].T_world_camera.has_value(), i == 2) << i;
  const Eigen::Isometry3d& T = *all.frames[2].T_world_camera;
  EXPECT_NEAR(T.translation().x(), 1.25, 1e-3);
  EXPECT_NEAR(Eigen::AngleAxisd(T.linear()).angle(), 0.3, 1e-3);
}

TEST(Tum, DepthIsInFiveThousandths) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "depth");
  cv::imwrite((folder.path() / "depth" / "a.png").string(), cv::Mat(4, 4, CV_16UC1, cv::Scalar(10000)));
  write_text(folder.path() / "depth.txt", "1.0 depth/a.png\n");
  const auto all = read_all(*open_folder(folder.path()));
  EXPECT_EQ(all.frames.at(0).depth_m.at(2, 2), 2.0F);
  EXPECT_TRUE(all.frames.at(0).T_colour_depth.matrix().isIdentity());
}

// ---- fakenect ----

TEST(Fakenect, DepthIsLittleEndianBehindItsHeader) {
  const TemporaryFolder folder;
  std::string file = "P5 2 1 65535\n";
  file += std::string("\xf4\x01\xff\x07", 4);  // 500, 2047
  write_text(folder.path() / "d-10.0-100.pgm", file);
  write_text(folder.path() / "INDEX.txt", "d-10.0-100.pgm\n");
  const auto all = read_all(*open_folder(folder.path()));
  ASSERT_EQ(all.frames.size(), 1U);
  EXPECT_NEAR(all.frames[0].depth_m.at(0, 0), 0.1236 * std::tan(500 / 2842.5 + 1.1863), 1e-6);
  EXPECT_EQ(all.frames[0].depth_m.at(1, 0), 0.0F);
}

TEST(Fakenect, BrokenListsAndFilesAreNamed) {
  const TemporaryFolder folder;
  write_recording(folder.path() / "r", RecordingFormat::kFakenect, 4, 640, 480);
  fs::path depth_file;
  for (const auto& entry : fs::directory_iterator(folder.path() / "r"))
    if (entry.path().filename().string().starts_with("d-100.066")) depth_file = entry.path();
  cut_to(depth_file, 0.5);
  const auto all = read_all(*open_folder(folder.path() / "r"));
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_EQ(all.frames.size(), 3U);
  EXPECT_TRUE(contains(all.faults[0], depth_file.filename().string()) && contains(all.faults[0], "cut short"))
      << all.faults[0];
  std::ofstream(folder.path() / "r" / "INDEX.txt", std::ios::app) << "d-10.\n";
  const std::string said =
      decisions_about([&](const SourceOptions& options) { return open_folder(folder.path() / "r", options); });
  EXPECT_TRUE(contains(said, "1 line of INDEX.txt is left out") && contains(said, "'d-10.' is not of the form")) << said;
}

// ---- intrinsics ----

TEST(Intrinsics, OfOtherSizesAreRefusedWithBothSizes) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  SourceOptions options;
  options.depth_camera = Intrinsics{640, 480, 585, 585, 320, 240};
  for (const std::string& message : {error_of([&] { open_folder(folder.path(), options); }), [&] {
                                       CameraRig rig = read_camera_file(folder.path() / "camera.json");
                                       rig.depth_camera = *options.depth_camera;
                                       write_camera_file(rig, folder.path() / "camera.json");
                                       return error_of([&] { open_folder(folder.path()); });
                                     }()}) {
    EXPECT_TRUE(contains(message, "640 x 480") && contains(message, "16 x 12")) << message;
  }
  fs::remove(folder.path() / "camera.json");
  write_text(folder.path() / "camera-intrinsics.txt", "585 0 320\n0 585 240\n0 0 1\n");
  EXPECT_TRUE(contains(error_of([&] { open_folder(folder.path()); }), "16 x 12"));
}

TEST(Intrinsics, GoFromTheCallerToTheFileToTheFormat) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  const auto depth_camera = [&](const SourceOptions& options = {}) {
    return read_all(*open_folder(folder.path(), options)).frames.at(0).depth_camera;
  };
  SourceOptions chosen;
  chosen.depth_camera = Intrinsics{16, 12, 33, 34, 7, 5};
  EXPECT_EQ(depth_camera(chosen), *chosen.depth_camera);
  EXPECT_EQ(depth_camera(), some_frame(0).depth_camera);
  fs::remove(folder.path() / "camera.json");
  EXPECT_NEAR(depth_camera().fx_px, 585.0 * 16 / 640, 1e-9);  // scaled to the images' width
  write_text(folder.path() / "camera-intrinsics.txt", "20 0 8\n0 21 6\n0 0 1\n");
  EXPECT_EQ(depth_camera(), (Intrinsics{16, 12, 20, 21, 8, 6}));
  for (const char* text : {"[[20, 0, 8],\n [0, 21, 6],\n [0, 0, 1]]\n", "20 0 8 0\n0 21 6 0\n0 0 1 0\n",
                           "20;0;8\n0;21;6\n0;0;1\n", "20 0 8 0\n0 21 6 0\n0 0 1 0\n0 0 0 1\n"}) {
    write_text(folder.path() / "camera-intrinsics.txt", text);
    EXPECT_EQ(depth_camera(), (Intrinsics{16, 12, 20, 21, 8, 6})) << text;
  }
}

TEST(Intrinsics, BrokenFilesAreNamed) {
  const auto fails = [](const char* name, const std::string& text) {
    const TemporaryFolder folder;
    write_recording(folder.path(), RecordingFormat::kSevenScenes);
    fs::remove(folder.path() / "camera.json");
    write_text(folder.path() / name, text);
    const std::string message = error_of([&] { open_folder(folder.path()); });
    EXPECT_TRUE(contains(message, name)) << message;
    return message;
  };
  EXPECT_TRUE(contains(fails("camera-intrinsics.txt", "1 2 3"), "3 numbers"));
  EXPECT_TRUE(contains(fails("camera-intrinsics.txt", "20 0 8\n0 nan 6\n0 0 1\n"), "fy_px"));
  EXPECT_TRUE(contains(fails("camera-intrinsics.txt", "20 0 8\n0 x 6\n0 0 1\n"), "'x' is not a number"));
  const std::string head = R"({"format": "roomradar camera", "version": 1, "depth": )";
  const std::string depth =
      R"({"width_px": 16, "height_px": 12, "fx_px": 14, "fy_px": 14, "cx_px": 8, "cy_px": 6})";
  EXPECT_TRUE(contains(fails("camera.json", head + depth), "not JSON"));
  EXPECT_TRUE(contains(fails("camera.json", "{}"), "'format' is missing"));
  EXPECT_TRUE(contains(fails("camera.json", R"({"command": "run", "settings": {}})"),
                       "is not a roomradar camera: the field 'format' is missing; the file is the report of "
                       "`roomradar run`"));
  EXPECT_TRUE(contains(fails("camera.json", "[1, 2]"), "missing"));
  EXPECT_TRUE(contains(fails("camera.json", R"({"format": "roomradar camera", "version": 2})"), "version 2"));
  const std::string deep = std::string(400'000, '[') + std::string(400'000, ']');
  EXPECT_TRUE(contains(fails("camera.json", R"({"format": )" + deep + "}"), "'format' is not a string"));
  EXPECT_TRUE(contains(fails("camera.json", head + R"({"width_px": 16})" + "}"), "'height_px' is missing"));
  EXPECT_TRUE(
      contains(fails("camera.json", head + R"({"width_px": "16"})" + "}"), "width_px is not a number"));
  EXPECT_TRUE(contains(
      fails(
          "camera.json",
          head + depth +
              R"(, "depth_noise": {"base_m": 0, "linear": 0, "quadratic_per_m": 0, "from_m": 0, "grazing": 0}})"),
      "depth_noise: is not a valid noise model"));
  EXPECT_TRUE(
      contains(fails("camera.json", head + depth + R"(, "T_colour_depth": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})"),
               "four rows"));
  EXPECT_TRUE(
      contains(fails("camera.json",
                     head + depth + R"(, "T_colour_depth": [[3,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})"),
               "rigid"));
}

TEST(CameraFile, ComesBackAsWritten) {
  const TemporaryFolder folder;
  const Frame frame = some_frame(2);
  CameraRig rig{frame.depth_camera, frame.colour_camera, *frame.T_world_camera, false, {}};
  rig.depth_noise = {0.003F, 0.008F, 0.001F, 0.25F, 0.0F};
  write_camera_file(rig, folder.path() / "camera.json");
  const CameraRig read = read_camera_file(folder.path() / "camera.json");
  EXPECT_EQ(read.depth_camera, rig.depth_camera);
  EXPECT_EQ(read.colour_camera, rig.colour_camera);
  EXPECT_EQ(read.depth_noise, rig.depth_noise);
  for (int i = 0; i < 50; ++i) {  // to the bit: a copy of a recording gives the same map
    rig.T_colour_depth = Eigen::Translation3d(0.01 * i, 0.3, 0.7) *
                         Eigen::AngleAxisd(0.07 * i, Eigen::Vector3d(1, i, 2).normalized());
    write_camera_file(rig, folder.path() / "camera.json");
    EXPECT_EQ(read_camera_file(folder.path() / "camera.json").T_colour_depth.matrix(),
              rig.T_colour_depth.matrix());
  }
}

TEST(OpenFolder, RewindsAndSeeks) {
  const TemporaryFolder folder;
  write_recording(folder.path(), RecordingFormat::kSevenScenes);
  const auto source = open_folder(folder.path());
  Frame frame;
  ASSERT_TRUE(source->seek(4));
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 4);
  EXPECT_FALSE(source->seek(kFrames));
  ASSERT_TRUE(source->rewind());
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 0);
}

}  // namespace
}  // namespace roomradar::sources_folder_test
