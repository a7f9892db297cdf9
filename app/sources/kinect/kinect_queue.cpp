// kinect_queue.cpp: one mutex, and one condition variable for every change.
#include "app/sources/kinect/kinect_queue.hpp"

#include <chrono>
#include <utility>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kReplayWaiting = 2;  // one queued, one with the reader

std::chrono::duration<double> seconds(double s) { return std::chrono::duration<double>(s); }

}  // namespace

void KinectQueue::announce(const KinectDevice& device) {
  std::optional<KinectConstants> constants = device.constants();
  const std::lock_guard lock(mutex_);
  constants_ = std::move(constants);
  opened_ = true;
  changed_.notify_all();
}

void KinectQueue::refuse(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  refused_ = fault;
}

void KinectQueue::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

bool KinectQueue::put(KinectFrame frame) {
  const std::lock_guard lock(mutex_);
  const bool is_full = !config_.is_replay && ready_.size() >= config_.most_waiting;
  if (is_full) {
    keep_memory(std::move(ready_.front()));
    ready_.pop_front();
  }
  ready_.push_back(std::move(frame));
  changed_.notify_all();
  return is_full;
}

KinectFrame KinectQueue::empty_frame() {
  KinectFrame frame;
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return frame;
  std::swap(frame.depth, spare_.back().depth);
  std::swap(frame.colour, spare_.back().colour);
  spare_.pop_back();
  frame.colour.clear();
  return frame;
}

bool KinectQueue::must_stop() {
  std::unique_lock lock(mutex_);
  if (config_.is_replay) changed_.wait(lock, [&] { return ready_.size() < kReplayWaiting || stop_; });
  return stop_;
}

bool KinectQueue::stopped_within(double wait_s) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, seconds(wait_s), [&] { return stop_; });
}

std::optional<KinectConstants> KinectQueue::wait_for_opening() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, seconds(config_.patience_s), [&] { return opened_ || ended_; });
  if (!refused_.empty()) throw Error(refused_);
  if (!opened_)
    throw Error(config_.name +
                ": does not answer; unplug it and plug it in again, into a USB 2 port of its own");
  return constants_;
}

KinectQueue::Take KinectQueue::take(KinectFrame& frame, double wait_s) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, seconds(wait_s), [&] { return !ready_.empty() || ended_; });
  if (ready_.empty()) return ended_ ? Take::kEnd : Take::kNothing;
  std::swap(frame, ready_.front());
  keep_memory(std::move(ready_.front()));
  ready_.pop_front();
  changed_.notify_all();
  return Take::kFrame;
}

bool KinectQueue::stop() {
  std::unique_lock lock(mutex_);
  stop_ = true;
  changed_.notify_all();
  return changed_.wait_for(lock, seconds(config_.stop_s), [&] { return ended_; });
}

void KinectQueue::keep_memory(KinectFrame frame) {
  if (frame.depth.capacity() > 0) spare_.push_back(std::move(frame));
}

}  // namespace roomradar
