// wrong_calls_test.cpp: wrong calls of the C API: a status and a sentence each, and nothing changes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/app/c_api/c_room.hpp"

namespace roomradar::wrong_calls_test {
namespace {

using test::assert_ok;
using test::expect_ok;
using test::OpenMap;
using test::OpenSession;
using test::sized;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_refused(roomradar_status status, roomradar_status expected, const std::string& in_sentence) {
  EXPECT_EQ(status, expected) << roomradar_last_error();
  EXPECT_NE(std::string(roomradar_last_error()).find(in_sentence), std::string::npos)
      << roomradar_last_error();
}

TEST(CWrongCall, NamesCallArgumentAndRule) {
  const OpenMap map;
  const OpenSession session(map.handle);
  Frame frame = test::frames_of(test::view_of_table("frames=1")).front();
  auto given = sized<roomradar_frame>();
  c_api::write_frame(frame, given);
  const auto step = [&] { return roomradar_session_step(session.handle, &given, nullptr); };
  expect_refused(roomradar_session_step(session.handle, nullptr, nullptr), ROOMRADAR_INVALID_ARGUMENT,
                 "roomradar_session_step: frame is null");
  given.struct_size = 8;
  expect_refused(step(), ROOMRADAR_WRONG_STRUCT_SIZE, "frame->struct_size = 8");
  given.struct_size = sizeof given + 8;
  expect_refused(step(), ROOMRADAR_WRONG_STRUCT_SIZE, "another version");
  c_api::write_frame(frame, given);
  given.struct_size = sizeof given;
  given.depth_camera.fx_px = kNan;
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.depth_camera");
  c_api::write_frame(frame, given);
  given.depth_m = nullptr;
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.depth_m is null");
  c_api::write_frame(frame, given);
  given.T_world_camera.m[0] = 1.1;
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.T_world_camera is not a rigid motion");
  c_api::write_frame(frame, given);
  given.stamp_s = std::numeric_limits<double>::infinity();
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.stamp_s");
  c_api::write_frame(frame, given);
  given.noise.base_m = -1.0F;
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.noise");
  c_api::write_frame(frame, given);
  given.has_gravity = 1;
  std::fill(std::begin(given.down_camera), std::end(given.down_camera), 0.0);
  expect_refused(step(), ROOMRADAR_INVALID_ARGUMENT, "frame.down_camera");
  EXPECT_EQ(std::string(roomradar_session_error(session.handle)), roomradar_last_error());
  c_api::write_frame(frame, given);
  expect_ok(step());

  roomradar_session* none = nullptr;
  auto options = sized<roomradar_session_options>();
  options.poses = 7;
  expect_refused(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_INVALID_ARGUMENT,
                 "poses = 7");
  options.poses = 0;
  options.surfaces = -1;
  expect_refused(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_INVALID_ARGUMENT,
                 "surfaces = -1");
  options.surfaces = 0;
  options.quality = "radar=nothing";
  EXPECT_NE(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_OK);
  options.quality = "radar";
  expect_refused(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_INVALID_ARGUMENT,
                 "NAME=VALUE");
  const std::string long_quality(5000, ' ');
  options.quality = long_quality.c_str();
  expect_refused(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_INVALID_ARGUMENT,
                 "longer than 4096");
  options.quality = nullptr;
  options.watches_changes = 1;
  options.adopt_after_s = -1.0;
  expect_refused(roomradar_session_open(map.handle, &options, &none), ROOMRADAR_FAILED, "after_s");
  EXPECT_EQ(none, nullptr);
  expect_refused(roomradar_session_add_file(session.handle, "pot", "/nowhere.glb", 0.0, nullptr),
                 ROOMRADAR_FAILED, "/nowhere.glb");
  expect_ok(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr));
  expect_refused(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr),
                 ROOMRADAR_INVALID_ARGUMENT, "already");
  expect_refused(roomradar_session_drop(session.handle, "pan", nullptr, 0.3), ROOMRADAR_INVALID_ARGUMENT,
                 "no object named pan");
  expect_refused(roomradar_session_drop(session.handle, "pot", nullptr, kNan), ROOMRADAR_INVALID_ARGUMENT,
                 "height_m");
  expect_refused(roomradar_session_adopt(session.handle), ROOMRADAR_FAILED, "watches_changes");
}

TEST(CWrongCall, AMeshIsCheckedWhole) {
  const std::array<float, 9> vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::array<std::uint32_t, 3> triangles = {0, 1, 3};
  auto mesh = sized<roomradar_mesh>();
  mesh.vertices_m = vertices.data();
  mesh.vertex_count = 3;
  mesh.triangles = triangles.data();
  mesh.triangle_count = 1;
  roomradar_shape* shape = nullptr;
  expect_refused(roomradar_shape_open(&mesh, &shape), ROOMRADAR_INVALID_ARGUMENT, "mesh.triangles[0]");
  mesh.triangle_count = std::numeric_limits<size_t>::max() / 3;
  expect_refused(roomradar_shape_open(&mesh, &shape), ROOMRADAR_INVALID_ARGUMENT, "mesh.triangle_count");
  mesh.triangle_count = 1;
  mesh.vertex_count = 0;
  expect_refused(roomradar_shape_open(&mesh, &shape), ROOMRADAR_INVALID_ARGUMENT, "mesh.vertex_count");
  const std::array<float, 9> endless = {0, 0, 0, 1, 0, INFINITY, 0, 1, 0};
  mesh.vertices_m = endless.data();
  mesh.vertex_count = 3;
  expect_refused(roomradar_shape_open(&mesh, &shape), ROOMRADAR_INVALID_ARGUMENT, "mesh.vertices_m[1]");
  EXPECT_EQ(shape, nullptr);
}

/// Makes random arguments, most of them wrong. Pointers are null or to memory that is large enough.
class Fuzz {
 public:
  explicit Fuzz(std::vector<const void*> handles) : handles_(std::move(handles)) {}

  std::size_t below(std::size_t count) { return random_() % count; }
  /// Returns the right handle half of the time; else one of another kind, a closed one, null or a number.
  template <typename Handle>
  Handle* handle(const Handle* right) {
    if (below(2) == 0) return const_cast<Handle*>(right);
    if (below(3) == 0) return reinterpret_cast<Handle*>(random_());
    return static_cast<Handle*>(const_cast<void*>(handles_[below(handles_.size())]));
  }
  double number() {
    const double some[] = {0.0, 1.0, -1.0, kNan, INFINITY, -INFINITY, 1e300, -1e-300, 0.3, 640.0};
    return some[below(std::size(some))];
  }
  std::int32_t integer() {
    const std::int32_t some[] = {
        0, 1, 2, 3, 4, 5, -1, 160, 120, 1 << 30, std::numeric_limits<std::int32_t>::min()};
    return some[below(std::size(some))];
  }
  const char* text() {
    static const std::string kLong(10'000, 'x');
    const char* some[] = {nullptr,          "",           "pot", "teapot", "/nowhere", "\xff\xfe",
                          "depth_stride=3", kLong.c_str()};
    return some[below(std::size(some))];
  }
  /// Returns a struct of random numbers, with a right size half of the time.
  template <typename Struct>
  Struct* structure() {
    if (below(6) == 0) return nullptr;
    static_assert(sizeof(Struct) <= sizeof bytes_[0]);
    std::uint8_t* const at = bytes_[next_++ % bytes_.size()].data();
    for (std::size_t i = 0; i < sizeof(Struct); i += 8) {
      const double value = number();
      const std::uint64_t pair =
          static_cast<std::uint32_t>(integer()) | std::uint64_t{static_cast<std::uint32_t>(integer())} << 32;
      std::memcpy(at + i, below(2) == 0 ? static_cast<const void*>(&value) : &pair,
                  std::min<std::size_t>(8, sizeof(Struct) - i));
    }
    return reinterpret_cast<Struct*>(at);
  }
  /// The same for a struct that begins with its size. `point` sets its pointers.
  template <typename Struct>
  Struct* sized_structure(const std::function<void(Struct&)>& point = [](Struct&) {}) {
    Struct* const made = structure<Struct>();
    if (made == nullptr) return nullptr;
    if (below(4) != 0) made->struct_size = sizeof(Struct);
    point(*made);
    return made;
  }
  /// Returns null or a large buffer.
  template <typename Element>
  Element* buffer() {
    return below(3) == 0 ? nullptr : reinterpret_cast<Element*>(large_.data());
  }
  size_t capacity() { return below(2000); }
  size_t* needed() { return below(4) == 0 ? nullptr : &needed_; }

 private:
  std::mt19937_64 random_{11};
  std::vector<const void*> handles_;
  alignas(16) std::array<std::array<std::uint8_t, 1024>, 4> bytes_{};
  std::size_t next_ = 0;
  alignas(16) std::array<std::uint8_t, 1 << 20> large_{};
  size_t needed_ = 0;
};

struct OpenHandles {
  roomradar_map* map = nullptr;
  roomradar_session* session = nullptr;
  roomradar_locator* locator = nullptr;
  roomradar_shape* shape = nullptr;
  roomradar_radar* radar = nullptr;
};

roomradar_status wrong_call(Fuzz& fuzz, const OpenHandles& open) {
  const auto map = [&] { return fuzz.handle(open.map); };
  const auto session = [&] { return fuzz.handle(open.session); };
  const auto shape = [&] { return fuzz.handle(open.shape); };
  const auto pose = [&] { return fuzz.structure<roomradar_pose>(); };
  const auto vector = [&] { return fuzz.buffer<double>(); };
  const auto mesh_out = [&] {
    return fuzz.sized_structure<roomradar_mesh_buffers>([&](roomradar_mesh_buffers& mesh) {
      mesh.vertices = fuzz.buffer<float>();
      mesh.normals = fuzz.buffer<float>();
      mesh.colours_rgb = fuzz.buffer<std::uint8_t>();
      mesh.triangles = fuzz.buffer<std::uint32_t>();
      mesh.vertex_capacity = mesh.triangle_capacity = fuzz.capacity();
    });
  };
  const auto mesh_in = [&] {
    return fuzz.sized_structure<roomradar_mesh>([&](roomradar_mesh& mesh) {
      mesh.vertices_m = fuzz.buffer<float>();
      mesh.triangles = fuzz.buffer<std::uint32_t>();
      mesh.colours_rgb = nullptr;
      mesh.vertex_count = fuzz.below(2) == 0 ? 0 : fuzz.below(100);
      mesh.triangle_count = fuzz.below(100);
    });
  };
  const auto frame = [&] {
    return fuzz.sized_structure<roomradar_frame>([&](roomradar_frame& made) {
      made.depth_m = fuzz.buffer<float>();  // holds 512 x 512
      made.colour_rgb = nullptr;
      made.depth_camera.width_px = std::min(made.depth_camera.width_px, 512);
      made.depth_camera.height_px = std::min(made.depth_camera.height_px, 512);
    });
  };
  const auto material = [&] { return fuzz.sized_structure<roomradar_material>(); };
  roomradar_map* new_map = nullptr;
  roomradar_session* new_session = nullptr;
  roomradar_shape* new_shape = nullptr;
  roomradar_source* new_source = nullptr;
  switch (fuzz.below(34)) {
    case 0:
      return roomradar_map_open(fuzz.text(), &new_map);
    case 1:
      return roomradar_source_open(fuzz.text(), &new_source);
    case 2:
      return roomradar_map_blocks(map(), fuzz.buffer<roomradar_block>(), fuzz.capacity(), fuzz.needed());
    case 3:
      return roomradar_map_block_mesh(map(), static_cast<std::uint64_t>(fuzz.integer()), mesh_out());
    case 4:
      return roomradar_map_describe(map(), fuzz.sized_structure<roomradar_map_info>());
    case 5:
      return roomradar_session_open(map(),
                                    fuzz.sized_structure<roomradar_session_options>([&](auto& options) {
                                      options.quality = fuzz.text();
                                      options.watches_changes = 0;
                                      options.poses = 9;  // a session is never made
                                    }),
                                    &new_session);
    case 6:
    case 7:
      return roomradar_session_step(session(), frame(), fuzz.sized_structure<roomradar_frame_result>());
    case 8:
      return roomradar_session_picture(session(), fuzz.buffer<std::uint8_t>(), fuzz.capacity(), fuzz.needed(),
                                       nullptr, nullptr);
    case 9:
      return roomradar_session_expected_depth(session(), fuzz.buffer<float>(), fuzz.capacity(), fuzz.needed(),
                                              nullptr);
    case 10:
      return roomradar_session_moved_mask(session(), fuzz.buffer<std::uint8_t>(), fuzz.capacity(),
                                          fuzz.needed(), nullptr, nullptr);
    case 11:
      return roomradar_session_moved_mesh(session(), fuzz.integer(), mesh_out());
    case 12:
      return roomradar_session_blocks(session(), fuzz.buffer<roomradar_block>(), fuzz.capacity(),
                                      fuzz.needed());
    case 13:
      return roomradar_session_notices(session(), fuzz.buffer<char>(), fuzz.capacity(), fuzz.needed());
    case 14:
      return roomradar_session_set_surfaces(session(), 4 + (fuzz.integer() & 0xff));
    case 15:
      return roomradar_session_set_quality(session(), fuzz.text());
    case 16:
      return roomradar_session_save(session(), fuzz.text());
    case 17:
      return roomradar_session_add_file(session(), fuzz.text(), fuzz.text(), fuzz.number(), material());
    case 18:
      return roomradar_session_add_mesh(session(), "mesh", mesh_in(), material());
    case 19:
      return roomradar_session_set_material(session(), fuzz.text(), material());
    case 20:
      return roomradar_session_place(session(), fuzz.text(), pose());
    case 21:
      return roomradar_session_throw(session(), fuzz.text(), pose(), vector(), vector());
    case 22:
      return roomradar_session_drop(session(), "pan", vector(), fuzz.number());
    case 23:
      return roomradar_session_object_name(session(), fuzz.capacity(), fuzz.buffer<char>(), 0, fuzz.needed());
    case 24:
      return roomradar_session_object_mesh(session(), fuzz.text(), mesh_out());
    case 25:
      return roomradar_session_touches(session(), fuzz.text(), fuzz.buffer<roomradar_touch>(),
                                       fuzz.capacity(), fuzz.needed());
    case 26:
      return roomradar_shape_open(mesh_in(), &new_shape);
    case 27:
      return roomradar_radar_query(fuzz.handle(open.radar), shape(), fuzz.structure<roomradar_query>(),
                                   fuzz.structure<roomradar_contact>());
    case 28:
      return roomradar_radar_set_scene(fuzz.handle(open.radar), fuzz.structure<roomradar_placed_shape>(), 1);
    case 29:
      return roomradar_session_query_object(session(), fuzz.text(), fuzz.structure<roomradar_query>(), 1,
                                            fuzz.structure<roomradar_contact>());
    case 30:
      return roomradar_session_query_shape(session(), shape(), fuzz.structure<roomradar_query>(), 1,
                                           fuzz.structure<roomradar_contact>());
    case 31:
      return roomradar_locator_locate(fuzz.handle(open.locator), frame(),
                                      fuzz.sized_structure<roomradar_location>());
    case 32:
      return roomradar_locator_expected_depth(fuzz.handle(open.locator), fuzz.structure<roomradar_camera>(),
                                              pose(), fuzz.buffer<float>(), fuzz.capacity(), fuzz.needed());
    default:
      return roomradar_pose_to_engine(fuzz.integer(), pose(), pose());
  }
}

TEST(CWrongCall, AThousandAtRandomAreRefusedWithASentenceEach) {
  const OpenMap map, closed;
  const OpenSession session(map.handle);
  OpenHandles open{map.handle, session.handle};
  assert_ok(roomradar_locator_open(map.handle, &open.locator));
  assert_ok(roomradar_map_shape(map.handle, &open.shape));
  assert_ok(roomradar_radar_open(nullptr, &open.radar));
  expect_ok(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr));
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=2&moving=hand"));
  session.step(frames[0]);
  roomradar_map_close(closed.handle);
  Fuzz fuzz({open.map, open.session, open.locator, open.shape, open.radar, closed.handle, nullptr});
  std::size_t wrong = 0, calls = 0;
  std::array<std::size_t, 10> by_status{};
  while (wrong < 1000 && calls < 20'000) {
    ++calls;
    const roomradar_status status = wrong_call(fuzz, open);
    ASSERT_GE(status, ROOMRADAR_OK);
    ASSERT_LE(status, ROOMRADAR_FAILED) << roomradar_last_error();  // no internal fault, no lack of memory
    ++by_status[status];
    if (status == ROOMRADAR_OK) continue;
    ++wrong;
    const std::string sentence = roomradar_last_error();
    ASSERT_EQ(sentence.rfind("roomradar_", 0), 0U) << sentence;
    ASSERT_GT(sentence.size(), 30U) << sentence;
  }
  EXPECT_EQ(wrong, 1000U);
  for (const roomradar_status status :
       {ROOMRADAR_INVALID_ARGUMENT, ROOMRADAR_CLOSED_HANDLE, ROOMRADAR_WRONG_STRUCT_SIZE,
        ROOMRADAR_BUFFER_TOO_SMALL, ROOMRADAR_FAILED})
    EXPECT_GT(by_status[status], 5U) << roomradar_status_name(status);
  // The session still works.
  EXPECT_EQ(session.step(frames[1]).is_located, 1);
  roomradar_locator_close(open.locator);
  roomradar_shape_close(open.shape);
  roomradar_radar_close(open.radar);
}

TEST(CWrongCall, AHandleIsNeverUsedTwice) {
  const OpenMap map;
  std::vector<const void*> handles;
  for (int i = 0; i < 50; ++i) {
    roomradar_shape* shape = nullptr;
    assert_ok(roomradar_map_shape(map.handle, &shape));
    EXPECT_EQ(std::count(handles.begin(), handles.end(), shape), 0);
    handles.push_back(shape);
    expect_ok(roomradar_shape_close(shape));
    EXPECT_EQ(roomradar_shape_close(shape), ROOMRADAR_CLOSED_HANDLE);
  }
  EXPECT_STRNE(roomradar_map_error(nullptr), "");
}

}  // namespace
}  // namespace roomradar::wrong_calls_test
