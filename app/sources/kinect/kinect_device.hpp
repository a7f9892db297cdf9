// kinect_device.hpp: the boundary behind which a Kinect stands: libfreenect's, or one that a test scripts.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "app/sources/formats/source_options.hpp"
#include "app/sources/kinect/kinect_rig.hpp"

namespace roomradar {

/// What a device calls from within KinectDevice::serve(), with the images as they lie in its own memory and
/// the 32 bit stamps of its clock.
struct KinectListener {
  /// 640 x 480 numbers as KinectDepth says; another size is a broken image.
  std::function<void(std::span<const std::uint16_t> pixels, std::uint32_t ticks)> on_depth;
  /// 640 x 480 pixels of red, green, blue.
  std::function<void(std::span<const std::uint8_t> bytes, std::uint32_t ticks)> on_colour;
};

/// A device that was opened and sends images; the destructor stops and closes it. All calls come from one
/// thread.
class KinectDevice {
 public:
  KinectDevice() = default;
  KinectDevice(const KinectDevice&) = delete;
  KinectDevice& operator=(const KinectDevice&) = delete;
  virtual ~KinectDevice() = default;

  /// Hands what has arrived to the listener, waiting for it for as long as `patience_s` if there is nothing.
  /// False: the device has gone, or its replay has come to the end.
  virtual bool serve(double patience_s) = 0;
  /// Asks the device for its accelerometer's state. Not to be called by the listener.
  virtual void ask_acceleration() = 0;
  /// What it answered last, in g; nothing if it did not.
  [[nodiscard]] virtual std::optional<Eigen::Vector3d> acceleration_g() const = 0;
  /// Of the camera, where it can be told: the same device has it again after it was plugged in anew.
  [[nodiscard]] virtual std::string serial() const = 0;
  [[nodiscard]] virtual std::optional<KinectConstants> constants() const = 0;
};

struct KinectWish {
  int number = 0;      ///< among those plugged in, from 0
  std::string serial;  ///< if not empty: this one, whatever its number is by now
  KinectDepth depth = KinectDepth::kRaw;
  KinectListener listener;
};

/// Opens and starts a device. Throws Error with what is in the way and what to do.
using KinectOpener = std::function<std::unique_ptr<KinectDevice>(const KinectWish&)>;

}  // namespace roomradar
