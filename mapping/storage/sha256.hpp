// sha256.hpp: SHA-256 checksums.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace roomradar {

/// Returns the SHA-256 of bytes as 64 lower-case hexadecimal digits.
std::string sha256_of(std::string_view bytes);
/// Same, as 32 bytes.
std::string sha256_bytes_of(std::string_view bytes);
/// Returns the SHA-256 of a file's content. Throws Error if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace roomradar
