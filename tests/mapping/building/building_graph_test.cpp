// building_graph_test.cpp: recordings are placed by joins; joins that contradict the others are refused.
#include "mapping/building/building_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace roomradar::building_graph_test {
namespace {

Eigen::Isometry3d pose(const Eigen::Vector3d& t, double yaw_rad = 0.0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = t;
  return T;
}

/// A ring of recordings round a courtyard, each along one piece of it, which overlaps with the next.
struct Ring {
  std::vector<std::vector<Eigen::Isometry3d>> truth;  ///< T_building_keyframe
  std::vector<GraphSubmap> submaps;                   ///< with drift
  std::vector<GraphJoin> joins;                       ///< of neighbours
};

constexpr std::size_t kRecordings = 8, kKeyframes = 12, kShared = 3;
constexpr double kRadius_m = 16.0;

Eigen::Isometry3d on_ring(std::size_t step) {
  const double a = 2.0 * M_PI * static_cast<double>(step) / (kRecordings * (kKeyframes - kShared));
  return pose({kRadius_m * std::cos(a), kRadius_m * std::sin(a), 1.5}, a);
}

GraphJoin join_of(const Ring& ring, std::size_t a, std::size_t b,
                  const std::vector<std::pair<std::size_t, std::size_t>>& keyframes) {
  GraphJoin join{a, b, {}};
  join.join.status = JoinStatus::kJoined;
  join.join.agreeing = static_cast<int>(keyframes.size());
  for (const auto& [i, j] : keyframes) {
    KeyframeLink link{i, j, ring.truth[a][i].inverse() * ring.truth[b][j], Matrix6d::Identity()};
    link.information *= 1e4;  // 1 cm
    join.join.links.push_back(link);
  }
  return join;
}

Ring make_ring(double drift_rad = 0.002) {
  Ring ring;
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  for (std::size_t r = 0; r < kRecordings; ++r) {
    ring.truth.emplace_back();
    GraphSubmap submap;
    Eigen::Isometry3d T_submap = Eigen::Isometry3d::Identity();
    for (std::size_t k = 0; k < kKeyframes; ++k) {
      ring.truth[r].push_back(on_ring(r * (kKeyframes - kShared) + k));
      if (k > 0)
        T_submap = T_submap * ring.truth[r][k - 1].inverse() * ring.truth[r][k] *
                   pose({0.002 * noise(random), 0.002 * noise(random), 0.0}, drift_rad);
      submap.T_submap_keyframe.push_back(T_submap);
    }
    ring.submaps.push_back(std::move(submap));
  }
  for (std::size_t r = 0; r < kRecordings; ++r) {
    const std::size_t next = (r + 1) % kRecordings;
    const auto last = [](std::size_t k) { return kKeyframes - kShared + k; };
    if (next == 0) continue;
    ring.joins.push_back(join_of(ring, r, next, {{last(0), 0}, {last(1), 1}, {last(2), 2}}));
  }
  return ring;
}

/// Closes the ring: the last recording ends where the first begins.
GraphJoin closing(const Ring& ring) {
  return join_of(ring, 0, kRecordings - 1,
                 {{0, kKeyframes - kShared}, {1, kKeyframes - kShared + 1}, {2, kKeyframes - 1}});
}

/// Greatest distance from the truth, with the first keyframe where it truly is.
double error_m(const Ring& ring, const BuildingGraph& graph) {
  const Eigen::Isometry3d T_truth = ring.truth[0][0] * graph.submaps[0].T_building_keyframe[0].inverse();
  double most_m = 0.0;
  for (std::size_t r = 0; r < kRecordings; ++r)
    for (std::size_t k = 0; k < kKeyframes; ++k)
      most_m = std::max(most_m, ((T_truth * graph.submaps[r].T_building_keyframe[k]).translation() -
                                 ring.truth[r][k].translation())
                                    .norm());
  return most_m;
}

TEST(BuildingGraph, AClosedRingDriftsLessThanAnOpenOne) {
  Ring ring = make_ring();
  const BuildingGraph open = solve_building(ring.submaps, ring.joins);
  ring.joins.push_back(closing(ring));
  const BuildingGraph closed = solve_building(ring.submaps, ring.joins);
  EXPECT_EQ(closed.parts, 1U);
  for (const bool used : closed.is_used) EXPECT_TRUE(used);
  EXPECT_GT(error_m(ring, open), 1.0);
  EXPECT_LT(error_m(ring, closed), 0.15 * error_m(ring, open));
}

TEST(BuildingGraph, AFalseJoinIsRefusedWhetherItComesFirstOrLast) {
  for (const bool is_strong : {false, true}) {
    Ring ring = make_ring();
    ring.joins.push_back(closing(ring));
    // Recordings 1 and 5 seem to show the same room.
    GraphJoin wrong = join_of(ring, 1, 5, {{4, 4}, {5, 5}, {6, 6}});
    for (KeyframeLink& link : wrong.join.links) link.T_a_b = pose({0.1, 0.0, 0.0});
    if (is_strong) wrong.join.agreeing = 20;  // more keyframes than any true join
    ring.joins.insert(ring.joins.begin(), wrong);
    const BuildingGraph graph = solve_building(ring.submaps, ring.joins);
    EXPECT_FALSE(graph.is_used[0]);
    for (std::size_t j = 1; j < graph.is_used.size(); ++j) EXPECT_TRUE(graph.is_used[j]) << j;
    EXPECT_LT(error_m(ring, graph), 0.5);
  }
}

TEST(BuildingGraph, RecordingsThatNothingJoinsArePartsOfTheirOwn) {
  Ring ring = make_ring();
  ring.joins.erase(ring.joins.begin() + 3);
  const BuildingGraph graph = solve_building(ring.submaps, ring.joins);
  EXPECT_EQ(graph.parts, 2U);
  for (std::size_t r = 0; r < kRecordings; ++r) EXPECT_EQ(graph.submaps[r].part, r < 4 ? 0U : 1U) << r;
}

TEST(BuildingGraph, EarlierPosesAreKeptUnlessTheyAreWrong) {
  Ring ring = make_ring();
  ring.joins.push_back(closing(ring));
  const BuildingGraph first = solve_building(ring.submaps, ring.joins);
  for (std::size_t r = 0; r < kRecordings; ++r)
    ring.submaps[r].T_building_keyframe = first.submaps[r].T_building_keyframe;
  const BuildingGraph same = solve_building(ring.submaps, ring.joins);
  for (std::size_t r = 0; r < kRecordings; ++r) {
    EXPECT_TRUE(same.submaps[r].was_kept);
    for (std::size_t k = 0; k < kKeyframes; ++k)
      EXPECT_EQ(same.submaps[r].T_building_keyframe[k].matrix(),
                first.submaps[r].T_building_keyframe[k].matrix())
          << "to the bit";
  }
  // Recording 4 was recorded again; the others stay.
  ring.submaps[4].T_building_keyframe.clear();
  ring.submaps[4].T_submap_keyframe[5].translation().x() += 0.002;
  const BuildingGraph changed = solve_building(ring.submaps, ring.joins);
  for (std::size_t r = 0; r < kRecordings; ++r) EXPECT_EQ(changed.submaps[r].was_kept, r != 4) << r;
  EXPECT_LT(error_m(ring, changed), 1.2 * error_m(ring, first) + 0.02);
}

TEST(BuildingGraph, NoRecordingsAndEmptyOnes) {
  EXPECT_EQ(solve_building({}, {}).parts, 0U);
  const std::vector<GraphSubmap> empty(2);
  const BuildingGraph graph = solve_building(empty, {});
  EXPECT_EQ(graph.parts, 2U);
  EXPECT_TRUE(graph.submaps[1].T_building_keyframe.empty());
}

}  // namespace
}  // namespace roomradar::building_graph_test
