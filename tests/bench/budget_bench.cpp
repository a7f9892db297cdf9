// budget_bench.cpp: checks whether the frame budget is kept when a person fills the view and 50 objects
// appear at once, and measures the cost in accuracy.
//
// usage: budget_bench [--budget MS]... [--presets FILE] [--map DIR] [--frames N] [--objects N]
//                     [--clock thread|wall] [--unknown free|solid] [--each-step 1] [--json FILE]
// Scene: a simulated dining room, hand-held camera, N frames (1,000). The first quarter shows the room as
// scanned. In the next half a person stands and walks close in front of the camera, and 50 teapots fall at
// once. In the last quarter both are gone. The scan has a hole in the floor, the shadow of a chair, and some
// teapots fall over it. Objects below the floor are therefore counted by whether the floor is mapped where
// they fell. Rows: one without a budget, and one per budget (33, 16). With --each-step 1 also rows for each
// step of the presets' Pareto front, without a budget and alternating with the default, with the ratios to
// the default that the presets store. --clock thread: CPU time of this thread, which then also runs OpenGL
// (for busy machines); wall: wall-clock time. Scene, seeds and frames are fixed: changing them breaks the
// comparison with earlier results. The map is made once and kept in DIR (budget-bench-map).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "app/quality/quality_json.hpp"
#include "app/run/run_budget.hpp"
#include "app/session/apply_quality.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/session.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/error.hpp"
#include "radar/exact/ray_hit.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar {
namespace {

constexpr int kScene = 15;  // frames of each part, shown forwards and backwards
constexpr int kWarmUp = 10;

struct Settings {
  std::vector<double> budgets_ms;
  std::filesystem::path presets, map = "budget-bench-map";
  int frames = 1000, objects = 50;
  bool is_wall = false, each_step = false, unknown_is_solid = false;
  std::string json;
};

std::optional<Settings> read_arguments(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 == argc) return std::nullopt;
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--budget")
      settings.budgets_ms.push_back(std::strtod(value.c_str(), nullptr));
    else if (key == "--presets")
      settings.presets = value;
    else if (key == "--map")
      settings.map = value;
    else if (key == "--frames")
      settings.frames = std::max(40, std::atoi(value.c_str()));
    else if (key == "--objects")
      settings.objects = std::clamp(std::atoi(value.c_str()), 1, 200);
    else if (key == "--clock")
      settings.is_wall = value == "wall";
    else if (key == "--unknown" && (value == "free" || value == "solid"))
      settings.unknown_is_solid = value == "solid";
    else if (key == "--each-step")
      settings.each_step = value == "1";
    else if (key == "--json")
      settings.json = value;
    else
      return std::nullopt;
  }
  if (settings.budgets_ms.empty()) settings.budgets_ms = {33.0, 16.0};
  return settings;
}

SavedMap map_of(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) {
    std::fprintf(stderr, "%s: scanning\n", folder.c_str());
    SimulatedSource source(parse_sim_spec("sim:table?seed=1&frames=360&rate=15"));
    StageTimes times;
    save_map(folder, prescan(source, {}, times).map);
  }
  return load_map(folder);
}

/// Frames without and with the person, from the same poses.
struct Views {
  std::vector<Frame> calm, crowded;
};

/// Returns the frame, within the first minute, in which the person covers most of the view.
std::int64_t most_crowded(const Eigen::Isometry3d& T_world_camera) {
  constexpr std::int64_t kEvery = 10, kFrames = 1800;
  SimulatedSource source(parse_sim_spec(
      "sim:table?seed=7&frames=2000&path=view&moving=person&pace=slow&width=64&colour=none&noise=0"));
  std::int64_t best = 0, best_px = 0;
  Frame frame;
  for (std::int64_t index = 0; index < kFrames; index += kEvery) {
    source.look(index, T_world_camera, frame);
    const MaskImage& moved = source.truth().moved;
    const std::int64_t px = std::count(moved.pixels.begin(), moved.pixels.end(), 255);
    if (px <= best_px) continue;
    best = index;
    best_px = px;
  }
  return best;
}

Views make_views() {
  // The person's path is along x at y = 1.75; from 0.9 m beside it a body covers a third of the image.
  const auto pose = [](double sway) {
    return test::looking_at({-0.9 + 0.02 * sway, 0.9, 1.4 + 0.01 * sway}, {0.4, 1.6, 0.7});
  };
  SimulatedSource calm(parse_sim_spec("sim:table?seed=7&frames=2000&path=view"));
  SimulatedSource crowded(parse_sim_spec("sim:table?seed=7&frames=2000&path=view&moving=person&pace=slow"));
  const std::int64_t first = most_crowded(pose(0.0)) - kScene / 2;
  Views views;
  for (int i = 0; i < kScene; ++i) {
    const Eigen::Isometry3d T_world_camera = pose(std::sin(2.0 * std::numbers::pi * i / kScene));
    calm.look(i, T_world_camera, views.calm.emplace_back());
    crowded.look(std::max<std::int64_t>(first, 0) + i, T_world_camera, views.crowded.emplace_back());
  }
  return views;
}

enum Phase { kBefore, kDuring, kAfter };

struct Outcome {
  std::array<test::Times, 3> frame_ms;
  std::array<test::Times, kFrameParts> part_ms;  ///< under load
  test::Times pose_error_m;
  std::vector<Eigen::Vector3d> at_m;  ///< positions of the objects at the end of the load
  double deepest_m = 0.0, dynamic_fraction = 0.0;
  int through_floor = 0, through_holes = 0;  ///< objects below the floor at the end of the load
  int located = 0;
  nlohmann::json budget;
};

void drop_objects(Session& session, const Eigen::Isometry3d& T_map_room, int count) {
  for (int i = 0; i < count; ++i) {
    DropObject drop{.name = "pot" + std::to_string(i)};
    // On the floor where the person walks, ten per row.
    drop.position_world =
        T_map_room * Eigen::Vector3d(-0.5 + 0.19 * (i % 10), 1.5 + 0.12 * (i / 10 % 5), 0.2 * (i / 50));
    drop.height_m = 0.3 + 0.02 * (i % 7);
    apply(session, {drop});
  }
}

void remove_objects(Session& session) {
  for (const auto& object : session.objects()) apply(session, {RemoveObject{object->body.name}});
}

/// Returns true if the floor above or below an object's centre is mapped.
bool is_by_mapped_floor(const Session& session, const Eigen::Vector3d& middle_world, double floor_world_m) {
  constexpr double kAbout_m = 0.05;
  const Eigen::Vector3d above(middle_world.x(), middle_world.y(), floor_world_m + kAbout_m);
  return hit_mesh({&session.room().touched, Eigen::Isometry3d::Identity()},
                  {above, -Eigen::Vector3d::UnitZ()}, 2.0 * kAbout_m)
      .has_value();
}

/// Counts objects below the floor by whether the floor is mapped where they last were above it.
class FloorJudge {
 public:
  explicit FloorJudge(const Eigen::Isometry3d& T_map_room)
      : T_room_map_(T_map_room.inverse()), floor_world_m_(T_map_room.translation().z()) {}

  void watch(const Session& session) {
    last_above_world_.resize(session.objects().size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < last_above_world_.size(); ++i)
      if (!is_below(*session.objects()[i])) last_above_world_[i] = middle_world(*session.objects()[i]);
  }
  void count(const Session& session, Outcome& outcome) const {
    for (std::size_t i = 0; i < last_above_world_.size(); ++i)
      if (is_below(*session.objects()[i]))
        ++(is_by_mapped_floor(session, last_above_world_[i], floor_world_m_) ? outcome.through_floor
                                                                             : outcome.through_holes);
  }

 private:
  static Eigen::Vector3d middle_world(const VirtualObject& object) {
    return object.body.T_world_object * object.model->middle;
  }
  [[nodiscard]] bool is_below(const VirtualObject& object) const {
    constexpr double kFallen_m = 0.05;  // solid unknown space begins some cells below the surrounding floor
    return (T_room_map_ * middle_world(object)).z() < -kFallen_m;
  }

  Eigen::Isometry3d T_room_map_;
  double floor_world_m_;
  std::vector<Eigen::Vector3d> last_above_world_;
};

/// Returns true if the frame includes this part. If pictures are not made in every frame, objects move only
/// in frames without a new picture.
bool is_made(FramePart part, const RunQuality& quality, const FrameResult& result) {
  if (part == FramePart::kCompose) return result.picture_is_new;
  return part != FramePart::kPhysics || quality.picture_every_n_frames == 1 || !result.picture_is_new;
}

/// @param budget  null: no budget
Outcome play(const Settings& settings, const SavedMap& map, const Views& views, const RunQuality& quality,
             RunBudget* budget, const std::function<double()>& now_ms) {
  SessionConfig config;
  apply(quality, config);
  config.measure_penetration = true;
  std::array<double, kFrameParts + 1> begun_ms{};
  config.watch = [&](FramePart part, const FrameLoad& load) -> std::optional<RunQuality> {
    begun_ms[index_of(part)] = now_ms();
    return budget != nullptr ? budget->before(part, load) : std::nullopt;
  };
  Session session(map, config);
  for (int i = 0; i < settings.objects; ++i)
    session.add_object("pot" + std::to_string(i), object_mesh("teapot", 0.08));

  Outcome outcome;
  StageTimes times;
  if (settings.unknown_is_solid) session.make_unknown_solid(times);
  FloorJudge judge(map.info.T_world_recorded);
  for (int number = 0; number < settings.frames; ++number) {
    const int quarter = 4 * number / settings.frames;
    const Phase phase = quarter == 0 ? kBefore : quarter == 3 ? kAfter : kDuring;
    const int shown = number % (2 * kScene);
    const std::size_t view = static_cast<std::size_t>(shown < kScene ? shown : 2 * kScene - 1 - shown);
    Frame frame = (phase == kDuring ? views.crowded : views.calm)[view];
    frame.index = number;
    frame.stamp_s = number / 30.0;
    if (number == settings.frames / 4) drop_objects(session, map.info.T_world_recorded, settings.objects);
    if (number == settings.frames - settings.frames / 4) {
      judge.count(session, outcome);
      for (const auto& object : session.objects())
        outcome.at_m.push_back(object->body.T_world_object.translation());
      remove_objects(session);
    }
    const FrameResult result = session.step(frame, times);
    if (phase == kDuring) judge.watch(session);
    if (budget != nullptr) static_cast<void>(budget->end_frame());
    if (number < kWarmUp) continue;
    outcome.frame_ms[phase].samples_ms.push_back(begun_ms[kFrameParts] - begun_ms[0]);
    if (result.status != FrameStatus::kDone) continue;
    ++outcome.located;
    outcome.deepest_m = std::max(outcome.deepest_m, result.deepest_penetration_m);
    const Eigen::Isometry3d T_true_found =
        (map.info.T_world_recorded * *frame.T_world_camera).inverse() * result.T_world_camera;
    outcome.pose_error_m.samples_ms.push_back(T_true_found.translation().norm());
    if (phase != kDuring) continue;
    for (std::size_t part = 0; part < kFrameParts; ++part)
      if (is_made(static_cast<FramePart>(part), quality, result))
        outcome.part_ms[part].samples_ms.push_back(begun_ms[part + 1] - begun_ms[part]);
    outcome.dynamic_fraction =
        std::max(outcome.dynamic_fraction,
                 static_cast<double>(result.foreground.moved) / static_cast<double>(result.foreground.valid));
  }
  if (budget != nullptr) outcome.budget = budget->report();
  return outcome;
}

nlohmann::json row_of(const std::string& name, Outcome& outcome, const Outcome* reference) {
  nlohmann::json row = {{"name", name},
                        {"located", outcome.located},
                        {"moved_fraction", outcome.dynamic_fraction},
                        {"through_floor", outcome.through_floor},
                        {"through_holes", outcome.through_holes},
                        {"deepest_penetration_m", outcome.deepest_m},
                        {"pose_error_median_m", outcome.pose_error_m.percentile(0.5)},
                        {"pose_error_p95_m", outcome.pose_error_m.percentile(0.95)},
                        {"budget", outcome.budget}};
  constexpr std::array<const char*, 3> kPhases = {"before", "during", "after"};
  for (std::size_t phase = 0; phase < 3; ++phase)
    row[kPhases[phase]] = {{"median_ms", outcome.frame_ms[phase].percentile(0.5)},
                           {"p95_ms", outcome.frame_ms[phase].percentile(0.95)},
                           {"p99_ms", outcome.frame_ms[phase].percentile(0.99)}};
  test::Times all;
  for (const test::Times& phase : outcome.frame_ms)
    all.samples_ms.insert(all.samples_ms.end(), phase.samples_ms.begin(), phase.samples_ms.end());
  row["all"] = {
      {"median_ms", all.percentile(0.5)}, {"p95_ms", all.percentile(0.95)}, {"p99_ms", all.percentile(0.99)}};
  for (std::size_t part = 0; part < kFrameParts; ++part)
    row["parts_during"][std::string(to_string(static_cast<FramePart>(part)))] = {
        {"median_ms", outcome.part_ms[part].percentile(0.5)},
        {"p95_ms", outcome.part_ms[part].percentile(0.95)}};
  if (reference != nullptr) {
    test::Times apart_m;
    for (std::size_t i = 0; i < outcome.at_m.size(); ++i)
      apart_m.samples_ms.push_back((outcome.at_m[i] - reference->at_m[i]).norm());
    row["objects_apart_median_m"] = apart_m.percentile(0.5);
  }
  return row;
}

// Ratios of the frame and part times under load to those of another run.
nlohmann::json ratios_of(Outcome& outcome, Outcome& other) {
  const auto ratio = [](test::Times& times, test::Times& to, double fraction) {
    return std::round(1e3 * times.percentile(fraction) / to.percentile(fraction)) / 1e3;
  };
  test::Times &frames = outcome.frame_ms[1], &to = other.frame_ms[1];
  nlohmann::json row = {{"frame_ratio", std::round(1e3 * frames.mean() / to.mean()) / 1e3},
                        {"frame_p95_ratio", ratio(frames, to, 0.95)}};
  for (std::size_t part = 0; part < kFrameParts; ++part)
    row["part_ratios"][std::string(to_string(static_cast<FramePart>(part)))] =
        ratio(outcome.part_ms[part], other.part_ms[part], 0.5);
  return row;
}

void print_row(const nlohmann::json& row) {
  const auto ms = [&](const char* phase, const char* key) { return row[phase][key].get<double>(); };
  const auto part = [&](const char* name) { return row["parts_during"][name]["median_ms"].get<double>(); };
  std::printf(
      "%-12s | %6.1f %6.1f %6.1f | %6.1f %6.1f %6.1f | %6.1f %6.1f %6.1f | %6.1f %6.1f | %5.1f %5.1f %5.1f "
      "%5.1f | %5.1f %5.1f %5.1f %5d %5d %4d %5.0f%%\n",
      row["name"].get<std::string>().c_str(), ms("before", "median_ms"), ms("before", "p95_ms"),
      ms("before", "p99_ms"), ms("during", "median_ms"), ms("during", "p95_ms"), ms("during", "p99_ms"),
      ms("after", "median_ms"), ms("after", "p95_ms"), ms("after", "p99_ms"), ms("all", "p95_ms"),
      ms("all", "p99_ms"), part("locate"), part("mesh"), part("physics"), part("compose"),
      1e3 * row["pose_error_median_m"].get<double>(), 1e3 * row["deepest_penetration_m"].get<double>(),
      1e3 * row.value("objects_apart_median_m", 0.0), row["through_floor"].get<int>(),
      row["through_holes"].get<int>(), row["located"].get<int>(),
      100.0 * row["moved_fraction"].get<double>());
  if (!row["budget"].is_null()) {
    std::printf("%12s   %d frames over, %d changes; frames at each step:", "",
                row["budget"]["frames_over"].get<int>(), row["budget"]["changes"].get<int>());
    for (const auto& setting : row["budget"]["settings"])
      std::printf(" %d:%d", setting["step"].get<int>(), setting["frames"].get<int>());
    std::printf(" of %d steps\n", row["budget"]["steps"].get<int>());
  }
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  const std::optional<Settings> asked = read_arguments(argc, argv);
  if (!asked) {
    std::fprintf(
        stderr,
        "usage: budget_bench [--budget MS]... [--presets FILE] [--map DIR] [--frames N] [--objects N] "
        "[--clock thread|wall] [--unknown free|solid] [--each-step 1] [--json FILE]\n");
    return 2;
  }
  const Settings& settings = *asked;
  if (!settings.is_wall) setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe then works on this thread
  const std::function<double()> now_ms = settings.is_wall ? steady_ms : test::thread_ms;
  const Presets presets =
      read_presets(settings.presets.empty() ? std::filesystem::path(ROOMRADAR_PRESETS) : settings.presets);
  const SavedMap map = map_of(settings.map);
  const Views views = make_views();
  std::printf("compiler %s, flags %s, clock %s\n", __VERSION__, ROOMRADAR_FLAGS,
              settings.is_wall ? "wall" : "thread");
  std::printf(
      "frame ms (median, p95, p99) before, during and after the load; p95, p99 of all; parts during, median; "
      "pose error mm "
      "median, deepest overlap mm, objects' mm from where they are without a budget, objects that went "
      "through the mapped floor and through its holes, frames "
      "located, most of the image moved\n"
      "             |         before       |        during        |         after        |      all      | "
      "locat  mesh  phys  comp |  pose  deep apart floor holes  loc moved\n");
  nlohmann::json rows = nlohmann::json::array();
  Outcome defaults = play(settings, map, views, {}, nullptr, now_ms);
  const auto add = [&](const std::string& name, Outcome& outcome) {
    rows.push_back(row_of(name, outcome, &defaults));
    print_row(rows.back());
  };
  add("no budget", defaults);
  if (settings.each_step) {
    for (std::size_t step = 0; step < presets.front.size(); ++step) {
      Outcome beside = play(settings, map, views, {}, nullptr, now_ms);
      Outcome outcome = play(settings, map, views, presets.front[step].run, nullptr, now_ms);
      add("step " + std::to_string(step), outcome);
      rows.back()["ratios"] = ratios_of(outcome, beside);
      std::printf("%12s   to the default beside it: %s\n", "", rows.back()["ratios"].dump().c_str());
      std::fflush(stdout);
    }
  } else {
    for (const double budget_ms : settings.budgets_ms) {
      RunBudget budget(front_for(presets, {}, {}), budget_ms, /*has_picture=*/true, now_ms);
      Outcome outcome = play(settings, map, views, {}, &budget, now_ms);
      add("budget " + std::to_string(static_cast<int>(budget_ms)), outcome);
    }
  }
  test::write_rows(settings.json, rows);
  return 0;
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  return roomradar::test::run_or_say("budget_bench", [&] { return roomradar::run(argc, argv); });
}
