// kinect_feed.cpp: the device's thread (open, serve, watch, reopen) and the queue of frames.
#include "app/sources/kinect/kinect_feed.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <utility>

#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

using Clock = std::chrono::steady_clock;  // the system clock may be set back while a device is read

constexpr std::size_t kPixels = std::size_t{640} * 480;
constexpr std::size_t kReplayWaiting = 2;  // one queued, one with the reader
constexpr double kFrame_s = 1.0 / 30.0;
constexpr double kPatience_s = 0.1;  // max delay until a stop is noticed

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::chrono::duration<double> seconds(double s) { return std::chrono::duration<double>(s); }

std::string with_tenths(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", s);
  return text;
}

}  // namespace

class KinectFeed::Work {
 public:
  Work(KinectOpener opener, KinectFeedConfig config)
      : opener_(std::move(opener)), config_(std::move(config)) {}

  // ---- called by the device's thread ----

  void run() {
    serve_until_stopped();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  // ---- called by the reader's thread ----

  /// Waits for the first opening. Throws Error if it failed.
  std::optional<KinectConstants> wait_for_opening() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(config_.patience_s), [&] { return opened_ || ended_; });
    if (!refused_.empty()) throw Error(refused_);
    if (!opened_)
      throw Error(config_.name +
                  ": does not answer; unplug it and plug it in again, into a USB 2 port of its own");
    return constants_;
  }

  Take take(KinectFrame& frame, double wait_s) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, seconds(wait_s), [&] { return !ready_.empty() || ended_; });
    if (ready_.empty()) return ended_ ? Take::kEnd : Take::kNothing;
    std::swap(frame, ready_.front());
    keep_memory(std::move(ready_.front()));
    ready_.pop_front();
    changed_.notify_all();
    return Take::kFrame;
  }

  /// Returns true if the thread ended within stop_s.
  bool stop() {
    std::unique_lock lock(mutex_);
    stop_ = true;
    changed_.notify_all();
    return changed_.wait_for(lock, seconds(config_.stop_s), [&] { return ended_; });
  }

 private:
  enum class Outcome { kStopped, kGone, kSilent, kColourless };
  struct Colour {
    std::int64_t number = 0;
    std::vector<std::uint8_t> pixels{};
  };

  void serve_until_stopped() {
    std::string serial;
    for (bool first = true;; first = false) {
      std::unique_ptr<KinectDevice> device;
      // Done before opening, since the first images may arrive during it.
      if (!first) clock_.restart(last_stamp_s_ + std::max(kFrame_s, seconds_since(last_stamp_at_)));
      try {
        device = opener_({config_.number, serial, config_.depth, listener()});
      } catch (const Error& error) {
        if (first) {
          const std::lock_guard lock(mutex_);
          refused_ = error.what();
          return;
        }
        if (!away_since_) tell(Outcome::kGone);
        if (stopped_within(config_.retry_s)) return;
        continue;
      }
      if (first) announce(*device);
      serial = device->serial();
      device_ = device.get();
      const Outcome outcome = serve(*device);
      finish_pairing();
      device_ = nullptr;
      device.reset();
      if (outcome == Outcome::kStopped || config_.is_replay) return;
      tell(outcome);
      if (stopped_within(config_.retry_s)) return;
    }
  }

  void announce(const KinectDevice& device) {
    std::optional<KinectConstants> constants = device.constants();
    const std::lock_guard lock(mutex_);
    constants_ = std::move(constants);
    opened_ = true;
    changed_.notify_all();
  }

  Outcome serve(KinectDevice& device) {
    // A device needs some time after opening before it sends its first images.
    last_depth_at_ = last_colour_at_ = Clock::now() + started_within();
    for (;;) {
      if (must_stop()) return Outcome::kStopped;
      const Clock::time_point began = Clock::now();
      if (!device.serve(kPatience_s)) return Outcome::kGone;
      if (std::exchange(depth_arrived_, false)) {
        // This USB transfer is not allowed within libusb's callback. Its result is used for the next depth
        // image.
        device.ask_acceleration();
        if (away_since_)
          config_.say(config_.name + ": is back after " + with_tenths(seconds_since(*away_since_)));
        away_since_.reset();
      }
      hand_over();
      if (config_.is_replay) continue;
      // Time in which this process was suspended or the driver blocked does not count as the device's
      // silence, since its images may still arrive.
      if (seconds_since(began) > 0.5 * config_.silence_s) {
        const Clock::duration lost = Clock::now() - began;
        last_depth_at_ += lost;
        last_colour_at_ += lost;
      }
      if (seconds_since(last_depth_at_) > config_.silence_s) return Outcome::kSilent;
      if (!tried_for_colour_ && seconds_since(last_colour_at_) > config_.silence_s)
        return Outcome::kColourless;
    }
  }

  /// Blocks a replay while its frames are not fetched.
  bool must_stop() {
    std::unique_lock lock(mutex_);
    if (config_.is_replay) changed_.wait(lock, [&] { return ready_.size() < kReplayWaiting || stop_; });
    return stop_;
  }

  bool stopped_within(double wait_s) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, seconds(wait_s), [&] { return stop_; });
  }

  void tell(Outcome outcome) {
    if (outcome == Outcome::kColourless) {
      tried_for_colour_ = true;
      config_.say(config_.name + ": sends depth, but no colour for " + with_tenths(config_.silence_s) +
                  "; it is restarted once");
      return;
    }
    if (away_since_) return;  // already reported
    away_since_ = std::min(last_depth_at_, Clock::now());
    config_.say(config_.name +
                (outcome == Outcome::kGone
                     ? ": the device has gone; waiting for it. Was it unplugged?"
                     : ": no depth image for " + with_tenths(config_.silence_s) + "; it is restarted"));
  }

  [[nodiscard]] Clock::duration started_within() const {
    return std::chrono::duration_cast<Clock::duration>(seconds(2.0 * config_.silence_s));
  }

  KinectListener listener() {
    return {.on_depth = [this](std::span<const std::uint16_t> pixels,
                               std::uint32_t ticks) { on_depth(pixels, ticks); },
            .on_colour = [this](std::span<const std::uint8_t> bytes,
                                std::uint32_t ticks) { on_colour(bytes, ticks); }};
  }

  double stamp_of(std::uint32_t ticks) {
    const double stamp_s = clock_.seconds(ticks);
    last_stamp_s_ = std::max(last_stamp_s_, stamp_s);
    last_stamp_at_ = Clock::now();
    return stamp_s;
  }

  void on_depth(std::span<const std::uint16_t> pixels, std::uint32_t ticks) {
    pass_over_broken();
    const double stamp_s = stamp_of(ticks);
    const std::int64_t number = depth_count_++;
    if (pixels.size() != kPixels) {
      fail(number, "has " + std::to_string(pixels.size()) + " pixels instead of " + std::to_string(kPixels));
      return;
    }
    KinectFrame depth = empty_frame();
    depth.number = number;
    depth.stamp_s = stamp_s;
    depth.depth.assign(pixels.begin(), pixels.end());
    if (const auto acceleration_g = device_ ? device_->acceleration_g() : std::nullopt)
      depth.down_camera = down_from_acceleration(*acceleration_g);
    pairing_.add_depth(depth.number, depth.stamp_s);
    depths_.push_back(std::move(depth));
    depth_arrived_ = true;
    last_depth_at_ = Clock::now();
  }

  void on_colour(std::span<const std::uint8_t> bytes, std::uint32_t ticks) {
    const double stamp_s = stamp_of(ticks);
    const std::int64_t number = colour_count_++;
    if (bytes.size() != 3 * kPixels) return;  // the depth image then has no colour
    Colour colour = colours_.size() < kColoursKept ? Colour{} : std::move(colours_.front());
    if (colours_.size() == kColoursKept) colours_.pop_front();
    colour.number = number;
    colour.pixels.assign(bytes.begin(), bytes.end());
    pairing_.add_colour(number, stamp_s);
    colours_.push_back(std::move(colour));
    last_colour_at_ = Clock::now();
    tried_for_colour_ = false;
  }

  /// Moves decided pairs to the queue that take() reads.
  void hand_over() {
    while (true) {
      put_broken();
      const auto pair = pairing_.take();
      if (!pair) return;
      KinectFrame frame = std::move(depths_.front());
      depths_.pop_front();
      if (pair->stamp_goes_back) {
        put(broken_frame(frame.number, "has a stamp that is not later than that of the one before it"));
        // If several stamps in a row go back, the device's clock was reset, so its stamps are valid again.
        if (++backwards_ < kBackwardsMost || config_.is_replay) continue;
        clock_.restart(last_stamp_s_ + kFrame_s);
        finish_pairing();
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
      put(std::move(frame));
    }
  }

  void finish_pairing() {
    if (std::exchange(is_finishing_, true)) return;
    if (config_.is_replay) pass_over_broken();
    pairing_.finish();
    hand_over();
    pairing_ = StampPairing(kDevicePairing);
    is_finishing_ = false;
  }

  void pass_over_broken() {
    for (auto known = config_.broken.find(depth_count_); known != config_.broken.end();
         known = config_.broken.find(depth_count_))
      fail(depth_count_++, known->second);
  }

  /// Queues the fault among the depth images that wait for colour, to keep their order.
  void fail(std::int64_t number, const std::string& what) { depths_.push_back(broken_frame(number, what)); }

  [[nodiscard]] KinectFrame broken_frame(std::int64_t number, const std::string& what) const {
    KinectFrame frame;
    frame.number = number;
    frame.fault = config_.name + ": depth image " + std::to_string(number) + " " + what;
    return frame;
  }

  void put_broken() {
    while (!depths_.empty() && !depths_.front().fault.empty()) {
      put(std::move(depths_.front()));
      depths_.pop_front();
    }
  }

  void put(KinectFrame frame) {
    std::unique_lock lock(mutex_);
    const bool is_full = !config_.is_replay && ready_.size() >= config_.most_waiting;
    if (is_full) {
      keep_memory(std::move(ready_.front()));
      ready_.pop_front();
    }
    ready_.push_back(std::move(frame));
    changed_.notify_all();
    lock.unlock();
    if (is_full && config_.most_waiting > 1 && !std::exchange(has_said_full_, true))
      config_.say(config_.name + ": sends frames faster than they are used; some are dropped from now on");
  }

  /// Frames with a fault have no memory to reuse.
  void keep_memory(KinectFrame frame) {
    if (frame.depth.capacity() > 0) spare_.push_back(std::move(frame));
  }

  /// Returns a frame, with reused memory if available.
  KinectFrame empty_frame() {
    KinectFrame frame;
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return frame;
    std::swap(frame.depth, spare_.back().depth);
    std::swap(frame.colour, spare_.back().colour);
    spare_.pop_back();
    frame.colour.clear();
    return frame;
  }

  static constexpr int kBackwardsMost = 3;

  const KinectOpener opener_;
  const KinectFeedConfig config_;

  // Used only by the device's thread.
  KinectDevice* device_ = nullptr;
  KinectClock clock_;
  StampPairing pairing_{kDevicePairing};
  std::int64_t depth_count_ = 0;
  std::int64_t colour_count_ = 0;
  std::deque<KinectFrame> depths_;
  std::deque<Colour> colours_;
  bool depth_arrived_ = false;
  bool tried_for_colour_ = false;
  bool is_finishing_ = false;
  bool has_said_full_ = false;
  int backwards_ = 0;
  double last_stamp_s_ = 0.0;
  Clock::time_point last_stamp_at_ = Clock::now();
  Clock::time_point last_depth_at_ = Clock::now();
  Clock::time_point last_colour_at_ = Clock::now();
  std::optional<Clock::time_point> away_since_;

  // Shared, guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<KinectFrame> ready_;
  std::vector<KinectFrame> spare_;
  std::optional<KinectConstants> constants_;
  std::string refused_;
  bool opened_ = false;
  bool ended_ = false;
  bool stop_ = false;
};

KinectFeed::KinectFeed(KinectOpener opener, KinectFeedConfig config)
    : work_(std::make_shared<Work>(std::move(opener), std::move(config))),
      thread_([work = work_] { work->run(); }) {
  try {
    constants_ = work_->wait_for_opening();
  } catch (...) {
    if (work_->stop())
      thread_.join();
    else
      thread_.detach();
    throw;
  }
}

KinectFeed::~KinectFeed() {
  // A hanging device's thread is detached; it owns everything it uses.
  if (work_->stop())
    thread_.join();
  else
    thread_.detach();
}

KinectFeed::Take KinectFeed::take(KinectFrame& frame, double wait_s) { return work_->take(frame, wait_s); }

}  // namespace roomradar
