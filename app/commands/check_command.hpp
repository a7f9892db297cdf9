// check_command.hpp: roomradar check: examines a recording.
#pragma once
#include "app/cli/options/check_options.hpp"

namespace roomradar {

/// Prints what a recording states and what was decided about it. Reads some of its frames only. Returns the
/// exit status: 1 if there is advice. Throws Error if the recording cannot be opened.
int run(const CheckOptions& options);

}  // namespace roomradar
