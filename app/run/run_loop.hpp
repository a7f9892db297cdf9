// run_loop.hpp: processes the frames of an opened run.
#pragma once
#include "app/run/opened_run.hpp"

namespace roomradar {

/// Processes frames until the source ends, a quit event occurs, the window is closed, or the user presses
/// Ctrl-C. Without a window, a run also ends after 5 s in which the source repeats frames and no event is
/// left. Requests from the window that fail are reported in the window only.
/// @throws Error if the source or a script event fails, or output cannot be written. `run` keeps the results
///         of earlier frames
void play_to_end(OpenedRun& run);

}  // namespace roomradar
