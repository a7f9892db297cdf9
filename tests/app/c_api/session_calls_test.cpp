// session_calls_test.cpp: sessions through the C API do what the Session of C++ does, to the bit.
#include <gtest/gtest.h>

#include <bit>
#include <map>

#include "app/session/session.hpp"
#include "mapping/map/map_writer.hpp"
#include "tests/app/c_api/c_room.hpp"

namespace roomradar::session_calls_test {
namespace {

using test::assert_ok;
using test::CRoom;
using test::expect_ok;
using test::OpenMap;
using test::OpenSession;
using test::sized;

/// Returns what a function gives, by asking for its size first.
template <typename Element, typename Call>
std::vector<Element> fetched(const Call& call) {
  size_t needed = 0;
  static_cast<void>(call(nullptr, 0, &needed));
  std::vector<Element> buffer(needed);
  assert_ok(call(buffer.data(), buffer.size(), &needed));
  return buffer;
}

TEST(CSession, EveryFrameIsThatOfTheSessionInCpp) {
  const SavedMap saved = load_map(CRoom::get().map_folder);
  SessionConfig config;
  config.poses = PoseOrigin::kTracked;
  Session expected(saved, config);
  const OpenMap map;
  const OpenSession session(map.handle, ROOMRADAR_POSES_TRACKED);
  expected.add_object("pot", object_mesh("teapot"));
  expect_ok(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr));
  expected.drop({.name = "pot"});
  expect_ok(roomradar_session_drop(session.handle, "pot", nullptr, 0.3));
  StageTimes times;
  std::size_t moved_pixels = 0;
  for (const Frame& frame : test::frames_of(test::view_of_table("frames=25&moving=hand"))) {
    const FrameResult wanted = expected.step(frame, times);
    const roomradar_frame_result got = session.step(frame);
    ASSERT_EQ(got.is_located, wanted.status == FrameStatus::kDone);
    const roomradar_pose T_world_camera = c_api::pose_of(wanted.T_world_camera);
    EXPECT_EQ(std::memcmp(&got.T_world_camera, &T_world_camera, sizeof T_world_camera), 0);
    double sigma_m[3] = {-1, -1, -1}, sigma_rad[3] = {-1, -1, -1};
    expect_ok(roomradar_session_pose_sigma(session.handle, sigma_m, sigma_rad));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(sigma_m[axis], wanted.sigma.position_m(axis));
      EXPECT_EQ(sigma_rad[axis], wanted.sigma.rotation_rad(axis));
    }
    EXPECT_EQ(got.contacts, wanted.contacts);
    const roomradar_object_state pot = session.object("pot");
    const Body& body = expected.objects().front()->body;
    const roomradar_pose T_world_object = c_api::pose_of(body.T_world_object);
    EXPECT_EQ(std::memcmp(&pot.T_world_object, &T_world_object, sizeof T_world_object), 0) << frame.index;
    EXPECT_EQ(pot.is_in_room != 0, expected.objects().front()->in_room);
    EXPECT_EQ(pot.is_asleep != 0, body.asleep);

    const auto picture = fetched<std::uint8_t>([&](std::uint8_t* to, size_t capacity, size_t* needed) {
      return roomradar_session_picture(session.handle, to, capacity, needed, nullptr, nullptr);
    });
    ASSERT_EQ(picture.size(), 3 * expected.picture().pixels.size());
    EXPECT_EQ(std::memcmp(picture.data(), expected.picture().pixels.data(), picture.size()), 0);
    const auto mask = fetched<std::uint8_t>([&](std::uint8_t* to, size_t capacity, size_t* needed) {
      return roomradar_session_moved_mask(session.handle, to, capacity, needed, nullptr, nullptr);
    });
    ASSERT_EQ(mask.size(), expected.scene().foreground().dynamic_mask.pixels.size());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      ASSERT_EQ(mask[i] != 0, expected.scene().foreground().dynamic_mask.pixels[i] != 0);
      moved_pixels += mask[i] != 0;
    }
    const auto depth_m = fetched<float>([&](float* to, size_t capacity, size_t* needed) {
      return roomradar_session_expected_depth(session.handle, to, capacity, needed, nullptr);
    });
    EXPECT_EQ(depth_m, expected.scene().expected().depth_m.pixels);

    auto mesh = sized<roomradar_mesh_buffers>();
    static_cast<void>(roomradar_session_moved_mesh(session.handle, 0, &mesh));
    std::vector<float> vertices(3 * mesh.vertex_count), normals(vertices.size());
    std::vector<std::uint32_t> triangles(3 * mesh.triangle_count);
    mesh.vertices = vertices.data();
    mesh.normals = normals.data();
    mesh.triangles = triangles.data();
    mesh.vertex_capacity = mesh.vertex_count;
    mesh.triangle_capacity = mesh.triangle_count;
    expect_ok(roomradar_session_moved_mesh(session.handle, 0, &mesh));
    const Mesh& seen = expected.scene().dynamic_world().seen_world;
    ASSERT_EQ(mesh.vertex_count, seen.vertices.size());
    ASSERT_EQ(mesh.triangle_count, seen.triangles.size());
    if (!seen.triangles.empty()) {
      EXPECT_EQ(std::memcmp(triangles.data(), seen.triangles.data(), 4 * triangles.size()), 0);
      EXPECT_EQ(std::memcmp(vertices.data(), seen.vertices.data(), 4 * vertices.size()), 0);
    }
  }
  EXPECT_GT(moved_pixels, 1000U);  // the hand
  EXPECT_EQ(session.object("pot").rests_on, ROOMRADAR_SURFACE_STATIC);
  const auto touches = fetched<roomradar_touch>([&](roomradar_touch* to, size_t capacity, size_t* needed) {
    return roomradar_session_touches(session.handle, "pot", to, capacity, needed);
  });
  ASSERT_GE(touches.size(), 3U);  // a pot stands on three points at least
  for (const roomradar_touch& touch : touches) {
    EXPECT_EQ(touch.other, -1);
    EXPECT_GT(touch.normal_world[2], 0.9);
  }
}

TEST(CSession, GivenPosesAreThoseOfTheMapsWorld) {
  const CRoom& room = CRoom::get();
  SavedMap turned = load_map(room.map_folder);  // a map whose world is not that of its recording
  turned.info.T_world_recorded.translate(Eigen::Vector3d(0.5, -0.25, 0.0));
  const std::string folder = (room.folder.path() / "turned").string();
  save_map(folder, turned);
  roomradar_map* map = nullptr;
  assert_ok(roomradar_map_open(folder.c_str(), &map));
  const OpenSession given(map, ROOMRADAR_POSES_GIVEN), recorded(map, ROOMRADAR_POSES_RECORDED);
  expect_ok(roomradar_map_close(map));  // sessions keep what they need
  Frame frame = test::frames_of(test::view_of_table("frames=1")).front();
  const Eigen::Isometry3d T_recorded_camera = *frame.T_world_camera;
  const roomradar_frame_result by_record = recorded.step(frame);
  frame.T_world_camera = turned.info.T_world_recorded * T_recorded_camera;
  const roomradar_frame_result by_given = given.step(frame);
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR(by_given.T_world_camera.m[i], by_record.T_world_camera.m[i], 1e-12);
  EXPECT_NEAR(by_given.T_world_camera.m[3], T_recorded_camera.translation().x() + 0.5, 1e-12);
  frame.T_world_camera.reset();
  EXPECT_EQ(given.step(frame).is_located, 0);
}

TEST(CSession, NegativeAndInfiniteDepthIsNoMeasurement) {
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const float depth_m[] = {1.5F, -1.0F, kInfinite, std::numeric_limits<float>::quiet_NaN(), -kInfinite, 0.0F};
  auto given = sized<roomradar_frame>();
  given.depth_camera = {3, 2, 10.0, 10.0, 1.0, 0.5};
  given.depth_m = depth_m;
  Frame read;
  read.depth_m.resize(160, 120, 7.0F);  // of an earlier frame
  c_api::read_frame(&given, read);
  EXPECT_EQ(read.depth_m.pixels, std::vector<float>({1.5F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}));
}

/// Runs a scene in which a crate comes onto the table, until it is adopted. Returns true if it is.
bool adopts_crate(const OpenSession& session, const std::vector<Frame>& frames, std::size_t& next) {
  for (; next < frames.size(); ++next) {
    if (session.step(frames[next]).room_version > 1) return true;
    if (next > frames.size() / 2) expect_ok(roomradar_session_adopt(session.handle));
  }
  return false;
}

std::map<std::uint64_t, roomradar_block> blocks_of(const OpenSession& session) {
  std::map<std::uint64_t, roomradar_block> blocks;
  for (const roomradar_block& block :
       fetched<roomradar_block>([&](roomradar_block*to, size_t capacity, size_t*needed) {
         return roomradar_session_blocks(session.handle, to, capacity, needed);
       }))
    blocks[block.id] = block;
  return blocks;
}

TEST(CSession, AnAdoptedCrateRenewsItsBlockAloneAndIsSaved) {
  const OpenMap map;
  const OpenSession session(map.handle, ROOMRADAR_POSES_RECORDED, true);
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=120&crate=comes"));
  const auto before = blocks_of(session);
  ASSERT_GE(before.size(), 2U);
  std::size_t next = 0;
  ASSERT_TRUE(adopts_crate(session, frames, next));
  const auto changes = fetched<roomradar_change>([&](roomradar_change* to, size_t capacity, size_t* needed) {
    return roomradar_session_changes(session.handle, to, capacity, needed);
  });
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].is_removal, 0);
  EXPECT_NEAR(changes[0].max_world_m[2], 0.97, 0.05);  // the crate's top
  std::size_t renewed = 0;
  for (const auto& [id, block] : blocks_of(session)) {
    const auto old = before.find(id);
    const bool is_near = block.min_world_m[0] < changes[0].max_world_m[0] + 0.2 &&
                         block.max_world_m[0] > changes[0].min_world_m[0] - 0.2 &&
                         block.min_world_m[1] < changes[0].max_world_m[1] + 0.2 &&
                         block.max_world_m[1] > changes[0].min_world_m[1] - 0.2;
    if (old == before.end() || block.version == 2) {
      ++renewed;
      EXPECT_TRUE(is_near);
    } else {
      EXPECT_EQ(block.version, 1U);
      EXPECT_EQ(block.triangle_count, old->second.triangle_count);
    }
  }
  EXPECT_GE(renewed, 1U);
  EXPECT_LT(renewed, before.size());

  const std::string folder = (CRoom::get().folder.path() / "with-crate").string();
  expect_ok(roomradar_session_save(session.handle, folder.c_str()));
  roomradar_map* saved = nullptr;
  assert_ok(roomradar_map_open(folder.c_str(), &saved));
  const double points_world_m[] = {0.11, -0.205, 0.96, 0.11, -0.205, 1.3, 1e9, 0.0, 0.0};
  std::uint8_t occupancy[3] = {};
  expect_ok(roomradar_map_occupancy(saved, points_world_m, 3, occupancy));
  EXPECT_EQ(occupancy[0], ROOMRADAR_OCCUPANCY_OCCUPIED);
  EXPECT_EQ(occupancy[1], ROOMRADAR_OCCUPANCY_FREE);
  EXPECT_EQ(occupancy[2], ROOMRADAR_OCCUPANCY_UNKNOWN);
  expect_ok(roomradar_map_close(saved));
}

TEST(CSession, ASaveDuringACommitTakesEffectInTheNextFrame) {
  const OpenMap map;
  const OpenSession session(map.handle, ROOMRADAR_POSES_RECORDED, true);
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=120&crate=comes"));
  const std::string folder = (CRoom::get().folder.path() / "early").string();
  const auto changes = [&] {
    size_t needed = 0;
    static_cast<void>(roomradar_session_changes(session.handle, nullptr, 0, &needed));
    return needed;
  };
  std::size_t next = 0;
  for (; next < frames.size() && changes() == 0; ++next) {
    ASSERT_EQ(session.step(frames[next]).room_version, 1U);
    if (next > 60) expect_ok(roomradar_session_adopt(session.handle));
    if (next > 75) expect_ok(roomradar_session_save(session.handle, folder.c_str()));
  }
  ASSERT_LT(next, frames.size());
  EXPECT_EQ(session.step(frames[next]).room_version, 2U);
}

TEST(CSession, WhatHappensToObjectsIsSaidOnce) {
  const OpenMap map;
  const OpenSession session(map.handle);
  for (const Frame& frame : test::frames_of(test::view_of_table("frames=2"))) session.step(frame);
  expect_ok(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr));
  const roomradar_pose in_the_table = test::pose_at(0.1, -0.1, 0.73);
  expect_ok(roomradar_session_place(session.handle, "pot", &in_the_table));
  const auto text = fetched<char>([&](char* to, size_t capacity, size_t* needed) {
    return roomradar_session_notices(session.handle, to, capacity, needed);
  });
  EXPECT_NE(std::string(text.data()).find("pot"), std::string::npos) << text.data();
  EXPECT_EQ(fetched<char>([&](char* to, size_t capacity, size_t* needed) {
              return roomradar_session_notices(session.handle, to, capacity, needed);
            }).size(),
            1U);
}

TEST(CSession, ObjectsAreCarriedThrownTurnedAndWeighed) {
  const OpenMap map;
  const OpenSession session(map.handle);
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=12"));
  session.step(frames[0]);
  const float vertices[] = {0, 0, 0, 0.1F, 0, 0, 0, 0.1F, 0, 0, 0, 0.1F};
  const std::uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  auto mesh = sized<roomradar_mesh>();
  mesh.vertices_m = vertices;
  mesh.vertex_count = 4;
  mesh.triangles = triangles;
  mesh.triangle_count = 4;
  auto material = sized<roomradar_material>();
  material.is_set = ROOMRADAR_SETS_MASS;
  material.mass_kg = 0.25;
  expect_ok(roomradar_session_add_mesh(session.handle, "tent", &mesh, &material));
  EXPECT_EQ(session.object("tent").mass_kg, 0.25);
  const roomradar_pose start = test::pose_at(0.0, -0.1, 1.2);
  const double up_mps[] = {0.0, 0.0, 1.0}, spin[] = {0.0, 0.0, 3.0}, turn_deg[] = {0.0, 0.0, 90.0};
  expect_ok(roomradar_session_throw(session.handle, "tent", &start, up_mps, spin));
  session.step(frames[1]);
  EXPECT_GT(session.object("tent").T_world_object.m[11], 1.2);
  EXPECT_GT(session.object("tent").angular_velocity_world_rad_s[2], 2.0);
  expect_ok(roomradar_session_place(session.handle, "tent", &start));
  expect_ok(roomradar_session_turn(session.handle, "tent", turn_deg));
  EXPECT_NEAR(session.object("tent").T_world_object.m[4], 1.0, 1e-6);  // x points along y
  const double there[] = {0.15, -0.1, 1.25};
  expect_ok(roomradar_session_carry(session.handle, "tent", there));
  for (int i = 2; i < 10; ++i) session.step(frames[static_cast<std::size_t>(i)]);
  EXPECT_EQ(session.object("tent").is_carried, 1);
  EXPECT_NEAR(session.object("tent").T_world_object.m[3], 0.15, 0.01);
  EXPECT_NEAR(session.object("tent").T_world_object.m[11], 1.25, 0.01);
  const double still[] = {0.0, 0.0, 0.0};
  expect_ok(roomradar_session_release(session.handle, "tent", still));
  session.step(frames[10]);
  EXPECT_LT(session.object("tent").T_world_object.m[11], 1.25);
  expect_ok(roomradar_session_remove(session.handle, "tent"));
  EXPECT_EQ(session.object("tent").is_in_room, 0);
}

TEST(CLocator, FindsTheCameraAndRendersWhatItExpects) {
  const OpenMap map;
  roomradar_locator* locator = nullptr;
  assert_ok(roomradar_locator_open(map.handle, &locator));
  const OpenSession session(map.handle);
  auto given = sized<roomradar_frame>();
  auto location = sized<roomradar_location>();
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=3"));
  for (const Frame& frame : frames) {
    c_api::write_frame(frame, given);
    expect_ok(roomradar_locator_locate(locator, &given, &location));
    EXPECT_EQ(location.tracking, ROOMRADAR_TRACKED);
    const Eigen::Vector3d is(location.T_world_camera.m[3], location.T_world_camera.m[7],
                             location.T_world_camera.m[11]);
    EXPECT_LT((is - frame.T_world_camera->translation()).norm(), 0.02);
    expect_ok(roomradar_locator_forget(locator));
  }
  session.step(frames.back());
  const auto expected = fetched<float>([&](float* to, size_t capacity, size_t* needed) {
    return roomradar_session_expected_depth(session.handle, to, capacity, needed, nullptr);
  });
  const auto rendered = fetched<float>([&](float* to, size_t capacity, size_t* needed) {
    return roomradar_locator_expected_depth(locator, &given.depth_camera, &given.T_world_camera, to, capacity,
                                            needed);
  });
  EXPECT_EQ(rendered, expected);
  expect_ok(roomradar_locator_close(locator));
}

}  // namespace
}  // namespace roomradar::session_calls_test
