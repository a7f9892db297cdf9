// ui_channel.cpp: one mutex and one condition variable for all state.
#include "app/window/link/ui_channel.hpp"

#include <algorithm>
#include <chrono>

#include "app/cli/interrupt.hpp"

namespace roomradar {
namespace {

/// Merges mouse events that arrive faster than frames: the newest drag position replaces the last, rotations
/// are added. Returns false if `next` must stay separate.
bool merge(UserCommand& last, const UserCommand& next) {
  if (std::holds_alternative<DragGrabbed>(last) && std::holds_alternative<DragGrabbed>(next)) {
    last = next;
    return true;
  }
  auto* const sum = std::get_if<TurnGrabbed>(&last);
  const auto* const turn = std::get_if<TurnGrabbed>(&next);
  if (sum == nullptr || turn == nullptr) return false;
  const Eigen::Vector3d turn_world_deg = sum->turn_world_deg + turn->turn_world_deg;
  if (turn_world_deg.cwiseAbs().maxCoeff() > kMaxTurn_deg) return false;
  sum->turn_world_deg = turn_world_deg;
  return true;
}

}  // namespace

void UiChannel::ask(UserCommand command) {
  const std::lock_guard lock(mutex_);
  if (is_paused_ && !std::holds_alternative<GrabObject>(command))
    message_ = "paused: takes effect in the next frame";
  if (commands_.empty() || !merge(commands_.back(), command)) commands_.push_back(std::move(command));
}

void UiChannel::set_paused(bool is_paused) {
  const std::lock_guard lock(mutex_);
  is_paused_ = is_paused;
  was_paused_ = was_paused_ || is_paused;
  steps_ = 0;
  changed_.notify_all();
}

bool UiChannel::is_paused() const {
  const std::lock_guard lock(mutex_);
  return is_paused_;
}

void UiChannel::step() {
  const std::lock_guard lock(mutex_);
  ++steps_;
  changed_.notify_all();
}

void UiChannel::set_speed(double speed) {
  const std::lock_guard lock(mutex_);
  speed_ = speed;
  last_turn_.reset();
  changed_.notify_all();
}

void UiChannel::want(const ViewsWanted& views) {
  const std::lock_guard lock(mutex_);
  if (views == wanted_) return;
  const bool only_mouse = views.radar == wanted_.radar && views.models == wanted_.models;
  wanted_ = views;
  if (only_mouse && !is_paused_) return;  // the next frame shows it
  wants_changed_ = true;
  changed_.notify_all();
}

bool UiChannel::take(Snapshot& shown) {
  const std::lock_guard lock(mutex_);
  if (!is_fresh_) return false;
  std::swap(newest_, shown);
  is_fresh_ = false;
  return true;
}

std::string UiChannel::take_message() {
  const std::lock_guard lock(mutex_);
  return std::exchange(message_, {});
}

void UiChannel::ask_to_scan() {
  const std::lock_guard lock(mutex_);
  wants_to_scan_ = true;
}

bool UiChannel::wants_to_scan() const {
  const std::lock_guard lock(mutex_);
  return wants_to_scan_;
}

void UiChannel::close() {
  const std::lock_guard lock(mutex_);
  is_closed_ = true;
  changed_.notify_all();
}

bool UiChannel::is_over() const {
  const std::lock_guard lock(mutex_);
  return is_over_;
}

bool UiChannel::wait_turn(double stamp_s, bool in_time, const std::function<void()>& refresh) {
  constexpr double kCatchUp_s = 0.2;  // longer delays are not caught up
  constexpr std::chrono::milliseconds kLookUp{200};
  std::unique_lock lock(mutex_);
  while (!is_closed_) {
    if (wants_changed_) {
      wants_changed_ = false;
      lock.unlock();
      refresh();
      lock.lock();
      continue;
    }
    if (is_paused_ && steps_ == 0) {
      last_turn_.reset();
      changed_.wait_for(lock, kLookUp);
      if (Interrupt::is_asked()) break;  // while paused, no thread reads the source, which handles Ctrl-C
      continue;
    }
    const Clock::time_point now = Clock::now();
    Clock::time_point due = now;
    if (in_time && last_turn_ && steps_ == 0) {
      const double wait_s = std::clamp((stamp_s - last_turn_->first) / speed_, 0.0, 1.0);
      due = last_turn_->second +
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait_s));
    }
    if (now < due) {
      changed_.wait_until(lock, due);
      continue;
    }
    if (now - due > std::chrono::duration<double>(kCatchUp_s)) due = now;
    last_turn_ = {stamp_s, due};
    steps_ = std::max(steps_ - 1, 0);
    return true;
  }
  return false;
}

bool UiChannel::take_pause() {
  const std::lock_guard lock(mutex_);
  return std::exchange(was_paused_, is_paused_);
}

bool UiChannel::is_closed() const {
  const std::lock_guard lock(mutex_);
  return is_closed_;
}

std::vector<UserCommand> UiChannel::take_commands() {
  const std::lock_guard lock(mutex_);
  return std::exchange(commands_, {});
}

ViewsWanted UiChannel::wanted() const {
  const std::lock_guard lock(mutex_);
  return wanted_;
}

void UiChannel::publish(Snapshot& filled) {
  {
    const std::lock_guard lock(mutex_);
    std::swap(newest_, filled);
    is_fresh_ = true;
  }
  wake_();
}

void UiChannel::say(std::string message) {
  {
    const std::lock_guard lock(mutex_);
    message_ = std::move(message);
  }
  wake_();
}

void UiChannel::finish() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  wake_();
}

}  // namespace roomradar
