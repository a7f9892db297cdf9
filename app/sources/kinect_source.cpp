// kinect_source.cpp: libfreenect behind a thread of its own, its images paired as a recording's are.
#include "app/sources/kinect_source.hpp"

#include <libfreenect.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/sources/kinect_units.hpp"
#include "app/sources/nominal_rig.hpp"
#include "app/sources/stamp_pairing.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

/// What fakenect's library itself goes by. A replay is not in a hurry: it can wait for whoever reads the
/// frames.
bool is_replay() { return std::getenv("FAKENECT_PATH") != nullptr; }

/// libfreenect's context and an opened device, closed in the right order.
class FreenectDevice {
 public:
  explicit FreenectDevice(int number) {
    const std::string name = "kinect:" + std::to_string(number);
    if (freenect_init(&context_, nullptr) < 0)
      throw Error(name + ": libfreenect cannot start; is USB accessible?");
    freenect_set_log_level(context_, FREENECT_LOG_ERROR);
    freenect_select_subdevices(
        context_, static_cast<freenect_device_flags>(FREENECT_DEVICE_CAMERA | FREENECT_DEVICE_MOTOR));
    const int devices = freenect_num_devices(context_);
    if (number < 0 || number >= devices) {
      freenect_shutdown(context_);
      throw Error(name + ": there is no such Kinect; libfreenect sees " +
                  std::to_string(std::max(devices, 0)) +
                  ", counted from 0. Is it plugged into USB and into its own power supply?");
    }
    if (freenect_open_device(context_, &device_, number) < 0) {
      freenect_shutdown(context_);
      throw Error(name +
                  ": cannot be opened. Does another program use it, or does this user lack the right to "
                  "(udev rule 60-libfreenect, group plugdev)?");
    }
  }
  FreenectDevice(const FreenectDevice&) = delete;
  FreenectDevice& operator=(const FreenectDevice&) = delete;
  ~FreenectDevice() {
    freenect_stop_depth(device_);
    freenect_stop_video(device_);
    freenect_close_device(device_);
    freenect_shutdown(context_);
  }
  [[nodiscard]] freenect_context* context() const { return context_; }
  [[nodiscard]] freenect_device* device() const { return device_; }

 private:
  freenect_context* context_ = nullptr;
  freenect_device* device_ = nullptr;
};

struct RawDepth {
  std::int64_t number = 0;
  double stamp_s = 0.0;
  std::vector<std::uint16_t> raw{};
  std::optional<Eigen::Vector3d> down_camera{};
};
struct RawColour {
  std::int64_t number = 0;
  std::vector<Rgb> pixels{};  ///< empty: no image
};
struct RawFrame {
  RawDepth depth;
  RawColour colour{};
  bool stamp_goes_back = false;
};

class KinectSource final : public FrameSource {
 public:
  KinectSource(int number, const SourceOptions& options)
      : name_("kinect:" + std::to_string(number)),
        timeout_s_(options.device_timeout_s),
        replay_(is_replay()),
        device_(number) {
    const auto depth_mode = freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_DEPTH_11BIT);
    const auto video_mode = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
    depth_size_ = {depth_mode.width, depth_mode.height};
    colour_size_ = {video_mode.width, video_mode.height};
    // A replay may bring a camera.json of its own; nothing else stands in a live device's place.
    const char* replayed = std::getenv("FAKENECT_PATH");
    rig_ = rig_of_recording(replayed ? replayed : "", NominalRig::kKinect, options.depth_camera, depth_size_,
                            colour_size_);

    freenect_set_user(device_.device(), this);
    freenect_set_depth_callback(
        device_.device(), [](freenect_device* device, void* pixels, std::uint32_t ticks) {
          static_cast<KinectSource*>(freenect_get_user(device))->on_depth(pixels, ticks);
        });
    freenect_set_video_callback(
        device_.device(), [](freenect_device* device, void* pixels, std::uint32_t ticks) {
          static_cast<KinectSource*>(freenect_get_user(device))->on_colour(pixels, ticks);
        });
    const bool started = freenect_set_depth_mode(device_.device(), depth_mode) >= 0 &&
                         freenect_set_video_mode(device_.device(), video_mode) >= 0 &&
                         freenect_start_depth(device_.device()) >= 0 &&
                         freenect_start_video(device_.device()) >= 0;
    if (!started) throw Error(name_ + ": its cameras cannot be started; unplug it and plug it in again");
    thread_ = std::thread([this] { serve(); });
  }

  ~KinectSource() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  ReadResult next(Frame& frame) override {
    RawFrame raw;
    {
      std::unique_lock lock(mutex_);
      const auto something = [&] { return !ready_.empty() || ended_; };
      if (replay_) changed_.wait(lock, something);  // a recording may have long gaps
      const bool arrived = changed_.wait_for(lock, std::chrono::duration<double>(timeout_s_), something);
      if (!arrived)
        throw Error(name_ + ": has sent no depth image for " + std::to_string(timeout_s_) +
                    " s; check its cable and power supply");
      if (ready_.empty()) {
        if (replay_) return {ReadStatus::kEnd, {}};
        throw Error(name_ + ": the device has gone; was it unplugged?");
      }
      raw = std::move(ready_.front());
      ready_.pop_front();
    }
    changed_.notify_all();

    if (raw.stamp_goes_back) {
      const std::string fault = name_ + ": depth image " + std::to_string(raw.depth.number) +
                                " has a stamp that is not later than that of the one before it";
      if (++bad_in_a_row_ >= kBadFramesInARow)
        throw Error(fault + ", for the " + std::to_string(bad_in_a_row_) + "th time in a row" +
                    (replay_ ? "; replay without a loop: FAKENECT_LOOP=0" : ""));
      return {ReadStatus::kSkipped, fault};
    }
    bad_in_a_row_ = 0;
    fill(raw, frame);
    return {ReadStatus::kFrame, {}};
  }

  bool rewind() override { return false; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  // One being waited for, one in hand; more would only be late.
  static constexpr std::size_t kReadyFrames = 2;
  static constexpr int kBadFramesInARow = 10;
  static constexpr int kInterrupted = -10;  // LIBUSB_ERROR_INTERRUPTED: a signal came in between; no fault

  // ---- the device's thread ----

  void serve() {
    for (;;) {
      {
        std::unique_lock lock(mutex_);
        if (replay_) changed_.wait(lock, [&] { return ready_.size() < kReadyFrames || stop_; });
        if (stop_) return;
      }
      timeval patience{.tv_sec = 0, .tv_usec = 100'000};
      const int result = freenect_process_events_timeout(device_.context(), &patience);
      if (result < 0 && (replay_ || result != kInterrupted)) break;
      if (depth_arrived_) {
        // A USB transfer, which libusb forbids within the callback. The answer goes with the next depth
        // image.
        freenect_update_tilt_state(device_.device());
        depth_arrived_ = false;
      }
      hand_over();
    }
    pairing_.finish();
    hand_over();
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
  }

  void on_depth(const void* pixels, std::uint32_t ticks) {
    RawDepth depth{.number = depth_count_++, .stamp_s = clock_.seconds(ticks)};
    const auto* raw = static_cast<const std::uint16_t*>(pixels);
    depth.raw.assign(raw, raw + depth_size_.width_px * depth_size_.height_px);
    const freenect_raw_tilt_state* tilt = freenect_get_tilt_state(device_.device());
    if (tilt)
      depth.down_camera = down_from_acceleration(
          Eigen::Vector3d(tilt->accelerometer_x, tilt->accelerometer_y, tilt->accelerometer_z) /
          kKinectCountsPerG);
    pairing_.add_depth(depth.number, depth.stamp_s);
    depths_.push_back(std::move(depth));
    depth_arrived_ = true;
  }

  void on_colour(const void* pixels, std::uint32_t ticks) {
    RawColour colour{.number = colour_count_++};
    const auto* rgb = static_cast<const Rgb*>(pixels);
    colour.pixels.assign(rgb, rgb + colour_size_.width_px * colour_size_.height_px);
    pairing_.add_colour(colour.number, clock_.seconds(ticks));
    colours_.push_back(std::move(colour));
    if (colours_.size() > kColoursKept) colours_.pop_front();
  }

  /// Moves what the pairing has decided on to where next() takes it.
  void hand_over() {
    while (const auto pair = pairing_.take()) {
      RawFrame raw{.depth = std::move(depths_.front()), .stamp_goes_back = pair->stamp_goes_back};
      depths_.pop_front();
      const auto colour = std::find_if(colours_.begin(), colours_.end(), [&](const RawColour& candidate) {
        return pair->colour && candidate.number == *pair->colour;
      });
      if (colour != colours_.end()) raw.colour = std::move(*colour);
      {
        const std::lock_guard lock(mutex_);
        if (!replay_ && ready_.size() == kReadyFrames) ready_.pop_front();
        ready_.push_back(std::move(raw));
      }
      changed_.notify_all();
    }
  }

  // ---- the reader's thread ----

  void fill(const RawFrame& raw, Frame& frame) const {
    frame.index = raw.depth.number;
    frame.stamp_s = raw.depth.stamp_s;
    frame.depth_camera = rig_.depth_camera;
    frame.colour_camera = *rig_.colour_camera;
    frame.T_colour_depth = rig_.T_colour_depth;
    frame.T_world_camera.reset();
    frame.down_camera = raw.depth.down_camera;
    frame.depth_m.resize(depth_size_.width_px, depth_size_.height_px);
    std::transform(raw.depth.raw.begin(), raw.depth.raw.end(), frame.depth_m.pixels.begin(), raw_depth_m);
    const bool has_colour = !raw.colour.pixels.empty();
    frame.colour.resize(has_colour ? colour_size_.width_px : 0, has_colour ? colour_size_.height_px : 0);
    std::copy(raw.colour.pixels.begin(), raw.colour.pixels.end(), frame.colour.pixels.begin());
  }

  const std::string name_;
  const double timeout_s_;
  const bool replay_;
  ImageSize depth_size_;
  ImageSize colour_size_;
  CameraRig rig_;
  int bad_in_a_row_ = 0;

  // Of the device's thread alone.
  KinectClock clock_;
  StampPairing pairing_{kDevicePairing};
  std::int64_t depth_count_ = 0;
  std::int64_t colour_count_ = 0;
  std::deque<RawDepth> depths_;
  std::deque<RawColour> colours_;
  bool depth_arrived_ = false;

  // Shared, under mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RawFrame> ready_;
  bool ended_ = false;
  bool stop_ = false;

  FreenectDevice device_;  // after all that its callbacks fill: it is closed before that goes
  std::thread thread_;
};

}  // namespace

std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options) {
  return std::make_unique<KinectSource>(device, options);
}

int count_kinects() {
  freenect_context* context = nullptr;
  if (freenect_init(&context, nullptr) < 0) return 0;
  freenect_set_log_level(context, FREENECT_LOG_FATAL);
  const int devices = freenect_num_devices(context);
  freenect_shutdown(context);
  return std::max(devices, 0);
}

}  // namespace roomradar
