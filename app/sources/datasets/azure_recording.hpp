// azure_recording.hpp: recordings of Azure Kinect and Femto cameras, Matroska files of the k4arecorder.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Lists the frames of a Matroska file with the tracks DEPTH (16 bit big-endian, mm), COLOR (MJPG, NV12, YUY2
/// or BGRA; optional) and IMU (optional), and the attachment calibration.json. Depth and colour images each
/// have their own intrinsics and lens distortion. Gravity comes from the accelerometer.
/// @throws Error naming the file if it is damaged, has no depth track, or has an unusable calibration
RecordingFacts index_azure_recording(const std::filesystem::path& path);

}  // namespace roomradar
