// file_bytes.hpp: a file's bytes, all of them or an Error.
#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <limits>
#include <string>
#include <string_view>

namespace roomradar {

/// All bytes of the plain file `path`, or of the one that it links to. Memory is taken only for what is
/// there.
/// @param what  that it should be, for messages: "a camera file"
/// @throws Error naming the file if it is missing, is no plain file (a folder, a pipe), has more bytes than
/// `most_bytes`, or cannot be read to its end
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::string_view what,
                                     std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

/// Makes them the file `path`, in place of what it held. Not in one step: see WholeFile for that.
/// @throws Error naming the file if not all of them could be written; half of it is not left
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

/// After writing to `path` as it comes: throws Error naming the file if `stream` has failed.
void require_written(const std::ios& stream, const std::filesystem::path& path);

}  // namespace roomradar
