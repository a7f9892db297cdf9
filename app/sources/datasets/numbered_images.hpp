// numbered_images.hpp: folders of numbered images, and ScanNet's exports.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the folder contains a folder depth.
[[nodiscard]] bool is_numbered_images(const std::filesystem::path& folder);

/// States the frames of a folder of numbered images:
///   depth/N.png    mm
///   color/N.jpg    or .png, also in the folder colour or rgb
///   pose/N.txt     4 x 4 matrix, camera to world (m), not finite where tracking was lost; optional
///   intrinsic/intrinsic_depth.txt, intrinsic_color.txt, extrinsic_depth.txt, extrinsic_color.txt
///                  4 x 4 matrices of the cameras and of their places on the device; optional
///
/// pose and intrinsic are those of an export by ScanNet's SensReader. Stamps are N / 30 s. Without intrinsic,
/// the cameras are those of one particular device.
/// Source: ScanNet, SensReader/python/SensorData.py, export_poses() and export_intrinsics().
RecordingFacts index_numbered_images(const std::filesystem::path& folder);

}  // namespace roomradar
