// keyframe_pairs_test.cpp: the choice of pairs of keyframes, and their alignment while a scan goes on.
#include "mapping/odometry/keyframe_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/support/noisy_room.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar::keyframe_pairs_test {
namespace {

using test::frame_at, test::on_path;

Keyframe keyframe_at(const Eigen::Isometry3d& T_world_camera, int index) {
  return {index, T_world_camera, test::stored_view(frame_at(T_world_camera, index)), 0, 0.1 * index, {}};
}

std::vector<Keyframe> keyframes_on_path(int count) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < count; ++i) keyframes.push_back(keyframe_at(on_path(i, 30), i));
  return keyframes;
}

/// Keyframes without views. Each visit moves by 1 cm a keyframe, from the origin; between visits lies one
/// keyframe 5 m away.
std::vector<Keyframe> visits(int count, int keyframes_per_visit) {
  std::vector<Keyframe> keyframes;
  for (int visit = 0; visit < count; ++visit) {
    for (int i = 0; i <= keyframes_per_visit; ++i) {
      Keyframe keyframe;
      keyframe.T_world_camera.translation().x() = i < keyframes_per_visit ? 0.01 * i : 5.0;
      keyframes.push_back(keyframe);
    }
  }
  return keyframes;
}

TEST(KeyframePairs, OneKeyframeOfEachVisitIsChosenTheMostSimilar) {
  std::vector<Keyframe> keyframes = visits(3, 4);
  keyframes.emplace_back();  // at the origin
  KeyframeGraphConfig config;
  config.max_edges_rebuild = 3;
  EXPECT_EQ(choose_older(keyframes, 15, {}, config), (std::vector<std::size_t>{0, 5, 10}));
  const std::vector<KeyframePair> aligned{{7, 15, {}, {}}, {8, 15, {}, {}}};
  EXPECT_EQ(choose_older(keyframes, 15, aligned, config), (std::vector<std::size_t>{0, 7, 10}));
  config.max_edges_rebuild = 100;
  EXPECT_EQ(choose_older(keyframes, 15, {}, config).size(), 12U);
  EXPECT_TRUE(choose_older(keyframes, 0, {}, config).empty());
}

TEST(KeyframePairs, ClosingLoopsDoesNotDependOnThreads) {
  KeyframeGraph graph;
  graph.keyframes = keyframes_on_path(6);
  KeyframeGraph again = graph;
  close_loops(graph, {}, {});
  close_loops(again, {}, {});
  ASSERT_GT(graph.constraints.size(), 8U);
  ASSERT_EQ(again.constraints.size(), graph.constraints.size());
  for (std::size_t i = 0; i < graph.constraints.size(); ++i) {
    EXPECT_EQ(again.constraints[i].a, graph.constraints[i].a);
    EXPECT_EQ(again.constraints[i].T_a_b.matrix(), graph.constraints[i].T_a_b.matrix());
  }
  KeyframeGraph none, one;
  close_loops(none, {}, {});
  one.keyframes.push_back(again.keyframes[0]);
  close_loops(one, {}, {});
  EXPECT_TRUE(one.constraints.empty());
}

TEST(KeyframePairs, WhatIsAlignedAlreadyIsUsedAsItIs) {
  KeyframeGraph graph;
  graph.keyframes = keyframes_on_path(4);
  std::vector<KeyframePair> aligned = align_pairs(graph.keyframes, 1, 3, {}, {}, 1);
  ASSERT_EQ(aligned.size(), 3U);
  // A mark that no alignment would give.
  for (KeyframePair& pair : aligned) pair.newer_in_older.information = 7.0 * Matrix6d::Identity();
  close_loops(graph, aligned, {});
  ASSERT_EQ(graph.constraints.size(), 12U);
  int marked = 0;
  for (const PoseConstraint& constraint : graph.constraints) {
    const bool is_marked = constraint.information == 7.0 * Matrix6d::Identity();
    EXPECT_EQ(is_marked, constraint.b < 3 && constraint.a < constraint.b);
    marked += is_marked ? 1 : 0;
  }
  EXPECT_EQ(marked, 3);
}

TEST(PairAligner, AlignsAllButTheNewestInBatchesAndGivesTheSameAsAtOnce) {
  const std::vector<Keyframe> all = keyframes_on_path(22);
  PairAligner aligner, resumed;
  std::size_t final_keyframes = 0;
  for (std::size_t count = 1; count <= all.size(); ++count) {
    const std::vector<Keyframe> keyframes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    const std::size_t now = aligner.advance(keyframes, {});
    EXPECT_GE(now, final_keyframes);
    EXPECT_LT(now, count);
    final_keyframes = now;
    // A scan that was resumed after 19 keyframes makes the same keyframes final.
    if (count > 19) {
      EXPECT_EQ(resumed.advance(keyframes, {}), now);
    }
  }
  EXPECT_EQ(final_keyframes, 16U);
  const std::vector<KeyframePair> expected =
      align_pairs(std::span(all).first(final_keyframes), 1, final_keyframes, {}, {}, 2);
  for (PairAligner* one : {&aligner, &resumed}) {
    const std::vector<KeyframePair> pairs = one->finish();
    ASSERT_EQ(pairs.size(), expected.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_EQ(pairs[i].older, expected[i].older);
      EXPECT_EQ(pairs[i].newer, expected[i].newer);
      EXPECT_EQ(pairs[i].newer_in_older.T_world_camera.matrix(),
                expected[i].newer_in_older.T_world_camera.matrix());
    }
  }
}

}  // namespace
}  // namespace roomradar::keyframe_pairs_test
