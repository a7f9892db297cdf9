// record_command.hpp: roomradar record: writes a source's frames as a recording.
#pragma once
#include "app/cli/options/record_options.hpp"

namespace roomradar {

/// Copies the frames until the source ends or Ctrl-C is pressed. Returns the exit status 0.
/// @throws Error if no frame can be read, or if one cannot be written; frames before it are complete
int run(const RecordOptions& options);

}  // namespace roomradar
