// threads_test.cpp: the library used from four threads, and loaded twice.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <thread>

#include "tests/app/c_api/c_room.hpp"

namespace roomradar::threads_test {
namespace {

using test::CRoom;
using test::OpenMap;
using test::OpenSession;

constexpr int kThreads = 4;

/// Returns the pot's height after each frame.
std::vector<double> heights_m(const roomradar_map* map, const std::vector<Frame>& frames) {
  const OpenSession session(map);
  test::assert_ok(roomradar_session_add_file(session.handle, "pot", "teapot", 0.0, nullptr));
  test::assert_ok(roomradar_session_drop(session.handle, "pot", nullptr, 0.3));
  std::vector<double> heights;
  for (const Frame& frame : frames) {
    session.step(frame);
    heights.push_back(session.object("pot").T_world_object.m[11]);
  }
  return heights;
}

template <typename Work>
void in_threads(const Work& work) {
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back([&work, i] { work(i); });
  for (std::thread& thread : threads) thread.join();
}

TEST(CThreads, FourWithASessionEachAndOneMapGetWhatOneGets) {
  const OpenMap map;
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=8"));
  const std::vector<double> expected = heights_m(map.handle, frames);
  std::array<std::vector<double>, kThreads> got;
  in_threads([&](int i) { got[static_cast<std::size_t>(i)] = heights_m(map.handle, frames); });
  for (const std::vector<double>& heights : got) EXPECT_EQ(heights, expected);
}

TEST(CThreads, FourMayShareASession) {
  const OpenMap map;
  const OpenSession session(map.handle);
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=3"));
  session.step(frames[0]);
  std::atomic<int> located{0}, faults{0};
  in_threads([&](int i) {
    const std::string name = "pot" + std::to_string(i);
    faults +=
        roomradar_session_add_file(session.handle, name.c_str(), "teapot", 0.1, nullptr) != ROOMRADAR_OK;
    const double above[] = {0.2 * i - 0.3, -0.1, 0.9};
    faults += roomradar_session_drop(session.handle, name.c_str(), above, 0.1) != ROOMRADAR_OK;
    for (const Frame& frame : frames) located += session.step(frame).is_located;
    std::vector<roomradar_object_state> states(8);
    size_t needed = 0;
    faults +=
        roomradar_session_objects(session.handle, states.data(), states.size(), &needed) != ROOMRADAR_OK;
    roomradar_query down{test::pose_at(0, 0, 2), {0, 0, -1}, 3.0, 0.0};
    roomradar_contact contact{};
    faults +=
        roomradar_session_query_object(session.handle, name.c_str(), &down, 1, &contact) != ROOMRADAR_OK;
    faults += roomradar_session_remove(session.handle, "nobody") != ROOMRADAR_INVALID_ARGUMENT;
    faults += std::string(roomradar_session_error(session.handle)).empty();
  });
  EXPECT_EQ(located, kThreads * 3);
  EXPECT_EQ(faults, 0);
}

TEST(CThreads, AHandleMayBeClosedWhileOthersUseIt) {
  const OpenMap map;
  const std::vector<Frame> frames = test::frames_of(test::view_of_table("frames=4"));
  roomradar_session* session = nullptr;
  test::assert_ok(roomradar_session_open(map.handle, nullptr, &session));
  auto given = test::sized<roomradar_frame>();
  c_api::write_frame(frames[0], given);
  std::atomic<int> others{0};
  in_threads([&](int i) {
    if (i == 0) roomradar_session_close(session);
    for (int k = 0; k < 3; ++k) {
      const roomradar_status status = roomradar_session_step(session, &given, nullptr);
      others += status != ROOMRADAR_OK && status != ROOMRADAR_CLOSED_HANDLE;
    }
  });
  EXPECT_EQ(others, 0);
  EXPECT_EQ(roomradar_session_step(session, &given, nullptr), ROOMRADAR_CLOSED_HANDLE);
}

/// A library loaded at run time.
struct Loaded {
  void* library = nullptr;
  explicit Loaded(const std::string& path) : library(dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (library == nullptr) throw std::runtime_error(dlerror());
  }
  template <typename Function>
  [[nodiscard]] Function* function(const char* name, Function* /*type*/) const {
    return reinterpret_cast<Function*>(dlsym(library, name));
  }
  /// Opens the map, leaves it open, and returns its number of blocks.
  [[nodiscard]] std::size_t use() const {
    const auto open = function("roomradar_map_open", &roomradar_map_open);
    const auto blocks = function("roomradar_map_blocks", &roomradar_map_blocks);
    const auto session_open = function("roomradar_session_open", &roomradar_session_open);
    roomradar_map* map = nullptr;
    roomradar_session* session = nullptr;
    size_t needed = 0;
    if (open(CRoom::get().map_folder.c_str(), &map) != ROOMRADAR_OK) return 0;
    if (session_open(map, nullptr, &session) != ROOMRADAR_OK) return 0;
    static_cast<void>(blocks(map, nullptr, 0, &needed));
    return needed;
  }
};

TEST(CLibrary, IsLoadedTwiceAndUnloadedWithOpenSessions) {
  const OpenMap map;
  size_t expected = 0;
  static_cast<void>(roomradar_map_blocks(map.handle, nullptr, 0, &expected));
  ASSERT_GT(expected, 0U);
  const std::string copy = (CRoom::get().folder.path() / "copy.so").string();
  std::filesystem::copy_file(ROOMRADAR_LIBRARY, copy);
  const Loaded one(ROOMRADAR_LIBRARY), again(ROOMRADAR_LIBRARY),
      other(copy);  // `other` has handles of its own
  EXPECT_EQ(one.library, again.library);
  EXPECT_NE(one.library, other.library);
  EXPECT_EQ(one.use(), expected);
  EXPECT_EQ(other.use(), expected);
  EXPECT_EQ(dlclose(one.library), 0);
  EXPECT_EQ(again.use(), expected);
  EXPECT_EQ(dlclose(again.library), 0);
  EXPECT_EQ(dlclose(other.library), 0);  // its session's thread lives on
  EXPECT_EQ(Loaded(ROOMRADAR_LIBRARY).use(), expected);
}

}  // namespace
}  // namespace roomradar::threads_test
