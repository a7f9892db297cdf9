// source_list.hpp: the frame sources that a user can choose from.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

enum class SourceKind { kKinect, kRecording, kSimulated };

struct SourceEntry {
  SourceKind kind = SourceKind::kSimulated;
  std::string name;    ///< text in the list
  std::string detail;  ///< a few words, such as "300 frames"
  std::string source;  ///< in the syntax of open_source()
  /// Source for playing, in the syntax of open_source(). For simulated rooms it differs from `source`: the
  /// camera stays at one position.
  std::string play_source;
  std::string fault;  ///< sentence on why the source cannot be used; empty if it can
  /// Command that says what a recording holds and what is decided about it; empty for other sources.
  std::string check_command{};
};

/// Returns the Kinects on the USB bus, or the recording that fakenect replays in place of one. Does not open
/// them.
std::vector<SourceEntry> list_kinects();

/// Returns the recordings among the subfolders and files of `folder` and of `folder`/recordings,
/// sorted by name. If `folder` is a recording, returns only `folder`. Searches what subfolders() and
/// files_in_folder() return. Ignores unreadable folders and folders without a recording.
std::vector<SourceEntry> list_recordings(const std::filesystem::path& folder);

/// Returns the simulated rooms, without the one with the checkerboard.
std::vector<SourceEntry> list_simulated_rooms();

/// Returns the entry of a source, with a fault if `source` is not a source or cannot be read.
/// @param source  kinect:N with or without ?depth=, openni:N (its presence is not checked), sim:ROOM with
///                keys, or a recording's path
SourceEntry describe_source(const std::string& source);

}  // namespace roomradar
