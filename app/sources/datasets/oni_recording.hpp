// oni_recording.hpp: recordings of OpenNI and OpenNI2 as frames.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Lists the frames of a .oni file: depth (16zT, 16zP or raw; mm, or 0.1 mm), colour (JPEG or raw RGB, YUV,
/// grey). Intrinsics follow from the recorded horizontal field of view, or from a PrimeSense's (58.6 degrees)
/// if the file has none. If depth is not registered to colour, a baseline of 2.5 cm is assumed. Mirrored
/// images are mirrored back.
/// @throws Error naming the file if it is damaged, contains no depth, or its depth has another codec
RecordingFacts index_oni_recording(const std::filesystem::path& path);

}  // namespace roomradar
