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

/// Callbacks of KinectDevice::serve(). Images are in the device's buffers, valid during the call. `ticks` is
/// the 32 bit stamp of the device's clock.
struct KinectListener {
  /// Called per depth image, with 640 x 480 values in the requested KinectDepth mode. Any other number
  /// of values means a broken image.
  std::function<void(std::span<const std::uint16_t> pixels, std::uint32_t ticks)> on_depth;
  /// Called per colour image, with 640 x 480 RGB pixels of 3 bytes.
  std::function<void(std::span<const std::uint8_t> bytes, std::uint32_t ticks)> on_colour;
};

/// An open device that sends images. The destructor stops and closes the device. Not thread safe: all calls
/// must come from one thread.
class KinectDevice {
 public:
  KinectDevice() = default;
  KinectDevice(const KinectDevice&) = delete;
  KinectDevice& operator=(const KinectDevice&) = delete;
  virtual ~KinectDevice() = default;

  /// Passes images that have arrived to the listener. Waits up to `patience_s` for an image. Returns false if
  /// the device was disconnected or its replay has ended.
  virtual bool serve(double patience_s) = 0;
  /// Reads the device's accelerometer and stores the reading for acceleration_g(). Must not be called by the
  /// listener.
  virtual void ask_acceleration() = 0;
  /// Returns the last accelerometer reading, g, or nullopt if there is none.
  [[nodiscard]] virtual std::optional<Eigen::Vector3d> acceleration_g() const = 0;
  /// Returns the camera's serial number, or an empty string if unknown. The number identifies the device when
  /// it is reconnected.
  [[nodiscard]] virtual std::string serial() const = 0;
  /// Returns the device's factory calibration, or nullopt if unknown.
  [[nodiscard]] virtual std::optional<KinectConstants> constants() const = 0;
};

struct KinectRequest {
  /// Index among the connected devices, from 0.
  int number = 0;
  /// Serial number. If not empty, selects the device instead of `number`.
  std::string serial;
  KinectDepth depth = KinectDepth::kRaw;
  KinectListener listener;
};

/// Function that opens and starts a device. Throws Error with the cause and a remedy.
using KinectOpener = std::function<std::unique_ptr<KinectDevice>(const KinectRequest&)>;

}  // namespace roomradar
