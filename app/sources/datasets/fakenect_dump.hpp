// fakenect_dump.hpp: recordings of a Kinect made by libfreenect's `fakenect-record`.
#pragma once
#include <filesystem>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the folder contains INDEX.txt.
[[nodiscard]] bool is_fakenect_dump(const std::filesystem::path& folder);

/// States the frames of a folder that libfreenect recorded: INDEX.txt lists d-*.pgm (raw 11 bit depth),
/// r-*.ppm (colour) and a-*.dump (accelerometer) in the order of arrival. Colour images are paired with depth
/// images in this order, so the pairs are those of the live device. Lines of another form are left out, and
/// counted.
/// @throws Error if INDEX.txt cannot be read
RecordingFacts index_fakenect_dump(const std::filesystem::path& folder);

}  // namespace roomradar
