// program_beside.hpp: finds another program of roomradar in the folder of the running one.
#pragma once
#include <filesystem>
#include <string>

namespace roomradar {

/// Returns the path of a program in the folder of the running one.
/// @param name  "roomradar", or "roomradar-COMMAND" for a command that is a program of its own
/// @throws Error if the program is missing; the message says how to build it
std::filesystem::path program_beside(const std::string& name);

}  // namespace roomradar
