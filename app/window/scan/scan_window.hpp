// scan_window.hpp: window of `roomradar prescan --window`.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/options/prescan_options.hpp"
#include "app/scan/scan_channel.hpp"

namespace roomradar {

struct ScanWindowResult {
  int status = 0;              ///< the value that the work returned
  bool wants_to_play = false;  ///< the user asks to play in the map
  /// If wants_to_play: owns the window, so that it stays open for the next caller of open_window(). Else
  /// null.
  std::shared_ptr<void> window{};
};

/// Opens a window, or reuses the open one with a new title. Runs `work` on another thread and shows the state
/// that `work` publishes, then its outcome. Ends when the user closes the window, discards the scan or asks
/// to play. If the user closes the window before `work` has ended, `work` continues without the window, as
/// after Ctrl-C. Waits for `work` to end. Call on the main thread.
///
/// @param ui_scale  scale of text and panes; unset: the monitor's scale, clamped to 1..3
/// @param lost_signal  signal when tracking is lost
/// @throws Error with advice if the program was built without a window, or if there is no display with OpenGL
///         3.3. Exceptions of `work` are rethrown
ScanWindowResult run_in_scan_window(const std::string& title, std::optional<double> ui_scale,
                                    LostSignal lost_signal, const std::function<int(ScanChannel&)>& work);

}  // namespace roomradar
