// play_host.cpp: handles commands between frames and publishes a snapshot after each.
#include "app/window/link/play_host.hpp"

#include <chrono>
#include <new>
#include <variant>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kSaidAfterFrames = 30;  // before the user is told that an object is being read

/// Throws Error naming the mesh file and the fault.
ObjectParts parts_of(const ObjectSource& source, double room_extent_m) {
  Model model = object_model(source);
  require_sensible_size(model, source, {room_extent_m, "the slider \"new\" at "});
  return object_parts(source.mesh, std::move(model));
}

}  // namespace

bool PlayHost::wait_turn(const Frame& frame) {
  const bool in_time = !is_live_ || source_.is_again();
  return link_.wait_turn(frame.stamp_s, in_time, [this] {
    if (shown_.run_frame >= 0) publish();
  });
}

std::vector<ScriptEvent> PlayHost::take_events() {
  std::vector<UserCommand> commands = link_.take_commands();
  ready_new_objects(commands);
  std::vector<ScriptEvent> events = player_.events_of(commands, session_);
  if (!player_.complaint().empty()) link_.say(player_.complaint());
  if (is_live_ && link_.take_pause()) events.push_back({PlayCamera{CameraPlay::kResume}});
  return events;
}

void PlayHost::ready_new_objects(std::vector<UserCommand>& commands) {
  for (const UserCommand& command : commands)
    if (const auto* add = std::get_if<AddNew>(&command)) new_.waiting.push_back(*add);
  std::erase_if(commands, [](const UserCommand& command) { return std::holds_alternative<AddNew>(command); });
  if (new_.readying.valid() && new_.readying.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    try {
      new_.parts = new_.readying.get();
      commands.push_back(new_.waiting.front());
    } catch (const std::bad_alloc&) {
      link_.say(new_.waiting.front().source.mesh + ": not enough memory");
    } catch (const Error& fault) {
      link_.say(fault.what());
    }
    new_.waiting.pop_front();
  }
  if (new_.readying.valid()) {
    if (++new_.frames_waited == kSaidAfterFrames)
      link_.say("reading " + new_.waiting.front().source.mesh + " ...");
  } else if (!new_.waiting.empty()) {
    new_.frames_waited = 0;
    new_.readying =
        std::async(std::launch::async, parts_of, new_.waiting.front().source, session_.room_extent_m());
  }
}

void PlayHost::show(std::int64_t run_frame, double run_time_s, const Frame& frame,
                    const FrameResult& result) {
  shown_.run_frame = run_frame;
  shown_.run_time_s = run_time_s;
  shown_.source_frame = frame.index;
  shown_.result = result;
  say_if_a_drop_waits();
  publish();
}

void PlayHost::say_if_a_drop_waits() {
  const std::string waits = session_.waiting_drops().empty() ? "" : session_.waiting_drops().back().drop.name;
  if (!waits.empty() && waits != said_to_wait_)
    link_.say(waits + " waits for a level surface in view, to be dropped over it");
  said_to_wait_ = waits;
}

void PlayHost::publish() {
  filled_.run_frame = shown_.run_frame;
  filled_.run_time_s = shown_.run_time_s;
  filled_.source_frame = shown_.source_frame;
  filled_.chosen = player_.chosen();
  filled_.is_held = source_.is_held();
  filled_.is_repeating = source_.is_repeating();
  filled_.at_end = source_.at_end();
  filled_.given_up = given_up_;
  maker_.fill(session_, shown_.result, times_, link_.wanted(), filled_);
  link_.publish(filled_);
}

}  // namespace roomradar
