// script_test.cpp: event files, valid and invalid.
#include "app/session/script/script.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include "mapping/types/system/error.hpp"

namespace roomradar::script_test {
namespace {

std::string message_of(const std::string& text) {
  try {
    (void)parse_script(text, "events.txt");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Returns the event's action, which is of this kind.
template <typename Kind>
const Kind& as(const ScriptEvent& event) {
  return std::get<Kind>(event.action);
}
template <typename Kind>
Kind& as(ScriptEvent& event) {
  return std::get<Kind>(event.action);
}

constexpr const char* kWhole = R"(# the whole language
frame 0    add pot teapot size 0.2
frame 10   drop pot view height 0.4    # over what is seen
time 2.5   drop pot at 0.4 -0.1 0.75

time 4     place pot 0.4 -0.1 0.9
time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 5e-1
frame 200  remove pot
time 8     commit
time 9     turn pot 0 0 -45.5
frame 250  carry pot 0.4 -0.1 1
frame 251  release pot velocity 0.1 0 0
frame 252  surfaces border
frame 253  unknown solid
frame 254  radar sampled 48
frame 255  camera hold
frame 256  quality depth_stride 2 mesh_tolerance_sigmas 0.1 radar sampled shadows off
frame 257  quality from physics move_every_n_frames 4
frame 300  quit
)";

TEST(Script, AnObjectMayBeAddedWithASizeAndAnAxisThatPointsUp) {
  for (const char* line :
       {"frame 0 add chair chair.obj size 0.9 up -y", "frame 0 add chair chair.obj up -y size 0.9"}) {
    const Script script = parse_script(std::string(line) + "\n", "test");
    ASSERT_EQ(script.events.size(), 1U);
    EXPECT_EQ(as<AddObject>(script.events[0]).source.size_m, 0.9);
    EXPECT_EQ(as<AddObject>(script.events[0]).source.up, UpAxis::kMinusY);
    EXPECT_EQ(to_line(script.events[0]), "frame 0 add chair chair.obj size 0.9 up -y");
  }
  EXPECT_FALSE(as<AddObject>(parse_script("frame 0 add chair chair.obj\n", "test").events[0]).source.up);
  for (const char* bad : {"up sideways", "up", "size 0.9 size 0.8", "up y up z", "upright"})
    EXPECT_THROW(parse_script(std::string("frame 0 add chair chair.obj ") + bad + "\n", "test"), Error)
        << bad;
}

TEST(Script, ReadsTheNameThatCommitHadBefore) {
  const Script script = parse_script("time 8 adopt", "events.txt");
  ASSERT_EQ(script.events.size(), 1U);
  EXPECT_EQ(script.events[0].action, Action(CommitChanges{}));
  EXPECT_EQ(to_line(script.events[0]), "time 8 commit");
}

TEST(Script, ReadsEachAction) {
  const Script script = parse_script(kWhole, "events.txt");
  ASSERT_EQ(script.events.size(), 17U);
  const auto& add = script.events[0];
  EXPECT_EQ(add.action, Action(AddObject{.name = "pot", .source = {.mesh = "teapot", .size_m = 0.2}}));
  EXPECT_EQ(add.line, 2);
  EXPECT_EQ(add.frame, 0);
  EXPECT_FALSE(add.time_s);
  EXPECT_EQ(script.events[1].action, Action(DropObject{.name = "pot", .height_m = 0.4}));
  EXPECT_EQ(script.events[2].time_s, 2.5);
  EXPECT_EQ(
      script.events[2].action,
      Action(DropObject{.name = "pot", .position_world = Eigen::Vector3d(0.4, -0.1, 0.75), .height_m = 0.3}));
  EXPECT_EQ(script.events[3].action, Action(PlaceObject{"pot", {0.4, -0.1, 0.9}}));
  EXPECT_EQ(script.events[4].action, Action(ThrowObject{"pot", {0.4, -0.1, 1.2}, {1, 0, 0.5}}));
  EXPECT_EQ(script.events[5].action, Action(RemoveObject{"pot"}));
  EXPECT_EQ(script.events[6].action, Action(CommitChanges{}));
  EXPECT_EQ(script.events[7].action, Action(TurnObject{"pot", {0, 0, -45.5}}));
  EXPECT_EQ(script.events[8].action, Action(CarryObject{"pot", {0.4, -0.1, 1}}));
  EXPECT_EQ(script.events[9].action, Action(ReleaseObject{"pot", {0.1, 0, 0}}));
  EXPECT_EQ(script.events[10].action, Action(SetSurfaces{SurfacePolicy::kBorder}));
  EXPECT_EQ(script.events[11].action, Action(SetUnknown{.is_solid = true}));
  EXPECT_EQ(as<SetRadar>(script.events[12]).radar.mode, RadarMode::kSampled);
  EXPECT_EQ(as<SetRadar>(script.events[12]).radar.resolution_px, 48);
  EXPECT_EQ(script.events[13].action, Action(PlayCamera{CameraPlay::kHold}));
  EXPECT_EQ(
      script.events[14].action,
      Action(SetQuality{
          {.depth_stride = 2, .mesh_tolerance_sigmas = 0.1, .radar = RadarMode::kSampled, .shadows = false},
          FramePart::kLocate}));
  EXPECT_EQ(script.events[15].action, Action(SetQuality{{.move_every_n_frames = 4}, FramePart::kPhysics}));
  EXPECT_EQ(script.events[16].action, Action(Quit{}));
  EXPECT_EQ(script.events[14].line, 17);
}

TEST(Script, AnObjectHasAMaterialFromTheBeginningOrLater) {
  const Script script = parse_script(
      "frame 0 add pot teapot friction 0.3 size 0.2 density 2700 restitution 1\n"
      "frame 9 material pot mass 2\n",
      "test");
  ASSERT_EQ(script.events.size(), 2U);
  EXPECT_EQ(as<AddObject>(script.events[0]).source.size_m, 0.2);
  EXPECT_EQ(as<AddObject>(script.events[0]).material,
            (BodyMaterial{.density_kg_m3 = 2700.0, .friction = 0.3, .restitution = 1.0}));
  EXPECT_EQ(to_line(script.events[0]),
            "frame 0 add pot teapot size 0.2 density 2700 friction 0.3 restitution 1");
  EXPECT_EQ(script.events[1].action, Action(ChangeMaterial{"pot", {.mass_kg = 2.0}}));
  EXPECT_EQ(to_line(script.events[1]), "frame 9 material pot mass 2");
}

TEST(Script, EveryEventIsWrittenAsALineThatReadsBackToTheLastBit) {
  Script script =
      parse_script(std::string(kWhole) +
                       "frame 301 throw pot 0 0 1 velocity 1 0 0 spin 0 6.1 0 turned 10 20.3 -30\n"
                       "frame 302 drop pot view height 0.1 turned 1 2 3\n",
                   "events.txt");
  // Numbers without a short decimal representation.
  as<PlaceObject>(script.events[3]).position_world = Eigen::Vector3d(1.0 / 3.0, -1e-17, 0.1 + 0.2);
  as<ThrowObject>(script.events[4]).velocity_world_mps = Eigen::Vector3d(std::sqrt(2.0), -0.0, 1e-9);
  script.events[2].time_s = 1.0 / 30.0;
  for (const CameraPlay camera :
       {CameraPlay::kHold, CameraPlay::kGo, CameraPlay::kRewind, CameraPlay::kLoop, CameraPlay::kStay})
    script.events.push_back({.action = PlayCamera{camera}, .frame = 7});
  std::string text;
  for (const ScriptEvent& event : script.events) text += to_line(event) + "\n";
  const Script again = parse_script(text, "again.txt");
  ASSERT_EQ(again.events.size(), script.events.size());
  for (std::size_t i = 0; i < script.events.size(); ++i) {
    const ScriptEvent& a = script.events[i];
    const ScriptEvent& b = again.events[i];
    EXPECT_EQ(a.frame, b.frame) << text;
    EXPECT_EQ(a.time_s, b.time_s);
    EXPECT_EQ(a.action, b.action) << to_line(a);
  }
}

TEST(Script, FormerNamesOfSettingsAreReadAndNewOnesWritten) {
  const Script script =
      parse_script("frame 1 quality mesh_sigmas 1.5 object_turns 2 shadow_turns 3 picture_turns 4\n", "test");
  ASSERT_EQ(script.events.size(), 1U);
  EXPECT_EQ(to_line(script.events[0]),
            "frame 1 quality mesh_tolerance_sigmas 1.5 move_every_n_frames 2 shadow_every_n_frames 3 "
            "picture_every_n_frames 4");
}

TEST(Script, NothingIsAScriptToo) {
  EXPECT_TRUE(parse_script("", "e").events.empty());
  EXPECT_TRUE(parse_script("\n  # only words\r\n\t\n", "e").events.empty());
}

TEST(Script, NamesFileLineAndFault) {
  const std::string add = "frame 0 add pot teapot\n";
  const struct {
    const char* text;
    const char* expected;
  } faults[] = {
      {"frame 1 jump pot", "unknown word 'jump'; expected an action: add, place,"},
      {"at 1 quit", "not with 'at'"},
      {"frame -1 quit", "'-1' is out of range"},
      {"frame 1.5 quit", "whole number"},
      {"frame one quit", "'one' is not a finite number"},
      {"time nan quit", "'nan' is not a finite number"},
      {"time inf quit", "'inf' is not a finite number"},
      {"time -0.1 quit", "'-0.1' is out of range"},
      {"time 1e999 quit", "'1e999' is not a finite number"},
      {"frame 1", "the line ends"},
      {"frame 1 place pot 0 0", "the line ends"},
      {"frame 1 place pot 0 0 nan", "'nan' is not a finite number"},
      {"frame 1 place pot 0 0 1x", "'1x' is not a finite number"},
      {"frame 1 place pot 0 0 1 2", "unexpected '2': the event is already complete"},
      {"frame 1 place pot 0 0 5e8", "'5e8' is out of range"},
      {"frame 1 drop pot 0 0 1", "expected 'at', found"},
      {"frame 1 drop pot view height -1", "'-1' is out of range"},
      {"frame 1 drop pot view hight 1", "unexpected 'hight': the event is already complete"},
      {"frame 1 throw pot 0 0 1 speed 1 0 0", "expected 'velocity', found"},
      {"frame 1 throw pot 0 0 1 velocity 1000 0 0",
       "'1000' is out of range for a velocity X Y Z (m/s), each from -100 to 100"},
      {"frame 1 commit cup", "the event is already complete"},
      {"frame 1 remove cup", "no object 'cup'"},
      {"frame 1 add pot teapot", "already added in line 1"},
      {"frame 1 add cup teapot size 0", "'0' is out of range"},
      {"frame 1 add cup teapot mass 0", "'0' is out of range for a mass (kg), 0.0001..10000"},
      {"frame 1 add cup teapot density -5", "'-5' is out of range for a density (kg/m3), 1..30000"},
      {"frame 1 add cup teapot friction 11", "'11' is out of range for a coefficient of friction, 0..10"},
      {"frame 1 add cup teapot restitution nan", "'nan' is not a finite number"},
      {"frame 1 add cup teapot mass 1 density 5", "a mass and a density exclude each other"},
      {"frame 1 add cup teapot mass 1 mass 2",
       "'mass' is not an option of add (size, up, mass, density, friction, restitution), or is given twice"},
      {"frame 1 add cup teapot sze 0.2", "'sze' is not an option of add"},
      {"frame 1 material pot", "is followed by mass, density, friction or restitution"},
      {"frame 1 material pot heavy", "is followed by mass, density, friction or restitution"},
      {"frame 1 material pot mass", "the line ends"},
      {"frame 1 quit now", "unexpected 'now': the event is already complete"},
      {"frame 1 turn pot 0 0", "the line ends"},
      {"frame 1 turn pot 0 0 4000", "'4000' is out of range"},
      {"frame 1 carry pot 0 0", "the line ends"},
      {"frame 1 release pot 1 0 0", "expected 'velocity', found"},
      {"frame 1 surfaces all",
       "unknown word 'all'; expected the surfaces that can be touched: holes, skirt, border or map"},
      {"frame 1 unknown", "the line ends"},
      {"frame 1 radar exact 0", "'0' is out of range"},
      {"frame 1 radar exact 1.5", "whole number"},
      {"frame 1 quality depth_stride 3", "depth_stride = 3: must be 1, 2 or 4"},
      {"frame 1 quality depth_stride", "the line ends"},
      {"frame 1 quality speed 3", "there is no setting \"speed\""},
      {"frame 1 quality from nowhere", "unknown word 'nowhere'"},
      {"frame 1 camera jump", "hold, go, rewind, loop, stay or resume"},
  };
  for (const auto& fault : faults) {
    const std::string message = message_of(add + fault.text);
    EXPECT_NE(message.find(fault.expected), std::string::npos) << fault.text << " -> " << message;
    EXPECT_EQ(message.rfind("events.txt:2: ", 0), 0U) << message;
  }
}

TEST(Script, RefusesWhatIsNotText) {
  const std::string binary("frame 0\0 quit", 13);
  EXPECT_NE(message_of(binary).find("is not text"), std::string::npos);
}

TEST(Script, EveryTruncationIsReadOrRefusedWithALine) {
  const std::string whole = kWhole;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string message = message_of(whole.substr(0, length));
    if (!message.empty()) {
      EXPECT_EQ(message.rfind("events.txt:", 0), 0U) << message;
    }
  }
}

class ScriptFile : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("roomradar_script_test_" + std::to_string(::getpid()));
};

TEST_F(ScriptFile, MeshFilesAreRelativeToTheScript) {
  std::ofstream(folder_ / "e.txt")
      << "frame 0 add a bunny.obj\nframe 0 add b /abs/c.ply\nframe 0 add c teapot\n";
  const Script script = read_script(folder_ / "e.txt");
  EXPECT_EQ(as<AddObject>(script.events[0]).source.mesh, (folder_ / "bunny.obj").string());
  EXPECT_EQ(as<AddObject>(script.events[1]).source.mesh, "/abs/c.ply");
  EXPECT_EQ(as<AddObject>(script.events[2]).source.mesh, "teapot");
}

TEST_F(ScriptFile, ALastLineThatWasCutIsLeftOutWhereThatIsSaid) {
  std::ofstream(folder_ / "cut.txt") << "frame 0 add pot teapot\nframe 3 drop po";
  EXPECT_THROW((void)read_script(folder_ / "cut.txt"), Error);
  EXPECT_EQ(read_script(folder_ / "cut.txt", LastLine::kMayBeCut).events.size(), 1U);
  std::ofstream(folder_ / "cut.txt") << "frame 0 add po";
  EXPECT_TRUE(read_script(folder_ / "cut.txt", LastLine::kMayBeCut).events.empty());
}

TEST_F(ScriptFile, RefusesMissingFoldersAndHugeFiles) {
  EXPECT_THROW((void)read_script(folder_ / "none.txt"), Error);
  EXPECT_THROW((void)read_script(folder_), Error);
  std::ofstream(folder_ / "huge.txt") << "#";
  std::filesystem::resize_file(folder_ / "huge.txt", (1U << 26U) + 1U);
  EXPECT_THROW((void)read_script(folder_ / "huge.txt"), Error);
}

TEST(Script, AnEventIsDueFromItsFrameOrTimeOn) {
  const Script script = parse_script("frame 3 quit\ntime 1.5 quit", "e");
  EXPECT_FALSE(is_due(script.events[0], 2, 99.0));
  EXPECT_TRUE(is_due(script.events[0], 3, 0.0));
  EXPECT_TRUE(is_due(script.events[0], 4, 0.0));
  EXPECT_FALSE(is_due(script.events[1], 99, 1.49));
  EXPECT_TRUE(is_due(script.events[1], 0, 1.5));
}

}  // namespace
}  // namespace roomradar::script_test
