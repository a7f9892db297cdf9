// kinect_usb.hpp: lists Kinects on the USB bus through Linux sysfs, without a driver.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

constexpr const char* kKinectForXbox = "Kinect for Xbox 360";
constexpr const char* kKinectForWindows = "Kinect for Windows";

/// The camera of a Kinect v1 on the USB bus. A Kinect consists of three USB devices: camera, motor, and
/// microphones.
struct KinectOnUsb {
  /// False if a motor or microphones are on the bus, but no camera: USB powers only the motor, and the other
  /// devices need the power supply. The fields below are then unknown.
  bool has_camera = true;
  /// Model: one of the constants above.
  std::string model;
  int bus = 0;
  /// Speed of the connection: 480 if it is correct; 0: unknown.
  double speed_mbit_s = 0.0;
  /// Device node that libfreenect opens: /dev/bus/usb/BBB/DDD.
  std::filesystem::path node;
  /// True if this user may read and write the node.
  bool may_open = false;
  /// Driver bound to the camera, for example gspca_kinect; empty: none.
  std::string kernel_driver;
  /// True if the motor and microphones of the same Kinect, which need the power supply, are on the bus.
  std::optional<bool> has_power;
};

/// Lists all Kinects in the files under /sys/bus/usb/devices. The list is empty if there are no such files.
/// Values that cannot be read are omitted. Never throws.
/// @param sys_devices  replaces /sys/bus/usb/devices, for tests
/// @param dev_usb      replaces /dev/bus/usb, for tests
std::vector<KinectOnUsb> kinects_on_usb(const std::filesystem::path& sys_devices = "/sys/bus/usb/devices",
                                        const std::filesystem::path& dev_usb = "/dev/bus/usb");

}  // namespace roomradar
