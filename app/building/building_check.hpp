// building_check.hpp: compares a building's files with building.json.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

/// Returns one sentence per fault of the building's files, naming the file; empty if there is none. Compares
/// size, SHA-256 and content of each file with those in building.json. Throws Error only if building.json
/// itself cannot be read.
std::vector<std::string> verify_building(const std::filesystem::path& folder);

}  // namespace roomradar
