// player_test.cpp: a user's mouse actions become script events, on a known floor.
#include "app/window/link/player.hpp"
#include "app/session/script/session_events.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "app/cli/interrupt.hpp"
#include "app/run/opened_run.hpp"
#include "app/run/run_loop.hpp"
#include "app/window/link/key_meant.hpp"
#include "app/window/link/play_host.hpp"
#include "app/window/link/ui_channel.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::player_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
const Eigen::Isometry3d kAtTheFloor = test::looking_at({0.0, -1.2, 1.2}, {0.0, 0.0, 0.0});

/// A level floor of 4 x 4 m at z = 0.
SavedMap floor_map() {
  SavedMap map;
  map.mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  map.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return map;
}

/// A session on that floor with one pot, and a camera that looks down at it.
class Playing : public ::testing::Test {
 protected:
  void SetUp() override {
    apply(session_, {AddObject{.name = "pot", .source = {.mesh = "teapot"}}});
    step();
  }
  void step() {
    frame_.index = frames_;
    frame_.stamp_s = static_cast<double>(frames_++) / 30.0;
    frame_.depth_camera = kCamera;
    frame_.depth_m.resize(kCamera.width_px, kCamera.height_px, 0.0F);
    frame_.T_world_camera = kAtTheFloor;
    result_ = session_.step(frame_, times_);
  }
  /// Applies the events of one user command, and advances one frame.
  std::vector<ScriptEvent> play(const UserCommand& command) {
    std::vector<ScriptEvent> events = player_.events_of({&command, 1}, session_);
    for (const ScriptEvent& event : events) apply(session_, event);
    step();
    return events;
  }
  /// Pixel of the picture at which a point appears.
  static Eigen::Vector2d pixel_of(const Vec3& p_world) {
    return project(kCamera, kAtTheFloor.inverse() * p_world);
  }
  static AddNew new_teapot() { return {{.mesh = "teapot"}}; }
  [[nodiscard]] const VirtualObject& pot() const { return *session_.objects().front(); }
  [[nodiscard]] Vec3 position() const { return pot().body.T_world_object.translation(); }
  /// Centre of the pot, where it appears in the picture.
  [[nodiscard]] Vec3 middle() const { return pot().body.T_world_object * pot().model->middle; }

  static SessionConfig config() {
    SessionConfig config;
    config.poses = PoseOrigin::kRecorded;
    return config;
  }
  SavedMap map_ = floor_map();
  Session session_{map_, config()};
  Player player_;
  StageTimes times_;
  Frame frame_;
  FrameResult result_;
  std::int64_t frames_ = 0;
};

TEST_F(Playing, AnObjectIsDroppedWhereOneClicks) {
  const Vec3 there(0.3, 0.2, 0.0);
  EXPECT_TRUE(play(GrabObject{.pixel = pixel_of(there)}).empty());  // there is nothing to grab
  const auto events = play(LetGo{.pixel = pixel_of(there), .height_m = 0.25});
  ASSERT_EQ(events.size(), 1U);
  const auto& drop = std::get<DropObject>(events[0].action);
  EXPECT_EQ(drop.name, "pot");
  EXPECT_FALSE(drop.position_world);
  ASSERT_TRUE(drop.near_world);
  EXPECT_LT((*drop.near_world - there).norm(), 1e-6);
  EXPECT_EQ(drop.height_m, 0.25);
  for (int i = 0; i < 60; ++i) step();
  EXPECT_TRUE(pot().body.asleep);
  EXPECT_LT((middle() - there).head<2>().norm(), 0.03);  // places are 2 cm apart
}

TEST_F(Playing, AnObjectIsPlacedOntoTheSurface) {
  const auto events = play(PlaceChosen{.pixel = pixel_of({-0.4, 0.1, 0.0})});
  ASSERT_EQ(events.size(), 1U);
  const Vec3 position_world = std::get<PlaceObject>(events[0].action).position_world;
  EXPECT_NEAR(position_world.z() + lowest_m(pot()), 0.002, 1e-6);
  const Vec3 to_middle = level_to_middle(pot(), Eigen::Matrix3d::Identity());
  EXPECT_NEAR(position_world.x() + to_middle.x(), -0.4, 1e-6);
}

TEST_F(Playing, WhatIsTurnedWhileItIsDraggedStaysUnderTheMouse) {
  play(PlaceChosen{.pixel = pixel_of(Vec3::Zero())});
  play(GrabObject{.pixel = pixel_of(middle())});
  const Vec3 there = middle() + Vec3(0.0, 0.0, 0.3);
  for (int i = 0; i < 10; ++i) play(DragGrabbed{.pixel = pixel_of(there)});
  const Vec3 held = middle();
  play(TurnGrabbed{{90.0, 0.0, 0.0}});
  for (int i = 0; i < 3; ++i) play(DragGrabbed{.pixel = pixel_of(there)});
  EXPECT_LT((middle() - held).norm(), 0.005);
}

TEST_F(Playing, WhatIsDraggedFollowsTheMouseAndStopsAtTheFloor) {
  play(PlaceChosen{.pixel = pixel_of(Vec3::Zero())});
  for (int i = 0; i < 30; ++i) step();
  ASSERT_TRUE(play(GrabObject{.pixel = pixel_of(middle())}).empty());
  EXPECT_TRUE(player_.is_grabbed());
  // Half a metre to the right and up, at the distance at which it was grabbed.
  const Vec3 before = position();
  const double distance_m = (middle() - kAtTheFloor.translation()).norm();
  for (int i = 1; i <= 10; ++i) play(DragGrabbed{.pixel = pixel_of(middle() + Vec3(0.05, 0.0, 0.04))});
  for (int i = 0; i < 3; ++i) step();
  EXPECT_GT(position().x(), before.x() + 0.2);
  EXPECT_GT(position().z(), before.z() + 0.1);
  EXPECT_NEAR((middle() - kAtTheFloor.translation()).norm(), distance_m, 0.1);
  const Vec3 held = position();
  for (int i = 0; i < 20; ++i) step();
  EXPECT_LT((position() - held).norm(), 1e-6) << "it hangs in the air while it is held";
  // This would carry it through the floor if nothing stopped it.
  for (int i = 0; i < 10; ++i) play(DragGrabbed{.pixel = pixel_of({0.3, -0.4, 0.0})});
  EXPECT_GT(position().z() + lowest_m(pot()), -1e-6);
  const auto events = play(LetGo{.pixel = pixel_of({0.3, -0.4, 0.0})});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<ReleaseObject>(events[0].action));
  EXPECT_FALSE(player_.is_grabbed());
  EXPECT_FALSE(pot().carried_to_world);
}

TEST_F(Playing, WhatIsDraggedAndLetGoBetweenTwoFramesIsCarriedThere) {
  play(PlaceChosen{.pixel = pixel_of(Vec3::Zero())});
  for (int i = 0; i < 30; ++i) step();
  const Vec3 before = position(), way(0.2, 0.0, 0.3);
  const std::vector<UserCommand> commands = {GrabObject{.pixel = pixel_of(middle())},
                                             DragGrabbed{.pixel = pixel_of(middle() + way)},
                                             LetGo{.pixel = pixel_of(middle() + way)}};
  const std::vector<ScriptEvent> first = player_.events_of(commands, session_);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<CarryObject>(first[0].action));
  apply(session_, first[0]);
  step();
  EXPECT_GT((position() - before).norm(), 0.2);
  const std::vector<ScriptEvent> second = player_.events_of({}, session_);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<ReleaseObject>(second[0].action));
  EXPECT_TRUE(player_.events_of({}, session_).empty());
}

TEST_F(Playing, RemovingAnotherObjectDoesNotLeaveTheHeldOneHanging) {
  play(PlaceChosen{.pixel = pixel_of(Vec3::Zero())});
  play(new_teapot());
  play(PlaceChosen{.pixel = pixel_of(Vec3(0.5, 0.0, 0.0))});
  play(GrabObject{.pixel = pixel_of(middle())});
  play(DragGrabbed{.pixel = pixel_of(middle() + Vec3(0.0, 0.0, 0.2))});
  ASSERT_TRUE(pot().carried_to_world);
  play(ChooseObject{"teapot"});
  ASSERT_EQ(object_of(play(RemoveChosen{}).at(0).action), "teapot");
  EXPECT_TRUE(player_.is_grabbed());
  play(LetGo{.pixel = pixel_of(middle())});
  EXPECT_FALSE(pot().carried_to_world);
}

TEST_F(Playing, WhatIsLetGoInMotionFliesOnAsFastAsTheMouseWas) {
  play(PlaceChosen{.pixel = pixel_of(Vec3::Zero())});
  play(GrabObject{.pixel = pixel_of(middle())});
  play(DragGrabbed{.pixel = pixel_of(middle() + Vec3(0.0, 0.0, 0.2))});
  LetGo let_go{.pixel = pixel_of(middle() + Vec3(0.02, 0.0, 0.2))};
  let_go.pixel_velocity_s = {146.0, 0.0};  // one metre per second, at a distance of one metre
  const auto events = play(let_go);
  ASSERT_EQ(events.size(), 1U);
  const double distance_m = (middle() - kAtTheFloor.translation()).norm();
  const Vec3 velocity_world_mps = std::get<ReleaseObject>(events[0].action).velocity_world_mps;
  EXPECT_NEAR(velocity_world_mps.x(), distance_m, 0.15 * distance_m);
  EXPECT_NEAR(velocity_world_mps.y(), 0.0, 0.1);
}

TEST_F(Playing, AThrownObjectFliesThroughThePixel) {
  const auto events = play(ThrowChosen{pixel_of({0.5, 0.5, 0.0}), /*speed_mps=*/4.0});
  ASSERT_EQ(events.size(), 1U);
  const Vec3 velocity_world_mps = std::get<ThrowObject>(events[0].action).velocity_world_mps;
  EXPECT_NEAR(velocity_world_mps.norm(), 4.0, 1e-9);
  const Vec3 to_there = Vec3(0.5, 0.5, 0.0) - kAtTheFloor.translation();
  EXPECT_NEAR(velocity_world_mps.normalized().dot(to_there.normalized()), 1.0, 1e-9);
}

TEST_F(Playing, AnotherObjectHasANameOfItsOwnAndIsChosen) {
  const auto events = play(new_teapot());
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(std::get<AddObject>(events[0].action).name, "teapot");
  EXPECT_EQ(player_.chosen(), "teapot");
  EXPECT_EQ(object_of(play(new_teapot())[0].action), "teapot2");
  EXPECT_EQ(session_.objects().size(), 3U);
  const auto reset = play(ResetObjects{});
  EXPECT_EQ(std::get<DropObject>(reset.back().action).name, "teapot2");
}

TEST_F(Playing, ResetLeavesNoDropWaiting) {
  apply(session_, {AddObject{.name = "other", .source = {.mesh = "teapot"}}});
  apply(session_, {DropObject{.name = "other"}});  // waits for the next frame
  (void)play(ResetObjects{});
  EXPECT_TRUE(session_.objects()[0]->in_room);
  EXPECT_FALSE(session_.objects()[1]->in_room);
}

TEST_F(Playing, WhereThereIsNothingTheUserIsTold) {
  const UserCommand at_the_sky = DropChosen{.pixel = pixel_of({0.0, 40.0, 0.0})};
  EXPECT_TRUE(play(at_the_sky).empty());
  EXPECT_NE(player_.complaint().find("no surface"), std::string::npos);
  EXPECT_EQ(play(DropChosen{.pixel = pixel_of(Vec3::Zero())}).size(), 1U);
  EXPECT_TRUE(player_.complaint().empty());
}

TEST_F(Playing, UnknownSpaceIsSolidWithTheMapsSurfacesOnly) {
  const ScriptEvent solid{SetUnknown{.is_solid = true}};
  apply(session_, {SetSurfaces{SurfacePolicy::kSkirt}});
  EXPECT_EQ(session_.config().scene.surfaces, SurfacePolicy::kSkirt);
  EXPECT_THROW(apply(session_, solid), Error);
  EXPECT_FALSE(session_.unknown_is_solid());
  apply(session_, {SetSurfaces{SurfacePolicy::kMap}});
  apply(session_, solid);
  EXPECT_TRUE(session_.unknown_is_solid());
  const auto has_border = [&] {
    const std::vector<SceneTree> surfaces = session_.scene().surfaces();
    return std::any_of(surfaces.begin(), surfaces.end(), [](const SceneTree& surface) {
      return surface.kind == SurfaceKind::kUnknownFrontier;
    });
  };
  EXPECT_TRUE(has_border());
  apply(session_, {SetSurfaces{SurfacePolicy::kHoles}});  // and back again
  EXPECT_FALSE(has_border());
  apply(session_, {SetSurfaces{SurfacePolicy::kMap}});
  EXPECT_TRUE(has_border());
}

TEST(TurnOfDrag, TheSideThatFacesTheCameraGoesWithTheMouse) {
  const Vec3 target(0.0, 0.0, 0.0);
  const Vec3 places[] = {{0.0, -2.0, 0.0}, {0.0, -1.2, 1.2}, {1.0, 1.0, -1.0}, {0.0, -0.05, 2.0}};
  for (const Vec3& place : places)
    for (const double roll_deg : {0.0, 30.0, 90.0, 180.0, 270.0}) {
      const Eigen::Matrix3d R_world_view =
          test::looking_at(place, target).linear() *
          Eigen::AngleAxisd(roll_deg * M_PI / 180.0, Vec3::UnitZ()).toRotationMatrix();
      const Vec3 near_world = -0.1 * R_world_view.col(2);
      for (const Eigen::Vector2d& way_px : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
        const Vec3 turn_world_deg = turn_of_drag_world_deg(R_world_view, way_px);
        const Vec3 goes_view = R_world_view.transpose() * turn_world_deg.cross(near_world);
        EXPECT_GT(goes_view.head<2>().dot(way_px), 0.01)
            << "from " << place.transpose() << " rolled " << roll_deg << " by " << way_px.transpose();
      }
    }
  // An upright object stays upright when the mouse moves sideways.
  const Vec3 aside_deg = turn_of_drag_world_deg(kAtTheFloor.linear(), {1.0, 0.0});
  EXPECT_TRUE(aside_deg.isApprox(0.5 * Vec3::UnitZ()));
}

TEST(KeyMeant, IsWhatTheKeyTypesWhereThatIsOneLetterOrSign) {
  constexpr int kOfA = 'A', kOfMinus = '-', kOfSlash = '/', kHome = 268, kOfKeypadPlus = 334;
  EXPECT_EQ(key_meant(kOfA, "a"), 'A');
  EXPECT_EQ(key_meant(kOfA, "q"), 'Q') << "a French keyboard";
  EXPECT_EQ(key_meant(kOfSlash, "-"), '-') << "a German keyboard";
  EXPECT_EQ(key_meant(kOfMinus, "ß"), kOfMinus);
  EXPECT_EQ(key_meant(kOfA, "ф"), kOfA) << "a Russian keyboard";
  EXPECT_EQ(key_meant(kOfA, nullptr), kOfA);
  EXPECT_EQ(key_meant(kHome, nullptr), kHome);
  EXPECT_EQ(key_meant(kOfKeypadPlus, "+"), kOfKeypadPlus);
}

/// A device that never delivers a frame.
class NoFrames : public FrameSource {
 public:
  ReadResult next(Frame& /*frame*/) override { return {}; }
  bool rewind() override { return false; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return {}; }
  [[nodiscard]] std::string name() const override { return "none"; }
};

class Hosted : public Playing {
 protected:
  /// Returns the next events from a pending command, or none after half a minute.
  std::vector<ScriptEvent> awaited_events() {
    for (int tries = 0; tries < 3000; ++tries) {
      std::vector<ScriptEvent> events = host_.take_events();
      said_ += link_.take_message();
      if (!events.empty()) return events;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
  }
  std::string said_;
  UiChannel link_;
  PlaybackSource source_{std::make_unique<NoFrames>(), AtEnd::kEnd};
  PlayHost host_{link_, session_, source_, times_, shown_room(map_), /*is_live=*/true};
};

TEST_F(Hosted, ANewObjectComesOnceItIsReadyAndTheSameAsOneThatWasWaitedFor) {
  AddNew command = new_teapot();
  command.source.size_m = 0.25;  // no model of that size exists yet
  link_.ask(command);
  EXPECT_TRUE(host_.take_events().empty());  // it takes longer than this
  const std::vector<ScriptEvent> events = awaited_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<AddObject>(events[0].action));
  EXPECT_TRUE(std::holds_alternative<DropObject>(events[1].action));
  session_.add_object(object_of(events[0].action), host_.take_parts());
  const ObjectModel& model = *session_.objects().back()->model;
  auto waited_for = std::get<AddObject>(events[0].action);
  waited_for.name = "another";
  apply(session_, {waited_for});
  EXPECT_EQ(session_.objects().back()->model.get(), &model);  // same mesh, so it shares the model
  const ObjectParts parts = object_parts("pot", object_mesh("teapot", 0.25));
  ASSERT_EQ(model.levels().size(), parts.levels->size());
  EXPECT_GT(parts.levels->size(), 0U);
  EXPECT_EQ(model.mass.mass_kg, parts.mass.mass_kg);
}

TEST_F(Hosted, AMeshThatCannotBeReadIsSaidAndThoseAfterItCome) {
  link_.ask(AddNew{{.mesh = "/nowhere/chair.ply"}});
  link_.ask(new_teapot());
  link_.ask(new_teapot());
  std::vector<ScriptEvent> events = awaited_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(std::get<AddObject>(events[0].action).source.mesh, "teapot");
  EXPECT_NE(said_.find("/nowhere/chair.ply"), std::string::npos);
  session_.add_object(object_of(events[0].action), host_.take_parts());
  events = awaited_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(object_of(events[0].action), "teapot2");
}

TEST_F(Hosted, AfterAPauseADevicesTimeGoesOnWhereItWas) {
  EXPECT_TRUE(host_.take_events().empty());
  link_.set_paused(true);
  link_.step();
  for (const bool is_paused : {true, false}) {
    link_.set_paused(is_paused);
    const std::vector<ScriptEvent> events = host_.take_events();
    ASSERT_EQ(events.size(), 1U);
    EXPECT_EQ(events[0].action, Action(PlayCamera{CameraPlay::kResume}));
    ScriptEvent line = events[0];
    line.frame = 7;
    EXPECT_EQ(to_line(line), "frame 7 camera resume");
  }
  EXPECT_TRUE(host_.take_events().empty());
}

TEST_F(Hosted, ADropThatFindsNoSurfaceIsSaidToWaitOnce) {
  apply(session_, {DropObject{.name = "pot"}});
  frame_.T_world_camera.reset();  // the pose is unknown
  result_ = session_.step(frame_, times_);
  host_.show(0, 0.0, frame_, result_);
  EXPECT_NE(link_.take_message().find("pot waits for a level surface"), std::string::npos);
  host_.show(1, 0.1, frame_, result_);
  EXPECT_EQ(link_.take_message(), "");
}

/// A source during whose reading a user adds an object from a mesh file and turns it, until an error is
/// reported.
class AskedMeanwhile : public NoFrames {
 public:
  AskedMeanwhile(UiChannel& link, const std::string& mesh, std::string& said)
      : link_(link), said_(said), command_(AddNew{{.mesh = mesh}}) {}
  ReadResult next(Frame& frame) override {
    said_ += link_.take_message();
    if (said_.find("cannot be copied") != std::string::npos) frames_left_ = std::min(frames_left_, 5);
    if (--frames_left_ == 0) return {};
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    link_.ask(command_);
    command_ = TurnGrabbed{};
    frame.depth_camera = kCamera;
    frame.depth_m.resize(kCamera.width_px, kCamera.height_px, 0.0F);
    frame.stamp_s += 0.01;
    return {ReadStatus::kFrame, {}};
  }

 private:
  UiChannel& link_;
  std::string& said_;
  UserCommand command_;
  int frames_left_ = 6000;  // a minute
};

TEST(RecordedRun, AnObjectWhoseMeshCannotBeKeptDoesNotComeIn) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "roof.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";
  RunOptions options;
  options.map = folder.path() / "none";
  OpenedRun run(options);
  run.map = floor_map();
  run.session = std::make_unique<Session>(run.map, SessionConfig());
  run.recorder.emplace(folder.path() / "session", options, run.map.info, /*are_calibrated=*/false);
  std::ofstream(folder.path() / "session" / "meshes") << "where the folder of meshes should be";
  UiChannel link;
  std::string said;
  auto source = std::make_unique<PlaybackSource>(
      std::make_unique<AskedMeanwhile>(link, (folder.path() / "roof.obj").string(), said), AtEnd::kEnd);
  run.playback = source.get();
  run.source = std::move(source);
  run.host.emplace(link, *run.session, *run.playback, run.report.times, shown_room(run.map),
                   /*is_live=*/true);
  play_to_end(run);
  EXPECT_NE(said.find("cannot be copied"), std::string::npos) << said;
  EXPECT_TRUE(run.session->objects().empty());
  EXPECT_NO_THROW(static_cast<void>(read_script(folder.path() / "session" / "events.txt")));
}

TEST(UiChannel, APausedSessionWaitsForAStepOrTheEnd) {
  UiChannel link;
  link.set_paused(true);
  link.step();
  int refreshed = 0;
  link.want({.radar = true, .models = false});
  EXPECT_TRUE(link.wait_turn(1.0, true, [&] { ++refreshed; }));
  EXPECT_EQ(refreshed, 1);
  link.close();
  EXPECT_FALSE(link.wait_turn(2.0, true, [] {}));
}

TEST(UiChannel, CtrlCEndsAPausedSession) {
  const Interrupt interrupt;
  UiChannel link;
  link.set_paused(true);
  std::raise(SIGINT);
  EXPECT_FALSE(link.wait_turn(1.0, true, [] {}));
  EXPECT_TRUE(Interrupt::take()) << "whoever reads the source is told, too";
}

TEST(UiChannel, OfManyDragsOnlyTheNewestCountsAndTheOrderOfTheRestStays) {
  UiChannel link;
  link.ask(GrabObject{});
  for (const double x : {2.0, 3.0, 4.0}) link.ask(DragGrabbed{.pixel = {x, 0.0}});
  link.ask(LetGo{});
  const std::vector<UserCommand> commands = link.take_commands();
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(std::get<DragGrabbed>(commands[1]).pixel.x(), 4.0);
  EXPECT_TRUE(std::holds_alternative<LetGo>(commands[2]));
  EXPECT_TRUE(link.take_commands().empty());
}

TEST(UiChannel, TurnsBetweenTwoFramesAddUpAsFarAsAScriptCanSayThem) {
  UiChannel link;
  const TurnGrabbed turn{{0.5, 0.0, -1.0}};
  const auto turn_world_deg = [](const UserCommand& command) {
    return std::get<TurnGrabbed>(command).turn_world_deg;
  };
  for (int i = 0; i < 1000; ++i) link.ask(turn);
  std::vector<UserCommand> commands = link.take_commands();
  ASSERT_EQ(commands.size(), 1U);
  EXPECT_TRUE(turn_world_deg(commands[0]).isApprox(Vec3(500.0, 0.0, -1000.0)));
  for (int i = 0; i < 5000; ++i) link.ask(turn);
  commands = link.take_commands();
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(turn_world_deg(commands[0]).z(), -3600.0);
  EXPECT_EQ(turn_world_deg(commands[1]).z(), -1400.0);
  link.ask(turn);
  link.ask(ChooseObject{});
  link.ask(turn);
  EXPECT_EQ(link.take_commands().size(), 3U) << "of two objects, maybe";
}

}  // namespace
}  // namespace roomradar::player_test
