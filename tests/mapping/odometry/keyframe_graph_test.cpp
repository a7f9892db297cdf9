// keyframe_graph_test.cpp: keyframes are saved and restored; loops are closed if drift explains them, and
// rejected otherwise.
#include "mapping/alignment/packed_view.hpp"
#include "mapping/odometry/keyframe_graph.hpp"

#include <gtest/gtest.h>

#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar::keyframe_graph_test {
namespace {

using test::frame_at, test::on_path;

/// Makes a keyframe of a frame, with the estimated pose T_world_camera.
Keyframe keyframe_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double path_length_m) {
  return {frame.index, T_world_camera, test::stored_view(frame), 0, path_length_m, {}};
}

/// A camera goes away and returns to the pose of its first keyframe. Drift displaces the last keyframe by
/// `drift`.
struct RoundTrip {
  Eigen::Isometry3d T_first = on_path(0, 1);
  Eigen::Isometry3d T_last = on_path(0, 1) * Eigen::Translation3d(0.03, 0.0, 0.02);
  Frame first = frame_at(T_first, 0), last = frame_at(T_last, 9);
  KeyframeDatabase keyframe_database;
  KeyframeGraph graph;

  RoundTrip(const Eigen::Isometry3d& drift, double path_length_m) {
    graph.keyframes = {keyframe_of(first, T_first, 0.0), keyframe_of(last, T_last * drift, path_length_m)};
    // In between, away from both: three keyframes that observe none of this.
    for (int i = 1; i <= 3; ++i) {
      Keyframe blind = graph.keyframes[0];
      blind.view = std::make_shared<const PackedView>([&] {
        StoredView view = unpacked(*blind.view);
        std::fill(view.inverse_depth.pixels.begin(), view.inverse_depth.pixels.end(), std::uint16_t{0});
        return packed(view);
      }());
      blind.T_world_camera.translation().x() += 3.0 * i;
      blind.path_length_m = path_length_m * i / 4.0;
      graph.keyframes.insert(graph.keyframes.end() - 1, blind);
    }
    keyframe_database.keyframes.push_back(make_map_keyframe(first, T_first));
    for (int i = 1; i <= 3; ++i)
      keyframe_database.keyframes.push_back(
          {i, graph.keyframes[static_cast<std::size_t>(i)].T_world_camera, {}, {}, {}, {}, {}});
  }
  KeyframeJobResult run_job() const {
    return run({last, graph, KeyframeCache(8), &keyframe_database, nullptr},
               {{{}, {.max_correction_m = 0.25F, .max_correction_rad = 0.25F}, {}}, {}, {}});
  }
};

TEST(StoredView, ComesBackWithinAThirtiethOfTheNoise) {
  ViewPyramid before, after;
  make_pyramid(frame_at(on_path(0, 1), 0), {}, before);
  const Image<std::uint8_t> measured(320, 240, 1);
  restore(store(before, measured), {}, after);
  ASSERT_EQ(after.levels.size(), before.levels.size());
  for (std::size_t level = 0; level < before.levels.size(); ++level) {
    EXPECT_EQ(after.levels[level].camera, before.levels[level].camera);
    EXPECT_EQ(after.levels[level].intensity.pixels.size(), before.levels[level].intensity.pixels.size());
  }
  const ViewPyramid::Level &a = before.levels[0], &b = after.levels[0];
  for (std::size_t i = 0; i < a.inverse_depth_per_m.pixels.size(); ++i) {
    ASSERT_NEAR(b.inverse_depth_per_m.pixels[i], a.inverse_depth_per_m.pixels[i],
                0.51F * kInverseDepthStep_per_m);
    ASSERT_NEAR(b.intensity.pixels[i], a.intensity.pixels[i], 1.0F);
  }
}

TEST(PackedView, ComesBackAsItWas) {
  ViewPyramid pyramid;
  make_pyramid(frame_at(on_path(0, 1), 0), {}, pyramid);
  Image<std::uint8_t> measured(320, 240, 1);
  for (std::size_t i = 0; i < measured.pixels.size(); ++i) measured.pixels[i] = static_cast<std::uint8_t>(i);
  StoredView with_colour = store(pyramid, measured);
  with_colour.inverse_depth.pixels[0] = 65535;  // the greatest differences, in both directions
  with_colour.inverse_depth.pixels[1] = 0;
  with_colour.inverse_depth.pixels[2] = 32768;
  with_colour.intensity.pixels[0] = 255;
  with_colour.intensity.pixels[1] = 0;
  with_colour.intensity.pixels[2] = 128;
  StoredView without_colour = with_colour;
  without_colour.intensity.resize(0, 0);
  for (const StoredView& view : {with_colour, without_colour, StoredView{}}) {
    const StoredView again = unpacked(packed(view));
    EXPECT_EQ(again.camera, view.camera);
    EXPECT_EQ(again.noise, view.noise);
    EXPECT_EQ(again.inverse_depth.pixels, view.inverse_depth.pixels);
    EXPECT_EQ(again.intensity.pixels, view.intensity.pixels);
    EXPECT_EQ(again.measured.pixels, view.measured.pixels);
    EXPECT_EQ(again.intensity.width, view.intensity.width);
  }
  EXPECT_LT(packed(with_colour).columns.size(), 4U * 320 * 240 * 6 / 10);
}

TEST(StoredView, HasNoIntensityWhereThereWasNoColour) {
  ViewPyramid before, after;
  Frame frame = frame_at(on_path(0, 1), 0);
  make_pyramid(frame.depth_m, frame.depth_camera, {}, before);
  restore(store(before, Image<std::uint8_t>(320, 240, 1)), {}, after);
  for (const ViewPyramid::Level& level : after.levels) EXPECT_TRUE(level.intensity.empty());
}

TEST(KeyframeCache, ForgetsTheOneThatWasNotAskedForTheLongest) {
  KeyframeCache prepare_keyframe(2);
  const auto one = std::make_shared<CachedKeyframe>();
  prepare_keyframe.put(1, one);
  prepare_keyframe.put(2, std::make_shared<CachedKeyframe>());
  EXPECT_EQ(prepare_keyframe.find(1), one);
  prepare_keyframe.put(3, std::make_shared<CachedKeyframe>());
  EXPECT_EQ(prepare_keyframe.find(1), one);
  EXPECT_EQ(prepare_keyframe.find(2), nullptr);
  EXPECT_NE(prepare_keyframe.find(3), nullptr);
  prepare_keyframe.put(3, one);  // replaces the entry
  EXPECT_EQ(prepare_keyframe.find(3), one);
  EXPECT_EQ(prepare_keyframe.find(1), one);
}

TEST(KeyframeCache, MakesRoomByTheEntryThatAPutWouldRemove) {
  KeyframeCache cache(2);
  const auto one = std::make_shared<CachedKeyframe>(), two = std::make_shared<CachedKeyframe>();
  EXPECT_EQ(cache.make_room(1), nullptr);
  cache.put(1, one);
  cache.put(2, two);
  EXPECT_EQ(cache.make_room(2), two);  // would be replaced
  EXPECT_EQ(cache.find(2), nullptr);
  EXPECT_EQ(cache.make_room(3), nullptr);  // there is room
  cache.put(2, two);
  EXPECT_EQ(cache.make_room(3), one);  // least recently used
  EXPECT_EQ(cache.find(1), nullptr);
  EXPECT_EQ(cache.find(2), two);
}

TEST(KeyframeGraph, ALoopIsFoundByItsLooksThoughDriftHasParted) {
  // 1 m and 17 degrees off after 30 m: too far for the poses to suggest a loop.
  const Eigen::Isometry3d drift =
      Eigen::Translation3d(0.9, 0.1, 0.4) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  const RoundTrip trip(drift, 30.0);
  ASSERT_GT(view_distance(trip.graph.keyframes[0].T_world_camera.inverse() *
                          trip.graph.keyframes[4].T_world_camera),
            KeyframeGraphConfig{}.furthest);
  const KeyframeJobResult result = trip.run_job();
  EXPECT_EQ(result.graph.loops_found, 1);
  const Eigen::Isometry3d error = trip.T_last.inverse() * result.graph.keyframes.back().T_world_camera;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.01);
}

TEST(KeyframeGraph, ALookAlikePlaceFurtherOffThanDriftIsAnotherPlace) {
  // The same appearance and depth, 6 m away after a path of 7 m: the room next door has the same kitchen.
  const RoundTrip trip(Eigen::Isometry3d(Eigen::Translation3d(6.0, 0.0, 0.0)), 7.0);
  const KeyframeJobResult result = trip.run_job();
  EXPECT_EQ(result.graph.loops_found, 0);
  EXPECT_EQ(result.graph.loops_rejected, 1);
  EXPECT_TRUE(
      result.graph.keyframes.back().T_world_camera.isApprox(trip.graph.keyframes.back().T_world_camera));
}

TEST(KeyframeGraph, AJoinMustAgreeBothWays) {
  // A view of another room at the first keyframe's pose: no edge is added.
  RoundTrip trip(Eigen::Isometry3d::Identity(), 3.0);
  const test::Scene other = test::nearest_of(test::plane({0, 1, 0}, 1.4), test::sphere({0.3, 1.0, 0.9}, 0.4));
  trip.graph.keyframes.back() = keyframe_of(frame_at(trip.T_last, 9, other), trip.T_last, 3.0);
  KeyframeCache prepare_keyframe(4);
  EXPECT_FALSE(join(trip.graph, 0, 4, trip.T_first.inverse() * trip.T_last, {}, prepare_keyframe));
  EXPECT_EQ(trip.graph.loops_rejected, 1);
  EXPECT_TRUE(trip.graph.constraints.empty());
}

/// Keyframes along a curved path, each with exact edges to the next `reach` keyframes, and with disturbed
/// poses.
struct Way {
  std::vector<Eigen::Isometry3d> truth;
  KeyframeGraph graph;

  explicit Way(std::size_t reach) {
    for (int i = 0; i < 16; ++i) {
      truth.push_back(Eigen::Translation3d(0.08 * i, 0.02 * i * (i % 3), 0.01 * i) *
                      Eigen::AngleAxisd(0.06 * i, Eigen::Vector3d(0.2, 1.0, 0.1).normalized()));
      const double off = i == 0 ? 0.0 : 0.02 * (i % 5 - 2);
      const Eigen::Isometry3d T = truth.back() * Eigen::Translation3d(off, -off, 0.01) *
                                  Eigen::AngleAxisd(off, Eigen::Vector3d::UnitX());
      graph.keyframes.push_back(
          {i, i == 0 ? truth.back() : T, std::make_shared<const PackedView>(), 0, 0.1 * i, {}});
    }
    for (std::size_t a = 0; a < truth.size(); ++a) {
      for (std::size_t b = a + 1; b < truth.size() && b <= a + reach; ++b)
        graph.constraints.push_back(
            {a, b, truth[a].inverse() * truth[b], 1e6 * Matrix6d::Identity(), b - a > 2});
    }
  }
  /// RMS position error of all keyframes after the best rigid alignment with the true poses.
  [[nodiscard]] double position_error_m() const {
    std::vector<TimedPose> found, true_poses;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto index = static_cast<std::int64_t>(i);
      found.push_back({index, 0.0, graph.keyframes[i].T_world_camera});
      true_poses.push_back({index, 0.0, truth[i]});
    }
    return absolute_trajectory_error(found, true_poses).rmse_m;
  }
};

TEST(PositionsThenTurns, ExactMotionsGiveTheExactPosesAndTheFirstStays) {
  Way way(4);
  solve_positions_then_turns(way.graph);
  EXPECT_TRUE(way.graph.keyframes[0].T_world_camera.isApprox(way.truth[0], 1e-9));
  for (std::size_t i = 0; i < way.truth.size(); ++i)
    EXPECT_TRUE(way.graph.keyframes[i].T_world_camera.isApprox(way.truth[i], 1e-5)) << i;
}

TEST(PositionsThenTurns, MotionsBetweenLikeViewsOverruleThoseBetweenUnlikeOnes) {
  // Effect of a fixed distortion: the more two keyframes' views differ, the larger the error of the motion
  // between them.
  Way way(8);
  for (PoseConstraint& c : way.graph.constraints) {
    if (view_distance(c.T_a_b) > 1.0) c.T_a_b = c.T_a_b * Eigen::Translation3d(0.03, 0.0, 0.0);
  }
  solve_positions_then_turns(way.graph);
  EXPECT_LT(way.position_error_m(), 0.005);
}

TEST(PositionsThenTurns, ADirectionThatAMotionDoesNotFixIsTakenFromOthers) {
  // Each keyframe and the second one after it see one wall: along the wall their alignment is only a guess.
  Way way(2);
  for (PoseConstraint& c : way.graph.constraints) {
    if (c.b != c.a + 2) continue;
    const Eigen::Vector3d along = Eigen::Vector3d(1.0, 2.0, 0.5).normalized();
    c.information.topLeftCorner<3, 3>() -= 1e6 * along * along.transpose();
    c.T_a_b = c.T_a_b * Eigen::Translation3d(0.3 * along);
  }
  solve_positions_then_turns(way.graph);
  EXPECT_LT(way.position_error_m(), 1e-4);
}

TEST(PositionsThenTurns, AWrongLoopIsOverruled) {
  Way way(4);
  // A wrong edge: it places the last keyframe, 1.2 m away, at the first.
  way.graph.constraints.push_back({0, 15, Eigen::Isometry3d::Identity(), 1e6 * Matrix6d::Identity(), true});
  solve_positions_then_turns(way.graph);
  EXPECT_LT(way.position_error_m(), 0.015);
}

TEST(PositionsThenTurns, AnchoredKeyframesStandWhereTheMapSays) {
  Way way(4);
  const Eigen::Isometry3d T_map_world =
      Eigen::Translation3d(2.0, -1.0, 0.5) * Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  for (const std::size_t i : {2UL, 13UL})
    way.graph.anchors.push_back({i, T_map_world * way.truth[i], 1e4 * Matrix6d::Identity()});
  for (Keyframe& keyframe : way.graph.keyframes)
    keyframe.T_world_camera = T_map_world * keyframe.T_world_camera;
  solve_positions_then_turns(way.graph);
  for (std::size_t i = 0; i < way.truth.size(); ++i)
    EXPECT_TRUE(way.graph.keyframes[i].T_world_camera.isApprox(T_map_world * way.truth[i], 1e-4)) << i;
}

TEST(PositionsThenTurns, NothingAndOneStayAsTheyAre) {
  KeyframeGraph none;
  solve_positions_then_turns(none);
  EXPECT_TRUE(none.keyframes.empty());
  Way one(1);
  one.graph.keyframes.resize(1);
  one.graph.constraints.clear();
  solve_positions_then_turns(one.graph);
  EXPECT_TRUE(one.graph.keyframes[0].T_world_camera.isApprox(one.truth[0], 1e-12));
}

}  // namespace
}  // namespace roomradar::keyframe_graph_test
