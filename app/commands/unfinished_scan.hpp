// unfinished_scan.hpp: begins a prescan: a new one, an interrupted one, or one that extends a map.
#pragma once
#include <memory>
#include <optional>

#include "app/cli/options/prescan_options.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/checkpoints.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Input of a prescan.
struct ScanStart {
  std::unique_ptr<Checkpoints> checkpoints;  ///< null: no checkpoints requested
  /// Frame source, which can rewind. A live source is cached on disk beside the checkpoints, and ends on
  /// Ctrl-C.
  std::unique_ptr<FrameSource> source;
  bool is_live = false;         ///< continues until Ctrl-C, unless limited by --frames
  std::filesystem::path spool;  ///< a live source's stored frames, beside the checkpoints; empty: not stored
  std::optional<SavedMap> map;  ///< map to extend
  bool is_done = false;         ///< nothing to resume: the map already holds all of this recording
};

/// Opens the source. From --resume, the existing map and an interrupted scan beside it (MAP.unfinished),
/// decides whether to begin, resume or extend.
/// @throws Error if there is nothing to resume, if the interrupted scan belongs to another command, or if a
/// live scan would be lost without --resume; also as open_source() does
ScanStart start_scan(const PrescanOptions& options);

}  // namespace roomradar
