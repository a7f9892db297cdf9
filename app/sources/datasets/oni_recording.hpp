// oni_recording.hpp: recordings of OpenNI and OpenNI2 as frames.
#pragma once
#include <filesystem>

#include "app/sources/datasets/indexed_source.hpp"

namespace roomradar {

/// Lists the frames of a .oni file: depth (16zT, 16zP or raw; mm, or 0.1 mm), colour (JPEG or raw RGB, YUV,
/// grey). Cameras follow from the recorded field of view, else from a PrimeSense's, 58.6 degrees. For depth
/// that is not registered, the depth camera is assumed to be 2.5 cm beside the colour camera. Mirrored images
/// are mirrored back.
/// @throws Error naming the file if it is damaged, or holds no depth
IndexedRecording index_oni_recording(const std::filesystem::path& path);

}  // namespace roomradar
