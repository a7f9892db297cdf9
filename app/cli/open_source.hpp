// open_source.hpp: opens the frame source that a user names.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/sources/formats/frame_range.hpp"
#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

struct MapInfo;

/// Returns the calibration file for a source: the chosen one, or else calibration.json in the source's
/// folder; empty if there is none.
std::filesystem::path calibration_for(const std::string& source, const std::filesystem::path& chosen);

/// Returns true if open_source() delivers frames with lens and depth errors corrected, either by the file of
/// calibration_for() or before recording. Throws Error as reading the recording's description does.
bool gives_calibrated_frames(const std::string& source, const std::filesystem::path& chosen);

/// Opens `kinect:N[?depth=raw|mm|registered]`, `sim:ROOM[?key=value&...]`, or a folder with a recording or a
/// recorded session, recognised by its files. With `frames`, delivers only that range. With a calibration, or
/// a file calibration.json in the folder, frames are as if taken by ideal, calibrated cameras.
///
/// Throws Error listing the kinds of source if this is none of them, and Error if the frames would be
/// calibrated twice. Also throws whatever opening the source or the calibration throws.
std::unique_ptr<FrameSource> open_source(const std::string& source, const std::optional<FrameRange>& frames,
                                         const std::filesystem::path& calibration = {},
                                         const SourceOptions& options = {});

/// Throws Error if the map was scanned from frames without recorded poses: a recording's poses have no
/// meaning in its world.
/// @param map,source  names for the message
void require_recorded_world(const MapInfo& info, const std::string& map, const std::string& source);

}  // namespace roomradar
