// run_command.hpp: roomradar run: augmented reality in a saved room.
#pragma once
#include <optional>

#include "app/cli/options/run_options.hpp"
#include "app/objects/unknown_support.hpp"
#include "app/window/play_window.hpp"

namespace roomradar {

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
