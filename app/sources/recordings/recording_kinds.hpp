// recording_kinds.hpp: the kinds of recordings, recognised by their content.
#pragma once
#include <filesystem>
#include <string>

#include "app/sources/datasets/recording_facts.hpp"

namespace roomradar {

/// Returns the kind of the recording at `path`, a file or folder, such as "Record3D export". A folder with
/// one file that is a recording counts as that file. Returns an empty string if there is none.
[[nodiscard]] std::string recording_kind(const std::filesystem::path& path);

/// Returns true if the recording was written by another program than roomradar and libfreenect. Such a
/// recording may contain a file calibration.json of its own.
[[nodiscard]] bool is_foreign_recording(const std::filesystem::path& path);

/// Returns what a recording states. Reads lists and headers of some images only.
/// @param depth_topic  topic of a ROS recording with depth images; empty: chosen by find_streams()
/// @throws Error naming the file if the recording is of no known kind (the message lists the kinds), is
///         damaged, lacks depth images or cameras, or has no such topic
RecordingFacts read_facts(const std::filesystem::path& path, const std::string& depth_topic = {});

}  // namespace roomradar
