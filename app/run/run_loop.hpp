// run_loop.hpp: plays an opened run frame by frame to its end.
#pragma once
#include "app/run/opened_run.hpp"

namespace roomradar {

/// Plays until the source ends, an event says quit, the window is closed, or Ctrl-C. Throws Error if the
/// source fails, a script event is impossible, or output cannot be written; the run then keeps the results of
/// earlier frames. Impossible requests of the window's user are only reported in the window.
void play_to_end(OpenedRun& run);

}  // namespace roomradar
