// checkpoint_folder.hpp: writes, reads and verifies the files in a folder of checkpoints.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// Name of the file that is locked by the process that owns the folder.
inline constexpr const char* kCheckpointLock = "lock";

/// A checkpoint that was read back, with sizes and checksums of all files verified.
struct Checkpoint {
  std::string stage;             ///< stage passed to write_checkpoint()
  std::filesystem::path folder;  ///< contains the state's files; callers must not change it
};

/// Callback that writes a state's files into the empty folder `into`. `previous` is the preceding
/// checkpoint's folder, or an empty path. carry_over() can link unchanged files from there. The callback runs
/// in a child process, so its changes to memory are lost.
using WriteCheckpointFiles =
    std::function<void(const std::filesystem::path& into, const std::filesystem::path& previous)>;

/// Writes checkpoint `number` under a temporary name, syncs it, and renames it. Then removes all but the last
/// two checkpoints. If the disk fails, throws Error or std::filesystem::filesystem_error. The caller must
/// then call discard_unfinished().
/// @param last_number    number of the last complete checkpoint; 0: none
/// @param on_disk_until  files in the folder that were last written before this time count as synced
void write_checkpoint(const std::filesystem::path& folder, std::int64_t number, std::int64_t last_number,
                      const std::string& stage, const WriteCheckpointFiles& write_files,
                      std::filesystem::file_time_type on_disk_until);
/// Removes the partial files of an interrupted write_checkpoint(). Ignores errors.
void discard_unfinished(const std::filesystem::path& folder);

/// Verifies all files of a checkpoint. Throws Error naming the first file that is missing or altered.
Checkpoint read_checkpoint(const std::filesystem::path& folder, std::int64_t number);
/// Removes a checkpoint. Ignores errors.
void remove_checkpoint(const std::filesystem::path& folder, std::int64_t number);
/// Returns the numbers of the folder's checkpoints, newest first.
std::vector<std::int64_t> checkpoint_numbers(const std::filesystem::path& folder);

/// Writes the identity of the work (name-value pairs) to work.json, unless the folder has this file.
void write_identity(const std::filesystem::path& folder, const std::map<std::string, std::string>& identity);
/// Returns the identity in the folder's work.json. Throws Error if the file is missing or damaged.
std::map<std::string, std::string> identity_of(const std::filesystem::path& folder);

/// Returns true if the folder contains only work.json and the lock file, as after its creation.
bool has_nothing_to_resume(const std::filesystem::path& folder);

/// Returns the name to which the folder is renamed before it is removed. A folder of this name that was left
/// by a crash can be deleted.
std::filesystem::path done_beside(const std::filesystem::path& folder);

/// Protects other files from removal. Throws Error if `folder` exists and is not a folder, or contains
/// anything other than checkpoints and the entry named `beside`.
void require_checkpoints_only(const std::filesystem::path& folder, std::string_view beside);

/// Makes `to` a hard link to `from`, or a copy if linking fails. Returns false if `from` does not exist or
/// cannot be copied.
bool carry_over(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace roomradar
