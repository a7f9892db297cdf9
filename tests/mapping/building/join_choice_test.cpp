// join_choice_test.cpp: rooms with a twin on another floor, which only what lies around them tells apart.
#include "mapping/building/join_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace roomradar::join_choice_test {
namespace {

constexpr double kFloor_m = 3.0, kRoom_m = 5.0;
constexpr std::size_t kRooms = 4;
constexpr std::size_t kInRoom = 3;  // keyframes of a walk in its room; the others are in the corridor

Eigen::Isometry3d pose(double x_m, double y_m, std::size_t floor, double yaw_rad) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(x_m, y_m, kFloor_m * static_cast<double>(floor) + 1.5);
  return T;
}

const Eigen::Vector3d kStays_m = Eigen::Vector3d::Zero();

/// Two floors with a corridor and rooms along it. Recordings: on each floor one of the corridor, in both
/// directions, and one of each room, which goes out and along the corridor. On floor 1 these look the other
/// way there, so that two recordings of a room and of its twin share no view of the corridor.
struct Floors {
  std::vector<std::vector<Eigen::Isometry3d>> truth;
  std::vector<GraphSubmap> submaps;
  std::vector<GraphJoin> joins;

  static std::size_t corridor(std::size_t floor) { return floor * (kRooms + 1); }
  static std::size_t room(std::size_t floor, std::size_t number) { return corridor(floor) + 1 + number; }

  Floors() {
    for (std::size_t floor = 0; floor < 2; ++floor) {
      std::vector<Eigen::Isometry3d> along;
      for (const double yaw_rad : {0.0, M_PI})
        for (int x_m = 0; x_m <= 20; ++x_m) along.push_back(pose(x_m, 0.0, floor, yaw_rad));
      add(along);
      for (std::size_t number = 0; number < kRooms; ++number) {
        const double x_m = kRoom_m * static_cast<double>(number);
        std::vector<Eigen::Isometry3d> walk;
        for (std::size_t k = 0; k < kInRoom; ++k)
          walk.push_back(pose(x_m, 4.0 - static_cast<double>(k), floor, 0.0));
        for (int k = 0; k < 5; ++k) walk.push_back(pose(x_m + k, 0.0, floor, floor == 0 ? 0.0 : M_PI));
        add(walk);
        // The corridor's keyframes at the walk's end.
        const std::size_t at = static_cast<std::size_t>(x_m) + (floor == 0 ? 0 : 21);
        join(corridor(floor), room(floor, number), {{at + 1, 4}, {at + 2, 5}, {at + 3, 6}}, kStays_m);
      }
    }
  }

  void add(const std::vector<Eigen::Isometry3d>& poses) {
    truth.push_back(poses);
    submaps.emplace_back();
    for (const Eigen::Isometry3d& T : poses)
      submaps.back().T_submap_keyframe.push_back(poses.front().inverse() * T);
  }

  /// @param seems_moved_m  from where b truly is to where the join puts it
  void join(std::size_t a, std::size_t b, const std::vector<std::pair<std::size_t, std::size_t>>& keyframes,
            const Eigen::Vector3d& seems_moved_m) {
    GraphJoin join{a, b, {}};
    join.join.status = JoinStatus::kJoined;
    join.join.agreeing = 20;
    join.join.agreement = 0.99;
    for (const auto& [i, j] : keyframes) {
      const Eigen::Isometry3d T_b = Eigen::Translation3d(seems_moved_m) * truth[b][j];
      join.join.links.push_back({i, j, truth[a][i].inverse() * T_b, Matrix6d::Identity() * 1e4});
    }
    joins.push_back(std::move(join));
  }

  /// Recordings are recognised where they are truly at the same place.
  [[nodiscard]] TestOverlap sight() const {
    return [this](std::size_t a, std::size_t b, std::span<const PredictedPair> pairs) {
      PlacementTest test;
      std::optional<std::size_t> last;
      int miss = 0;
      for (const PredictedPair& pair : pairs) {
        if (pair.b == last) continue;
        last = pair.b;
        const Eigen::Isometry3d T_a_b = truth[a][pair.a].inverse() * truth[b][pair.b];
        const bool is_recognised = (T_a_b.inverse() * pair.T_a_b).translation().norm() < 0.5;
        ++test.expected;
        test.recognised += is_recognised ? 1 : 0;
        test.same += 100;
        miss = is_recognised ? 0 : miss + 1;
        test.longest_miss = std::max(test.longest_miss, miss);
      }
      return test;
    };
  }
};

std::vector<bool> chosen(const Floors& floors, bool with_sight) {
  return choose_joins(floors.submaps, floors.joins, with_sight ? floors.sight() : TestOverlap{});
}

TEST(JoinChoice, JoinsThatAgreeAreAllUsed) {
  const Floors floors;
  for (const bool is_used : chosen(floors, true)) EXPECT_TRUE(is_used);
}

const std::vector<std::pair<std::size_t, std::size_t>> kTwin = {{0, 0}, {1, 1}, {2, 2}};
const Eigen::Vector3d kDown_m(0.0, 0.0, -kFloor_m);

TEST(JoinChoice, TwinRoomsAreToldByTheCorridorInFrontOfThem) {
  // A stair joins the floors, and two rooms have twins below, which together say otherwise.
  Floors floors;
  const std::size_t stair = floors.joins.size();
  floors.join(Floors::corridor(0), Floors::corridor(1), {{0, 0}, {1, 1}, {2, 2}}, kStays_m);
  floors.join(Floors::room(0, 1), Floors::room(1, 1), kTwin, kDown_m);
  floors.join(Floors::room(0, 2), Floors::room(1, 2), kTwin, kDown_m);
  EXPECT_FALSE(chosen(floors, false)[stair]) << "too easy: the number of joins decides it";
  const std::vector<bool> is_used = chosen(floors, true);
  for (std::size_t j = 0; j <= stair; ++j) EXPECT_TRUE(is_used[j]) << j;
  EXPECT_FALSE(is_used[stair + 1]);
  EXPECT_FALSE(is_used[stair + 2]);
}

TEST(JoinChoice, ATwinThatNoCycleContradictsIsRefused) {
  Floors floors;
  floors.join(Floors::room(0, 1), Floors::room(1, 1), kTwin, kDown_m);
  EXPECT_TRUE(chosen(floors, false).back());
  const std::vector<bool> is_used = chosen(floors, true);
  EXPECT_FALSE(is_used.back());
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 1);
}

TEST(JoinChoice, KeyframesThatAreMissedHereAndThereAreNoConflict) {
  Floors floors;
  const TestOverlap hazy = [sight = floors.sight()](std::size_t a, std::size_t b,
                                                    std::span<const PredictedPair> pairs) {
    PlacementTest test = sight(a, b, pairs);
    test.recognised /= 2;  // every other one
    test.longest_miss = 1;
    return test;
  };
  floors.join(Floors::corridor(0), Floors::corridor(1), {{0, 0}, {1, 1}, {2, 2}}, kStays_m);
  const std::vector<bool> is_used = choose_joins(floors.submaps, floors.joins, hazy);
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
}

TEST(JoinChoice, APlaceThatChangedDoesNotBreakManyJoins) {
  // The corridor's end was repainted before room 3 was recorded again: four keyframes are not recognised.
  Floors floors;
  const std::size_t first = floors.joins.size();
  floors.add(floors.truth[Floors::room(0, 3)]);
  const std::size_t again = floors.truth.size() - 1;
  floors.join(Floors::room(0, 3), again, {{0, 0}, {1, 1}, {2, 2}}, kStays_m);
  floors.join(Floors::room(0, 3), again, {{0, 0}, {1, 1}, {2, 2}}, kStays_m);
  floors.join(Floors::corridor(0), Floors::room(0, 3), {{16, 4}, {17, 5}, {18, 6}}, kStays_m);
  const TestOverlap changed = [&, sight = floors.sight()](std::size_t a, std::size_t b,
                                                          std::span<const PredictedPair> pairs) {
    PlacementTest test = sight(a, b, pairs);
    if (b == again) test.longest_miss = std::min(test.expected, 4);
    return test;
  };
  const std::vector<bool> is_used = choose_joins(floors.submaps, floors.joins, changed);
  EXPECT_EQ(std::count(is_used.begin(), is_used.begin() + static_cast<std::ptrdiff_t>(first), false), 0);
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
}

TEST(JoinChoice, NothingIsChosenOfNothing) {
  EXPECT_TRUE(choose_joins({}, {}, {}).empty());
  const std::vector<GraphSubmap> submaps(3);
  EXPECT_TRUE(choose_joins(submaps, {}, {}).empty());
}

}  // namespace
}  // namespace roomradar::join_choice_test
