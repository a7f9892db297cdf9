// building_check.hpp: compares a building's files with building.json.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

/// Returns one sentence per fault of the building's files, naming the file; empty for a sound building.
/// Compares each file of building.json with its size and SHA-256, reads it, and compares its content with
/// what building.json says. Throws Error only if building.json itself cannot be read.
std::vector<std::string> verify_building(const std::filesystem::path& folder);

}  // namespace roomradar
