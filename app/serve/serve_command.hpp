// serve_command.hpp: execution of `roomradar serve`.
#pragma once
#include "app/cli/options/map_options.hpp"

namespace roomradar {

/// Serves until Ctrl-C. Returns the exit status. Throws Error if a map cannot be read, or the address cannot
/// be used or is not allowed.
int run(const ServeOptions& options);

}  // namespace roomradar
