// binary_file.hpp: binary files with a magic word, a version and a checksum.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "mapping/types/serialize.hpp"

namespace roomradar {

/// End of messages about files that are damaged.
inline constexpr const char* kFileAdvice = "; make the map again or take it from a backup";

/// Writes `magic`, `version`, `body` and a checksum of all three. Throws Error if the file cannot be written.
void write_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                  std::string_view body);

struct BinaryBody {
  std::uint32_t version = 0;
  std::string bytes;
};
/// Whether read_binary() compares the checksum in the file, which takes 1.5 ms per MB.
enum class FileChecksum {
  kCompared,
  kNotNeeded,  ///< the caller has just compared a checksum of the whole file
};
/// Returns the body of a file written by write_binary() with a version from `oldest` to `newest`. Throws
/// Error naming the file and the fault if the file is missing, truncated, altered, or of another kind or
/// version.
BinaryBody read_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t oldest,
                       std::uint32_t newest, FileChecksum checksum = FileChecksum::kCompared);
/// Returns the body of a file of this version.
inline std::string read_binary(const std::filesystem::path& path, std::string_view magic,
                               std::uint32_t version) {
  return read_binary(path, magic, version, version).bytes;
}

/// Writes a file with these fields, each by serialize(). Throws Error if it cannot be written.
template <typename... Fields>
void save_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                 const Fields&... fields) {
  ByteWriter out;
  out(fields...);
  write_binary(path, magic, version, out.bytes);
}
/// Reads the fields of a file written by save_binary(). Throws Error as read_binary() does, and if a field is
/// invalid or bytes are left.
template <typename... Fields>
void load_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                 Fields&... fields) {
  const std::string bytes = read_binary(path, magic, version);
  ByteReader in(bytes, path.string(), kFileAdvice);
  in(fields...);
  in.require_end();
}

}  // namespace roomradar
