// map_updater_test.cpp: a crate that is added and stays, or is removed, in a simulated session; and changes
// that must not be committed.
#include <gtest/gtest.h>

#include <optional>

#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::map_updater_test {
namespace {

using Eigen::Vector3d;

const Vector3d kCrateTop(0.11, -0.205, 0.97);  // in the room `table`, whose table is 0.75 m high

SimOptions view(const std::string& rest) {
  return parse_sim_spec("sim:table?path=view&rate=10&width=160&" + rest);
}

/// Map of a room fused from a viewer's frames at their true poses.
SavedMap map_of(const std::string& crate) {
  SavedMap map;
  map.octree = StaticMap(0.02);
  SimulatedSource source(view("frames=30&crate=" + crate));
  Frame frame;
  while (source.next(frame).status == ReadStatus::kFrame)
    map.octree.load().fuse(frame, *frame.T_world_camera);
  map.mesh = extract_surface(map.octree.load());
  return map;
}

/// @param after_s  nullopt: commit only on request
SessionConfig updating(std::optional<double> after_s) {
  SessionConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.make_picture = false;
  config.map_updates.emplace();
  config.map_updates->after_s = after_s;
  config.map_updates->views = 6;
  config.map_updates->apply_after_frames = 5;
  return config;
}

/// A session on a simulated source, with a pot in it.
class UpdatingSession {
 public:
  UpdatingSession(SavedMap& map, const SimOptions& options, const SessionConfig& config)
      : source_(options), session(map, config, &map.octree.load()) {}

  /// Runs this many frames; `hidden`: a hand close to the lens covers the middle of the image.
  FrameResult run(int frames, bool hidden = false) {
    FrameResult result;
    for (int i = 0; i < frames && source_.next(frame_).status == ReadStatus::kFrame; ++i) {
      if (hidden) {
        for (int y = 20; y < 110; ++y)
          for (int x = 30; x < 120; ++x) frame_.depth_m.at(x, y) = 0.6F;
      }
      result = session.step(frame_, times_);
    }
    return result;
  }
  /// Runs this many frames without a pose.
  void run_lost(int frames) {
    for (int i = 0; i < frames && source_.next(frame_).status == ReadStatus::kFrame; ++i) {
      frame_.T_world_camera.reset();
      static_cast<void>(session.step(frame_, times_));
    }
  }
  /// Repeats the last frame this many times, like a held source.
  void hold(int times) {
    for (int i = 0; i < times; ++i) {
      frame_.stamp_s += 1.0 / 30.0;
      static_cast<void>(session.step(frame_, times_));
    }
  }
  void make_unknown_solid() { session.make_unknown_solid(times_); }
  void drop_pot(const Vector3d& above) {
    apply(session, {AddObject{.name = "pot", .source = {.mesh = "teapot", .size_m = 0.1}}});
    apply(session, {DropObject{.name = "pot", .position_world = above, .height_m = 0.03}});
  }
  /// Height of the pot's lowest point.
  [[nodiscard]] double pot_m() const {
    const VirtualObject& pot = *session.objects().front();
    return pot.body.T_world_object.translation().z() + lowest_m(pot);
  }

 private:
  SimulatedSource source_;
  StageTimes times_;
  Frame frame_;

 public:
  Session session;
};

void ask(Session& session) { apply(session, {CommitChanges{}}); }

TEST(Adopt, ACrateThatCameHoldsAPotAlsoWhenAHandHidesIt) {
  SavedMap map = map_of("0");
  UpdatingSession run(map, view("frames=90&crate=comes"), updating(1.5));
  run.run(45);
  EXPECT_TRUE(run.session.committed_changes().empty());
  const FrameResult moved = run.run(5);
  EXPECT_GT(moved.foreground.moved, 150U);
  run.run(30);
  ASSERT_EQ(run.session.committed_changes().size(), 1U);
  const CommittedChange committed_changes = run.session.committed_changes().front();
  EXPECT_EQ(committed_changes.kind, LastingKind::kCame);
  EXPECT_GE(committed_changes.frame, 45 + 15 + 6 + 5);
  EXPECT_LT((committed_changes.box_world.center() - kCrateTop + Vector3d(0, 0, 0.11)).norm(), 0.06);
  // The crate is no longer foreground, and supports a pot dropped on it behind a hand.
  const FrameResult now = run.run(1);
  EXPECT_LT(now.foreground.moved, 20U);
  run.drop_pot(kCrateTop);
  run.run(9, true);
  EXPECT_NEAR(run.pot_m(), kCrateTop.z(), 0.01);
}

TEST(Adopt, WithoutItAHiddenCrateHoldsNothing) {
  SavedMap map = map_of("0");
  SessionConfig config = updating(1.5);
  config.map_updates.reset();
  UpdatingSession run(map, view("frames=90&crate=comes"), config);
  run.run(75);
  run.drop_pot(kCrateTop);
  run.run(12, true);
  EXPECT_LT(run.pot_m(), 0.8) << "the test above would pass by itself";
}

TEST(Adopt, WhatACrateHeldFallsWhenItIsTakenAway) {
  SavedMap map = map_of("1");
  UpdatingSession run(map, view("frames=120&crate=goes"), updating(1.5));
  run.drop_pot(kCrateTop);
  run.run(62);
  EXPECT_NEAR(run.pot_m(), kCrateTop.z(), 0.01) << "not seen for long enough to be gone";
  run.run(58);
  ASSERT_EQ(run.session.committed_changes().size(), 1U);
  EXPECT_EQ(run.session.committed_changes().front().kind, LastingKind::kWent);
  EXPECT_NEAR(run.pot_m(), 0.75, 0.01);
  EXPECT_EQ(map.octree.load().occupancy_at(kCrateTop - Vector3d(0, 0, 0.1)), Occupancy::kFree);
}

TEST(Adopt, SolidUnknownSpaceInsideACrateGoesWithIt) {
  SavedMap map = map_of("1");
  UpdatingSession run(map, view("frames=90&crate=goes"), updating(1.5));
  run.make_unknown_solid();
  const Vector3d inside = kCrateTop - Vector3d(0, 0, 0.11);
  EXPECT_TRUE(is_unknown(*run.session.unknown(), inside));
  run.drop_pot(kCrateTop);
  run.run(90);
  ASSERT_EQ(run.session.committed_changes().size(), 1U);
  EXPECT_FALSE(is_unknown(*run.session.unknown(), inside));
  EXPECT_NEAR(run.pot_m(), 0.75, 0.01);
}

TEST(Adopt, WhatIsAskedForIsAdoptedAtOnce) {
  SavedMap map = map_of("0");
  UpdatingSession run(map, view("frames=80&crate=comes"), updating(std::nullopt));
  run.run(60);
  EXPECT_TRUE(run.session.committed_changes().empty()) << "no commit was asked for";
  ask(run.session);
  run.run(15);
  EXPECT_EQ(run.session.committed_changes().size(), 1U);
}

TEST(Adopt, WhatWasAskedForWhileTheCameraWasLostIsNotDoneLater) {
  SavedMap map = map_of("0");
  UpdatingSession run(map, view("frames=90&crate=comes"), updating(std::nullopt));
  run.run(46);
  ask(run.session);
  run.run_lost(14);
  run.run(30);
  EXPECT_TRUE(run.session.committed_changes().empty()) << "nobody asked for what stands there by then";
}

TEST(Adopt, AHandThatWavesAndAPersonWhoStandsForTwoSecondsAreNot) {
  for (const char* const moving : {"hand", "hand&pace=slow", "person&pace=waits"}) {
    SavedMap map = map_of("0");
    UpdatingSession run(map, view(std::string("frames=100&moving=") + moving), updating(5.0));
    run.run(100);
    run.session.finish_commits();
    EXPECT_TRUE(run.session.committed_changes().empty()) << moving;
  }
}

TEST(Adopt, WhatMovesIsNotBecauseTheCameraIsHeld) {
  for (const char* const moving : {"moving=hand", "crate=comes"}) {
    SavedMap map = map_of("0");
    UpdatingSession run(map, view(std::string("frames=100&") + moving), updating(1.5));
    std::size_t moved = 0;
    for (int i = 0; i < 90 && moved < 150; ++i) moved = run.run(1).foreground.moved;
    ASSERT_GE(moved, 150U) << moving;
    run.hold(150);
    run.session.finish_commits();
    EXPECT_TRUE(run.session.committed_changes().empty()) << moving;
  }
}

TEST(Adopt, APersonInTheBackgroundDoesNotKeepTheCrateOut) {
  SavedMap map = map_of("0");
  UpdatingSession run(map, view("frames=90&crate=comes&moving=person"), updating(1.5));
  run.run(90);
  run.session.finish_commits();
  ASSERT_EQ(run.session.committed_changes().size(), 1U);
  EXPECT_LT(run.session.committed_changes().front().box_world.sizes().maxCoeff(), 0.4);
}

TEST(Adopt, AMapWithoutAnOctreeIsRefusedInWords) {
  SavedMap map;
  map.mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}};
  map.mesh.triangles = {{0, 1, 2}};
  try {
    Session session(map, updating(1.0), &map.octree.load());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("octree contains no surface"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(Session(map, updating(1.0)), Error);
  EXPECT_THROW(Session(map, updating(0.0), &map.octree.load()), Error);
}

TEST(Adopt, AskingASessionThatDoesNotWatchIsSaid) {
  SavedMap map = map_of("0");
  SessionConfig config = updating(1.0);
  config.map_updates.reset();
  Session session(map, config, &map.octree.load());
  EXPECT_THROW(ask(session), Error);
}

}  // namespace
}  // namespace roomradar::map_updater_test
