// recording_list.hpp: the list of a building's recordings.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

struct ListedRecording {
  std::string name;    ///< used in reports and in names of folders
  std::string source;  ///< in the syntax of open_source(); paths are relative to the list's folder
};

/// Reads a list of recordings, one per line:
///
///     # first floor
///     hall: recordings/hall
///     office-1: recordings/office-1.bag
///
/// Empty lines and lines that begin with # are ignored. The order of lines has no effect: the recordings are
/// returned sorted by name.
/// @throws Error with file and fault if the file cannot be read, the list is empty, a name is duplicate, or a
///         line is malformed (with its number)
std::vector<ListedRecording> read_recording_list(const std::filesystem::path& path);

}  // namespace roomradar
