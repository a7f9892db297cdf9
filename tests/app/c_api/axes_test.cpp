// axes_test.cpp: axes, units and winding of engines.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/c_api/c_room.hpp"

namespace roomradar::axes_test {
namespace {

using test::expect_ok;
using test::sized;

constexpr std::int32_t kAll[] = {ROOMRADAR_AXES_WORLD, ROOMRADAR_AXES_GLTF, ROOMRADAR_AXES_GODOT,
                                 ROOMRADAR_AXES_UNITY, ROOMRADAR_AXES_UNREAL};

Eigen::Vector3d to_engine(std::int32_t axes, const Eigen::Vector3d& p_world) {
  Eigen::Vector3d p;
  expect_ok(roomradar_points_to_engine(axes, p_world.data(), p.data(), 1));
  return p;
}

TEST(Axes, RightForwardAndUpAreThoseOfEachEngine) {
  const Eigen::Vector3d right(1, 0, 0), forward(0, 1, 0), up(0, 0, 1);
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_GLTF, right), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_GLTF, forward), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_GLTF, up), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_GODOT, forward), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNITY, right), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNITY, forward), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNITY, up), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNREAL, right), Eigen::Vector3d(0, 100, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNREAL, forward), Eigen::Vector3d(100, 0, 0));
  EXPECT_EQ(to_engine(ROOMRADAR_AXES_UNREAL, up), Eigen::Vector3d(0, 0, 100));
}

Eigen::Isometry3d some_pose() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(0.3, -1.2, 0.75);
  T.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.2, -0.5, 0.9).normalized()));
  return T;
}

TEST(Axes, PointsAndPosesComeBack) {
  const roomradar_pose pose = c_api::pose_of(some_pose());
  for (const std::int32_t axes : kAll) {
    roomradar_pose there{}, back{};
    expect_ok(roomradar_pose_to_engine(axes, &pose, &there));
    expect_ok(roomradar_pose_from_engine(axes, &there, &back));
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(back.m[i], pose.m[i], 1e-12);
    expect_ok(roomradar_camera_to_engine(axes, &pose, &there));
    expect_ok(roomradar_camera_from_engine(axes, &there, &back));
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(back.m[i], pose.m[i], 1e-12);
    double p[] = {1.0, -2.0, 3.0};
    expect_ok(roomradar_points_to_engine(axes, p, p, 1));
    expect_ok(roomradar_points_from_engine(axes, p, p, 1));
    EXPECT_NEAR(p[0], 1.0, 1e-12);
    EXPECT_NEAR(p[1], -2.0, 1e-12);
    EXPECT_NEAR(p[2], 3.0, 1e-12);
  }
}

TEST(Axes, APoseMovesAConvertedPointToTheConvertedPlace) {
  const Eigen::Isometry3d T = some_pose();
  const roomradar_pose pose = c_api::pose_of(T);
  const Eigen::Vector3d p_object(0.1, 0.2, -0.3);
  for (const std::int32_t axes : kAll) {
    roomradar_pose converted{};
    expect_ok(roomradar_pose_to_engine(axes, &pose, &converted));
    const Eigen::Vector3d moved = c_api::unchecked_pose_of(converted) * to_engine(axes, p_object);
    EXPECT_LT((moved - to_engine(axes, T * p_object)).norm(), 1e-12 * 100) << axes;
  }
}

TEST(Axes, AnEnginesCameraLooksWhereTheCameraLooks) {
  struct Looks {
    std::int32_t axes;
    Eigen::Vector3d forward, up;  // of the engine's camera, in its own axes
  };
  const Looks engines[] = {{ROOMRADAR_AXES_WORLD, {0, 0, 1}, {0, -1, 0}},
                           {ROOMRADAR_AXES_GLTF, {0, 0, -1}, {0, 1, 0}},
                           {ROOMRADAR_AXES_GODOT, {0, 0, -1}, {0, 1, 0}},
                           {ROOMRADAR_AXES_UNITY, {0, 0, 1}, {0, 1, 0}},
                           {ROOMRADAR_AXES_UNREAL, {1, 0, 0}, {0, 0, 1}}};
  const Eigen::Isometry3d T = some_pose();
  const roomradar_pose pose = c_api::pose_of(T);
  for (const Looks& engine : engines) {
    roomradar_pose converted{};
    expect_ok(roomradar_camera_to_engine(engine.axes, &pose, &converted));
    const Eigen::Matrix3d R = c_api::unchecked_pose_of(converted).linear();
    const double unit = engine.axes == ROOMRADAR_AXES_UNREAL ? 100.0 : 1.0;
    EXPECT_LT((unit * (R * engine.forward) - to_engine(engine.axes, T.linear().col(2))).norm(), 1e-10);
    EXPECT_LT((unit * (R * engine.up) - to_engine(engine.axes, -T.linear().col(1))).norm(), 1e-10);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-12) << engine.axes;
  }
}

TEST(Axes, TrianglesFaceAsTheEnginesFrontFaces) {
  const test::OpenMap map;
  roomradar_block block{};
  size_t needed = 0;
  static_cast<void>(roomradar_map_blocks(map.handle, nullptr, 0, &needed));
  std::vector<roomradar_block> blocks(needed);
  expect_ok(roomradar_map_blocks(map.handle, blocks.data(), needed, &needed));
  block = blocks.front();
  std::vector<float> vertices(3 * block.vertex_count), normals(3 * block.vertex_count);
  std::vector<std::uint32_t> triangles(3 * block.triangle_count);
  for (const std::int32_t axes : kAll) {
    auto mesh = sized<roomradar_mesh_buffers>();
    mesh.axes = axes;
    mesh.vertices = vertices.data();
    mesh.normals = normals.data();
    mesh.triangles = triangles.data();
    mesh.vertex_capacity = block.vertex_count;
    mesh.triangle_capacity = block.triangle_count;
    expect_ok(roomradar_map_block_mesh(map.handle, block.id, &mesh));
    // By the rule of the engine's hand, of counter-clockwise triangles the cross product faces outwards.
    const bool is_left_handed = axes == ROOMRADAR_AXES_UNITY || axes == ROOMRADAR_AXES_UNREAL;
    const bool is_clockwise = axes == ROOMRADAR_AXES_UNITY || axes == ROOMRADAR_AXES_GODOT;
    int outwards = 0, inwards = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const auto vertex = [&](std::size_t k) {
        return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * triangles[t + k]]);
      };
      const Eigen::Vector3f cross = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
      const float along = cross.dot(Eigen::Map<const Eigen::Vector3f>(&normals[3 * triangles[t]]));
      ++((along > 0.0F) != (is_left_handed != is_clockwise) ? outwards : inwards);
    }
    EXPECT_GT(outwards, 10 * inwards) << axes;
  }
}

TEST(Axes, QuaternionAndFieldOfViewAreThoseOfThePose) {
  const Eigen::Isometry3d T = some_pose();
  const roomradar_pose pose = c_api::pose_of(T);
  double q[4] = {};
  expect_ok(roomradar_quaternion(&pose, q));
  EXPECT_LT((Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix() - T.linear()).norm(), 1e-12);
  const roomradar_camera camera{640, 480, 500.0, 240.0, 320.0, 240.0};
  double fov_rad = 0.0;
  expect_ok(roomradar_vertical_fov(&camera, &fov_rad));
  EXPECT_NEAR(fov_rad, std::acos(0.0), 1e-12);  // 90 degrees
  EXPECT_EQ(roomradar_points_to_engine(5, q, q, 1), ROOMRADAR_INVALID_ARGUMENT);
  EXPECT_EQ(roomradar_points_to_engine(-1, q, q, 1), ROOMRADAR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace roomradar::axes_test
