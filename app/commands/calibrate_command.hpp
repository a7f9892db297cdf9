// calibrate_command.hpp: roomradar calibrate: estimates intrinsics, lens distortion and depth errors from a
// recording of a checkerboard.
#pragma once
#include "app/cli/options/calibrate_options.hpp"

namespace roomradar {

/// Estimates and writes the calibration, and prints residuals before and after. Returns the exit status 0.
/// @throws Error as calibrate() does, or if a file cannot be read or written
int run(const CalibrateOptions& options);

}  // namespace roomradar
