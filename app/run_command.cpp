// run_command.cpp: roomradar run: augmented reality in a saved room.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/open_source.hpp"
#include "app/picture_file.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/script.hpp"
#include "app/session.hpp"
#include "app/video_writer.hpp"
#include "mapping/map_folder.hpp"
#include "mapping/surface.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

constexpr double kVideoFramesPerS = 30.0;

/// Without a script, the object falls onto the best level surface that the camera sees.
Script drop_over_view(const std::string& object) {
  ScriptEvent add;
  add.frame = 0;
  add.action = Action::kAdd;
  add.name = "object";
  add.mesh = object;
  ScriptEvent drop;
  drop.frame = 0;
  drop.action = Action::kDrop;
  drop.name = add.name;
  return {{add, drop}};
}

/// Sums over the frames of a run, as the report wants them.
struct RunTotals {
  std::int64_t read = 0, skipped = 0, located = 0, degenerate = 0, contacts = 0;
  std::array<std::int64_t, kTouchedKinds> contacts_by_kind{};
  double moved_fraction = 0.0, dynamic_triangles = 0.0, inferred_triangles = 0.0, static_triangles = 0.0;
  double max_moved_fraction = 0.0;
  double deepest_penetration_m = 0.0;
  double first_stamp_s = 0.0;
  std::string last_fault;
  std::int64_t dropped = 0;  // by a live source, for newer ones
  std::optional<std::int64_t> first_index;

  /// Every frame that was read before, and those that were dropped, have a lower index.
  void count_dropped(std::int64_t index) {
    if (!first_index) first_index = index - (read - 1);
    dropped = std::max(dropped, index - *first_index - (read - 1));
  }

  void add(const FrameResult& frame) {
    if (frame.status != FrameStatus::kDone) return;
    ++located;
    if (frame.tracking == TrackStatus::kDegenerate) ++degenerate;
    contacts += frame.contacts;
    for (std::size_t kind = 0; kind < kTouchedKinds; ++kind)
      contacts_by_kind[kind] += frame.contacts_by_kind[kind];
    const double fraction = frame.foreground.valid > 0 ? static_cast<double>(frame.foreground.moved) /
                                                             static_cast<double>(frame.foreground.valid)
                                                       : 0.0;
    moved_fraction += fraction;
    max_moved_fraction = std::max(max_moved_fraction, fraction);
    dynamic_triangles += static_cast<double>(frame.dynamic_triangles);
    inferred_triangles += static_cast<double>(frame.inferred_triangles);
    static_triangles += static_cast<double>(frame.static_triangles_drawn);
    deepest_penetration_m = std::max(deepest_penetration_m, frame.deepest_penetration_m);
  }
  [[nodiscard]] double per_frame(double sum) const {
    return located > 0 ? sum / static_cast<double>(located) : 0.0;
  }
};

nlohmann::json results_of(const RunTotals& totals, const Session& session) {
  nlohmann::json objects = nlohmann::json::array();
  for (const auto& object : session.objects()) {
    const Eigen::Matrix3d R_world_object = object->body.T_world_object.linear();
    const Eigen::Quaterniond q(R_world_object);
    const double turned_deg = Eigen::AngleAxisd(object->R_world_put.transpose() * R_world_object).angle() *
                              (180.0 / std::numbers::pi);
    objects.push_back({{"name", object->body.name},
                       {"in_room", object->in_room},
                       {"at_rest", object->body.at_rest},
                       {"rests_on", to_string(object->body.rests_on)},
                       {"began_in_unknown", object->began_in_unknown},
                       {"position_m", to_json(object->body.T_world_object.translation())},
                       {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                       {"turned_deg", turned_deg}});
  }
  nlohmann::json adopted = nlohmann::json::array();
  for (const AdoptedChange& change : session.adopted())
    adopted.push_back({{"change", to_string(change.kind)},
                       {"time_s", change.stamp_s - totals.first_stamp_s},
                       {"frame", change.frame},
                       {"position_m", to_json(change.box_world.center())},
                       {"size_m", to_json(change.box_world.sizes())}});
  nlohmann::json contacts_by_kind = nlohmann::json::object();
  for (std::size_t kind = 1; kind < kTouchedKinds; ++kind)
    contacts_by_kind[std::string(to_string(static_cast<Touched>(kind)))] = totals.contacts_by_kind[kind];
  nlohmann::json results = {
      {"frames_located", totals.located},
      {"frames_degenerate", totals.degenerate},
      {"frames_dropped", totals.dropped},
      {"moved_fraction_mean", totals.per_frame(totals.moved_fraction)},
      {"moved_fraction_max", totals.max_moved_fraction},
      {"dynamic_triangles_mean", totals.per_frame(totals.dynamic_triangles)},
      {"inferred_triangles_mean", totals.per_frame(totals.inferred_triangles)},
      {"static_triangles_drawn_mean", totals.per_frame(totals.static_triangles)},
      {"contacts", totals.contacts},
      {"contacts_by_kind", contacts_by_kind},
      {"unknown_triangles", session.unknown().mesh_world.triangles.size()},
      {"unknown_mb", static_cast<double>(session.unknown().memory_bytes) / 1e6},
      {"deepest_penetration_m", totals.deepest_penetration_m},
      {"objects", objects},
      {"adopted", adopted},
  };
  if (!totals.last_fault.empty()) results["last_fault"] = totals.last_fault;
  return results;
}

/// Where it was put: it is free to go where nobody has seen what is there, until it has come out.
const char* note_on(const VirtualObject& object) {
  if (!object.began_in_unknown) return "";
  return object.in_unknown ? "; was put into unknown space, and a part of it still is there"
                           : "; was put into unknown space, and came out of it";
}

void print_summary(const RunTotals& totals, const Session& session) {
  std::printf(
      "located in %lld of %lld frames; %.2f %% of pixels moved, %.0f triangles of them meshed a frame\n",
      static_cast<long long>(totals.located), static_cast<long long>(totals.read),
      100.0 * totals.per_frame(totals.moved_fraction), totals.per_frame(totals.dynamic_triangles));
  for (const AdoptedChange& change : session.adopted()) {
    const Eigen::Vector3d p = change.box_world.center(), size = change.box_world.sizes();
    std::printf("adopted at %.1f s: what %s at %.2f %.2f %.2f m, %.2f x %.2f x %.2f m\n",
                change.stamp_s - totals.first_stamp_s, change.kind == LastingKind::kCame ? "came" : "went",
                p.x(), p.y(), p.z(), size.x(), size.y(), size.z());
  }
  for (const auto& object : session.objects()) {
    const Eigen::Vector3d p = object->body.T_world_object.translation();
    if (!object->in_room)
      std::printf("%s: not in the room\n", object->body.name.c_str());
    else
      std::printf(
          "%s: %s at %.3f %.3f %.3f m%s%s\n", object->body.name.c_str(),
          object->body.at_rest ? "at rest" : "moving", p.x(), p.y(), p.z(),
          object->body.rests_on == Touched::kUnknownFrontier ? ", on the border of unknown space" : "",
          note_on(*object));
  }
}

/// The composed picture, and what moved as the depth camera saw it.
void write_pictures(const Session& session, const FrameResult& result, const std::filesystem::path& folder,
                    std::int64_t frame_index) {
  char number[24];
  std::snprintf(number, sizeof number, "%06lld", static_cast<long long>(frame_index));
  if (!session.picture().empty()) write_png(session.picture(), folder / (std::string(number) + ".png"));
  if (result.status == FrameStatus::kDone)
    write_png(session.scene().moved_mask(), folder / (std::string(number) + ".moved.png"));
}

void make_unknown_solid(Session& session, StageTimes& times) {
  const auto start = std::chrono::steady_clock::now();
  session.make_unknown_solid(times);
  std::fprintf(stderr, "unknown space: %zu triangles round it, made in %.1f s with %.0f MB\n",
               session.unknown().mesh_world.triangles.size(), ms_since(start) / 1e3,
               static_cast<double>(session.unknown().memory_bytes) / 1e6);
}

/// The octree as the session has left it, with its surface made anew as a whole.
void save_changed(SavedMap& map, std::size_t changes, const std::string& folder) {
  if (changes > 0) map.mesh = extract_surface(map.octree);
  map.info.settings["adopted"] = std::to_string(changes);
  save_map(folder, map);
  std::printf("%s: saved with %zu changes\n", folder.c_str(), changes);
}

}  // namespace

int run(const RunCommand& command) {
  Report report;
  report.command = "run";
  report.source = command.source;
  report.settings = {{"map", command.map},
                     {"poses", to_string(command.poses)},
                     {"object", command.object},
                     {"script", command.script},
                     {"surfaces", to_string(command.surfaces)},
                     {"unknown", command.unknown_is_solid ? "solid" : "free"},
                     {"radar", to_string(command.radar.mode)},
                     {"radar_px", command.radar.resolution_px},
                     {"save_map", command.save_map}};
  if (command.adopt_after_s) report.settings["adopt_s"] = *command.adopt_after_s;
  if (!command.calibration.empty()) report.settings["calibration"] = command.calibration;
  if (command.frames) report.settings["frames"] = {command.frames->first, command.frames->last};

  require_writable(command.report);
  const Script script = command.script.empty() ? drop_over_view(command.object) : read_script(command.script);
  const bool asks = std::any_of(script.events.begin(), script.events.end(),
                                [](const ScriptEvent& event) { return event.action == Action::kAdopt; });
  if (!command.save_map.empty()) {
    if (!command.adopt_after_s && !asks)
      throw Error("--save-map " + command.save_map +
                  ": nothing would change in the map; add --adopt SECONDS, or an adopt event to the script");
    require_can_become_map(command.save_map);
  }
  SavedMap map = load_map(command.map);
  const Interrupt interrupt;
  const std::unique_ptr<FrameSource> source =
      ended_by_interrupt(open_source(command.source, command.frames, command.calibration));
  SessionConfig config;
  config.poses = command.poses;
  config.scene.surfaces = command.surfaces;
  config.radar = command.radar;
  config.make_picture = !command.video.empty() || !command.pictures.empty();
  config.measure_penetration = !command.report.empty();
  if (command.adopt_after_s || asks) {
    config.adopt.emplace();
    config.adopt->after_s = command.adopt_after_s;
    config.adopt->wait = source->frame_count().has_value();  // a device does not wait
  }
  Session session(map, config, &map.octree);
  report.renderer = session.renderer();
  std::fprintf(stderr, "rendering with %s\n", session.renderer().c_str());
  if (command.unknown_is_solid) make_unknown_solid(session, report.times);

  // Objects are loaded now, so that a wrong mesh is said before the first frame and not when its turn comes.
  for (const ScriptEvent& event : script.events)
    if (event.action == Action::kAdd) session.apply(event);

  std::unique_ptr<VideoWriter> video;
  if (!command.video.empty()) video = std::make_unique<VideoWriter>(command.video, kVideoFramesPerS);
  if (!command.pictures.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(command.pictures, failed);
    if (failed) throw Error(command.pictures + ": the folder cannot be made: " + failed.message());
  }

  RunTotals totals;
  Frame frame;
  std::size_t next_event = 0;
  bool quit = false;
  {
    Progress progress("running", source->frame_count());
    for (std::int64_t run_frame = 0; !quit; ++run_frame) {
      const ReadResult read = report.times.timed("read", [&] { return source->next(frame); });
      if (read.status == ReadStatus::kEnd) break;
      if (read.waiting) continue;  // what a live source waits for it says itself
      ++totals.read;
      if (read.status == ReadStatus::kSkipped) {
        ++totals.skipped;
        totals.last_fault = read.fault;
        continue;
      }
      if (totals.read - totals.skipped == 1) totals.first_stamp_s = frame.stamp_s;
      totals.count_dropped(frame.index);
      for (; next_event < script.events.size() &&
             is_due(script.events[next_event], run_frame, frame.stamp_s - totals.first_stamp_s);
           ++next_event) {
        const ScriptEvent& event = script.events[next_event];
        quit = quit || event.action == Action::kQuit;
        if (event.action != Action::kAdd) session.apply(event);
      }
      if (quit) break;
      const FrameResult result = session.step(frame, report.times);
      if (result.status == FrameStatus::kBadFrame) {
        ++totals.skipped;
        totals.last_fault = command.source + ": frame " + std::to_string(frame.index) + ": " +
                            std::string(result.fault) + "; it is passed over";
        continue;
      }
      totals.add(result);
      if (video) video->write(session.picture());
      if (!command.pictures.empty() && run_frame % command.pictures_every == 0)
        write_pictures(session, result, std::filesystem::path(command.pictures), frame.index);
      progress.step(result.status == FrameStatus::kDone ? "located" : "not located");
    }
  }
  if (video) video->close();
  session.finish_adopting();
  if (totals.read == totals.skipped)
    throw Error(command.source + ": there is not one readable frame" +
                (totals.last_fault.empty() ? "" : "; the last fault: " + totals.last_fault));

  if (!command.save_map.empty()) save_changed(map, session.adopted().size(), command.save_map);
  report.frames_read = totals.read;
  report.frames_skipped = totals.skipped + totals.dropped;
  report.results = results_of(totals, session);
  write_report(report, command.report);
  print_summary(totals, session);
  if (totals.located > 0 || quit) return 0;
  std::fprintf(stderr, "roomradar: %s: no frame shows where in %s the camera is; was that room mapped?\n",
               command.source.c_str(), command.map.c_str());
  return 1;
}

}  // namespace roomradar
