// freenect_device.cpp: libfreenect's context, device and callbacks; the only user of libfreenect.
#include "app/sources/kinect/freenect_device.hpp"

#include <libfreenect.h>
#include <libfreenect_registration.h>
#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/kinect_source.hpp"
#include "mapping/types/system/error.hpp"

// Null if fakenect's library is loaded, which lacks these functions.
#pragma weak freenect_list_device_attributes
#pragma weak freenect_free_device_attributes
#pragma weak freenect_copy_registration
#pragma weak freenect_destroy_registration

namespace roomradar {
namespace {

constexpr int kInterrupted = -10;  // LIBUSB_ERROR_INTERRUPTED: interrupted by a signal; not a failure
constexpr int kWidth = 640, kHeight = 480;

/// libfreenect's latest error message; per thread, since its callback gets no user pointer.
thread_local std::string complaint;

void keep_complaint(freenect_context* /*context*/, freenect_loglevel /*level*/, const char* text) {
  complaint = text;
  while (complaint.ends_with('\n')) complaint.pop_back();
}

class FreenectContext {
 public:
  explicit FreenectContext(const std::string& name) {
    complaint.clear();
    if (freenect_init(&context_, nullptr) < 0)
      throw Error(name + ": libfreenect cannot start; is USB accessible?");
    freenect_set_log_level(context_, FREENECT_LOG_ERROR);
    freenect_set_log_callback(context_, keep_complaint);
    freenect_select_subdevices(
        context_, static_cast<freenect_device_flags>(FREENECT_DEVICE_CAMERA | FREENECT_DEVICE_MOTOR));
  }
  ~FreenectContext() { freenect_shutdown(context_); }
  FreenectContext(const FreenectContext&) = delete;
  FreenectContext& operator=(const FreenectContext&) = delete;
  [[nodiscard]] freenect_context* get() const { return context_; }

 private:
  freenect_context* context_ = nullptr;
};

/// Returns the serial of the camera with that number; empty if ambiguous. libfreenect lists only cameras that
/// it can open, so indices in the list match the numbers only if no camera is missing.
std::string serial_of(freenect_context* context, int number) {
  if (!freenect_list_device_attributes) return {};
  freenect_device_attributes* list = nullptr;
  const int listed = freenect_list_device_attributes(context, &list);
  std::vector<std::string> serials;
  for (const freenect_device_attributes* device = list; device; device = device->next)
    serials.emplace_back(device->camera_serial ? device->camera_serial : "");
  if (list) freenect_free_device_attributes(list);
  if (listed != freenect_num_devices(context) || number >= listed ||
      listed != static_cast<int>(serials.size()))
    return {};
  const std::string& serial = serials[static_cast<std::size_t>(number)];
  return std::count(serials.begin(), serials.end(), serial) == 1 ? serial : std::string{};
}

std::string why_not_opened() {
  const auto complains = [](const char* of) { return complaint.find(of) != std::string::npos; };
  if (complains("BUSY")) return "another program uses it; end that program";
  if (complains("ACCESS"))
    return "this user lacks permission; install libfreenect0.5, which brings the udev rule, then unplug it "
           "and "
           "plug it in again, or join the group plugdev";
  return "does another program use it, or does this user lack permission (udev rule 60-libfreenect, group "
         "plugdev)?" +
         (complaint.empty() ? std::string{} : " libfreenect says: " + complaint);
}

freenect_depth_format format_of(KinectDepth depth) {
  switch (depth) {
    case KinectDepth::kRaw:
      return FREENECT_DEPTH_11BIT;
    case KinectDepth::kMillimetres:
      return FREENECT_DEPTH_MM;
    case KinectDepth::kRegistered:
      return FREENECT_DEPTH_REGISTERED;
  }
  return FREENECT_DEPTH_11BIT;
}

/// Samples libfreenect's own mapping of depth pixels to colour pixels. Source: registration.c,
/// freenect_map_rgb_to_depth.
std::vector<SeenByBoth> sampled(const freenect_registration& registration) {
  constexpr double kScale = 256.0;  // fixed-point scale of the table's x
  constexpr int kStep_px = 40;
  std::vector<SeenByBoth> seen_by_both;
  for (const int depth_mm : {600, 800, 1200, 2000, 3500, 6000})
    for (int y = kStep_px / 2; y < kHeight; y += kStep_px)
      for (int x = kStep_px / 2; x < kWidth; x += kStep_px) {
        const std::int32_t* at = registration.registration_table[y * kWidth + x];
        const double u = (at[0] + registration.depth_to_rgb_shift[depth_mm]) / kScale;
        const double v = at[1] - registration.reg_pad_info.start_lines;
        if (u < 0 || v < 0 || u >= kWidth || v >= kHeight) continue;
        seen_by_both.push_back({{x, y}, depth_mm / 1000.0, {u, v}});
      }
  return seen_by_both;
}

class FreenectDevice final : public KinectDevice {
 public:
  explicit FreenectDevice(const KinectRequest& request)
      : name_("kinect:" + std::to_string(request.number)), listener_(request.listener), context_(name_) {
    const int devices = freenect_num_devices(context_.get());
    const bool by_serial = !request.serial.empty();
    if (!by_serial && (request.number < 0 || request.number >= devices))
      throw Error(name_ + ": there is no such Kinect; libfreenect sees " +
                  std::to_string(std::max(devices, 0)) +
                  ", counted from 0. Is it plugged into USB and into its own power supply? roomradar doctor "
                  "looks further");
    serial_ = by_serial ? request.serial : serial_of(context_.get(), request.number);
    const int opened = by_serial
                           ? freenect_open_device_by_camera_serial(context_.get(), &device_, serial_.c_str())
                           : freenect_open_device(context_.get(), &device_, request.number);
    if (opened < 0) throw Error(name_ + ": cannot be opened: " + why_not_opened());
    try {
      start(request);
    } catch (...) {
      close();
      throw;
    }
  }
  ~FreenectDevice() override { close(); }

  bool serve(double patience_s) override {
    timeval patience{.tv_sec = 0, .tv_usec = static_cast<suseconds_t>(patience_s * 1e6)};
    const int result = freenect_process_events_timeout(context_.get(), &patience);
    return result >= 0 || (result == kInterrupted && !replayed_folder());
  }

  void ask_acceleration() override { has_acceleration_ = freenect_update_tilt_state(device_) >= 0; }

  [[nodiscard]] std::optional<Eigen::Vector3d> acceleration_g() const override {
    const freenect_raw_tilt_state* tilt = freenect_get_tilt_state(device_);
    if (!tilt || !has_acceleration_) return std::nullopt;
    return Eigen::Vector3d(tilt->accelerometer_x, tilt->accelerometer_y, tilt->accelerometer_z) /
           kKinectCountsPerG;
  }

  [[nodiscard]] std::string serial() const override { return serial_; }

  [[nodiscard]] std::optional<KinectConstants> constants() const override {
    if (!freenect_copy_registration) return std::nullopt;
    freenect_registration registration = freenect_copy_registration(device_);
    const freenect_zero_plane_info& plane = registration.zero_plane_info;
    std::optional<KinectConstants> constants;
    if (registration.registration_table && registration.depth_to_rgb_shift && plane.reference_distance > 0)
      constants = {{plane.reference_distance, plane.reference_pixel_size, plane.dcmos_emitter_dist,
                    registration.const_shift},
                   sampled(registration)};
    freenect_destroy_registration(&registration);
    return constants;
  }

 private:
  void start(const KinectRequest& request) {
    if (request.depth != KinectDepth::kRaw && replayed_folder())
      throw Error(name_ + ": fakenect replays raw depth only; leave out ?depth=");
    const auto depth_mode = freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM, format_of(request.depth));
    const auto video_mode = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
    if (!depth_mode.is_valid || !video_mode.is_valid)
      throw Error(name_ + ": this libfreenect does not have the requested mode; use ?depth=raw");
    depth_pixels_ = static_cast<std::size_t>(depth_mode.bytes) / sizeof(std::uint16_t);
    colour_bytes_ = static_cast<std::size_t>(video_mode.bytes);
    freenect_set_user(device_, this);
    freenect_set_depth_callback(device_, [](freenect_device* device, void* pixels, std::uint32_t ticks) {
      const auto& self = *static_cast<FreenectDevice*>(freenect_get_user(device));
      self.listener_.on_depth({static_cast<const std::uint16_t*>(pixels), self.depth_pixels_}, ticks);
    });
    freenect_set_video_callback(device_, [](freenect_device* device, void* pixels, std::uint32_t ticks) {
      const auto& self = *static_cast<FreenectDevice*>(freenect_get_user(device));
      self.listener_.on_colour({static_cast<const std::uint8_t*>(pixels), self.colour_bytes_}, ticks);
    });
    const bool started = freenect_set_depth_mode(device_, depth_mode) >= 0 &&
                         freenect_set_video_mode(device_, video_mode) >= 0 &&
                         freenect_start_depth(device_) >= 0 && freenect_start_video(device_) >= 0;
    if (!started) throw Error(name_ + ": its cameras cannot be started; unplug it and plug it in again");
  }

  void close() {
    freenect_stop_depth(device_);
    freenect_stop_video(device_);
    freenect_close_device(device_);
  }

  const std::string name_;
  const KinectListener listener_;
  FreenectContext context_;
  freenect_device* device_ = nullptr;
  std::string serial_;
  std::size_t depth_pixels_ = 0;
  std::size_t colour_bytes_ = 0;
  bool has_acceleration_ = true;  // false until a device's first reading (zero before); true for a replay
};

}  // namespace

std::unique_ptr<KinectDevice> open_freenect(const KinectRequest& request) {
  return std::make_unique<FreenectDevice>(request);
}

int count_kinects() {
  freenect_context* context = nullptr;
  if (freenect_init(&context, nullptr) < 0) return 0;
  freenect_set_log_level(context, FREENECT_LOG_FATAL);
  const int devices = freenect_num_devices(context);
  freenect_shutdown(context);
  return std::max(devices, 0);
}

std::optional<std::filesystem::path> replayed_folder() {
  const bool is_fakenect = freenect_copy_registration == nullptr;
  const char* path = std::getenv(kFakenectPath);
  if (!is_fakenect || path == nullptr) return std::nullopt;
  return path;
}

}  // namespace roomradar
