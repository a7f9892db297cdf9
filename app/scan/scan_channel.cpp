// scan_channel.cpp: guards the newest state with a mutex.
#include "app/scan/scan_channel.hpp"

namespace roomradar {

void ScanChannel::set_paused(bool is_paused) {
  {
    const std::lock_guard lock(mutex_);
    is_paused_ = is_paused;
  }
  changed_.notify_all();
}

bool ScanChannel::is_paused() const {
  const std::lock_guard lock(mutex_);
  return is_paused_;
}

void ScanChannel::request(ScanRequest request) {
  {
    const std::lock_guard lock(mutex_);
    request_ = request;
  }
  changed_.notify_all();
}

void ScanChannel::undo(double seconds) {
  const std::lock_guard lock(mutex_);
  undo_s_ += seconds;
}

double ScanChannel::take_undo_s() {
  const std::lock_guard lock(mutex_);
  return std::exchange(undo_s_, 0.0);
}

bool ScanChannel::take(ShownScan& shown) {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(is_fresh_, false)) return false;
  std::swap(newest_, shown);
  return true;
}

ScanStage ScanChannel::stage() const {
  const std::lock_guard lock(mutex_);
  return stage_;
}

ScanOutcome ScanChannel::outcome() const {
  const std::lock_guard lock(mutex_);
  return outcome_;
}

ScanRequest ScanChannel::requested() const {
  const std::lock_guard lock(mutex_);
  return request_;
}

void ScanChannel::wait_while_paused() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !is_paused_ || request_ != ScanRequest::kGoOn; });
}

void ScanChannel::publish(ShownScan& filled) {
  {
    const std::lock_guard lock(mutex_);
    std::swap(newest_, filled);
    is_fresh_ = true;
  }
  wake_();
}

void ScanChannel::set_stage(ScanStage stage) {
  {
    const std::lock_guard lock(mutex_);
    stage_ = std::move(stage);
  }
  wake_();
}

void ScanChannel::finish(ScanOutcome outcome) {
  {
    const std::lock_guard lock(mutex_);
    outcome_ = std::move(outcome);
  }
  wake_();
}

}  // namespace roomradar
