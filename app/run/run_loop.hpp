// run_loop.hpp: plays an opened run frame by frame to its end.
#pragma once
#include "app/run/opened_run.hpp"

namespace roomradar {

/// Processes frames until the source ends, a quit event occurs, the window is closed, or the user presses
/// Ctrl-C. Impossible requests of the window's user are only reported in the window.
/// @throws Error if the source fails, a script event is impossible, or output cannot be written; the results
/// of earlier frames are kept in `run`
void play_to_end(OpenedRun& run);

}  // namespace roomradar
