// kinect_usb.hpp: lists Kinects on the USB bus through Linux sysfs, without a driver.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

constexpr const char* kKinectForXbox = "Kinect for Xbox 360";
constexpr const char* kKinectForWindows = "Kinect for Windows";

/// A Kinect v1 on the USB bus. It consists of three USB devices: camera, motor and microphones.
struct KinectOnUsb {
  /// False if a motor or microphones are on the bus without a camera. The fields below are then unknown. USB
  /// powers only the motor. Camera and microphones need the Kinect's power supply.
  bool has_camera = true;
  /// Model: one of the constants above.
  std::string model;
  int bus = 0;
  /// Speed of the camera's connection. Should be 480. 0: unknown.
  double speed_mbit_s = 0.0;
  /// Device node that libfreenect opens: /dev/bus/usb/BBB/DDD.
  std::filesystem::path node;
  /// True if the current user may read and write `node`.
  bool may_open = false;
  /// Kernel driver bound to the camera, such as gspca_kinect; empty: none.
  std::string kernel_driver;
  /// True if a Kinect's motor or microphones are on the bus, too. Unset if there are several cameras.
  std::optional<bool> has_power;
};

/// Lists all Kinects found under /sys/bus/usb/devices. Returns an empty list if the folder does not exist.
/// Values that cannot be read keep their defaults. Never throws.
/// @param sys_devices  replaces /sys/bus/usb/devices, for tests
/// @param dev_usb      replaces /dev/bus/usb, for tests
std::vector<KinectOnUsb> kinects_on_usb(const std::filesystem::path& sys_devices = "/sys/bus/usb/devices",
                                        const std::filesystem::path& dev_usb = "/dev/bus/usb");

}  // namespace roomradar
