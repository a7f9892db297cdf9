// run_summary.cpp: prints the lines of the summary, the most important first.
#include "app/run/run_summary.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/objects/unknown_support.hpp"
#include "app/run/opened_run.hpp"

namespace roomradar {
namespace {

/// Returns a note on an object placed in unknown space, where it can move freely until it leaves.
const char* note_on(const VirtualObject& object) {
  if (!object.placement.began_in_unknown) return "";
  return object.placement.in_unknown ? "; was placed in unknown space and is still partly inside"
                                     : "; was placed in unknown space and has left it";
}

/// Prints the frame rate, the time per frame, and the stage that takes most of it.
void print_times(const OpenedRun& run) {
  const std::map<std::string, StageSummary> stages = run.report.times.summaries();
  const auto frame = stages.find("frame");
  const std::int64_t frames = run.totals.read - run.totals.skipped;
  const double wall_s = run.report.seconds();
  std::printf("%lld %s in %.1f s, %.1f per second", static_cast<long long>(frames),
              frames == 1 ? "frame" : "frames", wall_s,
              wall_s > 0.0 ? static_cast<double>(frames) / wall_s : 0.0);
  if (frame != stages.end()) {
    // `frame` is the sum of a frame's stages, `contact` that of the stages until contact, `read` is the
    // source's and `unknown` is computed once.
    const auto dearest = std::max_element(stages.begin(), stages.end(), [&](const auto& a, const auto& b) {
      const auto cost = [&](const auto& stage) {
        const bool is_part = stage.first != "frame" && stage.first != "contact" && stage.first != "read" &&
                             stage.first != "unknown";
        return is_part ? static_cast<double>(stage.second.count) * stage.second.median_ms : -1.0;
      };
      return cost(a) < cost(b);
    });
    std::printf("; %.1f ms each (median), 95 %% within %.1f ms, most of it for \"%s\" (%.1f ms)",
                frame->second.median_ms, frame->second.p95_ms, dearest->first.c_str(),
                dearest->second.median_ms);
    const auto read = stages.find("read");
    if (read != stages.end() && read->second.median_ms > frame->second.median_ms)
      std::printf("; reading a frame took %.1f ms", read->second.median_ms);
  }
  std::printf("\n");
}

void print_located(const RunTotals& totals) {
  constexpr std::size_t kShown = 5;
  std::printf("camera located in %lld of %lld frames", static_cast<long long>(totals.located),
              static_cast<long long>(totals.read - totals.skipped));
  const std::vector<LostSpan>& spans = totals.lost.spans;
  for (std::size_t i = 0; i < std::min(spans.size(), kShown); ++i) {
    std::printf("%s%lld", i == 0 ? "; not in frames " : ", ", static_cast<long long>(spans[i].from));
    if (spans[i].until < 0)
      std::printf(" to the last");
    else if (spans[i].until > spans[i].from + 1)
      std::printf("-%lld", static_cast<long long>(spans[i].until - 1));
  }
  if (spans.size() > kShown) std::printf(" and %zu more spans", spans.size() - kShown);
  std::printf("\n");
  if (totals.uncertain > 0)
    std::printf(
        "in %lld of these the pose was uncertain: depth did not constrain all directions for more than 0.15 "
        "s. "
        "Objects stood still meanwhile\n",
        static_cast<long long>(totals.uncertain));
  if (totals.skipped > 0)
    std::printf("%lld frames could not be used; the last fault: %s\n", static_cast<long long>(totals.skipped),
                totals.last_fault.c_str());
}

void print_changes(const RunTotals& totals, const Session& session) {
  for (const CommittedChange& change : session.committed_changes()) {
    const Eigen::Vector3d p = change.box_world.center(), size = change.box_world.sizes();
    std::printf("change committed at %.1f s: an object that %s at %.2f %.2f %.2f m, %.2f x %.2f x %.2f m\n",
                change.stamp_s - totals.first_stamp_s,
                change.kind == LastingKind::kCame ? "appeared" : "vanished", p.x(), p.y(), p.z(), size.x(),
                size.y(), size.z());
  }
}

std::string why_not_in_room(const VirtualObject& object, const Session& session) {
  for (const WaitingDrop& waiting : session.waiting_drops())
    if (waiting.drop.name == object.body.name)
      return "; its drop waits: " + (waiting.why.empty() ? "no frame was located since" : waiting.why);
  return object.departures > 0 ? "; it fell out of the map" : "; " + std::string(object.why_not_in_room);
}

void print_object(const VirtualObject& object, const Session& session) {
  const Body& body = object.body;
  if (!object.in_room) {
    std::printf("%s: not in the room%s\n", body.name.c_str(), why_not_in_room(object, session).c_str());
    return;
  }
  const Eigen::Vector3d p = middle_world(object);  // its origin may be far outside
  std::string state = "moving";
  if (object.placement.stuck)
    state = "stuck in a surface";
  else if (body.asleep)
    state = "at rest" + std::string(support_words(body.rests_on));
  std::printf("%s: %s at %.3f %.3f %.3f m%s\n", body.name.c_str(), state.c_str(), p.x(), p.y(), p.z(),
              note_on(object));
}

void print_files(const OpenedRun& run) {
  const RunOptions& options = run.options;
  std::string files;
  const auto add =
      [&](const std::string& path) {  // a device, or a file that could not be written, is no result
        std::error_code unknown;
        const std::filesystem::file_status status = std::filesystem::status(path, unknown);
        if (std::filesystem::is_regular_file(status) || std::filesystem::is_directory(status))
          files += (files.empty() ? "" : ", ") + path;
      };
  add(run.nothing_dropped.empty() ? options.video : "");
  add(options.pictures.empty() ? "" : options.pictures + "/");
  add(options.record_session.empty() ? "" : options.record_session + "/");
  add(options.save_map.empty() ? "" : options.save_map + "/");
  add(options.frames_csv);
  add(options.trajectory);
  add(options.stream);
  add(options.report);
  if (!files.empty()) std::printf("written: %s\n", files.c_str());
}

}  // namespace

void print_summary(const OpenedRun& run) {
  const RunTotals& totals = run.totals;
  print_times(run);
  print_located(totals);
  if (run.options.verbose) {
    std::printf("%.2f %% of pixels dynamic, meshed as %.0f triangles per frame\n",
                100.0 * totals.per_frame(totals.dynamic_fraction),
                totals.per_frame(totals.dynamic_triangles));
    print_use(totals.use);
  }
  print_changes(totals, *run.session);
  print_objects(*run.session);
  print_files(run);
}

void print_objects(const Session& session) {
  for (const auto& object : session.objects()) print_object(*object, session);
}

}  // namespace roomradar
