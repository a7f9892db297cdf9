// source_list_test.cpp: recordings are recognised, and what is none is left out or named.
#include "app/start/source_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "app/sim/sensor/sim_options.hpp"
#include "app/sim/simulate.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::source_list_test {
namespace {

namespace fs = std::filesystem;

TEST(SourceList, FindsRecordingsHereAndInTheFolderOfRecordings) {
  const TemporaryFolder folder;
  const fs::path here = folder.path();
  const SimOptions options = parse_sim_spec("sim:wall?frames=3&width=64");
  simulate(here / "b", options, RecordingFormat::kTum);
  simulate(here / "recordings/a", options, RecordingFormat::kSevenScenes);
  fs::create_directories(here / "empty");
  fs::create_directories(here / ".hidden");
  fs::create_directories(here / "texts");
  std::ofstream(here / "texts/notes.txt") << "x";
  add_litter(here);
  const std::vector<SourceEntry> entries = list_recordings(here);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].source, (here / "b").string());
  EXPECT_EQ(entries[1].source, (here / "recordings/a").string());
  for (const SourceEntry& entry : entries) {
    EXPECT_EQ(entry.kind, SourceKind::kRecording);
    EXPECT_TRUE(entry.detail.ends_with(" recording, 3 frames")) << entry.detail;
    EXPECT_EQ(entry.fault, "");
    EXPECT_EQ(entry.play_source, entry.source);
    EXPECT_EQ(entry.check_command, "roomradar check " + entry.source);
  }
  EXPECT_EQ(list_recordings(here / "b").size(), 1U);  // the folder itself
  EXPECT_TRUE(list_recordings(here / "not here").empty());
}

TEST(SourceList, FindsRecordingsOfOtherPrograms) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "phone/depth");
  std::ofstream(folder.path() / "phone/metadata")
      << R"({"w":8,"h":6,"dw":4,"dh":3,"K":[5,0,0,0,5,0,4,3,1],"poses":[]})";
  std::ofstream(folder.path() / "phone/depth/0.exr") << "not read here";
  std::ofstream(folder.path() / "cut.mkv") << "\x1A\x45\xDF\xA3";
  const std::vector<SourceEntry> entries = list_recordings(folder.path());
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_EQ(entries[0].detail, "Record3D export, 1 frame");
  fs::rename(folder.path() / "phone", folder.path() / "my phone");
  EXPECT_EQ(describe_source((folder.path() / "my phone").string()).check_command,
            "roomradar check '" + (folder.path() / "my phone").string() + "'");
  EXPECT_EQ(describe_source("sim:table").check_command, "");
  EXPECT_NE(describe_source((folder.path() / "cut.mkv").string()).fault.find("cut.mkv: is"),
            std::string::npos);
}

TEST(SourceList, EverySimulatedRoomCanBeScannedAndPlayedIn) {
  const std::vector<SourceEntry> rooms = list_simulated_rooms();
  EXPECT_GE(rooms.size(), 4U);
  for (const SourceEntry& room : rooms) {
    EXPECT_EQ(room.fault, "");
    EXPECT_EQ(parse_sim_spec(room.source).path, CameraPathKind::kScan) << room.source;
    EXPECT_EQ(parse_sim_spec(room.play_source).path, CameraPathKind::kView) << room.play_source;
    EXPECT_EQ(parse_sim_spec(room.play_source).room, parse_sim_spec(room.source).room);
  }
}

TEST(SourceList, WhatIsNoSourceIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "walk.bag") << "#ROSBAG V2.0\n";
  EXPECT_NE(describe_source((folder.path() / "walk.bag").string()).fault.find("walk.bag"), std::string::npos);
  EXPECT_NE(describe_source((folder.path() / "none").string()).fault.find("none"), std::string::npos);
  EXPECT_NE(describe_source("sim:nowhere").fault.find("nowhere"), std::string::npos);
  EXPECT_NE(describe_source("kinect:7").fault.find("kinect:7: is not plugged in"), std::string::npos);
}

TEST(SourceList, ADeviceMayHaveItsOwnOptions) {
  const SourceEntry xtion = describe_source("openni:0");
  EXPECT_EQ(xtion.kind, SourceKind::kKinect);
  EXPECT_EQ(xtion.fault, "");
  for (const SourceEntry& kinect : list_kinects()) {
    const SourceEntry metric = describe_source(kinect.source + "?depth=mm");
    EXPECT_EQ(metric.source, kinect.source + "?depth=mm");
    EXPECT_EQ(metric.name, kinect.name);
  }
}

}  // namespace
}  // namespace roomradar::test::source_list_test
