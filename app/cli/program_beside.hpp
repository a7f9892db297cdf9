// program_beside.hpp: the programs of roomradar, which are in one folder.
#pragma once
#include <filesystem>
#include <string>

namespace roomradar {

/// Returns the path of a program in the folder of the running one.
/// @param name  "roomradar", or "roomradar-COMMAND" for a command that is a program of its own
/// @throws Error that says how to build it if there is no such program
std::filesystem::path program_beside(const std::string& name);

}  // namespace roomradar
