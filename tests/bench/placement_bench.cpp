// placement_bench.cpp: objects that are dropped in view or placed inside surfaces, and where they end.
//
// usage: placement_bench --maps FOLDER [--drops N] [--places N] [--only WORD] [--pictures FOLDER] [--json
// FILE]
//        Maps are scanned once and kept in FOLDER. N: per simulated room. WORD: part of a row's name.
//        --pictures: the last picture of each drop that failed.
//
//   drops   default drops of a teapot of 2 to 60 cm: kitchen's every tenth frame, and random views of four
//           simulated rooms. Each view is held until the teapot is asleep, at most 10 s.
//     stayed  asleep within 10 cm, horizontally, of the place where it was dropped
//     refused no place was found; reasons are counted
//     left    fell out of the map
//   near    the same, dropped near a random point of the surfaces in view
//   places  teapots of 5 to 30 cm, placed at random depths inside the surfaces in view, held for 1 s
//     out     touches no surface after 0.5 s
//     refused the call said why
//     silent  still overlaps a surface, and nothing was said
//
// Settings are those of `run`: changing them breaks the comparison with earlier results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/cli/open_source.hpp"
#include "app/media/picture_file.hpp"
#include "app/session/session.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/exact/ray_hit.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/support/recordings.hpp"
#include "where_bench_rooms.hpp"

namespace roomradar {
namespace {

using Eigen::Vector3d;

struct Settings {
  std::filesystem::path maps, pictures;
  std::size_t drops = 38, places = 200;
  std::string only, json;
};

/// A room to try in: its map, and frames with recorded poses.
struct Stage {
  std::string name;
  SavedMap map;
  std::vector<Frame> views;
  PoseOrigin poses = PoseOrigin::kRecorded;
};

Stage kitchen_stage(const Settings& settings) {
  const std::string kitchen = test::recording("kitchen").value_or("kitchen").string();
  Stage stage{
      "kitchen",
      map_of(*open_source(kitchen, FrameRange{0, 499}), PoseOrigin::kTracked, settings.maps / "kitchen"),
      {},
      PoseOrigin::kTracked};
  const auto source = open_source(kitchen, FrameRange{0, 499});
  for (Frame frame; source->next(frame).status == ReadStatus::kFrame;)
    if (frame.index % 10 == 0) stage.views.push_back(frame);
  return stage;
}

Stage room_stage(const std::string& name, const std::string& kind, std::uint64_t seed, std::size_t views,
                 const Settings& settings) {
  const SimOptions scan = scan_of(kind, seed);
  SimulatedSource source(scan);
  Stage stage{name, map_of(source, PoseOrigin::kTracked, settings.maps / name), {}};
  std::int64_t index = 0;
  for (const Eigen::Isometry3d& T_room_camera :
       draw_free_views(source.room(), stage.map, poses_of(scan), views, 1)) {
    stage.views.emplace_back();
    source.look(5 * index++, T_room_camera, stage.views.back());
  }
  return stage;
}

/// Shows one frame for as long as wanted, at 30 frames per second.
class HeldView {
 public:
  explicit HeldView(Session& session) : session_(session) {}
  void show(const Frame& frame) { frame_ = frame; }
  FrameResult step() {
    frame_.index = ++count_;
    frame_.stamp_s = static_cast<double>(count_) / 30.0;
    return session_.step(frame_, times_);
  }

 private:
  Session& session_;
  Frame frame_;
  std::int64_t count_ = 0;
  StageTimes times_;
};

double log_uniform(CounterRandom& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

double overlap_m(const Session& session, const VirtualObject& object, CyberRadar& radar) {
  double deepest_m = 0.0;
  for (const SceneTree& surface : session.scene_without(&object)) {
    if (surface.kind != SurfaceKind::kStatic) continue;
    std::vector<ClosestPoint> unused;
    const RadarScene scene{{&surface, 1}, {}};
    const TreeInstance instance{&object.model->shape.touched, object.body.T_world_object};
    if (near_features(instance, scene, 1e-6, 0, unused) == 0) continue;
    const Contact contact = radar.query({instance, -Vector3d::UnitZ(), 0.01}, scene);
    deepest_m =
        std::max(deepest_m, contact.status == ContactStatus::kOverlap ? -contact.contact_distance_m : 1e-3);
  }
  return deepest_m;
}

/// Returns a random measured surface point of the frame, in the world, and its outward normal.
std::optional<MeshHit> random_surface(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                                      const Session& session, CounterRandom& random) {
  const Ray ray =
      ray_through(frame.depth_camera, T_world_camera, random.uniform() * (frame.depth_camera.width_px - 1),
                  random.uniform() * (frame.depth_camera.height_px - 1));
  for (const SceneTree& surface : session.scene_without(nullptr))
    if (surface.kind == SurfaceKind::kStatic) return hit_mesh(surface.instance, ray, 5.0);
  return std::nullopt;
}

enum class DropWhere { kInView, kNearPoint };

nlohmann::json drop_row(const Stage& stage, DropWhere where, const Settings& settings) {
  SessionConfig config;
  config.poses = stage.poses;
  config.make_picture = !settings.pictures.empty();
  Session session(stage.map, config);
  StageTimes times;
  session.make_unknown_solid(times);
  HeldView view(session);
  int dropped = 0, stayed = 0, left = 0, lost = 0;
  std::map<std::string, int> refused;
  nlohmann::json failed = nlohmann::json::array();
  std::vector<double> moved_mm;
  for (std::size_t i = 0; i < stage.views.size(); ++i) {
    CounterRandom random(hash_of(0x64726f70, i), 0);
    const double size_m = log_uniform(random, 0.02, 0.60);
    const std::string name = "t" + std::to_string(i);
    session.add_object(name, object_mesh("teapot", size_m));
    const VirtualObject& object = *session.objects().back();
    view.show(stage.views[i]);
    DropRequest drop{.name = name};
    if (where == DropWhere::kNearPoint) {
      const FrameResult located = view.step();
      const auto hit = located.status == FrameStatus::kDone
                           ? random_surface(stage.views[i], located.T_world_camera, session, random)
                           : std::nullopt;
      if (hit) drop.near_world = hit->point_world;
    }
    session.drop(drop);
    std::optional<Vector3d> from_world;
    bool has_left = false, was_located = false;
    std::string why_not;
    for (int step = 0; step < 300; ++step) {
      const FrameResult result = view.step();
      was_located = was_located || result.status == FrameStatus::kDone;
      if (!from_world && !result.notices.empty()) why_not = result.notices.back().text;
      if (!from_world && object.in_room) from_world = object.body.T_world_object * object.model->middle;
      if (!from_world && step == 15) break;
      has_left = has_left || !result.departures.empty();
      if (has_left || (object.in_room && object.body.asleep)) break;
    }
    const Vector3d middle = object.body.T_world_object * object.model->middle;
    const double moved_m = from_world ? (middle - *from_world).head<2>().norm() : 0.0;
    const bool has_stayed = from_world && !has_left && object.body.asleep && moved_m < 0.10;
    if (!was_located)
      ++lost;
    else if (!from_world)
      ++refused[why_not];
    else
      ++dropped, stayed += has_stayed, left += has_left, moved_mm.push_back(1e3 * moved_m);
    if (from_world && !has_stayed) {
      failed.push_back({{"view", i},
                        {"size_m", size_m},
                        {"moved_m", moved_m},
                        {"left", has_left},
                        {"began_in_unknown", object.placement.began_in_unknown},
                        {"asleep", object.body.asleep},
                        {"from", {from_world->x(), from_world->y(), from_world->z()}},
                        {"to", {middle.x(), middle.y(), middle.z()}},
                        {"rests_on", to_string(object.body.rests_on)}});
      if (!settings.pictures.empty()) {
        std::filesystem::create_directories(settings.pictures);
        write_png(session.picture(), settings.pictures / (stage.name + "-" + std::to_string(i) + ".png"));
      }
    }
    session.remove(name);
  }
  std::sort(moved_mm.begin(), moved_mm.end());
  return {{"row", stage.name + (where == DropWhere::kInView ? "-drops" : "-near")},
          {"views", stage.views.size()},
          {"not_located", lost},
          {"dropped", dropped},
          {"stayed", stayed},
          {"left", left},
          {"moved_median_mm", moved_mm.empty() ? 0.0 : moved_mm[moved_mm.size() / 2]},
          {"refused", refused},
          {"failed", failed}};
}

nlohmann::json place_row(const Stage& stage, const Settings& settings) {
  SessionConfig config;
  config.poses = stage.poses;
  config.make_picture = false;
  Session session(stage.map, config);
  StageTimes times;
  session.make_unknown_solid(times);
  HeldView view(session);
  CyberRadar radar;
  int placed = 0, free_at_once = 0, out = 0, silent = 0, named = 0;
  std::map<std::string, int> refused;
  nlohmann::json failed = nlohmann::json::array();
  for (std::uint64_t draw = 0; placed < static_cast<int>(settings.places) && draw < 20 * settings.places;
       ++draw) {
    const Frame& frame = stage.views[draw % stage.views.size()];
    CounterRandom random(hash_of(0x706c6163, draw), 0);
    view.show(frame);
    const FrameResult located = view.step();
    if (located.status != FrameStatus::kDone) continue;
    const auto hit = random_surface(frame, located.T_world_camera, session, random);
    if (!hit) continue;
    const double size_m = log_uniform(random, 0.05, 0.30);
    const std::string name = "t" + std::to_string(draw);
    session.add_object(name, object_mesh("teapot", size_m));
    const VirtualObject& object = *session.objects().back();
    // Its middle from half its radius outside the surface to 5 cm inside.
    const double depth_m = random.uniform(-0.5 * radius_m(object), 0.05);
    const Vector3d middle_world = hit->point_world - depth_m * hit->normal_world;
    ++placed;
    try {
      session.place(name, {.position_world = middle_world - object.model->middle});
    } catch (const Error& error) {
      ++refused[std::string(error.what()).substr(0, 40)];
      session.remove(name);
      continue;
    }
    if ((object.body.T_world_object * object.model->middle - middle_world).norm() < 1e-9 &&
        overlap_m(session, object, radar) == 0.0)
      ++free_at_once;
    for (int step = 0; step < 15; ++step) static_cast<void>(view.step());
    const double deep_m = object.in_room ? overlap_m(session, object, radar) : 0.0;
    if (deep_m <= 1.5e-3) {
      ++out;
    } else {
      ++silent;
      failed.push_back({{"draw", draw},
                        {"size_m", size_m},
                        {"depth_m", depth_m},
                        {"overlap_m", deep_m},
                        {"asleep", object.body.asleep},
                        {"normal_z", hit->normal_world.z()}});
    }
    session.remove(name);
  }
  return {{"row", stage.name + "-places"},
          {"placed", placed},
          {"free_at_once", free_at_once},
          {"out", out},
          {"refused", refused},
          {"named", named},
          {"silent", silent},
          {"failed", failed}};
}

Settings parse(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i], value = argv[i + 1];
    if (word == "--maps") settings.maps = value;
    if (word == "--drops") settings.drops = static_cast<std::size_t>(std::atoll(value.c_str()));
    if (word == "--places") settings.places = static_cast<std::size_t>(std::atoll(value.c_str()));
    if (word == "--only") settings.only = value;
    if (word == "--pictures") settings.pictures = value;
    if (word == "--json") settings.json = value;
  }
  if (settings.maps.empty()) throw Error("--maps FOLDER is needed: the maps are kept there");
  return settings;
}

int bench(const Settings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  const auto try_in = [&](const std::string& name, const auto& stage_of) {
    const bool drops = (name + "-drops").find(settings.only) != std::string::npos;
    const bool near = (name + "-near").find(settings.only) != std::string::npos;
    const bool places = (name + "-places").find(settings.only) != std::string::npos;
    if (!drops && !near && !places) return;
    const Stage stage = stage_of();
    const auto add = [&](const nlohmann::json& row) {
      rows.push_back(row);
      std::printf("%s\n", row.dump().c_str());
      std::fflush(stdout);
    };
    if (drops) add(drop_row(stage, DropWhere::kInView, settings));
    if (near) add(drop_row(stage, DropWhere::kNearPoint, settings));
    if (places) add(place_row(stage, settings));
  };
  try_in("kitchen", [&] { return kitchen_stage(settings); });
  const struct {
    const char* name;
    const char* kind;
    std::uint64_t seed;
  } rooms[] = {
      {"table", "table", 1}, {"shelf", "shelf", 1}, {"random2", "random", 2}, {"random3", "random", 3}};
  for (const auto& room : rooms)
    try_in(room.name, [&] { return room_stage(room.name, room.kind, room.seed, settings.drops, settings); });
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("placement_bench",
                                     [&] { return roomradar::bench(roomradar::parse(argc, argv)); });
}
