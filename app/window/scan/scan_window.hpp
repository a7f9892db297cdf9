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
  std::shared_ptr<void>
      window{};  ///< if wants_to_play: keeps the window open for the next user of open_window()
};

/// Opens a window, runs `work` on another thread, and shows the state that `work` publishes until the user
/// closes the window. The window remains open after `work` has returned, and shows the outcome. If the user
/// closes the window earlier, `work` continues without it, as after Ctrl-C. Call on the main thread.
///
/// @param title     title of the window
/// @param ui_scale  scale of text and panes; unset: that of the monitor
/// @param lost_signal  signal when tracking is lost
/// @throws Error with advice if the program was built without a window, or if there is no display with OpenGL
///         3.3. Exceptions of `work` are rethrown
ScanWindowResult run_in_scan_window(const std::string& title, std::optional<double> ui_scale,
                                    LostSignal lost_signal, const std::function<int(ScanChannel&)>& work);

}  // namespace roomradar
