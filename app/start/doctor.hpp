// doctor.hpp: checks Kinects, renderer and fakenect, and gives advice on repairs.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/sources/kinect/kinect_usb.hpp"

namespace roomradar {

enum class Health {
  kGood,
  kMissing,  ///< an optional component is absent
  kBad,      ///< a fault that must be repaired
};

struct Finding {
  Health health = Health::kGood;
  std::string what;        ///< sentence on what was found
  std::string what_to_do;  ///< sentence with advice; empty if `health` is kGood
};

/// Checks permission, port, power supply and kernel driver of each Kinect on the USB bus. Compares their
/// number with that of libfreenect.
/// @param seen_by_libfreenect  result of count_kinects()
std::vector<Finding> judge_kinects(const std::vector<KinectOnUsb>& on_usb, int seen_by_libfreenect);

/// Checks the recording that fakenect replays in place of a Kinect.
Finding judge_replay(const std::filesystem::path& recording);

/// Checks that an OpenGL renderer exists, and its max image size.
Finding judge_renderer();

/// Checks that the program `fakenect` is in a folder of `path`, a list of folders in the syntax of $PATH.
Finding judge_fakenect(const std::string& path);

/// Makes all checks, beginning with the Kinects or their replay. Takes up to a second.
std::vector<Finding> check_setup();

}  // namespace roomradar
