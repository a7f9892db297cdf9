// fakenect_dump.hpp: recordings of a Kinect made by libfreenect's `fakenect-record`.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns true if the folder contains INDEX.txt.
[[nodiscard]] bool is_fakenect_dump(const std::filesystem::path& folder);

/// A line of INDEX.txt, such as d-1313283822.781270-3018607296.pgm.
struct FakenectLine {
  char kind = 0;            ///< d: depth, r: colour, a: accelerometer
  std::uint32_t ticks = 0;  ///< the device's stamp
};

/// Returns nullopt for a line that is not of the form d-TIME-STAMP.pgm, r-TIME-STAMP.ppm or
/// a-TIME-STAMP.dump, with the recorder's time of day in s.
std::optional<FakenectLine> parse_fakenect_line(std::string_view line);

/// States the frames of a folder that libfreenect recorded: INDEX.txt lists d-*.pgm (raw 11 bit depth),
/// r-*.ppm (colour) and a-*.dump (accelerometer) in the order of arrival. Colour images are paired with depth
/// images in this order, so the pairs are those of the live device. Lines of another form are left out, and
/// counted.
/// @throws Error if INDEX.txt cannot be read
RecordingFacts index_fakenect_dump(const std::filesystem::path& folder);

}  // namespace roomradar
