// sha256.hpp: SHA-256 checksum of a file.
#pragma once
#include <filesystem>
#include <string>

namespace roomradar {

/// Returns the SHA-256 as 64 lower-case hexadecimal digits. Throws Error if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace roomradar
