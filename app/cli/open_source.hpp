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

/// Returns the calibration file for a source: `chosen` if it is not empty, otherwise calibration.json in the
/// source's folder. Returns an empty path if there is none.
std::filesystem::path calibration_for(const std::string& source, const std::filesystem::path& chosen);

/// Returns true if open_source() delivers frames whose lens and depth errors are corrected: either with the
/// file of calibration_for(), or because they were corrected before recording. Throws Error if the
/// recording's description cannot be read.
bool gives_calibrated_frames(const std::string& source, const std::filesystem::path& chosen);

/// Opens `kinect:N[?depth=raw|mm|registered]`, `sim:ROOM[?key=value&...]`, or a folder. A folder holds a
/// recording or a recorded session, recognised by its files. With `frames`, delivers only that range. With a
/// calibration file, or a file calibration.json in the folder, corrects lens and depth errors of the frames.
/// Recordings and simulated frames are read one frame ahead, on a second thread.
///
/// @throws Error listing the kinds of source if `source` is none of them, if the frames would be corrected
/// twice, or if source or calibration cannot be opened
std::unique_ptr<FrameSource> open_source(const std::string& source, const std::optional<FrameRange>& frames,
                                         const std::filesystem::path& calibration = {},
                                         const SourceOptions& options = {});

/// Throws Error if the map was scanned from frames without recorded poses: the map's world is then unrelated
/// to a recording's poses.
/// @param map     name of the map, for the message
/// @param source  name of the source, for the message
void require_recorded_world(const MapInfo& info, const std::string& map, const std::string& source);

}  // namespace roomradar
