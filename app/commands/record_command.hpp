// record_command.hpp: roomradar record: writes a source's frames as a recording.
#pragma once
#include "app/cli/options/recording_options.hpp"

namespace roomradar {

/// Records the frames until the source ends or Ctrl-C is pressed. Returns the exit status 0.
/// @throws Error if no frame can be read, or if a frame cannot be written. Frames written before it are
///         complete
int run(const RecordOptions& options);

}  // namespace roomradar
