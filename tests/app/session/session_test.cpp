// session_test.cpp: virtual objects on a known floor, and frames in which they cannot be placed.
#include "app/session/session.hpp"
#include "app/session/script/session_events.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <tuple>

#include "app/run/run_summary.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::session_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
const Eigen::Isometry3d kAtTheFloor = test::looking_at({0.0, -1.2, 1.2}, {0.0, 0.0, 0.0});
const Eigen::Isometry3d kAtTheSky = test::looking_at({0.0, -1.2, 1.2}, {0.0, 0.0, 3.0});

/// A level floor of 4 x 4 m at z = 0.
SavedMap floor_map() {
  SavedMap map;
  map.mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  map.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return map;
}

/// Frame of the floor from a camera without colour.
Frame depth_only(std::int64_t index, const std::optional<Eigen::Isometry3d>& T_world_camera) {
  Frame frame;
  frame.index = index;
  frame.stamp_s = static_cast<double>(index) / 30.0;
  frame.depth_camera = kCamera;
  frame.depth_m.resize(kCamera.width_px, kCamera.height_px, 2.0F);
  frame.T_world_camera = T_world_camera;
  return frame;
}

SessionConfig by_recorded_poses() {
  SessionConfig config;
  config.poses = PoseOrigin::kRecorded;
  return config;
}

ScriptEvent add_teapot(const std::string& name = "pot") {
  return {AddObject{.name = name, .source = {.mesh = "teapot"}}};
}

ScriptEvent drop_in_view(const std::string& name = "pot") { return {DropObject{.name = name}}; }

/// Requests the drop of a pot while no level surface is in view.
void let_a_drop_wait(Session& session, StageTimes& times) {
  apply(session, add_teapot());
  apply(session, drop_in_view());
  static_cast<void>(session.step(depth_only(0, kAtTheSky), times));
}

/// Shows the floor until the pot is in the room: a waiting drop is not tried in every frame.
void see_the_floor(Session& session, StageTimes& times) {
  for (std::int64_t i = 1; i <= 12 && !session.objects().front()->in_room; ++i)
    static_cast<void>(session.step(depth_only(i, kAtTheFloor), times));
}

/// Adds a green colour image with twice the resolution of the depth.
void give_colour(Frame& frame) {
  frame.colour_camera = {320, 240, 292.0, 292.0, 159.5, 119.5};
  frame.colour.resize(320, 240, {10, 200, 30});
}

/// Frame of the floor from a camera with colour.
Frame in_colour(std::int64_t index, const std::optional<Eigen::Isometry3d>& T_world_camera) {
  Frame frame = depth_only(index, T_world_camera);
  give_colour(frame);
  return frame;
}

TEST(Session, FrameWithoutColourThatIsNotLocatedShowsItsDepth) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  EXPECT_EQ(session.step(depth_only(0, std::nullopt), times).status, FrameStatus::kNotLocated);
  EXPECT_EQ(session.picture().width, kCamera.width_px);
  EXPECT_EQ(session.picture().height, kCamera.height_px);
}

TEST(Session, OneFrameWithoutColourKeepsTheLastPicture) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  Frame coloured = in_colour(0, kAtTheFloor);
  for (const Frame& frame : {coloured, depth_only(1, kAtTheFloor), depth_only(2, std::nullopt)}) {
    static_cast<void>(session.step(frame, times));
    EXPECT_EQ(session.picture().width, 320) << frame.index;
    EXPECT_EQ(session.picture().pixels, coloured.colour.pixels) << frame.index;
  }
}

TEST(Session, ACameraWhoseColourHasStoppedShowsItsDepthUntilThereIsColourAgain) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  Frame coloured = in_colour(0, kAtTheFloor);
  for (const bool is_located : {true, false}) {
    static_cast<void>(session.step(coloured, times));
    for (std::int64_t i = 1; i <= 20; ++i) {
      const auto T_world_camera = is_located ? std::optional(kAtTheFloor) : std::nullopt;
      static_cast<void>(session.step(depth_only(coloured.index + i, T_world_camera), times));
      const bool lasts = i <= 15;  // half a second
      EXPECT_EQ(session.picture().width, lasts ? 320 : 160) << "frame " << i << " located " << is_located;
    }
    coloured.index += 21;
    coloured.stamp_s = static_cast<double>(coloured.index) / 30.0;
  }
  static_cast<void>(session.step(coloured, times));
  EXPECT_EQ(session.picture().pixels, coloured.colour.pixels);
}

TEST(Session, ColourThatComesBetweenTwoPicturesIsInTheNextOne) {
  const SavedMap map = floor_map();
  SessionConfig config = by_recorded_poses();
  config.picture_every_n_frames = 2;
  Session session(map, config);
  StageTimes times;
  for (std::int64_t i = 0; i < 40; ++i) {
    Frame frame = depth_only(i, kAtTheFloor);
    if (i % 2 == 1) give_colour(frame);
    const bool is_composed = session.step(frame, times).picture_is_new;
    ASSERT_EQ(is_composed, i % 2 == 0);
    EXPECT_EQ(session.picture().width, i < 2 ? 160 : 320) << i;
  }
}

TEST(Session, ALostCameraDoesNotShowAnOlderPictureThanItHasShown) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  const Frame found = in_colour(0, kAtTheFloor);
  static_cast<void>(session.step(found, times));
  Frame lost = in_colour(1, std::nullopt);
  lost.colour.resize(320, 240, {200, 10, 30});
  static_cast<void>(session.step(lost, times));
  EXPECT_EQ(session.picture().pixels, lost.colour.pixels);
  static_cast<void>(session.step(depth_only(2, std::nullopt), times));
  EXPECT_EQ(session.picture().pixels, lost.colour.pixels);
  static_cast<void>(session.step(depth_only(3, kAtTheFloor), times));
  EXPECT_NE(session.picture().pixels, found.colour.pixels);
}

TEST(Session, WhatMovedNeedsNoColour) {
  const SavedMap map = floor_map();
  for (const bool has_colour : {false, true}) {
    Session session(map, by_recorded_poses());
    StageTimes times;
    Frame frame = depth_only(0, kAtTheFloor);
    static_cast<void>(session.step(frame, times));
    frame.depth_m = session.scene().expected().depth_m;
    for (int y = 40; y < 80; ++y)
      for (int x = 50; x < 100; ++x) frame.depth_m.at(x, y) = 0.8F;
    if (has_colour) give_colour(frame);
    FrameResult result;
    for (frame.index = 1; frame.index < 4; ++frame.index) {
      frame.stamp_s = static_cast<double>(frame.index) / 30.0;
      result = session.step(frame, times);
    }
    EXPECT_EQ(result.status, FrameStatus::kDone);
    EXPECT_EQ(result.foreground.moved, 40U * 50U) << has_colour;
    EXPECT_GT(result.dynamic_triangles, 0U) << has_colour;
    EXPECT_EQ(session.picture().width, has_colour ? 320 : 160);
  }
}

TEST(Session, WhatIsMeasuredHidesAnObjectBehindItWhereTheMapKnowsNothing) {
  // A man at 0.8 m fills the left half of a view without any map; a pot is held 1.5 m away, in the middle.
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  apply(session, add_teapot());
  for (std::int64_t i = 0; i < 4; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    for (int y = 0; y < kCamera.height_px; ++y)
      for (int x = 0; x < kCamera.width_px; ++x) frame.depth_m.at(x, y) = x < 80 ? 0.8F : 0.0F;
    give_colour(frame);
    session.carry("pot", kAtTheSky * Eigen::Vector3d(0.0, 0.0, 1.5));
    static_cast<void>(session.step(frame, times));
  }
  int left = 0, right = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      if (const Rgb& pixel = session.picture().at(x, y); pixel.r > 40) (x < 157 ? left : right) += 1;
  EXPECT_EQ(left, 0) << "drawn over the man";
  EXPECT_GT(right, 100);
}

TEST(Session, WhatIsMeasuredHoldsAnObjectUpWhereTheMapKnowsNothing) {
  // The floor's middle was not mapped, and is not measured. A box stands there that the map does not know.
  SavedMap map = floor_map();
  map.mesh.vertices = {{-2, -2, 0},   {-0.25, -2, 0}, {-0.25, 2, 0}, {-2, 2, 0},
                       {0.25, -2, 0}, {2, -2, 0},     {2, 2, 0},     {0.25, 2, 0}};
  map.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const test::Scene box = test::box({Eigen::Vector3d(-0.2, -0.2, 0.0), Eigen::Vector3d(0.2, 0.2, 0.5)});
  for (const bool has_box : {true, false}) {
    Session session(map, by_recorded_poses());
    StageTimes times;
    apply(session, add_teapot());
    Frame frame = depth_only(0, kAtTheFloor);
    for (int y = 0; y < kCamera.height_px; ++y) {
      for (int x = 0; x < kCamera.width_px; ++x) {
        const Eigen::Vector3d ray = kAtTheFloor.linear() * back_project(kCamera, x, y, 1.0);
        const Eigen::Vector3d eye = kAtTheFloor.translation();
        const double box_m = has_box ? box(eye, ray) : test::kNoHit;
        const double floor_m = test::plane({0, 0, 1}, 0.0)(eye, ray);
        const bool is_hole = std::abs(eye.x() + floor_m * ray.x()) < 0.25;
        const double z_m = std::min(box_m, is_hole ? test::kNoHit : floor_m);
        frame.depth_m.at(x, y) = z_m < 5.0 ? static_cast<float>(z_m) : 0.0F;
      }
    }
    const VirtualObject& pot = *session.objects().front();
    double lowest_bottom_m = 1.0;
    for (frame.index = 0; frame.index < 40; ++frame.index) {
      frame.stamp_s = static_cast<double>(frame.index) / 30.0;
      if (frame.index == 2) session.drop({.name = "pot", .position_world = Eigen::Vector3d(0.0, 0.0, 0.6)});
      static_cast<void>(session.step(frame, times));
      if (frame.index > 2)
        lowest_bottom_m =
            std::min(lowest_bottom_m, pot.body.T_world_object.translation().z() + lowest_m(pot));
    }
    if (has_box) {
      EXPECT_GT(lowest_bottom_m, 0.48);
    } else {
      EXPECT_LT(lowest_bottom_m, 0.0) << "without the box nothing holds it up, or the test says nothing";
    }
  }
}

TEST(Session, ObjectsAreDrawnFromWhereTheCameraWasWhenTheColourWasTaken) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  Frame before = depth_only(0, kAtTheFloor), after = depth_only(1, kAtTheFloor);
  Eigen::Isometry3d T_before_after = Eigen::Isometry3d::Identity();
  T_before_after.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  T_before_after.translation() = Eigen::Vector3d(0.03, 0.0, 0.0);
  after.T_world_camera = kAtTheFloor * T_before_after;
  after.colour_after_depth_s = -0.5 / 30.0;  // half a frame earlier
  for (Frame* frame : {&before, &after}) {
    frame->colour_camera = kCamera;
    frame->colour.resize(kCamera.width_px, kCamera.height_px);
    static_cast<void>(session.step(*frame, times));
  }
  ASSERT_TRUE(session.shown_view());
  const Eigen::Isometry3d T_before_shown = kAtTheFloor.inverse() * session.shown_view()->T_world_view;
  EXPECT_NEAR(T_before_shown.translation().x(), 0.015, 1e-3);
  EXPECT_NEAR(Eigen::AngleAxisd(T_before_shown.linear()).angle(), 0.01, 1e-6);
  // A picture that stays on display keeps the pose at which it was taken.
  Frame without = depth_only(2, *after.T_world_camera * T_before_after);
  static_cast<void>(session.step(without, times));
  EXPECT_NEAR((kAtTheFloor.inverse() * session.shown_view()->T_world_view).translation().x(), 0.015, 1e-3);
  // After a jump, such as the restart of a looped recording, there is no motion to interpolate.
  Frame far = after;
  far.index = 3;
  far.stamp_s = 3.0 / 30.0;
  far.T_world_camera = Eigen::Translation3d(1.0, 0.0, 0.0) * kAtTheFloor;
  static_cast<void>(session.step(far, times));
  EXPECT_TRUE(session.shown_view()->T_world_view.isApprox(*far.T_world_camera, 1e-9));
}

TEST(Session, DropWaitsForAFrameThatShowsALevelSurface) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  let_a_drop_wait(session, times);
  EXPECT_FALSE(session.objects().front()->in_room);
  see_the_floor(session, times);
  EXPECT_TRUE(session.objects().front()->in_room);
  EXPECT_NEAR(session.objects().front()->body.T_world_object.translation().z(), 0.3,
              0.02);  // the drop's height
}

TEST(Session, ADropThatWaitsToTheEndIsSaid) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  let_a_drop_wait(session, times);
  for (const bool is_in_view : {false, true}) {
    if (is_in_view) see_the_floor(session, times);
    testing::internal::CaptureStdout();
    print_objects(session);
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_EQ(said.find("pot: not in the room; its drop waits") == std::string::npos, is_in_view) << said;
  }
}

TEST(Session, ADropThatWaitsOutlivesATurnOfWhatIsNotInTheRoom) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  let_a_drop_wait(session, times);
  apply(session, {TurnObject{"pot", {0.0, 0.0, 30.0}}});
  see_the_floor(session, times);
  EXPECT_TRUE(session.objects().front()->in_room);
}

TEST(Session, RemovedObjectDoesNotComeInByADropThatWaited) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  let_a_drop_wait(session, times);
  apply(session, {RemoveObject{"pot"}});
  see_the_floor(session, times);
  EXPECT_FALSE(session.objects().front()->in_room);
}

TEST(Session, DropsThatWaitAreNotTriedAllInOneFrame) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  for (const char* const name : {"one", "two", "three"}) {
    apply(session, add_teapot(name));
    apply(session, drop_in_view(name));
  }
  static_cast<void>(session.step(depth_only(0, kAtTheSky), times));
  const auto& waiting = session.waiting_drops();
  ASSERT_EQ(waiting.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(waiting[i].try_at_frame, 10 + static_cast<std::int64_t>(i));
  for (std::int64_t i = 1; i <= 13; ++i) {
    static_cast<void>(session.step(depth_only(i, kAtTheFloor), times));
    EXPECT_EQ(waiting.size(), i < 10 ? 3U : i > 12 ? 0U : static_cast<std::size_t>(12 - i)) << i;
  }
}

TEST(Session, NothingIsDroppedOntoASurfaceThatSomethingStandsBefore) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  apply(session, add_teapot());
  apply(session, drop_in_view());
  Frame full = depth_only(0, kAtTheFloor);  // a person in front of all of the floor
  for (float& depth_m : full.depth_m.pixels) depth_m *= 0.6F;
  static_cast<void>(session.step(full, times));
  EXPECT_FALSE(session.objects().front()->in_room);
  see_the_floor(session, times);
  EXPECT_TRUE(session.objects().front()->in_room);
}

/// A box whose origin is at a corner of its base.
Mesh box_about_its_corner(float size_m) {
  Mesh box = shapes::box(Eigen::Vector3f::Constant(size_m));
  for (Eigen::Vector3f& p : box.vertices) p += Eigen::Vector3f::Constant(0.5F * size_m);
  return box;
}

TEST(Session, WhereAMeshHasItsOriginDoesNotMatterForADropInView) {
  const SavedMap map = floor_map();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const bool is_about_corner : {false, true}) {
    Session session(map, by_recorded_poses());
    StageTimes times;
    session.add_object(
        "pot", is_about_corner ? box_about_its_corner(0.4F) : shapes::box(Eigen::Vector3f::Constant(0.4F)));
    apply(session, drop_in_view());
    static_cast<void>(session.step(depth_only(0, kAtTheFloor), times));
    const VirtualObject& object = *session.objects().front();
    ASSERT_TRUE(object.in_room);
    const Eigen::Vector3d now = object.body.T_world_object * object.model->middle;
    if (is_about_corner) {
      EXPECT_LT((now - middle).norm(), 1e-6);
    }
    middle = now;
  }
  // Its farthest corner is 1.13 m sideways from its origin, and 0.57 m from its centre.
  Session session(map, by_recorded_poses());
  session.add_object("pot", box_about_its_corner(0.8F));
  EXPECT_NO_THROW(apply(session, drop_in_view()));
}

TEST(Session, WhatIsTurnedWhileItIsCarriedTurnsAboutItsMiddle) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  session.add_object("pot", box_about_its_corner(0.2F));
  const VirtualObject& object = *session.objects().front();
  const auto middle = [&]() -> Eigen::Vector3d { return object.body.T_world_object * object.model->middle; };
  apply(session, {CarryObject{"pot", {0.0, 0.0, 0.8}}});
  for (std::int64_t i = 0; i < 5; ++i) static_cast<void>(session.step(depth_only(i, kAtTheSky), times));
  const Eigen::Vector3d before = middle();
  apply(session, {TurnObject{"pot", {90.0, 0.0, 0.0}}});
  for (std::int64_t i = 5; i < 10; ++i) static_cast<void>(session.step(depth_only(i, kAtTheSky), times));
  EXPECT_GT(Eigen::AngleAxisd(object.body.T_world_object.linear()).angle(), 1.5);
  EXPECT_LT((middle() - before).norm(), 1e-3);
}

TEST(Session, OneThatSpinsOnAndOnDoesNotKeepTheOthersFromTheirShadows) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  for (const char* const name : {"rests", "spins"}) apply(session, add_teapot(name));
  session.place("rests",
                {.position_world = {0.0, 0.0, 0.001},
                 .R_world_object = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()).toRotationMatrix()});
  ThrowObject spins{.name = "spins"};
  spins.position_world = Eigen::Vector3d(0.5, 0.0, -5.0);  // below the floor, where it falls without end
  spins.angular_velocity_world_rad_s = Eigen::Vector3d(0.0, 0.0, 10.0);
  apply(session, {spins});
  for (std::int64_t i = 0; i < 40; ++i) static_cast<void>(session.step(in_colour(i, kAtTheFloor), times));
  ASSERT_TRUE(session.objects()[0]->body.asleep);
  ASSERT_FALSE(session.objects()[1]->body.asleep);
  const VirtualObject& rests = *session.objects()[0];
  EXPECT_EQ(rests.shadow.cells_across, 16);
  EXPECT_TRUE(rests.shadow.R_world_object.isApprox(rests.body.T_world_object.linear(), 0.05));
}

/// Free space above z = 0, 3.8 m wide, with a floor where x < 0; the space below is unknown elsewhere.
SavedMap half_floor_map() {
  SavedMap map;
  map.mesh.vertices = {{-2, -2, 0}, {0, -2, 0}, {0, 2, 0}, {-2, 2, 0}};
  map.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  map.octree = StaticMap(0.02);
  constexpr int kEdge = 16;
  for (int z = 0; z < 6; ++z)
    for (int y = -6; y < 6; ++y)
      for (int x = -6; x < 6; ++x)
        map.octree.load().add_evidence(MapLeaf{kEdge * Eigen::Vector3i(x, y, z), kEdge, -1.0F});
  return map;
}

/// Drops a pot on each of the positions.
void drop_pots(Session& session, const std::vector<Eigen::Vector3d>& over_world) {
  for (std::size_t i = 0; i < over_world.size(); ++i) {
    const std::string name = "pot" + std::to_string(i);
    apply(session, {AddObject{.name = name, .source = {.mesh = "teapot", .size_m = 0.08}}});
    apply(session, {DropObject{.name = name, .position_world = over_world[i], .height_m = 0.3}});
  }
}

TEST(Session, ManyPotsThatFallTogetherStayOnAMappedFloorAndOnlyAHoleLetsThemThrough) {
  const SavedMap map = half_floor_map();
  for (const bool is_solid : {false, true}) {
    Session session(map, by_recorded_poses());
    StageTimes times;
    if (is_solid) session.make_unknown_solid(times);
    std::vector<Eigen::Vector3d> places;
    for (int i = 0; i < 12; ++i) places.emplace_back(-0.6 + 0.1 * (i % 6), 0.1 * (i / 6), 0.0);
    for (int i = 0; i < 3; ++i) places.emplace_back(0.3 + 0.2 * i, 0.0, 0.0);  // without a mapped floor
    drop_pots(session, places);
    for (std::int64_t i = 0; i < 30; ++i) {
      Frame frame = depth_only(i, kAtTheSky);
      frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
      static_cast<void>(session.step(frame, times));
    }
    for (const auto& pot : session.objects()) {
      const Eigen::Vector3d middle_world = pot->body.T_world_object * pot->model->middle;
      const bool has_floor = middle_world.x() < 0.0 || is_solid;
      EXPECT_EQ(middle_world.z() > 0.0, has_floor) << pot->body.name << " at " << middle_world.transpose();
      EXPECT_EQ(pot->model, session.objects().front()->model);
    }
  }
}

/// Runs some frames without any depth.
void go_on(Session& session, std::int64_t first, std::int64_t frames) {
  StageTimes times;
  for (std::int64_t i = first; i < first + frames; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    static_cast<void>(session.step(frame, times));
  }
}

/// State of a pot after falling for 33 frames where there is no floor.
Body fallen(const SessionConfig& config) {
  const SavedMap map = half_floor_map();
  Session session(map, config);
  drop_pots(session, {{1.0, 0.0, 6.0}});  // still above the end of the map after 33 frames
  go_on(session, 0, 34);
  return session.objects().front()->body;
}

TEST(Session, ObjectsThatAreMovedInTurnsFallAsFastAsOthers) {
  SessionConfig config = by_recorded_poses();
  const Body defaults = fallen(config);
  config.move_every_n_frames = 16;
  config.picture_every_n_frames = 2;
  const Body in_turns = fallen(config);  // moved in frames 1 and 33
  EXPECT_NEAR(in_turns.velocity_world_mps.z(), -9.81 * 33.0 / 30.0, 1e-9);
  EXPECT_NEAR(in_turns.T_world_object.translation().z(), defaults.T_world_object.translation().z(), 1e-6);
}

TEST(Session, ObjectsMoveInTheSameFramesWhereNoPicturesAreMade) {
  SessionConfig config = by_recorded_poses();
  config.picture_every_n_frames = 3;
  const Body seen = fallen(config);
  config.make_picture = false;
  EXPECT_TRUE(fallen(config).T_world_object.isApprox(seen.T_world_object, 0.0));
}

TEST(Session, AQualityThatWasDueInALostFrameHoldsFromThereOn) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  apply(session, {SetQuality{{.shadow_every_n_frames = 7}, FramePart::kCompose}});
  ASSERT_EQ(session.step(depth_only(0, std::nullopt), times).status, FrameStatus::kNotLocated);
  EXPECT_EQ(session.config().shadow_every_n_frames, 7);
}

TEST(Session, AnObjectIsShovedByOneThatIsThrownAndByOneThatIsCarried) {
  const SavedMap map = half_floor_map();
  for (const bool is_thrown : {true, false}) {
    Session session(map, by_recorded_poses());
    drop_pots(session, {{-1.0, 0.0, 0.0}, {-1.4, 0.0, 0.0}});
    go_on(session, 0, 45);
    const Body& shoved = session.objects().front()->body;
    ASSERT_TRUE(shoved.asleep);
    const Eigen::Vector3d stood = shoved.T_world_object.translation();
    if (is_thrown) apply(session, {ThrowObject{"pot1", {-1.3, 0.0, 0.01}, {2.0, 0.0, 0.0}}});
    for (int frame = 0; frame < 30; ++frame) {
      if (!is_thrown) apply(session, {CarryObject{"pot1", {-1.4 + 0.02 * frame, 0.0, 0.01}}});
      go_on(session, 45 + frame, 1);
    }
    EXPECT_GT(shoved.T_world_object.translation().x() - stood.x(), 0.02)
        << (is_thrown ? "thrown" : "carried");
    EXPECT_LT(std::abs(shoved.T_world_object.translation().y()), 0.2) << (is_thrown ? "thrown" : "carried");
    EXPECT_GT(shoved.T_world_object.translation().z(), -0.05) << (is_thrown ? "thrown" : "carried");
  }
}

TEST(Session, PotsDroppedIntoOnePlaceBeginOnTopOfOneAnotherAndComeToLieApart) {
  const SavedMap map = half_floor_map();
  SessionConfig config = by_recorded_poses();
  config.measure_penetration = true;
  Session session(map, config);
  const Eigen::Vector3d place(-1.0, 0.0, 0.0);
  drop_pots(session, {place, place, place + Eigen::Vector3d(0.0, 0.03, 0.0), place});
  double below_m = 0.0;
  for (const auto& pot : session.objects()) {
    EXPECT_GT(pot->body.T_world_object.translation().z(), below_m) << pot->body.name;
    below_m = pot->body.T_world_object.translation().z();
  }
  EXPECT_LT(below_m, 0.3 + 4 * 0.08);
  StageTimes times;
  for (std::int64_t i = 0; i < 90; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    EXPECT_LT(session.step(frame, times).deepest_penetration_m, 0.001) << "frame " << i;
  }
  for (const auto& pot : session.objects())
    EXPECT_GT((pot->body.T_world_object * pot->model->middle).z(), 0.0) << pot->body.name;
}

enum class How { kDrop, kPlace, kThrow };
struct Put {
  How how = How::kPlace;
  Eigen::Vector3d at_world{-1.0, 0.0, 0.3};
};
Action action_of(const std::string& name, const Put& put) {
  if (put.how == How::kDrop) return DropObject{.name = name, .position_world = put.at_world};
  if (put.how == How::kThrow) return ThrowObject{.name = name, .position_world = put.at_world};
  return PlaceObject{.name = name, .position_world = put.at_world};
}
/// Returns the initial height above the floor of the bottom of the second of two bodies, in a room with an
/// optional shelf at shelf_z_m.
double begins_at_m(const std::pair<Mesh, Put>& first, const std::pair<Mesh, Put>& second,
                   std::optional<float> shelf_z_m = {}, bool faces_down = false) {
  SavedMap map = half_floor_map();
  if (shelf_z_m) {
    const std::vector<Eigen::Vector3f> floor = map.mesh.vertices;
    for (const Eigen::Vector3f& corner : floor)
      map.mesh.vertices.push_back(corner + Eigen::Vector3f(0.0F, 0.0F, *shelf_z_m));
    map.mesh.triangles.push_back(faces_down ? Triangle{4, 6, 5} : Triangle{4, 5, 6});
    map.mesh.triangles.push_back(faces_down ? Triangle{4, 7, 6} : Triangle{4, 6, 7});
  }
  Session session(map, by_recorded_poses());
  for (const auto& [mesh, put] : {first, second}) {
    const std::string name = std::to_string(session.objects().size());
    session.add_object(name, mesh);
    apply(session, {action_of(name, put)});
  }
  const VirtualObject& put = *session.objects().back();
  return put.body.T_world_object.translation().z() + lowest_m(put);
}

TEST(Session, WhatIsPutIntoAnotherObjectBeginsOnTopOfItUnlessTheRoomIsInTheWay) {
  const Mesh pot = object_mesh("teapot", 0.08), chest = shapes::box({0.4F, 0.4F, 0.5F});
  const Mesh crate = shapes::box({0.2F, 0.2F, 0.2F});
  const double on_chest_m = 0.55 + PhysicsConfig{}.contact_margin_m;
  const std::pair chest_there{chest, Put{}};  // from 0.05 to 0.55 m above the floor
  for (const How how : {How::kDrop, How::kPlace, How::kThrow}) {
    const Eigen::Vector3d at(-1.0, 0.0, how == How::kDrop ? 0.0 : 0.3);
    EXPECT_NEAR(begins_at_m(chest_there, {pot, {how, at}}), on_chest_m, 2e-5) << "wholly inside";
  }
  EXPECT_NEAR(begins_at_m(chest_there, {chest, {}}), on_chest_m, 2e-5) << "where its like stands";
  EXPECT_NEAR(begins_at_m(chest_there, {chest, {How::kPlace, {-0.9, 0.0, 0.3}}}), on_chest_m, 2e-5);
  EXPECT_NEAR(begins_at_m({crate, {}}, {chest, {How::kPlace, {-1.0, 0.1, 0.3}}}),
              0.4 + PhysicsConfig{}.contact_margin_m, 2e-5)
      << "wholly about it";
  const double pot_in_chest_m = begins_at_m({crate, {How::kPlace, {1.0, 0.0, 0.3}}}, {pot, {}});
  for (const bool faces_down : {false, true}) {
    EXPECT_NEAR(begins_at_m(chest_there, {pot, {}}, 0.57F, faces_down), pot_in_chest_m, 1e-9) << faces_down;
    EXPECT_NEAR(begins_at_m(chest_there, {pot, {}}, 0.7F, faces_down), on_chest_m, 2e-5) << faces_down;
  }
  EXPECT_NEAR(begins_at_m({crate, {}}, {pot, {}}, 0.41F), pot_in_chest_m, 1e-9) << "through a board";
}

TEST(Session, WhatIsPutFlushBesideAnotherObjectStaysThere) {
  const Mesh crate = shapes::box({0.2F, 0.2F, 0.2F});
  for (const Eigen::Vector3d& beside : {Eigen::Vector3d(0.2, 0.0, 0.0), Eigen::Vector3d(0.0, -0.2, 0.0),
                                        Eigen::Vector3d(0.0, 0.0, 0.2), Eigen::Vector3d(0.2, 0.2, 0.0)}) {
    const Eigen::Vector3d at = Eigen::Vector3d(-1.0, 0.0, 0.3) + beside;
    EXPECT_NEAR(begins_at_m({crate, {}}, {crate, {How::kPlace, at}}), at.z() - 0.1, 1e-6)
        << beside.transpose();
  }
}

TEST(Session, WhatIsTooLargeForAnyPlaceInViewIsRefusedInWords) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  session.add_object("pot", shapes::box({85.0F, 90.0F, 120.0F}));
  const std::string fault = test::error_of([&] { apply(session, drop_in_view()); });
  EXPECT_NE(fault.find("pot: reaches 61.9 m sideways"), std::string::npos) << fault;
  EXPECT_NE(fault.find("Make it smaller, in metres"), std::string::npos) << fault;
  // A rejected drop changes nothing.
  apply(session, {CarryObject{"pot", {0, 0, 100}}});
  EXPECT_NE(test::error_of([&] { apply(session, drop_in_view()); }), "");
  EXPECT_TRUE(session.objects().front()->carried_to_world);
}

TEST(Session, WhatTheRadarLookedAtIsCountedAcrossAChangeOfRadar) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  drop_pots(session, {{-1.0, 0.0, 0.0}});
  go_on(session, 0, 20);
  StageTimes times;
  for (std::int64_t i = 20; i < 30; ++i) {
    const RunQuality quality{.radar = i % 2 == 0 ? RadarMode::kSampled : RadarMode::kExact};
    apply(session, {SetQuality{quality, FramePart::kPhysics}});
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    EXPECT_LE(session.step(frame, times).use.room_asked, 1000U) << i;
  }
}

TEST(Session, ObjectsComeToRestAtTheSamePlaceByEveryRadar) {
  const SavedMap map = half_floor_map();
  std::vector<Eigen::Vector3d> at_world;
  for (const RadarMode mode : {RadarMode::kExact, RadarMode::kSampled, RadarMode::kPasses}) {
    SessionConfig config = by_recorded_poses();
    config.radar.mode = mode;
    Session session(map, config);
    drop_pots(session, {{-1.0, 0.0, 0.0}});
    go_on(session, 0, 60);
    const Body& body = session.objects().front()->body;
    EXPECT_TRUE(body.asleep) << to_string(mode);
    at_world.emplace_back(body.T_world_object.translation());
    EXPECT_LT((at_world.back() - at_world.front()).norm(), 0.002) << to_string(mode);
  }
}

struct Thrown {
  const VirtualObject& pot;
  int unknown_contacts = 0;
};

/// Throws a pot from a position and returns its state after one and a half seconds without any depth.
Thrown thrown(Session& session, const Eigen::Vector3d& from_world, double up_mps) {
  StageTimes times;
  apply(session, add_teapot());
  apply(session, {ThrowObject{"pot", from_world, {0.0, 0.0, up_mps}}});
  Thrown result{*session.objects().front()};
  for (std::int64_t i = 0; i < 45; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    result.unknown_contacts +=
        session.step(frame, times).contacts_by_kind[static_cast<std::size_t>(SurfaceKind::kUnknownFrontier)];
  }
  return result;
}

TEST(Session, SolidUnknownSpaceHoldsAnObjectUpAndSaysSo) {
  const SavedMap map = half_floor_map();
  for (const bool is_solid : {false, true}) {
    Session session(map, by_recorded_poses());
    StageTimes times;
    if (is_solid) session.make_unknown_solid(times);
    const auto [pot, unknown_contacts] = thrown(session, {1.0, 0.0, 0.6}, 0.0);
    const double bottom_m = pot.body.T_world_object.translation().z() + lowest_m(pot);
    EXPECT_FALSE(pot.placement.began_in_unknown);
    EXPECT_EQ(unknown_contacts > 0, is_solid);
    if (is_solid) {
      EXPECT_TRUE(pot.body.asleep);
      EXPECT_EQ(pot.body.rests_on, SurfaceKind::kUnknownFrontier);
      EXPECT_NEAR(bottom_m, 0.0, 0.005);
    } else {
      EXPECT_FALSE(pot.in_room);  // it has rested nowhere
      EXPECT_EQ(pot.departures, 1);
      EXPECT_LT(bottom_m, -0.5);
    }
  }
}

TEST(Session, WhatFallsOutOfTheMapIsBackWhereItLastRested) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  const VirtualObject& pot = thrown(session, {-1.0, 0.0, 0.3}, 0.0).pot;
  ASSERT_TRUE(pot.body.asleep);
  const Eigen::Isometry3d T_world_rested = pot.body.T_world_object;
  session.throw_object(pot.body.name, {.position_world = {1.0, 0.0, 0.3}});  // over the half without floor
  StageTimes times;
  std::vector<Departure> departures;
  for (std::int64_t i = 45; i < 90; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    const FrameResult result = session.step(frame, times);
    departures.insert(departures.end(), result.departures.begin(), result.departures.end());
  }
  ASSERT_EQ(departures.size(), 1U);
  EXPECT_EQ(departures[0].name, pot.body.name);
  EXPECT_TRUE(departures[0].is_back);
  EXPECT_LT(departures[0].position_world.z(), -0.5);
  EXPECT_TRUE(pot.in_room && pot.body.asleep);
  EXPECT_EQ(pot.body.T_world_object.matrix(), T_world_rested.matrix());
  EXPECT_EQ(pot.departures, 1);
}

/// Steps a frame that shows nothing for a time; returns the notices.
std::vector<ObjectNotice> wait(Session& session, std::int64_t from, std::int64_t until) {
  StageTimes times;
  std::vector<ObjectNotice> notices;
  for (std::int64_t i = from; i < until; ++i) {
    Frame frame = depth_only(i, kAtTheSky);
    frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px, 0.0F);
    const FrameResult result = session.step(frame, times);
    notices.insert(notices.end(), result.notices.begin(), result.notices.end());
  }
  return notices;
}

TEST(Session, WhatIsSetBackToAPlaceThatIsTakenComesToLieOnWhatTookIt) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  const VirtualObject& pot = thrown(session, {-1.0, 0.0, 0.3}, 0.0).pot;
  ASSERT_TRUE(pot.body.asleep);
  const Eigen::Vector3d place_world = pot.body.T_world_object.translation();
  session.throw_object(pot.body.name, {.position_world = {1.0, 0.0, 0.3}});  // over the half without floor
  apply(session, add_teapot("other"));
  session.throw_object("other", {.position_world = place_world});
  const VirtualObject& other = *session.objects().back();
  (void)wait(session, 45, 75);
  ASSERT_EQ(pot.departures, 1);
  ASSERT_TRUE(pot.in_room);
  const Eigen::Vector3d apart_m = middle_world(pot) - middle_world(other);
  EXPECT_GT(apart_m.norm(), 0.5 * (highest_m(other) - lowest_m(other)));
}

TEST(Session, WhatIsPlacedInAFloorIsMovedOutOfItAndSaidSo) {
  const SavedMap map = floor_map();
  for (const double depth_m : {0.0, 0.03, 0.08}) {
    Session session(map, by_recorded_poses());
    session.add_object("box", shapes::box(Eigen::Vector3f::Constant(0.1F)));
    const VirtualObject& box = *session.objects().front();
    session.place("box", {.position_world = {0.3, 0.2, 0.055 - depth_m}});
    const std::vector<ObjectNotice> notices = wait(session, 0, 30);
    EXPECT_NEAR(box.body.T_world_object.translation().z(), 0.05, 0.003) << depth_m;
    EXPECT_TRUE(box.body.asleep) << depth_m;
    EXPECT_FALSE(box.placement.stuck);
    ASSERT_EQ(notices.size(), depth_m > 0.01 ? 1U : 0U) << depth_m;
    if (!notices.empty()) {
      EXPECT_EQ(notices[0].name, "box");
      EXPECT_NE(notices[0].text.find("moved out"), std::string::npos) << notices[0].text;
    }
  }
}

TEST(Session, AHeavyObjectOnTheEndOfABoardTipsItAndALightOneDoesNot) {
  const SavedMap map = floor_map();
  for (const float load_size_m : {0.05F, 0.1F}) {
    Session session(map, by_recorded_poses());
    session.add_object("base", shapes::box({0.2F, 0.2F, 0.1F}));
    session.add_object("board", shapes::box({0.4F, 0.2F, 0.02F}));  // 1.6 kg, its middle 5 cm before the edge
    session.add_object("load", shapes::box(Eigen::Vector3f::Constant(load_size_m)));  // 0.125 kg or 1 kg
    session.place("base", {.position_world = {-0.1, 0.0, 0.051}});
    session.place("board", {.position_world = {-0.05, 0.0, 0.112}});
    (void)wait(session, 0, 45);
    const Body& board = session.objects()[1]->body;
    ASSERT_TRUE(board.asleep);
    session.place("load", {.position_world = {0.12, 0.0, 0.1225 + 0.5 * load_size_m}});
    bool has_tipped = false;
    for (int frame = 0; frame < 60; ++frame) {
      (void)wait(session, 45 + frame, 46 + frame);
      has_tipped |= board.T_world_object.linear()(2, 2) < 0.99;
    }
    EXPECT_EQ(has_tipped, load_size_m > 0.06F) << load_size_m;
  }
}

/// A floor and 9 cm above it a ceiling: no room for a box of 10 cm; 2 x 2 m.
SavedMap slot_map() {
  SavedMap map = floor_map();
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(-1, -1, 0.09F), Eigen::Vector3f(-1, 1, 0.09F),
                                   Eigen::Vector3f(1, 1, 0.09F), Eigen::Vector3f(1, -1, 0.09F)})
    map.mesh.vertices.push_back(p);
  map.mesh.triangles.push_back({4, 5, 6});
  map.mesh.triangles.push_back({4, 6, 7});
  return map;
}

TEST(Session, WhatHasNoFreePlaceNearIsRefusedWithTheNearestAndNothingHasChanged) {
  const SavedMap map = slot_map();
  Session session(map, by_recorded_poses());
  session.add_object("box", shapes::box(Eigen::Vector3f::Constant(0.1F)));
  const VirtualObject& box = *session.objects().front();
  const std::string refused = test::error_of([&] {
    session.place("box", {.position_world = {0.7, 0.0, 0.06}});
  });
  EXPECT_NE(refused.find("no free place within 10 cm; the nearest found is"), std::string::npos) << refused;
  EXPECT_FALSE(box.in_room);
  // In the room already, it stays where it is.
  session.place("box", {.position_world = {-1.5, 0.0, 0.3}});
  EXPECT_THROW(session.place("box", {.position_world = {0.7, 0.0, 0.06}}), PlaceRefused);
  EXPECT_TRUE(box.in_room);
  EXPECT_EQ(box.body.T_world_object.translation(), Eigen::Vector3d(-1.5, 0.0, 0.3));
  DropRequest turned{.name = "box", .position_world = Eigen::Vector3d(0.7, 0.0, 0.0), .height_m = 0.06};
  turned.R_world_object = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_THROW(session.drop(turned), PlaceRefused);
  EXPECT_EQ(box.body.T_world_object.linear(), Eigen::Matrix3d::Identity());
}

constexpr Intrinsics kFineCamera{320, 240, 292.0, 292.0, 159.5, 119.5};
const Eigen::Isometry3d kAboveTheFloor = test::looking_at({0.1, -0.9, 0.8}, {0.1, 0.0, 0.1});

/// Sweeps a fist of 6 cm at a height of 6 cm over the floor through a box of 10 cm. Returns where the box is,
/// along the fist's path, minus where the fist is in the last frame.
double swept_ahead_m(double speed_mps, const Eigen::Vector3d& way) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  session.add_object("box", shapes::box(Eigen::Vector3f::Constant(0.1F)));
  session.place("box", {.position_world = {0.0, 0.0, 0.052}});
  const VirtualObject& box = *session.objects().front();
  const test::Scene floor = test::plane(Eigen::Vector3d::UnitZ(), 0.0);
  StageTimes times;
  std::int64_t index = 0;
  const auto show = [&](const test::Scene& scene) {
    Frame frame = test::exact_frame(scene, kFineCamera, kAboveTheFloor);
    frame.index = index;
    frame.stamp_s = static_cast<double>(index++) / 30.0;
    static_cast<void>(session.step(frame, times));
  };
  while (index < 20) show(floor);
  EXPECT_TRUE(box.body.asleep);
  const double step_m = speed_mps / 30.0;
  double along_m = -0.4;
  for (; along_m < 0.15; along_m += step_m)
    show(test::nearest_of(floor, test::sphere(along_m * way + Eigen::Vector3d(0, 0, 0.06), 0.06)));
  return box.body.T_world_object.translation().dot(way) - (along_m - step_m);
}

TEST(Session, AHandPushesABoxAndDoesNotPassItAtAnySpeed) {
  for (const double speed_mps : {0.3, 0.9, 1.5, 3.0})
    for (const Eigen::Vector3d& way :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0)})
      EXPECT_GT(swept_ahead_m(speed_mps, way), 0.07) << speed_mps << " m/s along " << way.transpose();
}

TEST(Session, AnObjectIsGrippedBetweenTwoFingersLiftedCarriedAndPutDown) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  session.add_object("box", shapes::box(Eigen::Vector3f::Constant(0.06F)));
  session.place("box", {.position_world = {0.0, 0.0, 0.032}});
  const VirtualObject& box = *session.objects().front();
  constexpr double kFinger_m = 0.025;
  StageTimes times;
  std::int64_t index = 0;
  // Moves the two fingertips to a place, at a distance from each other, within some frames.
  Eigen::Vector3d middle(0.0, 0.0, 0.035);
  double apart_m = 0.4;
  const auto move = [&](const Eigen::Vector3d& to, double to_apart_m, int frames) {
    const Eigen::Vector3d from = middle;
    const double from_apart_m = apart_m;
    for (int i = 1; i <= frames; ++i) {
      const double part = static_cast<double>(i) / frames;
      middle = from + part * (to - from);
      apart_m = from_apart_m + part * (to_apart_m - from_apart_m);
      const Eigen::Vector3d half(0.5 * apart_m, 0.0, 0.0);
      Frame frame =
          test::exact_frame(test::nearest_of(test::plane(Eigen::Vector3d::UnitZ(), 0.0),
                                             test::nearest_of(test::sphere(middle - half, kFinger_m),
                                                              test::sphere(middle + half, kFinger_m))),
                            kFineCamera, kAboveTheFloor);
      frame.index = index;
      frame.stamp_s = static_cast<double>(index++) / 30.0;
      static_cast<void>(session.step(frame, times));
    }
  };
  const auto at = [&]() -> Eigen::Vector3d { return box.body.T_world_object.translation(); };
  const double closed_m = 0.06 + 2.0 * kFinger_m - 0.024;  // each 12 mm in the box
  move(middle, closed_m, 30);
  EXPECT_LT((at() - Eigen::Vector3d(0, 0, 0.031)).norm(), 0.02);
  move({0.0, 0.0, 0.235}, closed_m, 30);
  EXPECT_GT(at().z(), 0.2) << "not lifted";
  move({0.25, 0.05, 0.235}, closed_m, 30);
  EXPECT_LT((at() - Eigen::Vector3d(0.25, 0.05, 0.23)).norm(), 0.03) << at().transpose();
  move(middle, closed_m, 15);  // held still
  EXPECT_GT(at().z(), 0.2) << "let fall";
  move({0.25, 0.05, 0.037}, closed_m, 30);
  move(middle, 0.4, 30);
  move(middle, 0.4, 30);
  EXPECT_TRUE(box.body.asleep);
  EXPECT_LT((at() - Eigen::Vector3d(0.25, 0.05, 0.031)).norm(), 0.04) << at().transpose();
}

TEST(Session, AnObjectsMaterialIsChangedOrRefused) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  session.add_object("box", Model{.mesh = shapes::box(Eigen::Vector3f::Constant(0.1F))},
                     {.density_kg_m3 = 600.0, .friction = 0.2});
  VirtualObject& box = *session.objects().front();
  EXPECT_NEAR(box.body.mass.mass_kg, 0.6, 1e-6);
  EXPECT_EQ(box.body.material.friction, 0.2);
  box.body.asleep = true;
  session.set_material("box", {.mass_kg = 3.0});
  EXPECT_EQ(box.body.mass.mass_kg, 3.0);
  EXPECT_EQ(box.body.material, (BodyMaterial{.mass_kg = 3.0, .friction = 0.2}));  // what is not named stays
  EXPECT_FALSE(box.body.asleep);
  session.set_material("box", {.density_kg_m3 = 2000.0});
  EXPECT_NEAR(box.body.mass.mass_kg, 2.0, 1e-6);

  const BodyMaterial before = box.body.material;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const BodyMaterial& wrong :
       {BodyMaterial{.mass_kg = 0.0}, BodyMaterial{.mass_kg = -1.0}, BodyMaterial{.mass_kg = nan},
        BodyMaterial{.density_kg_m3 = 0.0}, BodyMaterial{.friction = 11.0}, BodyMaterial{.friction = -0.1},
        BodyMaterial{.restitution = 1.1}, BodyMaterial{.mass_kg = 1.0, .density_kg_m3 = 1000.0}})
    EXPECT_THROW(session.set_material("box", wrong), Error);
  EXPECT_EQ(test::error_of([&] { session.set_material("box", {.friction = 11.0}); }),
            "box: material.friction = 11: must be a coefficient of friction, 0..10");
  EXPECT_EQ(box.body.material, before);
  EXPECT_THROW(session.set_material("ball", {.mass_kg = 1.0}), Error);

  // An open mesh has no volume: its density says nothing, and nothing is added.
  const std::string open = test::error_of([&] {
    session.add_object("sheet", Model{.mesh = shapes::floor(0.1F, 0.0F)}, {.density_kg_m3 = 600.0});
  });
  EXPECT_NE(open.find("sheet: the mesh is open"), std::string::npos) << open;
  EXPECT_EQ(session.objects().size(), 1U);
  session.add_object("sheet", Model{.mesh = shapes::floor(0.1F, 0.0F)}, {.mass_kg = 0.1});
  EXPECT_EQ(session.objects().back()->body.mass.mass_kg, 0.1);
}

TEST(Session, ADropNearAPointIsTriedOnceAndSaysWhyNot) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  session.add_object("box", shapes::box(Eigen::Vector3f::Constant(0.1F)));
  const VirtualObject& box = *session.objects().front();
  StageTimes times;
  session.drop({.name = "box", .near_world = Eigen::Vector3d(0.2, 0.1, 0.0)});
  static_cast<void>(session.step(depth_only(0, kAtTheFloor), times));
  ASSERT_TRUE(box.in_room);
  EXPECT_LT((box.body.T_world_object.translation().head<2>() - Eigen::Vector2d(0.2, 0.1)).norm(), 0.03);
  session.remove("box");
  session.drop({.name = "box", .near_world = Eigen::Vector3d(0.2, 0.1, 1.0)});
  const FrameResult result = session.step(depth_only(1, kAtTheFloor), times);
  EXPECT_FALSE(box.in_room);
  EXPECT_TRUE(session.waiting_drops().empty());
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_NE(result.notices[0].text.find("is not dropped: it needs a free level circle"), std::string::npos)
      << result.notices[0].text;
}

TEST(Session, ADropIsGentlerWhereTheObjectWouldTopple) {
  StageTimes times;
  const auto dropped_on = [&](float slope, const Mesh& mesh) {
    SavedMap map = floor_map();
    for (Eigen::Vector3f& vertex : map.mesh.vertices) vertex.z() = slope * vertex.x();
    Session session(map, by_recorded_poses());
    session.add_object("thing", mesh);
    const Body& body = session.objects().front()->body;
    session.drop({.name = "thing"});
    std::string note;
    std::optional<Eigen::Isometry3d> T_world_start;
    for (int frame = 0; frame < 60; ++frame) {
      const FrameResult result = session.step(depth_only(frame, kAtTheFloor), times);
      for (const ObjectNotice& notice : result.notices) note += notice.name + notice.text;
      if (!T_world_start && session.objects().front()->in_room) T_world_start = body.T_world_object;
    }
    EXPECT_TRUE(T_world_start);
    const Eigen::Isometry3d T_end_start =
        body.T_world_object.inverse() * T_world_start.value_or(body.T_world_object);
    const double turned_deg = Eigen::AngleAxisd(T_end_start.linear()).angle() * 180.0 / std::numbers::pi;
    return std::tuple{note, turned_deg, T_end_start.translation().norm()};
  };
  const auto box = [](float width_m) { return shapes::box({width_m, width_m, 0.16F}); };
  {
    const auto [note, turned_deg, moved_m] = dropped_on(0.0F, box(0.1F));
    EXPECT_EQ(note, "");
    EXPECT_LT(turned_deg, 1.0);
  }
  {
    const auto [note, turned_deg, moved_m] = dropped_on(0.08F, box(0.1F));
    EXPECT_EQ(note, "thing is dropped from 0.05 m, since it would topple or move away if dropped from 0.3 m");
    EXPECT_LT(turned_deg, 6.0);
    EXPECT_LT(moved_m, 0.06);
  }
  for (const Mesh& unsteady : {box(0.06F), shapes::ball(0.05F, 16, 24)}) {
    const auto [note, turned_deg, moved_m] = dropped_on(0.12F, unsteady);
    EXPECT_EQ(note.find("thing may not stay where it is dropped: it topples, rolls or slides"), 0U) << note;
    EXPECT_GT(moved_m, 0.32);
  }
}

TEST(Session, OverASeenFloorSolidUnknownSpaceChangesNothing) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  session.make_unknown_solid(times);
  const auto [pot, unknown_contacts] = thrown(session, {-1.0, 0.0, 0.6}, 0.0);
  EXPECT_TRUE(pot.body.asleep);
  EXPECT_EQ(pot.body.rests_on, SurfaceKind::kStatic);
  EXPECT_EQ(unknown_contacts, 0);
}

TEST(Session, WhatIsPutIntoUnknownSpaceCanLeaveItAndCannotComeBack) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  session.make_unknown_solid(times);
  const VirtualObject& pot = thrown(session, {1.0, 0.0, -0.5}, 4.2).pot;
  EXPECT_TRUE(pot.placement.began_in_unknown);
  EXPECT_FALSE(pot.placement.in_unknown);
  EXPECT_EQ(pot.body.rests_on, SurfaceKind::kUnknownFrontier);
  EXPECT_NEAR(pot.body.T_world_object.translation().z() + lowest_m(pot), 0.0, 0.005);
}

TEST(Session, WhatIsPutPartlyIntoUnknownSpaceIsMovedOutOrRefused) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  session.make_unknown_solid(times);
  const VirtualObject& pot = thrown(session, {1.0, 0.0, -0.04}, 0.0).pot;  // 4 of its 15 cm are in the floor
  EXPECT_FALSE(pot.placement.began_in_unknown);
  EXPECT_TRUE(pot.body.asleep);
  EXPECT_EQ(pot.body.rests_on, SurfaceKind::kUnknownFrontier);
  EXPECT_NEAR(pot.body.T_world_object.translation().z() + lowest_m(pot), 0.0, 0.005);

  // a beam of 2.4 m of which 20 cm are beyond the end of the map, at x = 1.92
  Model beam{.mesh = shapes::box({2.4F, 0.1F, 0.1F})};
  session.add_object("beam", std::move(beam));
  const std::string refusal = test::error_of([&] {
    session.place("beam", {.position_world = {0.92, 0.0, 0.8}});
  });
  EXPECT_NE(refusal.find("a part of it would be in space that was not scanned"), std::string::npos)
      << refusal;
  const VirtualObject& its = *find_object(session.objects(), "beam");
  EXPECT_FALSE(its.in_room);
  EXPECT_EQ(its.why_not_in_room, "its start position was refused");
  session.place("beam", {.position_world = {0.92, 0.0, 0.8}, .velocity_world_mps = {-1.0, 0.0, 0.0}});
  EXPECT_TRUE(its.in_room);
  session.remove("beam");
  EXPECT_EQ(its.why_not_in_room, "it was removed");
}

TEST(Session, NothingIsPutIntoUnscannedSpaceUnlessItIsThrown) {
  const SavedMap map = half_floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  session.make_unknown_solid(times);
  apply(session, add_teapot());
  VirtualObject& pot = *session.objects().front();
  const std::string name = pot.body.name;
  // Deep below the floor nothing near is free; beyond the map there is nothing at all.
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1.0, 0.0, -0.5), Eigen::Vector3d(20.0, 1.0, 1.0)}) {
    const std::string refusal = test::error_of([&] { session.place(name, {.position_world = p}); });
    EXPECT_NE(refusal.find("that space was not scanned"), std::string::npos) << refusal;
    EXPECT_NE(test::error_of([&] { session.drop({.name = name, .position_world = p}); }), "");
    EXPECT_NE(test::error_of([&] { session.carry(name, p); }), "");
    EXPECT_FALSE(pot.in_room);
  }
  EXPECT_NE(test::error_of([&] {
              session.place(name, {.position_world = {1.0, 0.0, -0.5}});
            }).find("the nearest"),
            std::string::npos);
  EXPECT_NE(test::error_of([&] {
              session.place(name, {.position_world = {20.0, 1.0, 1.0}});
            }).find("within 10 cm, nor was one found within 1 m"),
            std::string::npos);
  session.place(name, {.position_world = {1.0, 0.0, -0.5}, .velocity_world_mps = {0.0, 0.0, 4.0}});
  EXPECT_TRUE(pot.in_room);
  const FrameResult result = session.step(depth_only(0, kAtTheSky), times);
  ASSERT_EQ(result.notices.size(), 1U);
  EXPECT_NE(result.notices[0].text.find("nothing stops it"), std::string::npos) << result.notices[0].text;

  // Where unknown space is free, an object may be put anywhere.
  session.remove(name);
  session.make_unknown_free();
  session.place(name, {.position_world = {20.0, 1.0, 1.0}});
  EXPECT_TRUE(pot.in_room);
}

TEST(Session, UnknownSpaceIsNotSolidWithoutTheMapsSurfaces) {
  const SavedMap map = half_floor_map();
  SessionConfig config = by_recorded_poses();
  config.scene.surfaces = SurfacePolicy::kSkirt;
  Session session(map, config);
  StageTimes times;
  EXPECT_THROW(session.make_unknown_solid(times), Error);
}

TEST(Session, AFrameThatDoesNotFitItsCameraIsPassedOver) {
  const SavedMap map = floor_map();
  Session session(map, by_recorded_poses());
  StageTimes times;
  Frame small = depth_only(0, kAtTheFloor);
  small.depth_m.resize(80, 60, 2.0F);
  const FrameResult bad = session.step(small, times);
  EXPECT_EQ(bad.status, FrameStatus::kBadFrame);
  EXPECT_NE(bad.fault.find("differ in size"), std::string_view::npos) << bad.fault;
  Frame coloured = depth_only(1, kAtTheFloor);
  coloured.colour_camera = kCamera;
  coloured.colour.resize(80, 60);
  EXPECT_EQ(session.step(coloured, times).status, FrameStatus::kBadFrame);
  EXPECT_EQ(session.step(depth_only(2, kAtTheFloor), times).status, FrameStatus::kDone);
}

TEST(VirtualObject, FootprintReachesToACorner) {
  GlContext context;
  Mesh plate;
  plate.vertices = {{-0.3F, -0.4F, 0.1F}, {0.3F, -0.4F, 0.1F}, {0.3F, 0.4F, 0.1F}};
  plate.triangles = {{0, 1, 2}};
  const VirtualObject object("plate",
                             std::make_shared<const ObjectModel>(context, object_parts("plate", plate)));
  EXPECT_NEAR(footprint_radius_m(object, Eigen::Matrix3d::Identity()), 0.5, 1e-6);
  const Eigen::AngleAxisd on_edge(M_PI / 2.0, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(footprint_radius_m(object, on_edge.toRotationMatrix()), 0.3, 1e-6);
  EXPECT_LT((level_to_middle(object, on_edge.toRotationMatrix()) - Eigen::Vector3d(0.0, -0.1, 0.0)).norm(),
            1e-6);
  EXPECT_NEAR(lowest_m(object), 0.1, 1e-6);
}

TEST(VirtualObject, MeshWithoutTrianglesIsRefused) { EXPECT_THROW(object_parts("nothing", Mesh{}), Error); }

}  // namespace
}  // namespace roomradar::session_test
