// simulate_command.hpp: roomradar simulate: records a simulated Kinect with ground truth.
#pragma once
#include "app/cli/options/recording_options.hpp"

namespace roomradar {

/// Writes the recording. Returns the exit status 0.
/// @throws Error if an option is not valid (require_valid()), or if the folder cannot be written
int run(const SimulateOptions& options);

}  // namespace roomradar
