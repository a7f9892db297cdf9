// file_io.hpp: reads and writes whole files as bytes.
#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iosfwd>
#include <limits>
#include <string>
#include <string_view>

namespace roomradar {

/// Reads the regular file `path`, following links. Allocates no more than the file's size.
/// @param what  name of the expected content in messages, such as "a camera file"
/// @throws Error naming the file if it is missing, not a regular file (a folder, a pipe), larger than
///         `max_bytes`, or cannot be read to its end
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::string_view what,
                                     std::uintmax_t max_bytes = std::numeric_limits<std::uintmax_t>::max());

/// Replaces the contents of the file `path` with `parts`, one after the other. Not atomic; use AtomicFile for
/// atomic writing.
/// @throws Error naming the file if some bytes could not be written; the partial file is removed
void write_parts(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);
inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  write_parts(path, {bytes});
}

/// Returns the reason why a file cannot be written at this path, as the end of a sentence. Detects a folder
/// that does not exist, is not writable or whose file system accepts no files (/proc), and a full disk.
/// Writes nothing. Returns an empty string if none of these is the case.
[[nodiscard]] std::string why_not_writable(const std::filesystem::path& path);

/// Throws Error naming the file and the cause if `stream` has failed. Call it after writing to `path` through
/// a plain stream.
void require_written(const std::ios& stream, const std::filesystem::path& path);

}  // namespace roomradar
