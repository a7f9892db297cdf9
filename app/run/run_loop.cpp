// run_loop.cpp: executes due events, processes the frame and stores its results.
#include "app/run/run_loop.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/cli/progress.hpp"
#include "app/objects/unknown_support.hpp"
#include "app/session/script/session_events.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

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
    case CameraPlay::kResume:
      source.resume();
      break;
  }
}

class RunLoop {
 public:
  explicit RunLoop(OpenedRun& run) : run_(run), progress_("running", run.source->frame_count()) {}

  /// Reads the source's next frame into frame_.
  enum class Next { kFrame, kSkipped, kEnd };
  Next read();
  void perform_due();
  void step();

  void play() {
    const auto is_past_end = [&] { return run_.last_frame && run_frame_ > *run_.last_frame; };
    for (; !run_.was_quit && !is_past_end() && !repeats_for_ever(); ++run_frame_) {
      const Next next = read();
      if (next == Next::kEnd) break;
      if (next == Next::kSkipped) continue;
      perform_due();
      if (run_.was_quit)
        --run_.totals.read;  // the frame is not used
      else
        step();
    }
    say_what_never_came();
    if (run_.recorder && !run_.was_quit) run_.recorder->write({Quit{}}, run_frame_);
  }

 private:
  OpenedRun& run_;
  Progress progress_;
  Frame frame_;
  std::size_t next_event_ = 0;
  std::int64_t run_frame_ = 0;
  double run_time_s_ = 0.0;
  /// Positions at which objects were last reported to rest on the border of unknown space, world, m.
  std::map<std::string, Eigen::Vector3d> on_unknown_;
  /// Objects reported to have fallen out of the map; second: true if the object was set back.
  std::set<std::pair<std::string, bool>> departed_;
  double last_event_s_ = 0.0;             ///< run time of the last event
  std::optional<double> repeats_from_s_;  ///< run time since which the source repeats itself

  bool repeats_for_ever();
  void perform(const ScriptEvent& event, bool is_from_script);
  ScriptEvent apply(const ScriptEvent& event);
  void record(const ScriptEvent& event);
  void perform_users(const std::vector<ScriptEvent>& events);
  void report(const Departure& departure);
  void say(const std::string& sentence);
  void say_what_rests_on_unknown();
  void say_what_never_came();
  void end_budget();
  void count_skipped(const std::string& fault);
  void keep(const FrameResult& result);
};

RunLoop::Next RunLoop::read() {
  RunTotals& totals = run_.totals;
  ReadResult read;
  do {  // a live source itself tells the user why it waits
    read = run_.report.times.timed("read", [&] { return run_.source->next(frame_); });
  } while (read.status == ReadStatus::kWaiting && !(run_.host && run_.host->is_closed()));
  if (read.status == ReadStatus::kEnd || read.status == ReadStatus::kWaiting) return Next::kEnd;
  ++totals.read;
  if (read.status == ReadStatus::kSkipped) {
    count_skipped(read.fault);
    return Next::kSkipped;
  }
  if (totals.read - totals.skipped == 1) totals.first_stamp_s = frame_.stamp_s;
  totals.dropped.see(frame_.index, totals.read);
  run_time_s_ = frame_.stamp_s - totals.first_stamp_s;
  return Next::kFrame;
}

void RunLoop::perform_due() {
  if (run_.host && !run_.host->wait_turn(frame_)) perform({Quit{}}, /*is_from_script=*/false);
  const std::vector<ScriptEvent>& events = run_.script.events;
  for (;
       !run_.was_quit && next_event_ < events.size() && is_due(events[next_event_], run_frame_, run_time_s_);
       ++next_event_)
    perform(events[next_event_], /*is_from_script=*/true);
  if (run_.host && !run_.was_quit) perform_users(run_.host->take_events());
}

/// Returns true, with a message, if the camera is held, or its recording stays at its end or loops, and
/// nothing can end the run: no window, no recorded end, and the last event was 5 s ago.
bool RunLoop::repeats_for_ever() {
  constexpr double kAfterLastEvent_s = 5.0;
  if (run_.host || run_.is_replay || run_.is_live) return false;
  const PlaybackSource& playback = *run_.playback;
  const bool repeats = playback.is_repeating() || (playback.at_end() == AtEnd::kLoop && playback.is_again());
  if (!repeats || next_event_ < run_.script.events.size()) {
    repeats_from_s_.reset();
    return false;
  }
  if (!repeats_from_s_) repeats_from_s_ = run_time_s_;
  if (run_time_s_ - std::max(*repeats_from_s_, last_event_s_) < kAfterLastEvent_s) return false;
  say("the camera repeats its frames and no scripted event is left: the run ends here; a quit event says "
      "when it should");
  return true;
}

void RunLoop::perform(const ScriptEvent& event, bool is_from_script) {
  last_event_s_ = run_time_s_;
  if (std::holds_alternative<AddObject>(event.action) && is_from_script)
    return;  // already added and recorded before the first frame
  try {
    record(apply(event));
  } catch (const PlaceRefused& refused) {  // not recorded: it has changed nothing
    ++run_.totals.places_refused;
    say(refused.what());
  }
}

/// Applies an event and returns it in the form to be recorded.
ScriptEvent RunLoop::apply(const ScriptEvent& event) {
  const auto* const add = std::get_if<AddObject>(&event.action);
  ObjectParts parts = add != nullptr ? run_.host->take_parts() : ObjectParts{};
  const ScriptEvent kept = run_.recorder ? run_.recorder->with_mesh_kept(event, parts.source) : event;
  if (std::holds_alternative<Quit>(event.action)) run_.was_quit = true;
  if (const auto* camera = std::get_if<PlayCamera>(&event.action)) control(*run_.playback, camera->play);
  if (const auto* set = std::get_if<SetRadar>(&event.action); set != nullptr && run_.budget)
    run_.budget->keep(set->radar);
  if (add != nullptr)
    run_.session->add_object(add->name, std::move(parts), add->material);
  else
    roomradar::apply(*run_.session, event);
  return kept;
}

void RunLoop::record(const ScriptEvent& event) {
  if (run_.recorder) run_.recorder->write(event, run_frame_);
}

void RunLoop::perform_users(const std::vector<ScriptEvent>& events) {
  std::set<std::string> not_made;
  for (const ScriptEvent& event : events) {
    const std::string name = object_of(event.action);
    if (not_made.contains(name)) continue;
    ScriptEvent applied;
    try {
      applied = apply(event);
    } catch (const Error& fault) {
      run_.host->complain(fault.what());
      if (std::holds_alternative<AddObject>(event.action)) not_made.insert(name);
      continue;
    }
    // Outside the try block: an event that cannot be recorded ends the run, because replays would differ.
    record(applied);
  }
}

void RunLoop::step() {
  const FrameResult result = run_.session->step(frame_, run_.report.times);
  if (result.status == FrameStatus::kBadFrame) {
    count_skipped(run_.options.source + ": frame " + std::to_string(frame_.index) + ": " +
                  std::string(result.fault) + "; it is skipped");
    return;
  }
  end_budget();
  run_.totals.add(result, *run_.session);
  const bool is_located = result.status == FrameStatus::kDone;
  for (const Departure& departure : result.departures) report(departure);
  for (const ObjectNotice& notice : result.notices) say(notice.name + notice.text);
  say_what_rests_on_unknown();
  const std::string news = run_.totals.lost.add(frame_.index, is_located);
  if (!news.empty()) std::fprintf(stderr, "%s\n", news.c_str());
  if (run_.host) run_.host->show(run_frame_, run_time_s_, frame_, result);
  keep(result);
  progress_.step(is_located                                     ? "located"
                 : result.status == FrameStatus::kUncertain ? "uncertain"
                                                            : "not located");
}

/// Reports that an object fell out of the map, once with and once without its being set back.
void RunLoop::report(const Departure& departure) {
  if (!departed_.emplace(departure.name, departure.is_back).second) return;
  say(sentence_of(departure, *run_.session));
}

void RunLoop::say(const std::string& sentence) {
  std::fprintf(stderr, "%s\n", sentence.c_str());
  if (run_.host) run_.host->complain(sentence);
}

/// Reports each object that came to rest on the border of unknown space, and the viewpoint from which to scan
/// its support. Repeats this only after the object has moved.
void RunLoop::say_what_rests_on_unknown() {
  constexpr double kMovedOn_m = 0.1;
  const Session& session = *run_.session;
  for (const auto& object : session.objects()) {
    if (!rests_on_unknown(*object)) continue;
    const Eigen::Vector3d position_world = support_point_world(*object);
    const auto [said, is_new] = on_unknown_.try_emplace(object->body.name, position_world);
    if (!is_new && (said->second - position_world).norm() < kMovedOn_m) continue;
    said->second = position_world;
    say(object->body.name +
        unknown_support_text(*object, session.scene_without(object.get()), camera_position_world(session)));
  }
}

/// Reports the events of the script that were due after the last frame.
void RunLoop::say_what_never_came() {
  const std::vector<ScriptEvent>& events = run_.script.events;
  if (run_.was_quit || run_.host || run_.is_replay || next_event_ >= events.size()) return;
  const ScriptEvent& first = events[next_event_];
  std::string sentence = std::to_string(events.size() - next_event_) + " of " +
                         std::to_string(events.size()) +
                         " events of the script were due after the last frame and did nothing";
  if (first.line > 0) sentence += "; the first is in line " + std::to_string(first.line);
  say(sentence);
}

/// Records the qualities that the frame used, so a replay uses the same without a clock.
void RunLoop::end_budget() {
  if (!run_.budget) return;
  for (const ScriptEvent& event : run_.budget->end_frame())
    if (run_.recorder) run_.recorder->write(event, run_frame_);
  const std::string news = run_.budget->news();
  if (!news.empty()) std::fprintf(stderr, "%s\n", news.c_str());
  if (run_.host) run_.host->say_given_up(run_.budget->given_up());
}

void RunLoop::count_skipped(const std::string& fault) {
  ++run_.totals.skipped;
  run_.totals.last_fault = fault;
}

void RunLoop::keep(const FrameResult& result) {
  const RunFrame frame{run_frame_, run_time_s_, frame_, result, *run_.session, run_.report.times};
  for (const std::unique_ptr<FrameSink>& sink : run_.sinks) sink->write(frame);
}

}  // namespace

void play_to_end(OpenedRun& run) { RunLoop(run).play(); }

}  // namespace roomradar
