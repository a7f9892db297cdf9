// locator_test.cpp: the camera is localised from anywhere, tracked, and reported lost when lost; a wrong pose
// is never certain.
#include "mapping/localization/locator.hpp"

#include <gtest/gtest.h>

#include "mapping/localization/pose_hypothesis.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::locator_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};

test::Scene room() { return test::nearest_of(test::plane({0, 0, 1}, 0.0), test::walls_and_things()); }

/// A room that is identical after half a turn about the z axis, including walls, objects and paint.
test::Scene twin_room() {
  const test::Scene half = test::box({Eigen::Vector3d(-1.9, 1.2, 0.0), Eigen::Vector3d(-1.0, 2.4, 0.8)});
  const test::Scene other = test::box({Eigen::Vector3d(1.0, -2.4, 0.0), Eigen::Vector3d(1.9, -1.2, 0.8)});
  using namespace test;
  const Scene walls = nearest_of(nearest_of(plane({0, 1, 0}, 2.5), plane({0, 1, 0}, -2.5)),
                                 nearest_of(plane({1, 0, 0}, 2.0), plane({1, 0, 0}, -2.0)));
  return nearest_of(nearest_of(plane({0, 0, 1}, 0.0), walls), nearest_of(half, other));
}
std::uint8_t twin_grey(const Eigen::Vector3d& p) {
  return test::cube_grey(p.y() > 0.0 ? p : Eigen::Vector3d(-p.x(), -p.y(), p.z()));
}

using Grey = std::function<std::uint8_t(const Eigen::Vector3d&)>;

/// A room scanned by a camera rotating in its centre, and a locator in it.
struct Mapped {
  explicit Mapped(test::Scene its_scene, Grey its_grey = test::cube_grey)
      : scene(std::move(its_scene)), grey(std::move(its_grey)) {
    for (int i = 0; i < 10; ++i) {
      const double angle_rad = 0.628 * i;
      const Eigen::Vector3d outward(std::cos(angle_rad), std::sin(angle_rad), 0.0);
      const Eigen::Isometry3d eye =
          test::looking_at(Eigen::Vector3d(0, 0, 1.3) - 0.4 * outward, Eigen::Vector3d(0, 0, 0.8) + outward);
      keyframe_database.keyframes.push_back(make_map_keyframe(seen_from(eye), eye));
    }
  }
  [[nodiscard]] Frame seen_from(const Eigen::Isometry3d& T_world_camera) const {
    Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
    test::paint_with(grey, frame, T_world_camera);
    test::add_depth_noise(frame, 7);
    return frame;
  }
  Tracking find(const Frame& frame) {
    return locate(locator, frame, keyframe_database, {},
                  [this](const Eigen::Isometry3d& T) -> const DepthImage& {
                    expected_m = test::exact_frame(scene, kCamera, T).depth_m;
                    return expected_m;
                  });
  }

  test::Scene scene;
  Grey grey;
  KeyframeDatabase keyframe_database;
  Locator locator;
  DepthImage expected_m;
};

double error_m(const Tracking& tracking, const Eigen::Isometry3d& truth) {
  return (tracking.T_world_camera.translation() - truth.translation()).norm();
}

Eigen::Isometry3d walk(int step) {
  return test::looking_at({0.5 - 0.02 * step, -0.6, 1.2}, {-0.6, 2.0, 0.5});
}
Eigen::Isometry3d elsewhere(int step) {
  return test::looking_at({-0.9, 0.8 - 0.01 * step, 1.5}, {1.2, -1.6, 0.6});
}

TEST(Locator, FindsViewsFarFromEveryPlace) {
  const Mapped mapped(room());
  for (const auto& truth : {test::looking_at({1.1, -0.9, 1.0}, {-1.2, 1.6, 0.5}),
                            test::looking_at({-1.3, -1.6, 1.7}, {1.0, 1.0, 0.2}),
                            test::looking_at({0.8, 0.9, 0.7}, {-1.5, 0.9, 0.5}, {0.3, 0.1, 0.9})}) {
    Mapped fresh = mapped;
    const Tracking found = fresh.find(fresh.seen_from(truth));
    ASSERT_TRUE(has_pose(found));
    EXPECT_LT(error_m(found, truth), 0.02);
  }
}

TEST(Locator, IsMendedWithinFiveFramesWhenTheCameraIsCarriedAway) {
  Mapped mapped(room());
  for (int i = 0; i < 4; ++i) ASSERT_LT(error_m(mapped.find(mapped.seen_from(walk(i))), walk(i)), 0.02) << i;
  for (int i = 0; i < 10; ++i) {
    const Tracking found = mapped.find(mapped.seen_from(elsewhere(i)));
    if (i < 5 && (!has_pose(found) || error_m(found, elsewhere(i)) > 0.02)) continue;
    ASSERT_TRUE(has_pose(found)) << i;
    EXPECT_LT(error_m(found, elsewhere(i)), 0.02) << i;
    EXPECT_LT(mapped.locator.T_last_now.translation().norm(), 0.1) << i << ": the way there was no motion";
  }
}

TEST(Locator, AJumpThatNoHandMakesIsNotAMotion) {
  for (const auto& [step_s, may_be_followed] : {std::pair{1.0 / 30.0, false}, std::pair{0.2, true}}) {
    Mapped mapped(room());
    const Eigen::Isometry3d there = walk(3) * Eigen::Translation3d(0.18, 0.0, 0.0);
    double stamp_s = 0.0;
    const auto find_at = [&](const Eigen::Isometry3d& truth) {
      Frame frame = mapped.seen_from(truth);
      frame.stamp_s = stamp_s;
      return mapped.find(frame);
    };
    for (int i = 0; i < 3; ++i, stamp_s += step_s) ASSERT_TRUE(has_pose(find_at(walk(3)))) << i;
    const Tracking found = find_at(there);
    ASSERT_TRUE(has_pose(found)) << step_s;
    EXPECT_LT(error_m(found, there), 0.02) << step_s;
    EXPECT_EQ(mapped.locator.T_last_now.translation().norm() > 0.05, may_be_followed) << step_s;
  }
}

TEST(Locator, SaysSoWhileTheLensIsCoveredAndGoesOnAfterwards) {
  Mapped mapped(room());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(has_pose(mapped.find(mapped.seen_from(walk(i)))));
  Frame dark = mapped.seen_from(walk(4));
  dark.depth_m.resize(kCamera.width_px, kCamera.height_px);
  EXPECT_FALSE(has_pose(mapped.find(dark)));
  Frame covered = mapped.seen_from(walk(4));
  covered.depth_m.resize(kCamera.width_px, kCamera.height_px, 0.5F);
  covered.colour.resize(kCamera.width_px, kCamera.height_px, {90, 60, 50});
  EXPECT_FALSE(has_pose(mapped.find(covered)));
  const Tracking found = mapped.find(mapped.seen_from(walk(5)));
  ASSERT_TRUE(has_pose(found));
  EXPECT_LT(error_m(found, walk(5)), 0.02);
  EXPECT_FALSE(mapped.locator.T_world_lost && mapped.locator.lost_frames > 3);
}

TEST(Locator, ACoveredLensIsNoticedWithinFiveFramesThoughItsMotionSeemsKnown) {
  Mapped mapped(room());
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(has_pose(mapped.find(mapped.seen_from(walk(i)))));
  Frame covered = mapped.seen_from(walk(4));
  for (int y = 0; y < kCamera.height_px; ++y)  // a hand, close to the lens, and a margin that shows the room
    for (int x = 20; x < kCamera.width_px; ++x) {
      covered.depth_m.at(x, y) = 0.45F + 0.0001F * static_cast<float>(x);
      covered.colour.at(x, y) = {90, 60, 50};
    }
  bool is_noticed = false;
  for (int i = 0; i < 5; ++i) is_noticed = is_noticed || !has_pose(mapped.find(covered));
  EXPECT_TRUE(is_noticed);
}

TEST(Locator, DoesNotChooseBetweenTwoPlacesThatLookTheSame) {
  Mapped twins(twin_room(), twin_grey);
  const Eigen::Isometry3d truth = test::looking_at({0.8, -0.2, 1.2}, {-1.2, 2.0, 0.5});
  EXPECT_FALSE(has_pose(twins.find(twins.seen_from(truth))));
  // A poster on only one of the walls resolves the ambiguity.
  Mapped told(twin_room(), [](const Eigen::Vector3d& p) {
    return p.y() > 1.0 ? test::cube_grey(p) : twin_grey(p + Eigen::Vector3d(7.0, 3.0, 0.0));
  });
  const Tracking found = told.find(told.seen_from(truth));
  ASSERT_TRUE(has_pose(found));
  EXPECT_LT(error_m(found, truth), 0.02);
}

TEST(Locator, FindsAViewWithoutColourByItsShape) {
  Mapped mapped(room());
  const Eigen::Isometry3d truth = test::looking_at({0.8, 0.9, 0.7}, {-1.5, 0.9, 0.5}, {0.1, 0.1, 0.9});
  Frame frame = mapped.seen_from(truth);
  frame.colour = {};
  frame.down_camera = truth.linear().transpose() * -Eigen::Vector3d::UnitZ();
  const Tracking found = mapped.find(frame);
  ASSERT_TRUE(has_pose(found));
  EXPECT_LT(error_m(found, truth), 0.02);
  EXPECT_EQ(mapped.locator.search_end, SearchEnd::kFound);
}

test::Scene bare_walls() {
  using namespace test;
  const Scene walls = nearest_of(nearest_of(plane({0, 1, 0}, 2.5), plane({0, 1, 0}, -2.5)),
                                 nearest_of(plane({1, 0, 0}, 2.0), plane({1, 0, 0}, -2.0)));
  return nearest_of(plane({0, 0, 1}, 0.0), walls);
}

/// A wall with a painted square on it; a view of a square of 24 cm has some thirty patches.
Grey poster_of(double width_m) {
  return [half_m = 0.5 * width_m](const Eigen::Vector3d& p) {
    const bool is_on_it = p.y() > 2.4 && std::abs(p.x() - 0.4) < half_m && std::abs(p.z() - 0.8) < half_m;
    return is_on_it ? test::cube_grey(p) : std::uint8_t{120};
  };
}

TEST(Locator, OneSmallPosterSaysWhereAlongABareWallItIs) {
  const Mapped mapped(bare_walls(), poster_of(0.24));
  for (const double aim : {0.3, 0.0}) {
    const Eigen::Isometry3d truth = test::looking_at({0.3, 0.4, 1.2}, {aim, 2.5, 0.4});
    Mapped fresh = mapped;
    const Tracking found = fresh.find(fresh.seen_from(truth));
    ASSERT_TRUE(has_pose(found)) << aim;
    EXPECT_LT(error_m(found, truth), 0.02) << aim;
    EXPECT_LT(fresh.locator.hypotheses.front().appearance.alike.size(), 40U) << aim;
  }
}

TEST(Locator, OneOfTwoEqualPostersDoesNotSayWhereItIs) {
  for (const double width_m : {0.24, 0.3}) {
    Mapped mapped(bare_walls(), [poster = poster_of(width_m)](const Eigen::Vector3d& p) {
      return poster(p.y() > 0.0 ? p : Eigen::Vector3d(-p.x(), -p.y(), p.z()));
    });
    const Frame frame = mapped.seen_from(test::looking_at({0.3, 0.4, 1.2}, {0.3, 2.5, 0.4}));
    EXPECT_FALSE(has_pose(mapped.find(frame))) << width_m;
    EXPECT_EQ(mapped.locator.search_end, SearchEnd::kAmbiguous) << width_m;
  }
}

TEST(Locator, IsNotTakenToBeWhereItWasWhenCarriedAlongAWallWithTheLensCovered) {
  const auto before_wall = [](double x) { return test::looking_at({x, 0.4, 1.2}, {x, 2.5, 0.4}); };
  for (const double carried_m : {0.0, 0.6}) {
    Mapped mapped(bare_walls());
    const Eigen::Isometry3d from = before_wall(0.3), to = before_wall(0.3 - carried_m);
    for (int i = 0; i < 3; ++i) ASSERT_LT(error_m(mapped.find(mapped.seen_from(from)), from), 0.02);
    Frame dark = mapped.seen_from(from);
    dark.depth_m.resize(kCamera.width_px, kCamera.height_px);
    EXPECT_FALSE(has_pose(mapped.find(dark)));
    const Tracking found = mapped.find(mapped.seen_from(to));
    ASSERT_TRUE(has_pose(found)) << carried_m;
    EXPECT_LT(error_m(found, to), 0.02) << carried_m;
  }
}

TEST(Locator, IsLostBeforeAWallWithoutMarksAfterTheLensWasCovered) {
  const auto before_wall = [](double x) { return test::looking_at({x, 0.4, 1.2}, {x, 2.5, 0.4}); };
  Mapped bare(bare_walls(), [](const Eigen::Vector3d&) { return 120; });
  bare.locator.T_world_camera = before_wall(0.3);
  ASSERT_TRUE(has_pose(bare.find(bare.seen_from(before_wall(0.3)))));
  Frame dark = bare.seen_from(before_wall(0.3));
  dark.depth_m.resize(kCamera.width_px, kCamera.height_px);
  EXPECT_FALSE(has_pose(bare.find(dark)));
  EXPECT_FALSE(has_pose(bare.find(bare.seen_from(before_wall(-0.3)))));
}

TEST(Locator, DoesNotSlideOnAlongAWallWithoutMarks) {
  const auto before_wall = [](double x) { return test::looking_at({x, 0.4, 1.2}, {x, 2.5, 0.4}); };
  Mapped bare(bare_walls(), [](const Eigen::Vector3d&) { return 120; });
  bare.locator.T_world_camera = before_wall(0.3);
  bare.locator.T_last_now.translation().x() = 0.01;  // last motion; the camera has stopped since
  Tracking found;
  for (int i = 0; i < 60; ++i) {
    Frame frame = bare.seen_from(before_wall(0.3));
    frame.stamp_s = i / 30.0;
    found = bare.find(frame);
    ASSERT_TRUE(has_guess(found)) << i;
  }
  EXPECT_EQ(found.status, TrackStatus::kUncertain);
  EXPECT_LT(error_m(found, before_wall(0.3)), 0.08);  // 0.15 s at 0.3 m/s, then slower
}

TEST(Locator, PassesAShortStretchOfBareWallByItsMotion) {
  // Depth shows only the distances to the wall and the floor.
  const auto passing = [](int i) {
    return test::looking_at({0.3 - 0.02 * i, 0.4, 1.2}, {0.3 - 0.02 * i, 2.5, 0.4});
  };
  Mapped mapped(bare_walls(), [](const Eigen::Vector3d&) { return 120; });
  mapped.locator.T_world_camera = passing(0);
  mapped.locator.T_last_now = passing(0).inverse() * passing(1);
  for (int i = 1; i <= 4; ++i) {
    Frame frame = mapped.seen_from(passing(i));
    frame.stamp_s = i / 30.0;
    const Tracking found = mapped.find(frame);
    // Two standard deviations exceed 10 cm from the fourth frame on.
    EXPECT_EQ(found.status, i <= 3 ? TrackStatus::kDegenerate : TrackStatus::kUncertain) << i;
    EXPECT_LT(error_m(found, passing(i)), 0.02) << i;
  }
}

TEST(Locator, ACameraThatStandsIsNotMovedByNoise) {
  Mapped mapped(room());
  Tracking first;
  for (int i = 0; i < 20; ++i) {
    Frame frame = mapped.seen_from(walk(3));
    test::add_depth_noise(frame, 100 + static_cast<unsigned>(i));
    frame.stamp_s = i / 30.0;
    const Tracking found = mapped.find(frame);
    ASSERT_TRUE(found) << i;
    if (i == 0) first = found;
    EXPECT_EQ(found.T_world_camera.matrix(), first.T_world_camera.matrix()) << i;
  }
}

TEST(Locator, AFrozenPictureDoesNotHoldACameraWhoseDepthMoves) {
  Mapped mapped(room());
  const Frame frozen = mapped.seen_from(walk(0));
  Tracking found;
  for (int i = 0; i < 20; ++i) {
    Frame frame = mapped.seen_from(walk(i));
    frame.colour = frozen.colour;
    frame.stamp_s = i / 30.0;
    found = mapped.find(frame);
  }
  EXPECT_TRUE(!has_pose(found) || error_m(found, walk(19)) < 0.05);
}

TEST(Locator, IsUncertainAfterAFewFramesBeforeAWallWithoutMarks) {
  const auto before_wall = [](double x) { return test::looking_at({x, 0.4, 1.2}, {x, 2.5, 0.4}); };
  Mapped bare(bare_walls(), [](const Eigen::Vector3d&) { return 120; });
  bare.locator.T_world_camera = before_wall(0.3);
  int index = 0;
  const auto find_at = [&](const Eigen::Isometry3d& T_world_camera) {
    Frame frame = bare.seen_from(T_world_camera);
    frame.colour.resize(0, 0);  // else the still picture would show that the camera stands
    frame.stamp_s = index++ / 30.0;
    return bare.find(frame);
  };
  for (int i = 0; i < 12; ++i) {
    const Tracking found = find_at(before_wall(0.3 - 0.02 * i));  // depth does not show this motion
    EXPECT_EQ(found.status, i < 3 ? TrackStatus::kDegenerate : TrackStatus::kUncertain) << i;
    const PoseSigma sigma = pose_sigma(found);
    EXPECT_GT(sigma.position_m.x(), sigma.position_m.y()) << i;
    if (i > 0) {
      EXPECT_GT(std::abs(sigma.least_certain_world.x()), 0.9) << i;
    }
  }
}

TEST(Locator, DoesNotSayWhereAlongABareWallItIs) {
  using namespace test;
  Mapped bare(bare_walls(), [](const Eigen::Vector3d&) { return 120; });
  const Eigen::Isometry3d truth = looking_at({0.3, 0.4, 1.2}, {0.3, 2.5, 0.4});
  Frame frame = bare.seen_from(truth);
  frame.down_camera = truth.linear().transpose() * -Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(has_pose(bare.find(frame)));
  EXPECT_NE(bare.locator.search_end, SearchEnd::kFound);
}

TEST(DepthAgreement, CountsWhatFitsAndWhatIsSeenThrough) {
  DepthImage live(40, 40, 2.0F), expected(40, 40, 2.0F);
  EXPECT_EQ(depth_agreement_of(live, expected).alike_part(), 1.0);
  EXPECT_EQ(depth_agreement_of(live, expected).valid, 100);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 20; ++x) expected.at(x, y) = y < 20 ? 1.5F : 2.5F;
  const DepthAgreement half = depth_agreement_of(live, expected);
  EXPECT_EQ(half.alike, 50);
  EXPECT_EQ(half.farther, 25);
  EXPECT_DOUBLE_EQ(half.score(), 0.0);
  // A door handle 24 cm away: voxels of 1 cm are coarser than the sensor.
  EXPECT_EQ(depth_agreement_of(DepthImage(40, 40, 0.24F), DepthImage(40, 40, 0.236F)).alike_part(), 1.0);
  EXPECT_EQ(depth_agreement_of(DepthImage(40, 40, 0.24F), DepthImage(40, 40, 0.233F)).farther_part(), 1.0);
  const DepthAgreement none = depth_agreement_of(DepthImage(40, 40), expected);
  EXPECT_EQ(none.valid, 0);
  EXPECT_EQ(none.score(), 0.0);
  EXPECT_EQ(none.alike_part(), 0.0);
}

}  // namespace
}  // namespace roomradar::locator_test
