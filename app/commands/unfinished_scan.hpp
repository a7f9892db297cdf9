// unfinished_scan.hpp: how a prescan begins: anew, where it was cut off, or in a map that is there already.
#pragma once
#include <memory>
#include <optional>

#include "app/commands/commands.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/storage/checkpoints.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// What a prescan is given to work with.
struct ScanStart {
  std::unique_ptr<Checkpoints> checkpoints;  ///< null: none are asked for
  /// Rewinds; a live one is spooled beside the checkpoints, and ended by Ctrl-C.
  std::unique_ptr<FrameSource> source;
  bool is_live = false;         ///< goes on until Ctrl-C, unless frames were asked for
  std::filesystem::path spool;  ///< of a live one's frames, beside the checkpoints; empty: they go with it
  std::optional<SavedMap> map;  ///< to be extended by what the source shows
  bool is_done = false;         ///< to be resumed, but the map holds all of this recording
};

/// Opens the source and decides by --resume and by what lies at the map's place and beside it
/// (MAP.unfinished).
/// @throws Error if there is nothing to resume, or what is there was begun by another command, or without
/// --resume if a live scan would be lost, and as open_source does
ScanStart start_scan(const PrescanCommand& command);

}  // namespace roomradar
