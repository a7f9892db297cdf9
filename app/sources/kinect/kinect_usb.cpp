// kinect_usb.cpp: reads the one-line sysfs files that Linux provides for each USB device.
#include "app/sources/kinect/kinect_usb.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
constexpr const char* kMicrosoft = "045e";

std::string line_of(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line.substr(0, 64);
}

std::string model_of(const std::string& product) {
  if (product == "02ae") return kKinectForXbox;
  if (product == "02bf") return kKinectForWindows;
  return {};
}

/// Returns true for a Kinect's motor or microphones.
bool is_companion(const std::string& product) {
  return product == "02b0" || product == "02ad" || product == "02bb" || product == "02be" ||
         product == "02c2" || product == "02c3";
}

/// Pads with zeros, "7" to "007"; returns an empty string if `text` is not a number.
std::string three_digits(const std::string& text) {
  int number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc{} || end != text.data() + text.size() || number < 1 || number > 999) return {};
  char digits[8];
  format_classic(digits, sizeof digits, "%03d", number);
  return digits;
}

/// Returns 0 if `text` is not a positive number.
double positive_number(const std::string& text) {
  double number = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  return fault == std::errc{} && end == text.data() + text.size() && number > 0.0 ? number : 0.0;
}

/// Returns the driver of the first interface that has one.
std::string kernel_driver_of(const fs::path& device) {
  std::error_code fault;
  for (fs::directory_iterator entry(device, fault), end; !fault && entry != end; entry.increment(fault)) {
    const fs::path driver = fs::read_symlink(entry->path() / "driver", fault);
    if (!fault && entry->path().filename().string().find(':') != std::string::npos)
      return driver.filename().string();
    fault.clear();
  }
  return {};
}

}  // namespace

std::vector<KinectOnUsb> kinects_on_usb(const fs::path& sys_devices, const fs::path& dev_usb) {
  std::vector<KinectOnUsb> kinects;
  bool companions = false;
  std::error_code fault;
  for (fs::directory_iterator entry(sys_devices, fault), end; !fault && entry != end;
       entry.increment(fault)) {
    const fs::path& device = entry->path();
    if (line_of(device / "idVendor") != kMicrosoft) continue;
    const std::string product = line_of(device / "idProduct");
    companions = companions || is_companion(product);
    const std::string model = model_of(product);
    if (model.empty()) continue;
    KinectOnUsb kinect;
    kinect.model = model;
    const std::string bus = three_digits(line_of(device / "busnum"));
    const std::string number = three_digits(line_of(device / "devnum"));
    if (bus.empty() || number.empty()) continue;
    kinect.bus = std::stoi(bus);
    kinect.speed_mbit_s = positive_number(line_of(device / "speed"));
    kinect.node = dev_usb / bus / number;
    kinect.may_open = access(kinect.node.c_str(), R_OK | W_OK) == 0;
    kinect.kernel_driver = kernel_driver_of(device);
    kinects.push_back(kinect);
  }
  for (KinectOnUsb& kinect : kinects)
    if (kinects.size() == 1) kinect.has_power = companions;  // else their owner is unknown
  if (kinects.empty() && companions) kinects.emplace_back().has_camera = false;
  std::sort(kinects.begin(), kinects.end(),
            [](const KinectOnUsb& a, const KinectOnUsb& b) { return a.node < b.node; });
  return kinects;
}

}  // namespace roomradar
