// kinect_device.hpp: interface to a Kinect, implemented by libfreenect and by scripted devices in tests.
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

/// Callbacks invoked within KinectDevice::serve(), with images in the device's own memory and the 32 bit
/// stamps of its clock.
struct KinectListener {
  /// 640 x 480 values in the chosen KinectDepth mode; any other size is a broken image.
  std::function<void(std::span<const std::uint16_t> pixels, std::uint32_t ticks)> on_depth;
  /// 640 x 480 pixels of red, green, blue.
  std::function<void(std::span<const std::uint8_t> bytes, std::uint32_t ticks)> on_colour;
};

/// An open device that sends images; the destructor stops and closes it. Not thread safe: all calls come from
/// one thread.
class KinectDevice {
 public:
  KinectDevice() = default;
  KinectDevice(const KinectDevice&) = delete;
  KinectDevice& operator=(const KinectDevice&) = delete;
  virtual ~KinectDevice() = default;

  /// Passes arrived images to the listener; waits up to `patience_s` if there are none. Returns false if the
  /// device has gone or its replay has ended.
  virtual bool serve(double patience_s) = 0;
  /// Reads the device's accelerometer. Must not be called by the listener.
  virtual void ask_acceleration() = 0;
  /// Returns the last accelerometer reading, g; nothing if there is none.
  [[nodiscard]] virtual std::optional<Eigen::Vector3d> acceleration_g() const = 0;
  /// Returns the camera's serial, or an empty string if unknown. The serial stays the same after the device
  /// was unplugged and plugged in again.
  [[nodiscard]] virtual std::string serial() const = 0;
  [[nodiscard]] virtual std::optional<KinectConstants> constants() const = 0;
};

struct KinectRequest {
  int number = 0;      ///< index among the connected devices, from 0
  std::string serial;  ///< if not empty: selects the device with this serial, whatever its index
  KinectDepth depth = KinectDepth::kRaw;
  KinectListener listener;
};

/// Opens and starts a device. Throws Error with the cause and a remedy.
using KinectOpener = std::function<std::unique_ptr<KinectDevice>(const KinectRequest&)>;

}  // namespace roomradar
