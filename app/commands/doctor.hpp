// doctor.hpp: checks Kinects, renderer and fakenect, with advice on repairs.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/sources/kinect/kinect_usb.hpp"

namespace roomradar {

enum class Health {
  kGood,
  kMissing,  ///< absent, but optional
  kBad,      ///< must be repaired
};

struct Finding {
  Health health = Health::kGood;
  std::string what;        ///< what was found, a sentence
  std::string what_to_do;  ///< advice, a sentence; empty if good
};

/// Checks the Kinects on the USB bus against the number that libfreenect sees (negative: this program was
/// built without it).
std::vector<Finding> judge_kinects(const std::vector<KinectOnUsb>& on_usb, int seen_by_libfreenect);

/// Checks the recording that fakenect replays in place of a Kinect.
Finding judge_replay(const std::filesystem::path& recording);

/// Checks that there is a renderer, and the max size of its images.
Finding judge_renderer();

/// Checks whether the program `fakenect` is in the folders of `path`, which has the form of $PATH.
Finding judge_fakenect(const std::string& path);

}  // namespace roomradar
