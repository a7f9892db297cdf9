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
  /// If wants_to_scan: keeps the window open for the next user of open_window().
  std::shared_ptr<void> window{};
};

/// Opens a window, runs `work` on another thread, and shows the snapshots of `work` until the user closes the
/// window. The window remains open after `work` has returned. Call on the main thread.
///
/// @param title      title of the window
/// @param meshes     objects that can be added, in addition to the built-in teapot
/// @param budget_ms  the run's time limit per frame; unset: none
/// @param ui_scale   scale of text and panes; unset: that of the monitor
/// @throws Error with advice if the program was built without a window, or if there is no display with OpenGL
///         3.3. Exceptions of `work` are rethrown
PlayWindowResult run_in_window(const std::string& title, const std::vector<ObjectSource>& meshes,
                               std::optional<double> budget_ms, std::optional<double> ui_scale,
                               const std::function<int(UiChannel&)>& work);

}  // namespace roomradar
