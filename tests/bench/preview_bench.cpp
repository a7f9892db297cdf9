// preview_bench.cpp: distance of a scan's live model from the finished map after a loop closed, and its
// memory.
//
// usage: preview_bench [--unwatched] [--frames N] [--later S] [--json FILE] SOURCE...
// SOURCE: a folder or sim:ROOM?... A recording is played at the rate of its stamps, or as fast as it is
// tracked if that is slower. S seconds (1 by default) after a loop closed, the model of ScanView is kept.
// When the map is finished, the model is moved into the map's world by the camera's pose in that frame, and
// its vertices are measured against the map's surface. Loops that close meanwhile belong to the same row.
// --unwatched scans without a view, to compare the peak of resident memory while tracking.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/cli/report.hpp"
#include "app/scan/controlled_source.hpp"
#include "app/scan/scan_view.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "tests/bench/bench_program.hpp"
#include "tests/bench/bench_times.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

struct Settings {
  std::int64_t frames = 0;  ///< 0: all
  double later_s = 1.0;
  bool is_watched = true;
  std::string json;
  std::vector<std::string> sources;
};

double since_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The model that the window showed some time after a loop closed.
struct Kept {
  std::int64_t loop_frame = 0;
  double later_s = 0.0;
  ShownScan shown;
};

/// Plays frames at the rate of their stamps, passes them to the view, and keeps the view's models.
class Watch final : public ScanObserver {
 public:
  explicit Watch(const Settings& settings) : settings_(settings) {
    if (settings.is_watched) view_.emplace(channel_);
  }

  void after_frame(const Frame& frame, const Tracking& tracking, const Odometry& odometry,
                   const StageTimes& times) override {
    if (view_) view_->after_frame(frame, tracking, odometry, times);
    if (frames_++ == 0) first_stamp_s_ = frame.stamp_s;
    const double early_s = frame.stamp_s - first_stamp_s_ - since_s(begun_);
    if (early_s > 0.0 && early_s < 1.0) std::this_thread::sleep_for(std::chrono::duration<double>(early_s));
    if (const std::int64_t loops = odometry.state().graph.loops_found; loops != loops_) {
      loops_ = loops;
      if (!closed_) closed_ = {frame.index, Clock::now()};
    }
    if (closed_ && since_s(closed_->at) >= settings_.later_s && view_) keep();
    peak_mb_ = peak_rss_mb();
    if (settings_.frames > 0 && frames_ >= settings_.frames) channel_.request(ScanRequest::kFinish);
  }

  ScanChannel& channel() { return channel_; }
  /// Ends the view, as at the end of tracking.
  void end() { view_.reset(); }

  std::vector<Kept> kept;
  std::int64_t frames() const { return frames_; }
  double peak_while_tracking_mb() const { return peak_mb_; }
  double frames_per_s() const { return static_cast<double>(frames_) / since_s(begun_); }

 private:
  struct Closed {
    std::int64_t frame = 0;
    Clock::time_point at;
  };
  void keep() {
    Kept model{closed_->frame, since_s(closed_->at), {}};
    if (!channel_.take(model.shown)) return;
    kept.push_back(std::move(model));
    closed_.reset();
  }

  const Settings& settings_;
  ScanChannel channel_;
  std::optional<ScanView> view_;
  const Clock::time_point begun_ = Clock::now();
  double first_stamp_s_ = 0.0, peak_mb_ = 0.0;
  std::int64_t frames_ = 0, loops_ = 0;
  std::optional<Closed> closed_;
};

/// Prints a row per model kept, and adds it to `rows`.
void judge(const std::string& source, const Watch& watch, const PrescanResult& scanned,
           nlohmann::json& rows) {
  constexpr float kReach_m = 0.08F;
  const Mesh& surface = scanned.map.mesh;
  const MeshDistanceQuery query(surface, kReach_m);
  for (const Kept& model : watch.kept) {
    const auto pose =
        std::find_if(scanned.map.trajectory.begin(), scanned.map.trajectory.end(),
                     [&](const TimedPose& p) { return p.frame_index == model.shown.frame_index; });
    if (pose == scanned.map.trajectory.end()) continue;
    const Isometry3d T_map_shown = pose->T_world_camera * model.shown.T_world_camera.inverse();
    std::vector<double> distances_m;
    for (const ShownPart& part : model.shown.parts)
      for (const Vector3f& vertex : part.mesh->vertices) {
        const Vector3d p_map = T_map_shown * part.T_world_mesh * (part.mesh->origin + vertex.cast<double>());
        const float distance_m = query.distance_m((p_map - surface.origin).cast<float>());
        distances_m.push_back(static_cast<double>(std::min(distance_m, kReach_m)));
      }
    const double median_mm = 1e3 * test::quantile(distances_m, 0.5),
                 p95_mm = 1e3 * test::quantile(distances_m, 0.95);
    std::printf(
        "%s: loop at frame %lld, %.2f s later, frame %lld: %zu parts, %zu vertices, to the map median "
        "%.1f mm, p95 %.1f mm\n",
        source.c_str(), static_cast<long long>(model.loop_frame), model.later_s,
        static_cast<long long>(model.shown.frame_index), model.shown.parts.size(), distances_m.size(),
        median_mm, p95_mm);
    rows.push_back({{"source", source},
                    {"loop_frame", model.loop_frame},
                    {"later_s", model.later_s},
                    {"median_mm", median_mm},
                    {"p95_mm", p95_mm}});
  }
}

void scan(const std::string& name, const Settings& settings, nlohmann::json& rows) {
  Watch watch(settings);
  const std::unique_ptr<FrameSource> source = controlled(
      name.starts_with("sim:") ? std::make_unique<SimulatedSource>(parse_sim_spec(name)) : open_folder(name),
      watch.channel());
  StageTimes times;
  bool is_tracking = true;
  double frames_per_s = 0.0;
  const auto progress = [&](const std::string& stage, const std::string& /*note*/) {
    if (!is_tracking || stage.starts_with("track")) return;
    is_tracking = false;
    frames_per_s = watch.frames_per_s();
    watch.end();
  };
  const PrescanResult scanned = prescan(*source, {}, times, progress, {nullptr, std::nullopt, &watch});
  std::printf("%s: %lld frames, %.1f frames/s, peak while tracking %.0f MB%s\n", name.c_str(),
              static_cast<long long>(watch.frames()), frames_per_s, watch.peak_while_tracking_mb(),
              settings.is_watched ? "" : " (unwatched)");
  rows.push_back({{"source", name},
                  {"is_watched", settings.is_watched},
                  {"frames_per_s", frames_per_s},
                  {"peak_while_tracking_mb", watch.peak_while_tracking_mb()}});
  judge(name, watch, scanned, rows);
}

}  // namespace
}  // namespace roomradar

int main(int argc, char** argv) {
  using namespace roomradar;
  return test::run_or_say("preview_bench", [&] {
    Settings settings;
    for (int i = 1; i < argc; ++i) {
      const std::string option = argv[i];
      if (option == "--unwatched")
        settings.is_watched = false;
      else if (option.starts_with("--") && i + 1 == argc)
        throw Error(option + ": unknown, or needs a value");
      else if (option == "--frames")
        settings.frames = std::atoll(argv[++i]);
      else if (option == "--later")
        settings.later_s = std::atof(argv[++i]);
      else if (option == "--json")
        settings.json = argv[++i];
      else if (option.starts_with("--"))
        throw Error(option + ": unknown");
      else
        settings.sources.push_back(option);
    }
    if (settings.sources.empty()) throw Error("no SOURCE given");
    mmap_large_allocations();
    nlohmann::json rows = nlohmann::json::array();
    for (const std::string& source : settings.sources) scan(source, settings, rows);
    test::write_rows(settings.json, rows);
    return 0;
  });
}
