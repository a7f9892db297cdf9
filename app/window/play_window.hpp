// play_window.hpp: window of `roomradar run --window`.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/object_file.hpp"
#include "app/window/link/ui_channel.hpp"

namespace roomradar {

struct PlayWindowResult {
  int status = 0;              ///< the value that the work returned
  bool wants_to_scan = false;  ///< the user asks to scan more of the room
  /// If wants_to_scan: owns the window, so that it stays open for the next caller of open_window(). Else
  /// null.
  std::shared_ptr<void> window{};
};

/// Opens a window, or reuses the open one with a new title. Runs `work` on another thread and shows the
/// snapshots that `work` publishes. The last snapshot remains visible after `work` has returned. Ends when
/// the user closes the window or asks to scan, when `work` throws, and when `work` returns after Ctrl-C.
/// Waits for `work` to end. Call on the main thread.
///
/// @param meshes     objects that can be added, in addition to the built-in teapot
/// @param budget_ms  the run's time limit per frame; unset: none
/// @param ui_scale   scale of text and panes; unset: the monitor's scale, clamped to 1..3
/// @throws Error with advice if the program was built without a window, or if there is no display with OpenGL
///         3.3. Exceptions of `work` are rethrown
PlayWindowResult run_in_window(const std::string& title, const std::vector<ObjectSource>& meshes,
                               std::optional<double> budget_ms, std::optional<double> ui_scale,
                               const std::function<int(UiChannel&)>& work);

}  // namespace roomradar
