// c_room.hpp: a small saved room and frames of it, for tests of the C API.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "app/c_api/conversions.hpp"
#include "app/c_api/roomradar.h"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test {

/// Fails with the library's sentence.
inline void expect_ok(roomradar_status status) {
  EXPECT_EQ(status, ROOMRADAR_OK) << roomradar_status_name(status) << ": " << roomradar_last_error();
}
inline void assert_ok(roomradar_status status) {
  if (status != ROOMRADAR_OK)
    throw std::runtime_error(std::string(roomradar_status_name(status)) + ": " + roomradar_last_error());
}

/// Returns a struct of zeros, with its size set.
template <typename Struct>
Struct sized() {
  Struct made{};
  made.struct_size = sizeof made;
  return made;
}

inline SimOptions view_of_table(const std::string& rest) {
  return parse_sim_spec("sim:table?path=view&rate=10&width=160&" + rest);
}

inline std::vector<Frame> frames_of(const SimOptions& options) {
  SimulatedSource source(options);
  std::vector<Frame> frames;
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) frames.push_back(frame);
  return frames;
}

/// The room `table`, scanned from a viewer's place with recorded poses, and saved.
struct CRoom {
  TemporaryFolder folder;
  std::string map_folder = (folder.path() / "map").string();

  CRoom() {
    SimulatedSource source(view_of_table("frames=30"));
    StageTimes times;
    PrescanConfig config;
    config.resolution_m = 0.02;
    config.poses = PoseOrigin::kRecorded;
    save_map(map_folder, prescan(source, config, times).map);
  }
  /// Returns the process's room.
  static const CRoom& get() {
    static const CRoom room;
    return room;
  }
};

/// Opens and closes handles.
struct OpenMap {
  roomradar_map* handle = nullptr;
  OpenMap() { assert_ok(roomradar_map_open(CRoom::get().map_folder.c_str(), &handle)); }
  ~OpenMap() { roomradar_map_close(handle); }
  OpenMap(const OpenMap&) = delete;
  OpenMap& operator=(const OpenMap&) = delete;
};

struct OpenSession {
  roomradar_session* handle = nullptr;
  explicit OpenSession(const roomradar_map* map, std::int32_t poses = ROOMRADAR_POSES_RECORDED,
                       bool watches_changes = false) {
    auto options = sized<roomradar_session_options>();
    options.poses = poses;
    options.watches_changes = watches_changes ? 1 : 0;
    assert_ok(roomradar_session_open(map, &options, &handle));
  }
  ~OpenSession() { roomradar_session_close(handle); }
  OpenSession(const OpenSession&) = delete;
  OpenSession& operator=(const OpenSession&) = delete;

  roomradar_frame_result step(const Frame& frame) const {
    auto given = sized<roomradar_frame>();
    c_api::write_frame(frame, given);
    auto result = sized<roomradar_frame_result>();
    assert_ok(roomradar_session_step(handle, &given, &result));
    return result;
  }
  [[nodiscard]] roomradar_object_state object(const char* name) const {
    roomradar_object_state state{};
    assert_ok(roomradar_session_object(handle, name, &state));
    return state;
  }
};

inline roomradar_pose pose_at(double x, double y, double z) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  return c_api::pose_of(T);
}

}  // namespace roomradar::test
