// radar_calls_test.cpp: radar queries through the C API are those of CyberRadar, to the bit.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "app/objects/object_file.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/app/c_api/c_room.hpp"

namespace roomradar::radar_calls_test {
namespace {

using test::assert_ok;
using test::expect_ok;
using test::OpenMap;
using test::sized;

roomradar_shape* shape_of(const Mesh& mesh) {
  std::vector<float> vertices;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    vertices.insert(vertices.end(), {vertex.x(), vertex.y(), vertex.z()});
  auto given = sized<roomradar_mesh>();
  given.vertices_m = vertices.data();
  given.vertex_count = mesh.vertices.size();
  given.triangles = mesh.triangles.front().data();
  given.triangle_count = mesh.triangles.size();
  for (int axis = 0; axis < 3; ++axis) given.origin_m[axis] = mesh.origin[axis];
  roomradar_shape* shape = nullptr;
  assert_ok(roomradar_shape_open(&given, &shape));
  return shape;
}

std::vector<roomradar_query> random_queries(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<roomradar_query> queries(count);
  for (roomradar_query& query : queries) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(unit(random), unit(random), 1.2 + 0.4 * unit(random));
    T.rotate(Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random)).normalized());
    query.T_world_object = c_api::pose_of(T);
    for (double& component : query.direction_world) component = unit(random);
    query.distance_m = 3.0;
    query.margin_m = 0.0;
  }
  return queries;
}

bool are_same(const roomradar_contact& got, const Contact& wanted) {
  return got.status == static_cast<int>(wanted.status) && got.kind == static_cast<int>(wanted.touched) &&
         got.travel_m == wanted.contact_distance_m && got.lower_m == wanted.lower_m &&
         got.upper_m == wanted.upper_m &&
         std::memcmp(got.point_world, wanted.point_world.data(), sizeof got.point_world) == 0 &&
         std::memcmp(got.normal_world, wanted.normal_world.data(), sizeof got.normal_world) == 0;
}

TEST(CRadar, QueriesOfTheMapAreThoseOfCyberRadar) {
  const OpenMap map;
  const SavedMap saved = load_map(test::CRoom::get().map_folder);
  TriangleTree room, pot;
  room.build_by_place(saved.mesh);
  const Mesh mesh = object_mesh("teapot");
  pot.build_by_place(mesh);
  roomradar_shape* const c_pot = shape_of(mesh);
  roomradar_shape* c_room = nullptr;
  roomradar_radar* radar = nullptr;
  assert_ok(roomradar_map_shape(map.handle, &c_room));
  assert_ok(roomradar_radar_open(nullptr, &radar));
  const roomradar_placed_shape placed{c_room, test::pose_at(0, 0, 0), ROOMRADAR_SURFACE_STATIC};
  expect_ok(roomradar_radar_set_scene(radar, &placed, 1));
  expect_ok(roomradar_shape_close(c_room));  // the scene keeps it

  const std::vector<SceneTree> scene{{{&room, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
  CyberRadar expected;
  const std::vector<roomradar_query> queries = random_queries(300);
  std::vector<roomradar_contact> batch(queries.size());
  expect_ok(roomradar_radar_query_many(radar, c_pot, queries.data(), queries.size(), batch.data()));
  int touching = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Contact wanted = expected.query({{&pot, c_api::unchecked_pose_of(queries[i].T_world_object)},
                                           Eigen::Map<const Eigen::Vector3d>(queries[i].direction_world),
                                           3.0},
                                          {scene, {}});
    EXPECT_TRUE(are_same(batch[i], wanted)) << i;
    roomradar_contact alone{};
    expect_ok(roomradar_radar_query(radar, c_pot, &queries[i], &alone));
    EXPECT_EQ(std::memcmp(&alone, &batch[i], sizeof alone), 0) << i;
    touching += wanted.status == ContactStatus::kContact;
  }
  EXPECT_GT(touching, 50);
  expect_ok(roomradar_shape_close(c_pot));
  expect_ok(roomradar_radar_close(radar));
}

TEST(CRadar, AnInvalidQueryLosesNothingButItself) {
  const Mesh mesh = object_mesh("teapot");
  roomradar_shape* const pot = shape_of(mesh);
  roomradar_radar* radar = nullptr;
  assert_ok(roomradar_radar_open(nullptr, &radar));
  const roomradar_placed_shape placed{pot, test::pose_at(0, 0, 0), ROOMRADAR_SURFACE_OBJECT};
  expect_ok(roomradar_radar_set_scene(radar, &placed, 1));
  std::vector<roomradar_query> queries(6, {test::pose_at(0, 0, 1), {0, 0, -1}, 3.0, 0.0});
  queries[0].distance_m = std::numeric_limits<double>::quiet_NaN();
  queries[1].direction_world[2] = 0.0;
  queries[2].T_world_object.m[0] = 2.0;  // not a rotation
  queries[3].T_world_object.m[15] = 0.0;
  queries[4].T_world_object.m[3] = std::numeric_limits<double>::infinity();
  std::vector<roomradar_contact> contacts(queries.size());
  expect_ok(roomradar_radar_query_many(radar, pot, queries.data(), queries.size(), contacts.data()));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(contacts[i].status, ROOMRADAR_CONTACT_INVALID) << i;
  EXPECT_EQ(contacts[5].status, ROOMRADAR_CONTACT_TOUCHES);
  EXPECT_EQ(contacts[5].kind, ROOMRADAR_SURFACE_OBJECT);
  expect_ok(roomradar_radar_query_many(radar, pot, nullptr, 0, nullptr));
  roomradar_shape_close(pot);
  roomradar_radar_close(radar);
}

TEST(CRadar, ManyShapesAnswerAsFewDo) {  // from 32 on, queries visit them by a hierarchy
  const Mesh mesh = object_mesh("teapot", 0.1);
  roomradar_shape* const pot = shape_of(mesh);
  roomradar_radar *few = nullptr, *many = nullptr;
  assert_ok(roomradar_radar_open(nullptr, &few));
  assert_ok(roomradar_radar_open(nullptr, &many));
  std::vector<roomradar_placed_shape> placed;
  for (int i = 0; i < 60; ++i)
    placed.push_back(
        {pot, test::pose_at(0.3 * (i % 8) - 1.0, 0.3 * (i / 8) - 1.0, 1.0), ROOMRADAR_SURFACE_OBJECT});
  expect_ok(roomradar_radar_set_scene(many, placed.data(), placed.size()));
  const std::vector<roomradar_query> queries = random_queries(100);
  int touching = 0;
  for (const roomradar_query& query : queries) {
    roomradar_contact with_many{};
    expect_ok(roomradar_radar_query(many, pot, &query, &with_many));
    double nearest_m = std::numeric_limits<double>::infinity();
    bool overlaps = false;
    for (std::size_t from = 0; from < placed.size(); from += 20) {
      roomradar_contact with_few{};
      expect_ok(roomradar_radar_set_scene(few, placed.data() + from, 20));
      expect_ok(roomradar_radar_query(few, pot, &query, &with_few));
      overlaps = overlaps || with_few.status == ROOMRADAR_CONTACT_OVERLAP;
      if (with_few.status == ROOMRADAR_CONTACT_TOUCHES) nearest_m = std::min(nearest_m, with_few.travel_m);
    }
    EXPECT_EQ(with_many.status == ROOMRADAR_CONTACT_OVERLAP, overlaps);
    if (overlaps || with_many.status != ROOMRADAR_CONTACT_TOUCHES) continue;
    ++touching;
    EXPECT_EQ(with_many.travel_m, nearest_m);
  }
  EXPECT_GT(touching, 10);
  roomradar_radar_close(few);
  roomradar_radar_close(many);
  roomradar_shape_close(pot);
}

}  // namespace
}  // namespace roomradar::radar_calls_test
