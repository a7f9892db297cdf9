// command_to_resume.hpp: the command that continues an interrupted scan.
#pragma once
#include <string>

#include "app/cli/options/prescan_options.hpp"

namespace roomradar {

/// Returns the command that continues this scan, as a line for a shell: the line as given, with --resume.
[[nodiscard]] std::string command_to_resume(const PrescanOptions& options);

}  // namespace roomradar
