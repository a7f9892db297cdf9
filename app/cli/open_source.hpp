// open_source.hpp: opens the frame source that a user has specified.
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
/// source's folder. calibration.json is ignored in recordings of other programs. Returns an empty path if
/// there is no calibration file.
std::filesystem::path calibration_for(const std::string& source, const std::filesystem::path& chosen);

/// Returns true if lens and depth errors are corrected in the frames of open_source(). The correction takes
/// place in open_source(), with the file of calibration_for(), or took place before recording. Throws Error
/// if the recording's camera.json or session.json cannot be read.
bool gives_calibrated_frames(const std::string& source, const std::filesystem::path& chosen);

/// Opens `kinect:N[?depth=raw|mm|registered]`, `openni:N`, `sim:ROOM[?key=value&...]`, or a file or folder.
/// Files and folders contain a recording or a recorded session, recognised by content. If `frames` is set,
/// the source delivers only that range. If calibration_for() finds a file, the source corrects lens and depth
/// errors. Recordings and simulated frames are read one frame ahead, on a second thread.
///
/// @throws Error with a list of the kinds of source if `source` is none of them. Also throws if the frames
///         would be corrected twice, or if source or calibration cannot be opened
std::unique_ptr<FrameSource> open_source(const std::string& source, const std::optional<FrameRange>& frames,
                                         const std::filesystem::path& calibration = {},
                                         const SourceOptions& options = {});

/// Throws Error if the map was scanned from frames without recorded poses. The map's world frame is then
/// unrelated to the poses of recordings.
/// @param map     name of the map in the error message
/// @param source  name of the source in the error message
void require_recorded_world(const MapInfo& info, const std::string& map, const std::string& source);

}  // namespace roomradar
