// open_source.hpp: from what the user calls a source to its frames.
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

/// The calibration file that frames of a source are seen with: the one chosen, else calibration.json in the
/// source's folder; empty: none.
std::filesystem::path calibration_for(const std::string& source, const std::filesystem::path& chosen);

/// Whether frames that open_source gives are freed of lens and depth errors: by calibration_for's file, or
/// before they were recorded. Throws Error as reading the recording's description of itself does.
bool gives_calibrated_frames(const std::string& source, const std::filesystem::path& chosen);

/// `kinect:N[?depth=raw|mm|registered]`, `sim:ROOM[?key=value&...]`, or a folder with a recording or a
/// recorded session, recognised by what is in it; only `frames` of it where given. With a calibration, or a
/// file calibration.json in the folder, frames are as the calibrated cameras would have taken them. Throws
/// Error saying what SOURCE can be if it is none of these, if its frames would be calibrated a second time,
/// and whatever opening it or the calibration throws.
std::unique_ptr<FrameSource> open_source(const std::string& source, const std::optional<FrameRange>& frames,
                                         const std::filesystem::path& calibration = {},
                                         const SourceOptions& options = {});

/// Poses of one world mean nothing in a map that was scanned without any. Throws Error if the map is such.
/// @param map,source  names for the message
void require_recorded_world(const MapInfo& info, const std::string& map, const std::string& source);

}  // namespace roomradar
