// extremes_room_test.cpp: rooms, voxels and ranges of extreme size, mapped and used, against exact geometry.
//
// ROOMRADAR_LONG_TESTS=1 maps the room of 200 m at 2 cm instead of 5 cm.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/octree/fusion.hpp"
#include "mapping/prescan.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "tests/app/session/extremes_row.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/kept_source.hpp"
#include "tests/support/painted_frame.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::extremes_room_test {
namespace {

using test::print_row;
using test::text;
using Vec3 = Eigen::Vector3d;

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};

/// Distance from a point to the nearest surface of a scene, m.
using Distance = std::function<double(const Vec3& p_world)>;

double to_box(const Eigen::AlignedBox3d& box, const Vec3& p) {
  const Vec3 outside = (box.min() - p).cwiseMax(p - box.max());
  return outside.maxCoeff() > 0.0 ? outside.cwiseMax(0.0).norm() : -outside.maxCoeff();
}

struct Quantiles {
  double median = 0.0, p95 = 0.0;
};
Quantiles quantiles(std::vector<double> values) {
  if (values.empty())
    return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values[values.size() * 95 / 100]};
}

/// Errors of the mesh's vertices and triangle centres for which counts() returns true.
Quantiles errors_m(
    const Mesh& mesh, const Eigen::Isometry3d& T_room_map, const Distance& distance_m,
    const std::function<bool(const Vec3&)>& counts = [](const Vec3&) { return true; }) {
  std::vector<double> errors;
  const auto add = [&](const Eigen::Vector3f& p) {
    const Vec3 p_room = T_room_map * (mesh.origin + p.cast<double>());
    if (counts(p_room)) errors.push_back(distance_m(p_room));
  };
  for (const Eigen::Vector3f& vertex : mesh.vertices) add(vertex);
  for (const Triangle& t : mesh.triangles)
    add((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0F);
  return quantiles(std::move(errors));
}

/// Final state of a pot dropped from 0.3 m above a point, after some seconds of frames without depth.
struct Dropped {
  bool asleep = false;
  double bottom_m = 0.0;
};
Dropped drop_pot(const SavedMap& map, const Vec3& onto_world) {
  SessionConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.make_picture = false;
  Session session(map, config);
  apply(session, {AddObject{.name = "pot", .source = {.mesh = "teapot"}}});
  apply(session, {DropObject{.name = "pot", .position_world = onto_world}});
  Frame frame;
  frame.depth_camera = {64, 48, 58.5, 58.5, 31.5, 23.5};
  frame.depth_m.resize(64, 48, 0.0F);
  frame.T_world_camera =
      map.info.T_world_recorded.inverse() * test::looking_at(onto_world + Vec3(1, 0, 1), onto_world);
  StageTimes times;
  for (frame.index = 0; frame.index < 90; ++frame.index) {
    frame.stamp_s = static_cast<double>(frame.index) / 30.0;
    static_cast<void>(session.step(frame, times));
  }
  const VirtualObject& pot = *session.objects().front();
  return {pot.body.asleep, pot.body.T_world_object.translation().z() + lowest_m(pot)};
}

Frame numbered(Frame frame, std::size_t index) {
  frame.index = static_cast<std::int64_t>(index);
  frame.stamp_s = static_cast<double>(index) / 30.0;
  return frame;
}

TEST(Extremes, ARoomOfTwoMetres) {
  const Eigen::AlignedBox3d crate(Vec3(-0.9, -0.9, 0.0), Vec3(-0.4, -0.5, 0.45));
  const Vec3 ball(0.6, 0.6, 0.25);
  const test::Scene walls = test::nearest_of(
      test::nearest_of(test::nearest_of(test::plane({1, 0, 0}, -1.0), test::plane({1, 0, 0}, 1.0)),
                       test::nearest_of(test::plane({0, 1, 0}, -1.0), test::plane({0, 1, 0}, 1.0))),
      test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 0, 1}, 2.0)));
  const test::Scene scene =
      test::nearest_of(walls, test::nearest_of(test::box(crate), test::sphere(ball, 0.25)));
  const Distance distance_m = [&](const Vec3& p) {
    const double wall_m = std::min({1.0 - std::abs(p.x()), 1.0 - std::abs(p.y()), p.z(), 2.0 - p.z()});
    return std::min({std::abs(wall_m), to_box(crate, p), std::abs((p - ball).norm() - 0.25)});
  };
  constexpr std::size_t kOnceRound = 180;
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < kOnceRound; ++i) {
    const double a = 2.0 * std::numbers::pi * static_cast<double>(i) / kOnceRound;
    const Vec3 eye(0.2 * std::cos(a), 0.2 * std::sin(a), 1.2);
    const Eigen::Isometry3d T_world_camera =
        test::looking_at(eye, eye + Vec3(-std::cos(a), -std::sin(a), -0.5 + 0.3 * std::sin(3.0 * a)));
    Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m < 0.4F) depth_m = 0.0F;  // nearer than a Kinect measures
    test::paint(frame, T_world_camera);
    test::add_depth_noise(frame, static_cast<unsigned>(i));
    frame.down_camera = T_world_camera.linear().transpose() * -Vec3::UnitZ();
    frames.push_back(numbered(std::move(frame), i));
  }
  std::vector<TimedPose> truth;
  for (const Frame& frame : frames) truth.push_back({frame.index, frame.stamp_s, *frame.T_world_camera});
  test::KeptSource source(std::move(frames));
  StageTimes times;
  const PrescanResult scan = prescan(source, {}, times);
  ASSERT_TRUE(scan.counts.trajectory_error);
  const TrajectoryError error = absolute_trajectory_error(scan.map.trajectory, truth);
  const Quantiles surface = errors_m(scan.map.mesh, error.T_reference_estimate, distance_m);
  EXPECT_EQ(scan.counts.frames_tracked, static_cast<std::int64_t>(kOnceRound));
  EXPECT_LT(error.rmse_m, 0.01);
  EXPECT_LT(surface.median, 0.005);
  EXPECT_LT(surface.p95, 0.02);
  const Eigen::Isometry3d T_map_room = error.T_reference_estimate.inverse();
  const Vec3 onto = T_map_room * Vec3(0.0, -0.5, 0.0);
  const Dropped pot = drop_pot(scan.map, onto);
  EXPECT_TRUE(pot.asleep);
  EXPECT_NEAR(pot.bottom_m, onto.z(), 0.02);
  print_row("a room of 2 × 2 × 2 m, 1 cm, tracked once round with a Kinect's noise",
            "all frames tracked, RMSE under 10 mm; surface 5 mm median; a pot rests on its floor",
            text("%.0f of 180, ", static_cast<double>(scan.counts.frames_tracked)) +
                text("RMSE %.1f mm; ", 1e3 * error.rmse_m) +
                text("surface %.1f mm median, ", 1e3 * surface.median) +
                text("%.1f at 95 %%; ", 1e3 * surface.p95) +
                text("the pot rests %.1f mm off the true floor", 1e3 * std::abs(pot.bottom_m - onto.z())));
}

/// A hall 200 m long, 4 m wide, 3 m high, with pillars of 40 cm on both sides, one every 4 m.
constexpr double kHall_m = 200.0;
Eigen::AlignedBox3d pillar(int i) {
  const Vec3 middle(4.0 * (i / 2) + 2.0, i % 2 == 0 ? -1.4 : 1.4, 1.5);
  return {middle - Vec3(0.2, 0.2, 1.5), middle + Vec3(0.2, 0.2, 1.5)};
}
constexpr int kPillars = 100;

TEST(Extremes, ARoomOfTwoHundredMetres) {
  const test::Scene shell = test::nearest_of(
      test::nearest_of(test::nearest_of(test::plane({1, 0, 0}, 0.0), test::plane({1, 0, 0}, kHall_m)),
                       test::nearest_of(test::plane({0, 1, 0}, -2.0), test::plane({0, 1, 0}, 2.0))),
      test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 0, 1}, 3.0)));
  const test::Scene scene = [&](const Vec3& from, const Vec3& direction) {
    double nearest = shell(from, direction);
    const int first = std::max(0, 2 * (static_cast<int>(from.x() / 4.0) - 3));
    for (int i = first; i < std::min(kPillars, first + 14); ++i)
      nearest = std::min(nearest, test::box(pillar(i))(from, direction));
    return nearest;
  };
  const Distance distance_m = [&](const Vec3& p) {
    double nearest = std::min({std::abs(p.x()), std::abs(kHall_m - p.x()), std::abs(2.0 - std::abs(p.y())),
                               std::abs(p.z()), std::abs(3.0 - p.z())});
    for (int i = 0; i < kPillars; ++i) nearest = std::min(nearest, to_box(pillar(i), p));
    return nearest;
  };
  std::vector<Frame> frames;
  constexpr std::size_t kFrames = 200;
  constexpr Intrinsics kCoarse{100, 75, 91.0, 91.0, 49.5, 37.0};
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double x_m = 0.5 + (kHall_m - 1.0) * static_cast<double>(i) / (kFrames - 1);
    const double a = 0.5 * std::sin(0.9 * static_cast<double>(i));
    const Vec3 eye(x_m, 0.0, 1.4);
    const Eigen::Isometry3d T_world_camera =
        test::looking_at(eye, eye + Vec3(std::cos(a), std::sin(a), -0.25));
    Frame frame = test::exact_frame(scene, kCoarse, T_world_camera);
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m > 8.0F) depth_m = 0.0F;
    frame.down_camera = T_world_camera.linear().transpose() * -Vec3::UnitZ();
    frames.push_back(numbered(std::move(frame), i));
  }
  test::KeptSource source(std::move(frames));
  PrescanConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.resolution_m = test::is_long_test() ? 0.02 : 0.05;
  StageTimes times;
  const PrescanResult scan = prescan(source, config, times);
  EXPECT_EQ(scan.counts.frames_fused, static_cast<std::int64_t>(kFrames));
  const Eigen::Isometry3d T_room_map = scan.map.info.T_world_recorded.inverse();
  const auto in_middle = [](const Vec3& p) { return p.x() > 5.0 && p.x() < 25.0; };
  const auto at_end = [](const Vec3& p) { return p.x() > kHall_m - 20.0; };
  const Quantiles near = errors_m(scan.map.mesh, T_room_map, distance_m, in_middle);
  const Quantiles far = errors_m(scan.map.mesh, T_room_map, distance_m, at_end);
  const MapCounts counts = scan.map.octree.load().counts();
  EXPECT_LT(far.median, 0.2 * config.resolution_m);
  EXPECT_LT(far.median, near.median + 0.001);  // numbers are as precise 200 m from the origin
  const test::TemporaryFolder folder;
  save_map(folder.path() / "hall", scan.map);
  const SavedMap loaded = load_map(folder.path() / "hall");
  EXPECT_EQ(loaded.octree.load().counts().occupied_leaves, counts.occupied_leaves);
  const Vec3 onto = scan.map.info.T_world_recorded * Vec3(kHall_m - 4.0, 0.0, 0.0);
  const Dropped pot = drop_pot(loaded, onto);
  EXPECT_TRUE(pot.asleep);
  EXPECT_NEAR(pot.bottom_m, onto.z(), 0.2 * config.resolution_m + 0.002);
  print_row(
      text("a room of 200 × 4 × 3 m, exact poses, %.0f cm", 1e2 * config.resolution_m),
      "surface within a fifth of a cell (median), no worse at its end; saved, loaded, a pot rests there",
      text("%.1f mm median at its beginning, ", 1e3 * near.median) +
          text("%.1f at its end; ", 1e3 * far.median) +
          text("octree %.0f MB; ", static_cast<double>(counts.memory_bytes) / 1e6) +
          text("the pot at 196 m rests %.1f mm off the true floor", 1e3 * std::abs(pot.bottom_m - onto.z())));
}

TEST(Extremes, CellsFromTwoMillimetresToTwentyCentimetres) {
  const test::Scene scene = test::corner_with_ball();
  const Distance distance_m = [](const Vec3& p) {
    return std::min({std::abs(p.z()), std::abs(p.y() - 2.5), std::abs(p.x() + 1.8),
                     std::abs((p - Vec3(0.5, 1.8, 0.4)).norm() - 0.4)});
  };
  constexpr Intrinsics kFine{320, 240, 292.0, 292.0, 159.5, 119.5};
  for (const double cell_m : {0.002, 0.01, 0.2}) {
    StaticMap map(cell_m);
    for (int i = 0; i < 12; ++i) {
      const double a = 0.25 * (i - 6);
      const Vec3 eye =
          Vec3(0.5, 1.8, 0.4) + (cell_m > 0.1 ? 2.0 : 0.9) * Vec3(std::sin(a), -std::cos(a), 0.5);
      Frame frame = test::exact_frame(scene, kFine, test::looking_at(eye, {0.5, 1.8, 0.4}));
      if (cell_m < 0.005)  // keeps only depth with pixels finer than the voxels
        for (float& depth_m : frame.depth_m.pixels) depth_m = depth_m < 1.1F ? depth_m : 0.0F;
      map.fuse(frame, *frame.T_world_camera);
    }
    const Mesh mesh = extract_surface(map);
    const Quantiles error = errors_m(mesh, Eigen::Isometry3d::Identity(), distance_m);
    const MapCounts counts = map.counts();
    EXPECT_GT(counts.occupied_leaves, 100U);
    EXPECT_LT(error.median, 0.125 * cell_m + 0.001);
    EXPECT_LT(error.p95, cell_m + 0.001);
    print_row(text("cells of %.0f mm", 1e3 * cell_m),
              "surface within 1 mm and an eighth of a cell (median), a cell (95 %)",
              text("%.2f mm median, ", 1e3 * error.median) + text("%.1f at 95 %%; ", 1e3 * error.p95) +
                  text("%.0f occupied leaves, ", static_cast<double>(counts.occupied_leaves)) +
                  text("%.2f MB", static_cast<double>(counts.memory_bytes) / 1e6));
  }
}

/// Twelve views of a wall from `away_m`, each slightly to the side, with the sensor's noise at that distance.
StaticMap wall_at(double away_m, Mesh& mesh) {
  StaticMap map(0.01);
  const test::Scene wall = test::plane({0, 1, 0}, 0.0);
  for (int i = 0; i < 12; ++i) {
    const Vec3 eye(0.01 * i, -away_m, 1.0);
    Frame frame = test::exact_frame(wall, kCamera, test::looking_at(eye, eye + Vec3(0, 1, 0)));
    test::add_depth_noise(frame, static_cast<unsigned>(i));
    map.fuse(frame, *frame.T_world_camera);
  }
  mesh = extract_surface(map);
  return map;
}

TEST(Extremes, TheEndsOfAKinectsRange) {
  const Distance distance_m = [](const Vec3& p) { return std::abs(p.y()); };
  for (const double away_m : {0.4, 4.8}) {
    Mesh mesh;
    const StaticMap map = wall_at(away_m, mesh);
    const Quantiles error = errors_m(mesh, Eigen::Isometry3d::Identity(), distance_m);
    const double sigma_m = depth_sigma_m(DepthNoise{}, static_cast<float>(away_m));
    EXPECT_GT(mesh.triangles.size(), 0U);
    EXPECT_LT(error.median, sigma_m);
    print_row(text("a wall at %.1f m", away_m), "a surface there, within the sensor's sigma (median)",
              text("%.1f mm median, ", 1e3 * error.median) + text("sigma %.1f mm", 1e3 * sigma_m));
  }
  for (const double away_m : {8.0, 12.0}) {
    Mesh mesh;
    const StaticMap map = wall_at(away_m, mesh);
    const MapCounts counts = map.counts();
    EXPECT_EQ(counts.occupied_leaves, 0U);
    EXPECT_TRUE(mesh.triangles.empty());
    const double free_to_m = away_m + counts.known_world.max().y();
    EXPECT_NEAR(free_to_m, 5.0, 0.2);
    print_row(text("a wall at %.0f m", away_m), "no surface, which would be centimetres off; free up to 5 m",
              text("%.0f occupied leaves, ", static_cast<double>(counts.occupied_leaves)) +
                  text("free up to %.2f m", free_to_m));
  }
  StaticMap map(0.01);
  Frame frame =
      test::exact_frame(test::plane({0, 1, 0}, 0.0), kCamera, test::looking_at({0, -2, 1}, {0, 0, 1}));
  const float odd[] = {-1.0F,
                       1e-30F,
                       1e30F,
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::quiet_NaN(),
                       65.535F};
  for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i)
    frame.depth_m.pixels[i] = odd[i % std::size(odd)];
  map.fuse(frame, *frame.T_world_camera);
  EXPECT_EQ(map.counts().occupied_leaves, 0U);
  print_row("depth of -1, 1e-30, 1e30, 65.5, ±infinity m and NaN", "no surface",
            text("%.0f occupied leaves", static_cast<double>(map.counts().occupied_leaves)));
}

}  // namespace
}  // namespace roomradar::extremes_room_test
