// doctor_command.hpp: roomradar doctor: checks the installation and gives advice on repairs.
#pragma once

namespace roomradar {

/// Prints a line per Finding. Returns the exit status: 0, or 1 if a finding is kBad.
int run_doctor();

}  // namespace roomradar
