// kinect_feed.cpp: the device's thread: open, serve, watch, reopen.
#include "app/sources/kinect/kinect_feed.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "app/sources/kinect/kinect_pairing.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
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
