// change_tracker_test.cpp: lasting changes are found in time; swaying, passing or occluding objects are not;
// edge cases.
#include "dynamic/foreground/change_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/allocation_count.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::change_tracker_test {
namespace {

using Eigen::Vector3d;
using test::Scene;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
constexpr double kStep_s = 0.1;

// A table top with a wall behind it.
Scene room() { return test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 1, 0}, 1.5)); }
Scene crate_at(const Vector3d& foot) {
  return test::box(Eigen::AlignedBox3d(foot - Vector3d(0.12, 0.09, 0.0), foot + Vector3d(0.12, 0.09, 0.22)));
}
// A camera that sways by 10 cm and rotates accordingly.
Eigen::Isometry3d pose_at(double t_s) {
  const double a = 2.0 * t_s;
  return test::looking_at({0.1 * std::sin(a), -1.1 + 0.05 * std::cos(a), 0.8},
                          {0.05 * std::sin(1.3 * a), 0.0, 0.1});
}

// Labels of an error-free foreground.
LabelImage labels_of(const DepthImage& depth_m, const DepthImage& expected_m) {
  LabelImage labels(depth_m.width, depth_m.height, PixelLabel::kNotKnown);
  for (std::size_t i = 0; i < depth_m.pixels.size(); ++i) {
    if (depth_m.pixels[i] == 0.0F || expected_m.pixels[i] == 0.0F) continue;
    const float apart = depth_m.pixels[i] - expected_m.pixels[i];
    labels.pixels[i] = apart < -0.02F  ? PixelLabel::kMoved
                       : apart > 0.02F ? PixelLabel::kRevealed
                                       : PixelLabel::kStatic;
  }
  return labels;
}

using SceneAt = std::function<Scene(double t_s)>;

// Runs frames of a live scene against a model of the room, with the sensor's noise.
class Watched {
 public:
  explicit Watched(Scene model) : model_(std::move(model)) {}

  void run(double from_s, double to_s, const SceneAt& live) {
    for (double t_s = from_s; t_s < to_s - 1e-9; t_s += kStep_s) {
      const Eigen::Isometry3d T_world_camera = pose_at(t_s);
      DepthImage depth_m = test::exact_frame(live(t_s), kCamera, T_world_camera).depth_m;
      const DepthImage expected_m = test::exact_frame(model_, kCamera, T_world_camera).depth_m;
      const LabelImage labels = labels_of(depth_m, expected_m);
      for (float& z : depth_m.pixels)
        if (z > 0.0F) z += noise_(random_) * depth_sigma_m(DepthNoise{}, z);
      tracker.update(depth_m, expected_m, labels, kCamera, T_world_camera, t_s);
    }
  }
  void run(double from_s, double to_s, const Scene& live) {
    run(from_s, to_s, [&](double) { return live; });
  }
  void learn(Scene model) { model_ = std::move(model); }

  ChangeTracker tracker;

 private:
  Scene model_;
  std::mt19937 random_{7};
  std::normal_distribution<float> noise_{0.0F, 1.0F};
};

TEST(ChangeTracker, WhatStaysIsFoundAfterItsTimeAndNotBefore) {
  Watched watched(room());
  watched.run(0.0, 3.6, test::nearest_of(room(), crate_at({0, 0, 0})));
  EXPECT_TRUE(watched.tracker.lasting_changes(4.0).empty());
  watched.run(3.6, 4.8, test::nearest_of(room(), crate_at({0, 0, 0})));
  const std::vector<LastingChange> changes = watched.tracker.lasting_changes(4.0);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, LastingKind::kCame);
  const Eigen::AlignedBox3d box = changes[0].box_world();
  // The swaying camera sees front, top and one side; noise and the points' spacing add 2 cm.
  EXPECT_LT((box.max() - Vector3d(0.12, 0.09, 0.22)).cwiseAbs().maxCoeff(), 0.03) << box.max().transpose();
  EXPECT_LT((box.min() - Vector3d(-0.12, -0.09, 0.0)).cwiseAbs().maxCoeff(), 0.03) << box.min().transpose();
  EXPECT_GT(watched.tracker.still_true(changes[0]), 0.99);
  EXPECT_GT(watched.tracker.seen_now(changes[0]), 0.7);
}

TEST(ChangeTracker, NothingHasComeWhereTheMapKnowsNothing) {
  // The crate is dynamic in all of these; of the map behind it, this share of the image is known.
  const auto found = [](double known) {
    ChangeTracker tracker;
    for (double t_s = 0.0; t_s < 3.0; t_s += kStep_s) {
      const Eigen::Isometry3d T_world_camera = pose_at(t_s);
      const DepthImage depth_m =
          test::exact_frame(test::nearest_of(room(), crate_at({0, 0, 0})), kCamera, T_world_camera).depth_m;
      DepthImage expected_m = test::exact_frame(room(), kCamera, T_world_camera).depth_m;
      const LabelImage labels = labels_of(depth_m, expected_m);
      for (int y = 0; y < expected_m.height; ++y)
        for (int x = static_cast<int>(known * expected_m.width); x < expected_m.width; ++x)
          expected_m.at(x, y) = 0.0F;
      tracker.update(depth_m, expected_m, labels, kCamera, T_world_camera, t_s);
    }
    return tracker.lasting_changes(2.0).size();
  };
  EXPECT_EQ(found(0.0), 0U);
  EXPECT_EQ(found(0.4), 0U);
  EXPECT_EQ(found(0.6), 1U);
  EXPECT_EQ(found(1.0), 1U);
}

TEST(ChangeTracker, WhatWasTakenAwayIsFound) {
  Watched watched(test::nearest_of(room(), crate_at({0, 0, 0})));
  watched.run(0.0, 1.7, room());
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
  watched.run(1.7, 2.8, room());
  const std::vector<LastingChange> changes = watched.tracker.lasting_changes(2.0);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, LastingKind::kWent);
  EXPECT_LT((changes[0].box_world().center() - Vector3d(0, 0, 0.11)).norm(), 0.05);
}

TEST(ChangeTracker, AStripAlongAnEdgeHasNotGoneAndASmallBoxHas) {
  const auto gone = [](const Vector3d& low, const Vector3d& high) {
    Watched watched(test::nearest_of(room(), test::box(Eigen::AlignedBox3d(low, high))));
    watched.run(0.0, 2.0, room());
    return watched.tracker.lasting_changes(1.0).size();
  };
  EXPECT_EQ(gone({-0.04, -0.04, 0.0}, {0.04, 0.04, 0.1}), 1U);
  EXPECT_EQ(gone({-0.4, 0.0, 0.3}, {0.4, 0.01, 0.34}), 0U);
}

TEST(ChangeTracker, WhatSwaysIsNeverFound) {
  for (const double amplitude_m : {0.03, 0.1}) {
    Watched watched(room());
    watched.run(0.0, 12.0, [&](double t_s) {
      const Vector3d hand(amplitude_m * std::sin(2.5 * t_s), amplitude_m * std::cos(2.5 * t_s), 0.2);
      return test::nearest_of(room(), test::sphere(hand, 0.06));
    });
    EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty()) << amplitude_m;
  }
}

TEST(ChangeTracker, AThingThatHoldsStillInPartIsNotFoundAsLongAsItHangsTogether) {
  const Scene held = test::box(Eigen::AlignedBox3d(Vector3d(-0.05, -0.05, 0.1), Vector3d(0.05, 0.05, 0.2)));
  const auto hand_at = [](double t_s) {
    return test::sphere({0.11, 0.02 * std::sin(4.0 * t_s), 0.15 + 0.03 * std::cos(4.0 * t_s)}, 0.07);
  };
  Watched watched(room());
  watched.run(0.0, 6.0,
              [&](double t_s) { return test::nearest_of(test::nearest_of(room(), held), hand_at(t_s)); });
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
  watched.run(6.0, 7.0, test::nearest_of(room(), held));
  EXPECT_EQ(watched.tracker.lasting_changes(2.0).size(), 1U) << "let go";
}

TEST(ChangeTracker, SomebodyWhoMovesElsewhereDoesNotKeepItFromBeingFound) {
  Watched watched(room());
  watched.run(0.0, 4.0, [&](double t_s) {
    const Scene person = test::sphere({0.5 * std::sin(t_s), 0.9, 0.5}, 0.25);
    return test::nearest_of(test::nearest_of(room(), crate_at({0, 0, 0})), person);
  });
  const std::vector<LastingChange> changes = watched.tracker.lasting_changes(3.0);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_LT(changes[0].box_world().max().y(), 0.15);
}

TEST(ChangeTracker, TimeStandsStillWhileItIsHidden) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  const auto behind_a_hand = [&](double t_s) {
    return test::nearest_of(with_crate, test::sphere(pose_at(t_s) * Vector3d(0, 0, 0.6), 0.3));
  };
  Watched watched(room());
  watched.run(0.0, 1.5, with_crate);
  watched.run(1.5, 5.0, behind_a_hand);
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty()) << "hidden time does not count";
  watched.run(5.0, 5.9, with_crate);
  ASSERT_EQ(watched.tracker.lasting_changes(2.0).size(), 1U) << "nor does it undo what was seen before";
}

TEST(ChangeTracker, WhatIsHiddenNowIsNotHandedOut) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  Watched watched(room());
  watched.run(0.0, 3.0, with_crate);
  watched.run(3.0, 3.2, [&](double t_s) {
    return test::nearest_of(with_crate, test::sphere(pose_at(t_s) * Vector3d(0, 0, 0.6), 0.3));
  });
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
}

TEST(ChangeTracker, WhatGoesAgainIsNoLongerTrue) {
  Watched watched(room());
  watched.run(0.0, 2.5, test::nearest_of(room(), crate_at({0, 0, 0})));
  const std::vector<LastingChange> changes = watched.tracker.lasting_changes(2.0);
  ASSERT_EQ(changes.size(), 1U);
  watched.run(2.5, 3.2, room());
  EXPECT_LT(watched.tracker.still_true(changes[0]), 0.05);
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
}

TEST(ChangeTracker, WhatTheModelHasByNowIsFoundNoMore) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  Watched watched(room());
  watched.run(0.0, 2.5, with_crate);
  ASSERT_EQ(watched.tracker.lasting_changes(2.0).size(), 1U);
  watched.learn(with_crate);
  watched.run(2.5, 3.2, with_crate);
  EXPECT_EQ(watched.tracker.point_count(), 0U);
}

TEST(ChangeTracker, WhatIsForgottenNeedsItsTimeAgain) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  Watched watched(room());
  watched.run(0.0, 2.5, with_crate);
  const std::vector<LastingChange> changes = watched.tracker.lasting_changes(2.0);
  ASSERT_EQ(changes.size(), 1U);
  watched.tracker.forget(changes[0]);
  EXPECT_EQ(watched.tracker.point_count(), 0U);
  EXPECT_EQ(watched.tracker.still_true(changes[0]), 0.0);
  watched.run(2.5, 4.0, with_crate);
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
  watched.run(4.0, 5.2, with_crate);
  EXPECT_EQ(watched.tracker.lasting_changes(2.0).size(), 1U);
}

TEST(ChangeTracker, ThingsThatSettleTogetherAreHandedOutTogether) {
  Watched watched(test::nearest_of(room(), crate_at({0.4, 0.2, 0})));
  watched.run(0.0, 2.5, test::nearest_of(room(), crate_at({-0.3, 0, 0})));
  std::vector<LastingChange> changes = watched.tracker.lasting_changes(2.0);
  ASSERT_EQ(changes.size(), 2U);
  EXPECT_EQ(changes[0].kind, LastingKind::kCame);
  EXPECT_EQ(changes[1].kind, LastingKind::kWent);
}

TEST(ChangeTracker, NothingMeasuredAndALensThatIsCoveredAreNoChange) {
  Watched watched(room());
  watched.run(0.0, 1.0, room());
  EXPECT_EQ(watched.tracker.point_count(), 0U);
  const DepthImage nothing(kCamera.width_px, kCamera.height_px, 0.0F);
  const DepthImage covered(kCamera.width_px, kCamera.height_px, 0.45F);
  const DepthImage expected_m = test::exact_frame(room(), kCamera, pose_at(0.0)).depth_m;
  ChangeTracker tracker;
  for (int i = 0; i < 40; ++i)
    tracker.update(nothing, expected_m, labels_of(nothing, expected_m), kCamera, pose_at(0.0), 0.1 * i);
  EXPECT_EQ(tracker.point_count(), 0U);
  // A hand over the lens of a moving camera moves with the camera.
  for (int i = 0; i < 40; ++i)
    tracker.update(covered, expected_m, labels_of(covered, expected_m), kCamera, pose_at(0.1 * i), 0.1 * i);
  EXPECT_TRUE(tracker.lasting_changes(2.0).empty());
}

TEST(ChangeTracker, AJumpOfTheClockCountsAsHalfASecondAtMost) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  Watched watched(room());
  watched.run(0.0, 0.5, with_crate);
  watched.run(100.0, 100.5, with_crate);
  EXPECT_TRUE(watched.tracker.lasting_changes(2.0).empty());
}

TEST(ChangeTracker, AStampThatIsNoNumberTakesNothingAway) {
  const Scene with_crate = test::nearest_of(room(), crate_at({0, 0, 0}));
  for (const double stamp_s :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -100.0}) {
    Watched watched(room());
    const DepthImage depth_m = test::exact_frame(with_crate, kCamera, pose_at(0.0)).depth_m;
    const DepthImage expected_m = test::exact_frame(room(), kCamera, pose_at(0.0)).depth_m;
    const LabelImage labels = labels_of(depth_m, expected_m);
    for (int i = 0; i < 40; ++i)
      watched.tracker.update(depth_m, expected_m, labels, kCamera, pose_at(0.0),
                             i % 10 == 0 ? stamp_s : 0.1 * i);
    EXPECT_EQ(watched.tracker.lasting_changes(2.0).size(), 1U) << stamp_s;
  }
}

TEST(ChangeTracker, PointsAreBounded) {
  ChangeTrackerConfig config;
  config.max_points = 50;
  ChangeTracker tracker(config);
  const DepthImage depth_m = test::exact_frame(test::plane({0, 1, 0}, 0.0), kCamera, pose_at(0.0)).depth_m;
  const DepthImage expected_m = test::exact_frame(room(), kCamera, pose_at(0.0)).depth_m;
  for (int i = 0; i < 3; ++i)
    tracker.update(depth_m, expected_m, labels_of(depth_m, expected_m), kCamera, pose_at(0.0), 0.1 * i);
  EXPECT_EQ(tracker.point_count(), 50U);
}

TEST(ChangeTracker, NothingIsAllocatedFromTheSecondFrameOn) {
  const DepthImage expected_m = test::exact_frame(room(), kCamera, pose_at(0.0)).depth_m;
  std::vector<DepthImage> depth_m;
  std::vector<LabelImage> labels;
  for (int i = 0; i < 20; ++i) {
    const Scene passing = test::sphere({0.05 * i - 0.5, 0.0, 0.2}, 0.1);
    const Scene scene = test::nearest_of(test::nearest_of(room(), crate_at({0.3, 0.3, 0.0})), passing);
    depth_m.push_back(test::exact_frame(scene, kCamera, pose_at(0.0)).depth_m);
    labels.push_back(labels_of(depth_m.back(), expected_m));
  }
  ChangeTracker tracker;
  tracker.update(depth_m[0], expected_m, labels[0], kCamera, pose_at(0.0), 0.0);
  const std::size_t before = test::allocations;
  bool found = false;
  for (std::size_t i = 1; i < 20; ++i) {
    tracker.update(depth_m[i], expected_m, labels[i], kCamera, pose_at(0.0), 0.1 * static_cast<double>(i));
    found |= !tracker.lasting_changes(10.0).empty();
  }
  EXPECT_EQ(test::allocations - before, 0U);
  EXPECT_FALSE(found);
  EXPECT_GT(tracker.point_count(), 100U);
}

TEST(ChangeTracker, ConfigIsChecked) {
  const auto refused = [](auto change) {
    ChangeTrackerConfig config;
    change(config);
    EXPECT_THROW(ChangeTracker{config}, Error);
  };
  refused([](auto& c) { c.spacing_m = 0.0F; });
  refused([](auto& c) { c.agree_sigmas = std::numeric_limits<float>::quiet_NaN(); });
  refused([](auto& c) { c.link_m = 0.01F; });
  refused([](auto& c) { c.min_steady_fraction = 1.5F; });
  refused([](auto& c) { c.max_points = 0; });
}

}  // namespace
}  // namespace roomradar::change_tracker_test
