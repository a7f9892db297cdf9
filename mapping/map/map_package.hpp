// map_package.hpp: a map as one file, NAME.rrm, to send or to keep: a ZIP with the files of the map's folder
// in a folder of the map's name.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace roomradar {

inline constexpr const char* kMapPackageExtension = ".rrm";
/// A package has at most this many files.
inline constexpr std::size_t kMaxPackedFiles = 10'000;

/// Returns how many bytes a package of this size may unpack to: 64 GB, and 1000 times its size plus 64 MB.
[[nodiscard]] std::uint64_t max_unpacked_bytes(std::uint64_t package_bytes);

/// Writes the map to the file, whole or not at all. An existing package is replaced. The same map gives the
/// same bytes: the files are sorted by name and have no times. Throws Error if the file's name does not end
/// in .rrm or is that of something else, the folder is not a map (existing_map()), holds more than a map
/// (require_only_map()) or is damaged (verify_map()), or the disk fails.
void pack_map(const std::filesystem::path& map, const std::filesystem::path& file);

/// Makes the map's folder from a package, which is not trusted. Returns its path. Names, number of files and
/// sizes are checked before anything is written, and the map by verify_map() before it is in place. Throws
/// Error, with nothing left behind, if the package is damaged or not one of a map, or something is in the
/// place.
/// @param to  folder to make; empty: in the current folder, with the name that the map had when it was packed
std::filesystem::path unpack_map(const std::filesystem::path& file, const std::filesystem::path& to);

}  // namespace roomradar
