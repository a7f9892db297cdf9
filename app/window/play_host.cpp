// play_host.cpp: between two frames, and after each.
#include "app/window/play_host.hpp"

namespace roomradar {

bool PlayHost::wait_turn(const Frame& frame) {
  const bool in_time = !is_live_ || source_.is_repeating();
  return link_.wait_turn(frame.stamp_s, in_time, [this] {
    if (run_frame_ >= 0) publish();
  });
}

std::vector<ScriptEvent> PlayHost::take_events() {
  const std::vector<Wish> wishes = link_.take_wishes();
  std::vector<ScriptEvent> events = player_.events_of(wishes, session_);
  if (!player_.complaint().empty()) link_.say(player_.complaint());
  return events;
}

void PlayHost::show(std::int64_t run_frame, double run_time_s, const Frame& frame,
                    const FrameResult& result) {
  run_frame_ = run_frame;
  run_time_s_ = run_time_s;
  source_frame_ = frame.index;
  result_ = result;
  publish();
}

void PlayHost::publish() {
  filled_.run_frame = run_frame_;
  filled_.run_time_s = run_time_s_;
  filled_.source_frame = source_frame_;
  filled_.chosen = player_.chosen();
  filled_.is_grabbed = player_.is_grabbed();
  filled_.is_held = source_.is_held();
  filled_.is_repeating = source_.is_repeating();
  filled_.at_end = source_.at_end();
  filled_.given_up = given_up_;
  maker_.fill(session_, result_, times_, link_.wanted(), filled_);
  link_.publish(filled_);
}

}  // namespace roomradar
