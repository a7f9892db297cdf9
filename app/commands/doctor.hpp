// doctor.hpp: what of a set-up works, what does not, and what to do about it, in words.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/sources/kinect/kinect_usb.hpp"

namespace roomradar {

enum class Health {
  kGood,
  kMissing,  ///< something that not everybody needs
  kBad,      ///< something that has to be mended
};

struct Finding {
  Health health = Health::kGood;
  std::string what;        ///< a sentence
  std::string what_to_do;  ///< empty if good
};

/// What the Kinects on the bus, and the number of them that libfreenect sees (negative: this program was
/// built without it), say together.
std::vector<Finding> judge_kinects(const std::vector<KinectOnUsb>& on_usb, int seen_by_libfreenect);

/// What fakenect replays in the place of a Kinect, and what is broken in it.
Finding judge_replay(const std::filesystem::path& recording);

/// Whether there is a renderer, which, and how large the images are that it draws.
Finding judge_renderer();

/// Whether the program that replays recordings as if they were a Kinect can be found in the folders of
/// `path`, which is written as $PATH is.
Finding judge_fakenect(const std::string& path);

}  // namespace roomradar
