// doctor_command.hpp: roomradar doctor: checks the installation, with advice on repairs.
#pragma once

namespace roomradar {

/// Prints a line per finding. Returns the exit status: 0, or 1 if something must be repaired.
int run_doctor();

}  // namespace roomradar
