// openni_source.cpp: images of OpenNI2's streams, paired by their stamps.
#include "app/sources/kinect/openni_source.hpp"

#include <OpenNI.h>

#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "app/sources/formats/nominal_rig.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/raw_pixels.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kSilence_ms = 1000;

/// Returns OpenNI2's last error message, as the end of a sentence.
std::string last_openni_error() {
  std::string text = openni::OpenNI::getExtendedError();
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  while (!text.empty() && (text.front() == '\t' || text.front() == ' ')) text.erase(0, 1);
  return text.empty() ? "OpenNI2 gives no reason" : text;
}

/// Returns the URI of a device given by number or URI.
std::string uri_of(const std::string& device) {
  const auto number = parse_whole_number(device);
  if (!number) return device;
  openni::Array<openni::DeviceInfo> devices;
  openni::OpenNI::enumerateDevices(&devices);
  if (*number < 0 || *number >= devices.getSize())
    throw Error("openni:" + device + ": is not plugged in; OpenNI2 finds " +
                std::to_string(devices.getSize()) +
                " devices, counted from 0. Plug it in, or give another number");
  return devices[static_cast<int>(*number)].getUri();
}

/// Chooses 640 x 480 at 30 Hz, if the stream has it.
void choose_mode(openni::VideoStream& stream, openni::PixelFormat format) {
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  for (int i = 0; i < modes.getSize(); ++i)
    if (modes[i].getResolutionX() == 640 && modes[i].getResolutionY() == 480 && modes[i].getFps() == 30 &&
        modes[i].getPixelFormat() == format) {
      stream.setVideoMode(modes[i]);
      return;
    }
}

Intrinsics camera_of(const openni::VideoStream& stream) {
  const openni::VideoMode mode = stream.getVideoMode();
  return openni_camera({mode.getResolutionX(), mode.getResolutionY()},
                       static_cast<double>(stream.getHorizontalFieldOfView()));
}

std::string_view bytes_of(const openni::VideoFrameRef& image) {
  return {static_cast<const char*>(image.getData()), static_cast<std::size_t>(image.getDataSize())};
}

RawLayout layout_of_image(const openni::VideoFrameRef& image) {
  return {image.getWidth(), image.getHeight(), static_cast<std::size_t>(image.getStrideInBytes())};
}

/// Starts the library once per process. It is never shut down: threads of some drivers outlive their streams,
/// and would execute the code of an unloaded driver.
void start_library() {
  static const bool is_started = openni::OpenNI::initialize() == openni::STATUS_OK;
  if (!is_started) throw Error("OpenNI2 cannot be started: " + last_openni_error());
}

class OpenniSource final : public FrameSource {
 public:
  OpenniSource(const std::string& device, const SourceOptions& options)
      : name_("openni:" + device), timeout_s_(options.device_timeout_s) {
    start_library();
    if (device_.open(uri_of(device).c_str()) != openni::STATUS_OK)
      throw Error(name_ + ": cannot be opened: " + last_openni_error());
    start(depth_, openni::SENSOR_DEPTH, openni::PIXEL_FORMAT_DEPTH_1_MM);
    if (!depth_.isValid()) throw Error(name_ + ": delivers no depth: " + last_openni_error());
    start(colour_, openni::SENSOR_COLOR, openni::PIXEL_FORMAT_RGB888);
    depth_camera_ = camera_of(depth_);
    if (colour_.isValid()) {
      colour_camera_ = camera_of(colour_);
      const auto mode = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
      const bool is_registered = device_.isImageRegistrationModeSupported(mode) &&
                                 device_.setImageRegistrationMode(mode) == openni::STATUS_OK;
      if (!is_registered)
        T_colour_depth_.translation().x() = -kPrimeSenseBaseline_m;
      else if (colour_camera_.width_px == depth_camera_.width_px)
        depth_camera_ = colour_camera_;
    }
    if (options.depth_camera) depth_camera_ = *options.depth_camera;
    require_valid(depth_camera_, (name_ + ", depth camera").c_str());
  }

  ~OpenniSource() override {
    depths_.clear();  // images belong to their streams
    colours_.clear();
    for (openni::VideoStream* stream : {&depth_, &colour_})
      if (stream->isValid()) {
        stream->stop();
        stream->destroy();
      }
    device_.close();
  }

  ReadResult next(Frame& frame) override {
    for (;;) {
      if (const auto pair = pairing_.take()) {
        const auto depth = depths_.extract(pair->depth);
        if (pair->stamp_goes_back || depth.empty()) continue;
        const auto colour = pair->colour ? colours_.find(*pair->colour) : colours_.end();
        fill(depth.mapped(), colour == colours_.end() ? nullptr : &colour->second, *pair, frame);
        colours_.erase(colours_.begin(), colour == colours_.end() ? colours_.begin() : std::next(colour));
        return {ReadStatus::kFrame, {}};
      }
      if (!wait_for_image()) return waited();
      silent_s_ = 0.0;
    }
  }

  bool rewind() override { return false; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string name() const override { return name_; }

 private:
  void start(openni::VideoStream& stream, openni::SensorType sensor, openni::PixelFormat format) {
    if (!device_.hasSensor(sensor) || stream.create(device_, sensor) != openni::STATUS_OK) return;
    choose_mode(stream, format);
    stream.setMirroringEnabled(false);
    if (stream.start() != openni::STATUS_OK) stream.destroy();
  }

  /// Waits for an image and adds it to the pairing. Returns false if none comes in time.
  bool wait_for_image() {
    openni::VideoStream* streams[] = {&depth_, &colour_};
    int ready = -1;
    if (openni::OpenNI::waitForAnyStream(streams, colour_.isValid() ? 2 : 1, &ready, kSilence_ms) !=
        openni::STATUS_OK)
      return false;
    openni::VideoFrameRef image;
    if (streams[ready]->readFrame(&image) != openni::STATUS_OK || !image.isValid()) return false;
    const double stamp_s = 1e-6 * static_cast<double>(image.getTimestamp());
    if (ready == 0) {
      if (!first_index_) first_index_ = image.getFrameIndex();
      depths_[depth_count_] = image;
      pairing_.add_depth(depth_count_++, stamp_s);
    } else {
      colours_[colour_count_] = image;
      if (colours_.size() > kColoursKept) colours_.erase(colours_.begin());
      pairing_.add_colour(colour_count_++, stamp_s);
    }
    return true;
  }

  ReadResult waited() {
    silent_s_ += kSilence_ms * 1e-3;
    const std::string text =
        name_ + ": no depth image for " + std::to_string(static_cast<int>(silent_s_)) + " s";
    if (silent_s_ > timeout_s_) throw Error(text + "; check its cable, then begin again");
    return {ReadStatus::kWaiting, text + "; waiting for it"};
  }

  void fill(const openni::VideoFrameRef& depth, const openni::VideoFrameRef* colour,
            const DepthColourPair& pair, Frame& frame) const {
    frame.index = depth.getFrameIndex() - *first_index_;
    frame.stamp_s = 1e-6 * static_cast<double>(depth.getTimestamp());
    frame.colour_after_depth_s = colour ? pair.colour_after_depth_s : 0.0;
    frame.depth_camera = depth_camera_;
    frame.colour_camera = colour_camera_;
    frame.T_colour_depth = T_colour_depth_;
    frame.timing = {};
    frame.T_world_camera.reset();
    frame.down_camera.reset();
    const bool is_fine = depth.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM;
    convert_depth(bytes_of(depth), layout_of_image(depth), DepthPixels::kUint16, is_fine ? 0.0001 : 0.001,
                  name_, frame.depth_m);
    if (!colour) {
      frame.colour.resize(0, 0);
      return;
    }
    const openni::PixelFormat format = colour->getVideoMode().getPixelFormat();
    const ColourPixels pixels = format == openni::PIXEL_FORMAT_YUV422  ? ColourPixels::kUyvy
                                : format == openni::PIXEL_FORMAT_YUYV  ? ColourPixels::kYuyv
                                : format == openni::PIXEL_FORMAT_GRAY8 ? ColourPixels::kMono8
                                                                       : ColourPixels::kRgb8;
    convert_colour(bytes_of(*colour), layout_of_image(*colour), pixels, name_, frame.colour);
  }

  const std::string name_;
  const double timeout_s_;
  openni::Device device_;
  openni::VideoStream depth_, colour_;
  Intrinsics depth_camera_, colour_camera_;
  Eigen::Isometry3d T_colour_depth_ = Eigen::Isometry3d::Identity();
  StampPairing pairing_{kDevicePairing};
  std::map<std::int64_t, openni::VideoFrameRef> depths_, colours_;  // not yet paired, by number
  std::int64_t depth_count_ = 0, colour_count_ = 0;
  std::optional<int> first_index_;
  double silent_s_ = 0.0;
};

}  // namespace

std::unique_ptr<FrameSource> open_openni(const std::string& device, const SourceOptions& options) {
  return std::make_unique<OpenniSource>(device, options);
}

}  // namespace roomradar
