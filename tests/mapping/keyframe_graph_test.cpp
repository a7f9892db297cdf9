// keyframe_graph_test.cpp: keyframes kept and restored, loops closed where drift explains them, and refused
// where it does not.
#include "mapping/keyframe_graph.hpp"

#include <gtest/gtest.h>

#include "mapping/keyframe_job.hpp"
#include "tests/support/noisy_room.hpp"

namespace roomradar {
namespace {

using test::frame_at, test::on_path;

/// One keyframe of a frame, thought to be at T_world_camera.
Keyframe keyframe_of(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double way_m) {
  ViewPyramid pyramid;
  make_pyramid(frame, {}, pyramid);
  const Image<std::uint8_t> measured(pyramid.levels[0].camera.width_px, pyramid.levels[0].camera.height_px,
                                     1);
  return {frame.index, T_world_camera, std::make_shared<const StoredView>(store(pyramid, measured)), 0,
          way_m};
}

/// A camera goes away and comes back to where it was at its first keyframe. Drift puts the last keyframe
/// `drift` off.
struct RoundTrip {
  Eigen::Isometry3d T_first = on_path(0, 1);
  Eigen::Isometry3d T_last = on_path(0, 1) * Eigen::Translation3d(0.03, 0.0, 0.02);
  Frame first = frame_at(T_first, 0), last = frame_at(T_last, 9);
  Places places;
  KeyframeGraph graph;

  RoundTrip(const Eigen::Isometry3d& drift, double way_m) {
    graph.keyframes = {keyframe_of(first, T_first, 0.0), keyframe_of(last, T_last * drift, way_m)};
    // In between, away from both: three keyframes that see nothing of this.
    for (int i = 1; i <= 3; ++i) {
      Keyframe blind = graph.keyframes[0];
      blind.view = std::make_shared<const StoredView>([&] {
        StoredView view = *blind.view;
        std::fill(view.inverse_depth.pixels.begin(), view.inverse_depth.pixels.end(), std::uint16_t{0});
        return view;
      }());
      blind.T_world_camera.translation().x() += 3.0 * i;
      blind.way_m = way_m * i / 4.0;
      graph.keyframes.insert(graph.keyframes.end() - 1, blind);
    }
    places.keyframes.push_back(describe_place(first, T_first));
    for (int i = 1; i <= 3; ++i)
      places.keyframes.push_back(
          {i, graph.keyframes[static_cast<std::size_t>(i)].T_world_camera, {}, {}, {}, {}});
  }
  KeyframeJobResult run_job() const {
    return run({last, graph, WarmKeyframes(8), &places, nullptr},
               {{{}, {.max_correction_m = 0.25F}, {}}, {}, {}});
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

TEST(StoredView, HasNoIntensityWhereThereWasNoColour) {
  ViewPyramid before, after;
  Frame frame = frame_at(on_path(0, 1), 0);
  make_pyramid(frame.depth_m, frame.depth_camera, {}, before);
  restore(store(before, Image<std::uint8_t>(320, 240, 1)), {}, after);
  for (const ViewPyramid::Level& level : after.levels) EXPECT_TRUE(level.intensity.empty());
}

TEST(WarmKeyframes, ForgetsTheOneThatWasNotAskedForTheLongest) {
  WarmKeyframes warm(2);
  warm.put(1, std::make_shared<WarmKeyframe>());
  warm.put(2, std::make_shared<WarmKeyframe>());
  const auto one = warm.find(1);
  warm.put(3, std::make_shared<WarmKeyframe>());
  EXPECT_EQ(warm.find(1), one);
  EXPECT_EQ(warm.find(2), nullptr);
  EXPECT_NE(warm.find(3), nullptr);
  warm.put(3, one);  // in place of what was held
  EXPECT_EQ(warm.find(3), one);
  EXPECT_EQ(warm.find(1), one);
}

TEST(KeyframeGraph, ALoopIsFoundByItsLooksThoughDriftHasParted) {
  // 1 m and 17 degrees off after 30 m: too far for the poses to suggest it.
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
  // The same looks and the same depth, 6 m away after a way of 7 m: the room next door has the same kitchen.
  const RoundTrip trip(Eigen::Isometry3d(Eigen::Translation3d(6.0, 0.0, 0.0)), 7.0);
  const KeyframeJobResult result = trip.run_job();
  EXPECT_EQ(result.graph.loops_found, 0);
  EXPECT_EQ(result.graph.loops_rejected, 1);
  EXPECT_TRUE(
      result.graph.keyframes.back().T_world_camera.isApprox(trip.graph.keyframes.back().T_world_camera));
}

TEST(KeyframeGraph, AJoinMustAgreeBothWays) {
  // Another room's view where the first one's should be: nothing is joined.
  RoundTrip trip(Eigen::Isometry3d::Identity(), 3.0);
  const test::Scene other = test::nearest_of(test::plane({0, 1, 0}, 1.4), test::sphere({0.3, 1.0, 0.9}, 0.4));
  trip.graph.keyframes.back() = keyframe_of(frame_at(trip.T_last, 9, other), trip.T_last, 3.0);
  WarmKeyframes warm(4);
  EXPECT_FALSE(join(trip.graph, 0, 4, trip.T_first.inverse() * trip.T_last, {}, warm));
  EXPECT_EQ(trip.graph.loops_rejected, 1);
  EXPECT_TRUE(trip.graph.constraints.empty());
}

TEST(KeyframeGraph, JoiningAllAnewDoesNotDependOnThreads) {
  KeyframeGraph graph;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d T = on_path(i, 30);
    graph.keyframes.push_back(keyframe_of(frame_at(T, i), T, 0.1 * i));
  }
  KeyframeGraph again = graph;
  join_all(graph, {});
  join_all(again, {});
  ASSERT_GT(graph.constraints.size(), 8U);
  ASSERT_EQ(again.constraints.size(), graph.constraints.size());
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    EXPECT_EQ(again.constraints[i].a, graph.constraints[i].a);
    EXPECT_EQ(again.constraints[i].T_a_b.matrix(), graph.constraints[i].T_a_b.matrix());
  }
  KeyframeGraph none, one;
  join_all(none, {});
  one.keyframes.push_back(again.keyframes[0]);
  join_all(one, {});
  EXPECT_TRUE(one.constraints.empty());
}

}  // namespace
}  // namespace roomradar
