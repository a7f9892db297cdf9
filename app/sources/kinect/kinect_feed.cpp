// kinect_feed.cpp: the device's thread: open, serve, watch, reopen.
#include "app/sources/kinect/kinect_feed.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Makes frames from the images of a device, in the order of the depth images. An unusable depth image
/// becomes a frame with an error message. Used by the device's thread only.
class KinectPairing {
 public:
  /// @param config  must outlive the pairing
  /// @param put     called with each frame
  KinectPairing(const KinectFeedConfig& config, std::function<void(KinectFrame)> put)
      : config_(config), put_(std::move(put)) {}

  /// Makes stamps advance by the elapsed host time across a gap. Call before the device is reopened, since
  /// the first images may arrive during the opening.
  void restart_clock();
  /// Adds a depth image. Returns false if its size is wrong.
  /// @param pixels          640 x 480 values
  /// @param ticks           stamp of the device's clock
  /// @param memory          returns a frame whose buffers can be reused
  /// @param acceleration_g  latest accelerometer reading, g, in the accelerometer's axes
  bool add_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks,
                 const std::function<KinectFrame()>& memory,
                 const std::optional<Eigen::Vector3d>& acceleration_g);
  /// Adds a colour image. Returns false and ignores the image if its size is wrong; its depth image then has
  /// no colour.
  /// @param bytes  640 x 480 x 3 values
  /// @param ticks  stamp of the device's clock
  bool add_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks);
  /// Passes all frames with decided pairs to `put`.
  void hand_over();
  /// Passes all remaining frames to `put`. Call after the device has been closed.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  struct Colour {
    std::int64_t number = 0;
    std::vector<std::uint8_t> pixels{};
  };

  double stamp_of(std::uint32_t ticks);
  void pass_over_broken();
  /// Adds an error to the queue of depth images that wait for colour, so that frames keep their order.
  void fail(std::int64_t number, const std::string& what);
  [[nodiscard]] KinectFrame broken_frame(std::int64_t number, const std::string& what) const;
  void put_broken();

  const KinectFeedConfig& config_;
  std::function<void(KinectFrame)> put_;
  KinectClock clock_;
  StampPairing pairing_{kDevicePairing};
  std::int64_t depth_count_ = 0;
  std::int64_t colour_count_ = 0;
  std::deque<KinectFrame> depths_;
  std::deque<Colour> colours_;
  bool is_finishing_ = false;
  int backwards_ = 0;
  double last_stamp_s_ = 0.0;
  Clock::time_point last_stamp_at_ = Clock::now();
};

namespace {

constexpr std::size_t kPixels = std::size_t{640} * 480;
constexpr double kFrame_s = 1.0 / 30.0;
constexpr int kBackwardsMost = 3;

}  // namespace

void KinectPairing::restart_clock() {
  const double gap_s = std::chrono::duration<double>(Clock::now() - last_stamp_at_).count();
  clock_.restart(last_stamp_s_ + std::max(kFrame_s, gap_s));
}

double KinectPairing::stamp_of(std::uint32_t ticks) {
  const double stamp_s = clock_.seconds(ticks);
  last_stamp_s_ = std::max(last_stamp_s_, stamp_s);
  last_stamp_at_ = Clock::now();
  return stamp_s;
}

bool KinectPairing::add_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks,
                              const std::function<KinectFrame()>& memory,
                              const std::optional<Eigen::Vector3d>& acceleration_g) {
  pass_over_broken();
  const double stamp_s = stamp_of(ticks);
  const std::int64_t number = depth_count_++;
  if (pixels.size() != kPixels) {
    fail(number, "has " + std::to_string(pixels.size()) + " pixels instead of " + std::to_string(kPixels));
    return false;
  }
  KinectFrame depth = memory();
  depth.number = number;
  depth.stamp_s = stamp_s;
  depth.depth.assign(pixels.begin(), pixels.end());
  if (acceleration_g) depth.down_camera = down_from_acceleration(*acceleration_g);
  pairing_.add_depth(depth.number, depth.stamp_s);
  depths_.push_back(std::move(depth));
  return true;
}

bool KinectPairing::add_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks) {
  const double stamp_s = stamp_of(ticks);
  const std::int64_t number = colour_count_++;
  if (bytes.size() != 3 * kPixels) return false;  // the depth image then has no colour
  Colour colour = colours_.size() < kColoursKept ? Colour{} : std::move(colours_.front());
  if (colours_.size() == kColoursKept) colours_.pop_front();
  colour.number = number;
  colour.pixels.assign(bytes.begin(), bytes.end());
  pairing_.add_colour(number, stamp_s);
  colours_.push_back(std::move(colour));
  return true;
}

void KinectPairing::hand_over() {
  while (true) {
    put_broken();
    const auto pair = pairing_.take();
    if (!pair) return;
    KinectFrame frame = std::move(depths_.front());
    depths_.pop_front();
    if (pair->stamp_goes_back) {
      put_(broken_frame(frame.number, "has a stamp that is not later than that of the one before it"));
      // If several stamps in a row go back, the device's clock was reset, so its stamps are valid again.
      if (++backwards_ < kBackwardsMost || config_.is_replay) continue;
      clock_.restart(last_stamp_s_ + kFrame_s);
      finish();
      continue;
    }
    backwards_ = 0;
    const auto colour = std::find_if(colours_.begin(), colours_.end(), [&](const Colour& candidate) {
      return pair->colour && candidate.number == *pair->colour;
    });
    if (colour != colours_.end()) {
      std::swap(frame.colour, colour->pixels);
      frame.colour_after_depth_s = pair->colour_after_depth_s;
    }
    put_(std::move(frame));
  }
}

void KinectPairing::finish() {
  if (std::exchange(is_finishing_, true)) return;
  if (config_.is_replay) pass_over_broken();
  pairing_.finish();
  hand_over();
  pairing_ = StampPairing(kDevicePairing);
  is_finishing_ = false;
}

void KinectPairing::pass_over_broken() {
  for (auto known = config_.broken.find(depth_count_); known != config_.broken.end();
       known = config_.broken.find(depth_count_))
    fail(depth_count_++, known->second);
}

void KinectPairing::fail(std::int64_t number, const std::string& what) {
  depths_.push_back(broken_frame(number, what));
}

KinectFrame KinectPairing::broken_frame(std::int64_t number, const std::string& what) const {
  KinectFrame frame;
  frame.number = number;
  frame.fault = config_.name + ": depth image " + std::to_string(number) + " " + what;
  return frame;
}

void KinectPairing::put_broken() {
  while (!depths_.empty() && !depths_.front().fault.empty()) {
    put_(std::move(depths_.front()));
    depths_.pop_front();
  }
}

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

namespace {

using Clock = std::chrono::steady_clock;  // the system clock may be set back while a device is read

constexpr double kPatience_s = 0.1;  // max delay until a stop is noticed

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string with_tenths(double s) {
  char text[32];
  format_classic(text, sizeof text, "%.1f s", s);
  return text;
}

}  // namespace

class KinectFeed::Work {
 public:
  Work(KinectOpener opener, KinectFeedConfig config)
      : opener_(std::move(opener)), config_(std::move(config)) {}

  /// Serves the device until the reader stops it or a replay ends. Called by the device's thread.
  void run() {
    serve_until_stopped();
    queue_.end();
  }

  /// Shared with the reader's thread.
  [[nodiscard]] KinectQueue& queue() { return queue_; }

 private:
  enum class Outcome { kStopped, kGone, kSilent, kColourless };

  void serve_until_stopped() {
    std::string serial;
    for (bool first = true;; first = false) {
      std::unique_ptr<KinectDevice> device;
      // Done before opening, since the first images may arrive during it.
      if (!first) pairing_.restart_clock();
      try {
        device = opener_({config_.number, serial, config_.depth, listener()});
      } catch (const Error& error) {
        if (first) {
          queue_.refuse(error.what());
          return;
        }
        if (!watch_.away_since) tell(Outcome::kGone);
        if (queue_.stopped_within(config_.retry_s)) return;
        continue;
      }
      if (first) queue_.announce(*device);
      serial = device->serial();
      device_ = device.get();
      const Outcome outcome = serve(*device);
      pairing_.finish();
      device_ = nullptr;
      device.reset();
      if (outcome == Outcome::kStopped || config_.is_replay) return;
      tell(outcome);
      if (queue_.stopped_within(config_.retry_s)) return;
    }
  }

  Outcome serve(KinectDevice& device) {
    // A device needs some time after opening before it sends its first images.
    watch_.last_depth_at = watch_.last_colour_at = Clock::now() + started_within();
    for (;;) {
      if (queue_.must_stop()) return Outcome::kStopped;
      const Clock::time_point began = Clock::now();
      if (!device.serve(kPatience_s)) return Outcome::kGone;
      if (std::exchange(watch_.depth_arrived, false)) {
        // This USB transfer is not allowed within libusb's callback. Its result is used for the next depth
        // image.
        device.ask_acceleration();
        if (watch_.away_since)
          config_.say(config_.name + ": is back after " + with_tenths(seconds_since(*watch_.away_since)));
        watch_.away_since.reset();
      }
      pairing_.hand_over();
      if (config_.is_replay) continue;
      // Time in which this process was suspended or the driver blocked does not count as the device's
      // silence, since its images may still arrive.
      if (seconds_since(began) > 0.5 * config_.silence_s) {
        const Clock::duration lost = Clock::now() - began;
        watch_.last_depth_at += lost;
        watch_.last_colour_at += lost;
      }
      if (seconds_since(watch_.last_depth_at) > config_.silence_s) return Outcome::kSilent;
      if (!watch_.tried_for_colour && seconds_since(watch_.last_colour_at) > config_.silence_s)
        return Outcome::kColourless;
    }
  }

  void tell(Outcome outcome) {
    if (outcome == Outcome::kColourless) {
      watch_.tried_for_colour = true;
      config_.say(config_.name + ": sends depth, but no colour for " + with_tenths(config_.silence_s) +
                  "; it is restarted once");
      return;
    }
    if (watch_.away_since) return;  // already reported
    watch_.away_since = std::min(watch_.last_depth_at, Clock::now());
    config_.say(config_.name +
                (outcome == Outcome::kGone
                     ? ": the device has gone; waiting for it. Was it unplugged?"
                     : ": no depth image for " + with_tenths(config_.silence_s) + "; it is restarted"));
  }

  [[nodiscard]] Clock::duration started_within() const {
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(2.0 * config_.silence_s));
  }

  KinectListener listener() {
    return {.on_depth = [this](std::span<const std::uint16_t> pixels,
                               std::uint32_t ticks) { on_depth(pixels, ticks); },
            .on_colour = [this](std::span<const std::uint8_t> bytes,
                                std::uint32_t ticks) { on_colour(bytes, ticks); }};
  }

  void on_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks) {
    const auto acceleration_g = device_ ? device_->acceleration_g() : std::nullopt;
    if (!pairing_.add_depth(
            pixels, ticks, [this] { return queue_.empty_frame(); }, acceleration_g))
      return;
    watch_.depth_arrived = true;
    watch_.last_depth_at = Clock::now();
  }

  void on_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks) {
    if (!pairing_.add_colour(bytes, ticks)) return;
    watch_.last_colour_at = Clock::now();
    watch_.tried_for_colour = false;
  }

  void put(KinectFrame frame) {
    const bool is_full = queue_.put(std::move(frame));
    if (is_full && config_.most_waiting > 1 && !std::exchange(has_said_full_, true))
      config_.say(config_.name + ": sends frames faster than they are used; some are dropped from now on");
  }

  /// Record of the images that the device has sent, to detect that it stopped.
  struct Watch {
    bool depth_arrived = false;
    bool tried_for_colour = false;
    Clock::time_point last_depth_at = Clock::now();
    Clock::time_point last_colour_at = Clock::now();
    std::optional<Clock::time_point> away_since;
  };

  const KinectOpener opener_;
  const KinectFeedConfig config_;
  KinectQueue queue_{config_};

  // Used only by the device's thread.
  KinectDevice* device_ = nullptr;
  KinectPairing pairing_{config_, [this](KinectFrame frame) { put(std::move(frame)); }};
  Watch watch_;
  bool has_said_full_ = false;
};

KinectFeed::KinectFeed(KinectOpener opener, KinectFeedConfig config)
    : work_(std::make_shared<Work>(std::move(opener), std::move(config))),
      thread_([work = work_] { work->run(); }) {
  try {
    constants_ = work_->queue().wait_for_opening();
  } catch (...) {
    if (work_->queue().stop())
      thread_.join();
    else
      thread_.detach();
    throw;
  }
}

KinectFeed::~KinectFeed() {
  // A hanging device's thread is detached; it owns everything it uses.
  if (work_->queue().stop())
    thread_.join();
  else
    thread_.detach();
}

KinectFeed::Take KinectFeed::take(KinectFrame& frame, double wait_s) {
  return work_->queue().take(frame, wait_s);
}

}  // namespace roomradar
