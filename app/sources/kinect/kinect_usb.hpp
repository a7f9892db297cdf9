// kinect_usb.hpp: lists Kinects on the USB bus through Linux sysfs, without a driver.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

constexpr const char* kKinectForXbox = "Kinect for Xbox 360";
constexpr const char* kKinectForWindows = "Kinect for Windows";

/// The camera of a Kinect v1, one of the three USB devices in a Kinect.
struct KinectOnUsb {
  /// false: a motor or microphones are on the bus, but no camera. USB powers only the motor; the rest needs
  /// the power supply. The fields below are then unknown.
  bool has_camera = true;
  std::string model;  ///< one of the constants above
  int bus = 0;
  double speed_mbit_s = 0.0;   ///< 480 if all is well; 0: unknown
  std::filesystem::path node;  ///< device node that libfreenect opens, /dev/bus/usb/BBB/DDD
  bool may_open = false;       ///< this user may read and write the node
  std::string kernel_driver;   ///< driver bound to the camera, such as gspca_kinect; empty: none
  /// True if its motor and microphones, which need the power supply, are on the bus.
  std::optional<bool> has_power;
};

/// Lists all Kinects from the files under /sys/bus/usb/devices; empty if there are no such files. Omits
/// values that cannot be read. Never throws.
/// @param sys_devices  replaces /sys/bus/usb/devices
/// @param dev_usb      replaces /dev/bus/usb
std::vector<KinectOnUsb> kinects_on_usb(const std::filesystem::path& sys_devices = "/sys/bus/usb/devices",
                                        const std::filesystem::path& dev_usb = "/dev/bus/usb");

}  // namespace roomradar
