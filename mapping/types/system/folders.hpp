// folders.hpp: creates folders, with the true cause if that fails; lists folders without the files that
// desktops and file systems leave in them.
#pragma once
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace roomradar {

/// Creates the folder and its parents; does nothing if it exists. Throws Error naming the folder and the
/// cause. The cause is the nearest existing parent folder if that is not writable, or is in a file system
/// that accepts no new files, such as /proc. For /proc, the system's own message would be a misleading "No
/// such file or directory".
void make_folder(const std::filesystem::path& folder);

/// Returns true for the name of a file or folder that a desktop, a file system or a network share adds to
/// folders by itself: "._NAME", ".DS_Store", "__MACOSX", ".directory", "Thumbs.db", "desktop.ini",
/// ".Trash-1000" and so on. It may be deleted with the folder that holds it.
[[nodiscard]] bool is_litter(std::string_view name);

/// Returns true for litter and for all other hidden files, whose names begin with a dot. A recording is read
/// as if they did not exist. Unlike litter they may be someone's work, such as .git, and are never deleted.
[[nodiscard]] bool is_hidden_file(std::string_view name);

/// Returns the paths in `folder`, sorted, without hidden ones and litter. Throws std::filesystem_error if the
/// folder cannot be listed.
[[nodiscard]] std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);
/// Like entries_of(); sets `fault` instead of throwing, and then returns what it has found.
[[nodiscard]] std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder,
                                                            std::error_code& fault);

/// Returns true if the folder is empty or holds only litter. Sets `fault`, and returns false, if it cannot be
/// listed.
[[nodiscard]] bool is_empty_folder(const std::filesystem::path& folder, std::error_code& fault);

}  // namespace roomradar
