// correlative_search_test.cpp: position of a view in a room from its depth alone, as far as the shape
// determines it.
#include "mapping/localization/correlative_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::correlative_search_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 146.25, 146.25, 79.5, 59.5};

/// Room 2.5 m high.
test::Scene room() {
  using namespace test;
  return nearest_of(nearest_of(plane({0, 0, 1}, 0.0), plane({0, 0, 1}, 2.5)), walls_and_things());
}

Frame seen_from(const Eigen::Isometry3d& T_world_camera) {
  Frame frame = test::exact_frame(room(), kCamera, T_world_camera);
  test::add_depth_noise(frame, 7);
  frame.down_camera = T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ();
  return frame;
}

/// Keyframes of a camera that rotates in the room's centre, looking forward and down.
KeyframeDatabase scanned() {
  KeyframeDatabase keyframe_database;
  for (int i = 0; i < 20; ++i) {
    const double angle_rad = 0.628 * i;
    const Eigen::Vector3d outward(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    const Eigen::Isometry3d eye = test::looking_at(Eigen::Vector3d(0, 0, 1.3) - 0.4 * outward,
                                                   Eigen::Vector3d(0, 0, i < 10 ? 1.2 : 0.6) + outward);
    keyframe_database.keyframes.push_back(make_map_keyframe(seen_from(eye), eye));
  }
  return keyframe_database;
}

double error_m(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}
double error_rad(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

const std::array kViews{test::looking_at({1.1, -0.9, 1.0}, {-1.2, 1.6, 0.5}),
                        test::looking_at({-1.3, -1.6, 1.7}, {1.0, 1.0, 0.2}),
                        test::looking_at({0.8, 0.9, 0.7}, {-1.5, 0.9, 0.5}, {0.1, 0.1, 0.9})};

TEST(ShapeSearch, FindsAWholeScanInAnother) {
  const KeyframeDatabase keyframes = scanned();
  const Eigen::Isometry3d T_world_scan =
      Eigen::Translation3d(0.3, -0.2, 1.1) * Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ());
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Isometry3d& view : kViews) {
    const Frame frame = seen_from(view);
    for (int y = 0; y < kCamera.height_px; y += 4)
      for (int x = 0; x < kCamera.width_px; x += 4)
        if (const double depth_m = frame.depth_m.at(x, y); depth_m > 0.0)
          points.emplace_back(
              (T_world_scan.inverse() * view * back_project(kCamera, x, y, depth_m)).cast<float>());
  }
  const auto found = search_by_shape(points, -Eigen::Vector3d::UnitZ(), shape_index(keyframes), 2);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(error_m(found.front().T_world_camera, T_world_scan), 0.03);
  EXPECT_LT(error_rad(found.front().T_world_camera, T_world_scan), 0.02);
  EXPECT_TRUE(search_by_shape({}, -Eigen::Vector3d::UnitZ(), shape_index(keyframes), 2).empty());
}

TEST(ShapeSearch, FindsViewsOfThingsFromWhereNobodyWas) {
  const ShapeIndex known = shape_index(scanned());
  for (const Eigen::Isometry3d& truth : kViews) {
    const Frame frame = seen_from(truth);
    const auto found = search_by_shape(frame.depth_m, frame.depth_camera, *frame.down_camera, known, 4);
    ASSERT_FALSE(found.empty());
    ASSERT_LE(found.size(), 4U);
    EXPECT_LT(error_m(found.front().T_world_camera, truth), 0.1);
    EXPECT_LT(error_rad(found.front().T_world_camera, truth), 0.1);
    for (std::size_t i = 1; i < found.size(); ++i) {
      EXPECT_LE(found[i].nearness, found[i - 1].nearness);
      EXPECT_GT(error_m(found[i].T_world_camera, truth) + error_rad(found[i].T_world_camera, truth), 0.1);
    }
  }
}

TEST(ShapeSearch, MovesWithTheRoom) {
  Eigen::Isometry3d T_new_old(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  T_new_old.translation() = Eigen::Vector3d(30.0, -7.0, 2.0);
  KeyframeDatabase keyframe_database = scanned();
  transform(keyframe_database, T_new_old);
  const Frame frame = seen_from(kViews[0]);
  const auto found = search_by_shape(frame.depth_m, frame.depth_camera, *frame.down_camera,
                                     shape_index(keyframe_database), 1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(error_m(found.front().T_world_camera, T_new_old * kViews[0]), 0.1);
}

TEST(ShapeSearch, StaysWithinItsMemoryHoweverFarThePlacesAreApart) {
  const KeyframeDatabase room = scanned();
  for (const double apart_m : {100.0, 1e3, 3e4})
    for (int axis = 0; axis < 3; ++axis) {
      KeyframeDatabase keyframe_database = room;
      KeyframeDatabase other = room;
      transform(other, Eigen::Isometry3d(Eigen::Translation3d(apart_m * Eigen::Vector3d::Unit(axis))));
      keyframe_database.keyframes.insert(keyframe_database.keyframes.end(), other.keyframes.begin(),
                                         other.keyframes.end());
      const ShapeIndex known = shape_index(keyframe_database);
      EXPECT_GE(known.coarse.cell_m, 0.15);
      EXPECT_LE(known.coarse.nearness.size(), 500'000U) << apart_m;
      EXPECT_LE(known.fine.nearness.size(), 8U * 500'000U) << apart_m;
      EXPECT_GT(known.coarse.nearness.size(), 100U) << apart_m;
    }
  KeyframeDatabase damaged = room;
  damaged.keyframes.front().preview_camera.fx_px = 1e-300;
  EXPECT_DOUBLE_EQ(shape_index(damaged).coarse.cell_m, 0.15);
}

TEST(ShapeSearch, IsNearWhereSurfacesAreAndNowhereElse) {
  const ShapeGrid grid = shape_index(scanned()).coarse;
  const auto at = [&grid](const Eigen::Vector3d& p_world) {
    const Eigen::Vector3i cell = ((p_world - grid.low) / grid.cell_m).array().floor().cast<int>();
    return grid
        .nearness[static_cast<std::size_t>((cell.z() * grid.size[1] + cell.y()) * grid.size[0] + cell.x())];
  };
  EXPECT_EQ(at({0.0, 1.5, 0.02}), ShapeGrid::kOnSurface);
  EXPECT_GT(at({0.0, 1.5, 0.17}), 0);
  EXPECT_EQ(at({0.0, 0.0, 1.0}), 0);
}

TEST(ShapeSearch, SaysNothingWithoutDepthGravityOrRoom) {
  const ShapeIndex known = shape_index(scanned());
  const Frame frame = seen_from(kViews[0]);
  const DepthImage none(kCamera.width_px, kCamera.height_px);
  EXPECT_TRUE(search_by_shape(none, kCamera, *frame.down_camera, known, 4).empty());
  EXPECT_TRUE(search_by_shape({}, kCamera, *frame.down_camera, known, 4).empty());
  EXPECT_TRUE(search_by_shape(frame.depth_m, kCamera, Eigen::Vector3d::Zero(), known, 4).empty());
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(std::nan(""));
  EXPECT_TRUE(search_by_shape(frame.depth_m, kCamera, unknown, known, 4).empty());
  EXPECT_TRUE(shape_index({}).empty());
  EXPECT_TRUE(search_by_shape(frame.depth_m, kCamera, *frame.down_camera, shape_index({}), 4).empty());
}

}  // namespace
}  // namespace roomradar::correlative_search_test
