// seven_scenes.hpp: recordings in the form of the 7-Scenes dataset.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if a file in the folder is named like those of 7-Scenes.
[[nodiscard]] bool is_seven_scenes(const std::filesystem::path& folder);

/// States the frames of a folder in the form of 7-Scenes, also of ScanNet's SensReader, 3RScan, BundleFusion:
///   frame-XXXXXX.depth.png  or .pgm (16 bit, big-endian), mm
///   frame-XXXXXX.color.jpg  or .png; .none: the frame was recorded without colour
///   frame-XXXXXX.pose.txt   4 x 4 matrix, camera to world (m); optional
///   _info.txt               or info.txt: m_depthShift (units per metre), sizes and 4 x 4 matrices of the
///   cameras
///                           and of their places on the device; optional
///
/// Stamps are XXXXXX / 30 s. Without _info.txt, cameras are those of the dataset's Kinect v1.
/// Source: ScanNet, SensReader/c++/src/sensorData.h, saveToImages().
RecordingFacts index_seven_scenes(const std::filesystem::path& folder);

/// Reads a pose, a 4 x 4 or 3 x 4 matrix. Its rotation is replaced by the nearest exact one; rotations in
/// recordings deviate by about 1e-4. A matrix with its translation in the last row is transposed. A file that
/// is missing, empty or no rigid transform gives a StatedPose with a fault.
StatedPose read_pose_file(const std::filesystem::path& path);

}  // namespace roomradar
