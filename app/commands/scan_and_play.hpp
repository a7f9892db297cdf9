// scan_and_play.hpp: the parts between which roomradar prescan and run alternate: a scan, and a run in its
// map.
#pragma once
#include <optional>

#include "app/cli/options/prescan_options.hpp"
#include "app/cli/options/run_options.hpp"
#include "app/objects/unknown_support.hpp"
#include "app/window/play_window.hpp"
#include "app/window/scan/scan_window.hpp"

namespace roomradar {

/// Scans the room without a window, saves the map, and prints its properties and largest holes. Returns the
/// exit status: 0, or 1 if the map was saved but could not be compared with the held-out frames.
/// @throws Error if the scan fails or is stopped. The message says how to continue the scan, if possible
int scan(const PrescanOptions& options);

/// Does the same as scan(), in a window. The result may contain the user's request to play in the map.
ScanWindowResult scan_in_window(const PrescanOptions& options);

/// Processes the source's frames without a window, and writes the requested results. Returns the exit status:
/// 0, or 1 if the camera was not localised in any frame.
/// @throws Error if the run cannot begin, has no readable frame or fails. Results obtained before the error
///         are written
int play(const RunOptions& options);

struct PlayResult {
  PlayWindowResult window;
  /// If the user asks to scan more: the place where an object rests on the frontier of unknown space. Unset
  /// if no object rests there.
  std::optional<PlaceToScan> look_at{};
};
/// Does the same as play(), in a window.
PlayResult play_in_window(const RunOptions& options);

}  // namespace roomradar
