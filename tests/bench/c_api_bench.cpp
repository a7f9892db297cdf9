// c_api_bench.cpp: cost of the C API over the same calls in C++: radar queries alone and in batches, and
// frames of a session. Runs of C++ and C alternate; medians. Changing the settings breaks comparison with old
// figures.
//
// usage: c_api_bench MAP    MAP: of sim:table, such as by `prescan sim:table?frames=100&rate=10&width=320
// --poses recorded`
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "app/c_api/conversions.hpp"
#include "app/c_api/roomradar.h"
#include "app/objects/object_file.hpp"
#include "app/session/session.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kQueries = 10'000;
constexpr int kRuns = 15;

void require_ok(roomradar_status status) {
  if (status != ROOMRADAR_OK) throw Error(roomradar_last_error());
}

template <typename Struct>
Struct sized() {
  Struct made{};
  made.struct_size = sizeof made;
  return made;
}

/// Medians of two kinds of runs that alternate, and of their difference.
struct Compared {
  double cpp_ms = 0.0, c_ms = 0.0, more_ms = 0.0;
};
Compared compare(const std::function<double()>& cpp, const std::function<double()>& c) {
  std::vector<double> cpp_ms, c_ms, more_ms;
  static_cast<void>(cpp()), static_cast<void>(c());  // warm
  for (int run = 0; run < kRuns; ++run) {
    cpp_ms.push_back(cpp());
    c_ms.push_back(c());
    more_ms.push_back(c_ms.back() - cpp_ms.back());
  }
  return {test::quantile(cpp_ms, 0.5), test::quantile(c_ms, 0.5), test::quantile(more_ms, 0.5)};
}

/// Falls of a pot from random places onto the room.
std::vector<roomradar_query> falls() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<roomradar_query> queries(kQueries);
  for (roomradar_query& query : queries) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation() = Eigen::Vector3d(unit(random), unit(random), 1.2);
    query = {c_api::pose_of(T), {0.0, 0.0, -1.0}, 3.0, 0.0};
  }
  return queries;
}

void compare_queries(const SavedMap& saved, const roomradar_map* map) {
  TriangleTree room, pot;
  room.build_by_place(saved.mesh);
  const Mesh mesh = object_mesh("teapot");
  pot.build_by_place(mesh);
  const std::vector<SceneTree> scene{{{&room, Eigen::Isometry3d::Identity()}, SurfaceKind::kStatic}};
  roomradar_shape *c_room = nullptr, *c_pot = nullptr;
  roomradar_radar* radar = nullptr;
  auto given = sized<roomradar_mesh>();
  given.vertices_m = mesh.vertices.front().data();
  given.vertex_count = mesh.vertices.size();
  given.triangles = mesh.triangles.front().data();
  given.triangle_count = mesh.triangles.size();
  require_ok(roomradar_shape_open(&given, &c_pot));
  require_ok(roomradar_map_shape(map, &c_room));
  require_ok(roomradar_radar_open(nullptr, &radar));
  const roomradar_placed_shape placed{c_room, c_api::pose_of(Eigen::Isometry3d::Identity()),
                                      ROOMRADAR_SURFACE_STATIC};
  require_ok(roomradar_radar_set_scene(radar, &placed, 1));

  CyberRadar expected;
  const std::vector<roomradar_query> queries = falls();
  std::vector<RadarQuery> cpp_queries;
  for (const roomradar_query& query : queries)
    cpp_queries.push_back(
        {{&pot, c_api::unchecked_pose_of(query.T_world_object)}, -Eigen::Vector3d::UnitZ(), 3.0});
  std::vector<Contact> cpp_contacts(kQueries);
  std::vector<roomradar_contact> contacts(kQueries);
  const auto in_cpp = [&] {
    const double start_ms = test::thread_ms();
    for (std::size_t i = 0; i < kQueries; ++i) cpp_contacts[i] = expected.query(cpp_queries[i], {scene, {}});
    return test::thread_ms() - start_ms;
  };
  const Compared alone = compare(in_cpp, [&] {
    const double start_ms = test::thread_ms();
    for (std::size_t i = 0; i < kQueries; ++i)
      require_ok(roomradar_radar_query(radar, c_pot, &queries[i], &contacts[i]));
    return test::thread_ms() - start_ms;
  });
  const Compared batch = compare(in_cpp, [&] {
    const double start_ms = test::thread_ms();
    require_ok(roomradar_radar_query_many(radar, c_pot, queries.data(), kQueries, contacts.data()));
    return test::thread_ms() - start_ms;
  });
  std::size_t different = 0;
  for (std::size_t i = 0; i < kQueries; ++i)
    different += contacts[i].travel_m != cpp_contacts[i].contact_distance_m;
  const double per_query = 1e3 / static_cast<double>(kQueries);  // ms to us per query
  std::printf("radar query, alone: %.2f us in C++, %+.3f us through C\n", alone.cpp_ms * per_query,
              alone.more_ms * per_query);
  std::printf("batch of %zu: %.1f ms in C++, %+.2f %% through C; %zu answers differ\n", kQueries,
              batch.cpp_ms, 100.0 * batch.more_ms / batch.cpp_ms, different);
}

double wall_ms(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return ms_since(start);
}

/// Frames of 640 x 480 with colour. Those without a pose end before the engine's work: what is left is the
/// copy of the images and the change of threads.
void compare_frames(const SavedMap& saved, const roomradar_map* map) {
  std::vector<Frame> frames;
  SimulatedSource source(parse_sim_spec("sim:table?frames=10&path=view&moving=hand"));
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) frames.push_back(frame);
  SessionConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.make_picture = false;
  Session session(saved, config);
  auto options = sized<roomradar_session_options>();
  options.poses = ROOMRADAR_POSES_RECORDED;
  options.has_no_picture = 1;
  roomradar_session* c_session = nullptr;
  require_ok(roomradar_session_open(map, &options, &c_session));
  StageTimes times;
  for (const bool is_located : {false, true}) {
    std::vector<roomradar_frame> given;
    for (Frame& frame : frames) {
      if (!is_located) frame.T_world_camera.reset();
      given.push_back(sized<roomradar_frame>());
    }
    if (is_located) {
      source.rewind();
      for (Frame& frame : frames) static_cast<void>(source.next(frame));
    }
    for (std::size_t i = 0; i < frames.size(); ++i) c_api::write_frame(frames[i], given[i]);
    auto result = sized<roomradar_frame_result>();
    std::size_t next = 0;
    const auto in_cpp = [&] {
      return wall_ms([&] { static_cast<void>(session.step(frames[next], times)); });
    };
    const auto in_c = [&] {
      const double ms =
          wall_ms([&] { require_ok(roomradar_session_step(c_session, &given[next], &result)); });
      next = (next + 1) % frames.size();
      return ms;
    };
    Frame copy;
    const auto copied = [&] { return wall_ms([&] { c_api::read_frame(&given[next], copy); }); };
    std::vector<double> copies;
    for (int i = 0; i < kRuns; ++i) copies.push_back(copied());
    std::vector<double> cpp_ms, more_ms;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Compared compared = compare(in_cpp, in_c);
      cpp_ms.push_back(compared.cpp_ms);
      more_ms.push_back(compared.more_ms);
    }
    std::printf(
        "frame of 640 x 480, %s: %.3f ms in C++, %+.3f ms through C, of which %.3f ms copy the images\n",
        is_located ? "located" : "not located", test::quantile(cpp_ms, 0.5), test::quantile(more_ms, 0.5),
        test::quantile(copies, 0.5));
  }
  require_ok(roomradar_session_close(c_session));
}

int run(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: c_api_bench MAP\n");
    return 2;
  }
  std::printf("%s\n", test::processor().c_str());
  const SavedMap saved = load_map(argv[1]);
  roomradar_map* map = nullptr;
  require_ok(roomradar_map_open(argv[1], &map));
  compare_queries(saved, map);
  compare_frames(saved, map);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("c_api_bench", [&] { return roomradar::run(argc, argv); });
}
