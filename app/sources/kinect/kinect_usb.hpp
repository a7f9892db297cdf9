// kinect_usb.hpp: Kinects on the USB bus as Linux sees them, before any driver is asked.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

constexpr const char* kKinectForXbox = "Kinect for Xbox 360";
constexpr const char* kKinectForWindows = "Kinect for Windows";

/// The camera of a Kinect v1, one of the three devices behind its plug.
struct KinectOnUsb {
  /// False: no camera is on the bus, but a motor or microphones are. USB alone powers the motor, the supply
  /// the rest. Then nothing below is known.
  bool has_camera = true;
  std::string model;  ///< one of the above
  int bus = 0;
  double speed_mbit_s = 0.0;   ///< 480 where all is well; 0: not known
  std::filesystem::path node;  ///< what libfreenect must open, /dev/bus/usb/BBB/DDD
  bool may_open = false;       ///< whether this user may read and write it
  std::string kernel_driver;   ///< what holds it, such as gspca_kinect; empty: nothing does
  std::optional<bool>
      has_power;  ///< whether its motor and microphones are there, which need the power supply
};

/// All Kinects, by the files under /sys/bus/usb/devices; none where there are no such files. What cannot be
/// read is left out. Never throws.
/// @param sys_devices  in the place of /sys/bus/usb/devices
/// @param dev_usb      in the place of /dev/bus/usb
std::vector<KinectOnUsb> kinects_on_usb(const std::filesystem::path& sys_devices = "/sys/bus/usb/devices",
                                        const std::filesystem::path& dev_usb = "/dev/bus/usb");

}  // namespace roomradar
