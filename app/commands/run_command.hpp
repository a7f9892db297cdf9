// run_command.hpp: roomradar run: augmented reality in a saved room.
#pragma once
#include "app/cli/options/run_options.hpp"

namespace roomradar {

/// Processes the source's frames, in a window if requested, and writes the requested results. Returns the
/// exit status: 0, or 1 if the camera was not localised in any frame.
/// @throws Error if the run cannot begin, has no readable frame or fails. Results obtained before the error
/// are written
int run(const RunOptions& options);

}  // namespace roomradar
