// unfinished_scan.hpp: decides whether a prescan is new, resumed, or extends a map. The command that resumes
// it.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "app/cli/options/prescan_options.hpp"
#include "app/sources/formats/input_report.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/checkpoints.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Returns the command that continues this scan, as a line for a shell: the line as given, with --resume.
[[nodiscard]] std::string command_to_resume(const PrescanOptions& options);

/// Input of a prescan.
struct ScanStart {
  std::unique_ptr<Checkpoints> checkpoints;  ///< null: no checkpoints are written
  /// Frame source that can rewind. A live source is cached on disk (`spool`), and ends on Ctrl-C.
  std::unique_ptr<FrameSource> source;
  /// Decisions about the recording.
  std::shared_ptr<InputReport> input = std::make_shared<InputReport>();
  bool is_live = false;  ///< true: the source continues until Ctrl-C, unless limited by --frames
  /// Cache folder for a live source's frames, in the same folder as the checkpoints. Empty: not cached.
  std::filesystem::path spool;
  std::optional<SavedMap> map;  ///< the map to extend; unset: a new map
  bool is_done = false;         ///< true: nothing to do, since the map already contains the whole recording
};

/// Opens the source. Decides whether to begin a new scan, resume a scan or extend a map. The decision depends
/// on --resume, the existing map, and an interrupted scan in the folder MAP.unfinished.
/// @throws Error if there is nothing to resume, the interrupted scan belongs to another command, or an
///         interrupted live scan would be lost without --resume. Also throws as open_source() does
ScanStart start_scan(const PrescanOptions& options);

}  // namespace roomradar
