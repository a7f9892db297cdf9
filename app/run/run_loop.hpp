// run_loop.hpp: plays an opened run, frame by frame, to its end.
#pragma once
#include "app/run/opened_run.hpp"

namespace roomradar {

/// Until the source ends, an event says quit, the window is closed, or Ctrl-C. Throws Error if the source
/// goes away, an event of the script cannot be, or what is to be kept of a frame cannot be written: the run
/// is as the frames before have left it. What a user of the window asks for and cannot be is said there.
void play_to_end(OpenedRun& run);

}  // namespace roomradar
