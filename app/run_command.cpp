// run_command.cpp: roomradar run: augmented reality in a saved room.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/open_source.hpp"
#include "app/picture_file.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"
#include "app/run_results.hpp"
#include "app/script.hpp"
#include "app/session.hpp"
#include "app/session_folder.hpp"
#include "app/sources/playback_source.hpp"
#include "app/video_writer.hpp"
#include "app/window/play_host.hpp"
#include "app/window/play_window.hpp"
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

void control(PlaybackSource& source, CameraPlay camera) {
  switch (camera) {
    case CameraPlay::kHold:
    case CameraPlay::kGo:
      source.hold(camera == CameraPlay::kHold);
      break;
    case CameraPlay::kRewind:
      if (!source.rewind()) throw Error(source.name() + ": a live device cannot go back to its first frame");
      break;
    case CameraPlay::kLoop:
    case CameraPlay::kStay:
      source.set_at_end(camera == CameraPlay::kLoop ? AtEnd::kLoop : AtEnd::kStay);
      break;
  }
}

/// Says on stderr how a replay compares with what was recorded.
nlohmann::json report_replay(const ReplayCheck& check) {
  std::fprintf(stderr, "replay: %lld of %lld frames the same as recorded",
               static_cast<long long>(check.same()), static_cast<long long>(check.recorded()));
  if (check.different() > 0)
    std::fprintf(stderr, ", the first that is not: %lld", static_cast<long long>(check.first_different()));
  std::fprintf(stderr, "\n");
  return {{"same", check.same()}, {"different", check.different()}, {"recorded", check.recorded()}};
}

/// @param link  to the window; null: there is none
int run_frames(const RunCommand& command, PlayLink* link) {
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
                     {"at_end", to_string(command.at_end)},
                     {"window", command.window},
                     {"record_session", command.record_session},
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
  std::unique_ptr<FrameSource> opened = open_source(command.source, command.frames, command.calibration);
  const bool is_live = !opened->frame_count();
  std::optional<SessionRecorder> recorder;
  if (!command.record_session.empty()) {
    recorder.emplace(command.record_session, command, map.info);
    opened = recorder->recorded(std::move(opened));
  }
  std::optional<ReplayCheck> check;
  if (is_session_folder(command.source)) {
    check.emplace(command.source);
    if (const std::string fault = map_difference(command.source, map.info); !fault.empty())
      std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  }
  // A session that was cut off has no event that ends it.
  const bool ends = std::any_of(script.events.begin(), script.events.end(),
                                [](const ScriptEvent& event) { return event.action == Action::kQuit; });
  auto played =
      std::make_unique<PlaybackSource>(std::move(opened), check && !ends ? AtEnd::kEnd : command.at_end);
  PlaybackSource& playback = *played;
  const Interrupt interrupt;
  const std::unique_ptr<FrameSource> source = ended_by_interrupt(std::move(played));
  SessionConfig config;
  config.poses = command.poses;
  config.scene.surfaces = command.surfaces;
  config.radar = command.radar;
  config.make_picture = link != nullptr || !command.video.empty() || !command.pictures.empty();
  config.measure_penetration = !command.report.empty();
  if (command.adopt_after_s || asks) {
    config.adopt.emplace();
    config.adopt->after_s = command.adopt_after_s;
    config.adopt->wait = !is_live || recorder;  // a device does not wait, unless it is to be repeated
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
  std::optional<PlayHost> host;
  if (link != nullptr)
    host.emplace(*link, session, playback, report.times, map.mesh, command.object, is_live);
  std::size_t next_event = 0;
  std::int64_t run_frame = 0;
  bool quit = false;
  const auto perform = [&](const ScriptEvent& event, bool is_from_script) {
    if (event.action == Action::kQuit) quit = true;
    if (event.action == Action::kCamera) control(playback, event.camera);
    if (event.action != Action::kAdd || !is_from_script) session.apply(event);
    if (recorder) recorder->write(event, run_frame);
  };
  const auto perform_users = [&](const std::vector<ScriptEvent>& events) {
    for (const ScriptEvent& event : events) {
      try {
        perform(event, /*is_from_script=*/false);
      } catch (const Error& fault) {
        host->complain(fault.what());
        break;  // those that follow are about what this one should have made
      }
    }
  };
  {
    Progress progress("running", source->frame_count());
    for (; !quit; ++run_frame) {
      ReadResult read;
      do {  // what a live source waits for it says itself
        read = report.times.timed("read", [&] { return source->next(frame); });
      } while (read.waiting && !(host && host->is_closed()));
      if (read.status == ReadStatus::kEnd || read.waiting) break;
      ++totals.read;
      if (read.status == ReadStatus::kSkipped) {
        ++totals.skipped;
        totals.last_fault = read.fault;
        continue;
      }
      if (totals.read - totals.skipped == 1) totals.first_stamp_s = frame.stamp_s;
      totals.count_dropped(frame.index);
      const double run_time_s = frame.stamp_s - totals.first_stamp_s;
      if (host && !host->wait_turn(frame))
        perform(ScriptEvent{}, /*is_from_script=*/false);  // it says to quit
      for (; !quit && next_event < script.events.size() &&
             is_due(script.events[next_event], run_frame, run_time_s);
           ++next_event)
        perform(script.events[next_event], /*is_from_script=*/true);
      if (host && !quit) perform_users(host->take_events());
      if (quit) break;
      const FrameResult result = session.step(frame, report.times);
      if (result.status == FrameStatus::kBadFrame) {
        ++totals.skipped;
        totals.last_fault = command.source + ": frame " + std::to_string(frame.index) + ": " +
                            std::string(result.fault) + "; it is passed over";
        continue;
      }
      totals.add(result);
      const std::string news = totals.lost.add(frame.index, result.status == FrameStatus::kDone);
      if (!news.empty()) std::fprintf(stderr, "%s\n", news.c_str());
      if (host) host->show(run_frame, run_time_s, frame, result);
      if (recorder || check) {
        const FrameFingerprint fingerprint = fingerprint_of(run_frame, session);
        if (recorder) recorder->write(fingerprint);
        if (check) check->compare(fingerprint);
      }
      if (video) video->write(session.picture());
      if (!command.pictures.empty() && run_frame % command.pictures_every == 0)
        write_pictures(session, result, std::filesystem::path(command.pictures), frame.index);
      progress.step(result.status == FrameStatus::kDone ? "located" : "not located");
    }
  }
  if (recorder && !quit) recorder->write(ScriptEvent{}, run_frame);  // it says to quit
  if (video) video->close();
  session.finish_adopting();
  if (totals.read == totals.skipped)
    throw Error(command.source + ": there is not one readable frame" +
                (totals.last_fault.empty() ? "" : "; the last fault: " + totals.last_fault));

  if (!command.save_map.empty()) save_changed(map, session.adopted().size(), command.save_map);
  report.frames_read = totals.read;
  report.frames_skipped = totals.skipped + totals.dropped;
  report.results = results_of(totals, session);
  if (check) report.results["replay"] = report_replay(*check);
  write_report(report, command.report);
  print_summary(totals, session);
  if (totals.located > 0 || quit) return 0;
  std::fprintf(stderr, "roomradar: %s: no frame shows where in %s the camera is; was that room mapped?\n",
               command.source.c_str(), command.map.c_str());
  return 1;
}

}  // namespace

int run(const RunCommand& command) {
  if (!command.window) return run_frames(command, nullptr);
  std::vector<std::string> meshes;
  if (command.object != "teapot") meshes.push_back(command.object);
  return run_in_window("roomradar - " + command.source, meshes,
                       [&](PlayLink& link) { return run_frames(command, &link); });
}

}  // namespace roomradar
