// tum_rgbd.hpp: recordings in the TUM RGB-D format, roomradar's own among them.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the folder contains depth.txt or rgb.txt.
[[nodiscard]] bool is_tum_rgbd(const std::filesystem::path& folder);

/// States the frames of a recording in the TUM RGB-D format:
///   depth.txt          stamp and file of each depth image (16 bit, 1/5000 m), registered to colour
///   rgb.txt            stamp and file of each colour image; optional
///   groundtruth.txt    stamp tx ty tz qx qy qz qw; optional
///   accelerometer.txt  stamp ax ay az (m/s^2); optional
///
/// File names may contain blanks. Lines that are not a stamp and a file of this folder are left out, and
/// counted. Cameras are those of a Kinect v1, or of the Xtion of BONN's dataset for folders rgbd_bonn_*.
/// @throws Error if depth.txt is missing, or rgb.txt is although there is a folder rgb
RecordingFacts index_tum_rgbd(const std::filesystem::path& folder);

}  // namespace roomradar
