// checkpoint_folder.hpp: files in a folder of checkpoints: names, checksums, identity of the work.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// Name of the file that the process which owns the folder locks.
inline constexpr const char* kCheckpointLock = "lock";

/// A checkpoint that was read back, with sizes and checksums of all files verified.
struct Checkpoint {
  std::string stage;             ///< as passed to write_checkpoint()
  std::filesystem::path folder;  ///< contains the state's files; not to be changed
};

/// Writes a state's files into `into`, an empty folder. `previous` is the preceding checkpoint's folder, or
/// empty; unchanged files can be linked from it with carry_over(). Runs in a child process: changes to
/// memory are lost.
using WriteCheckpointFiles =
    std::function<void(const std::filesystem::path& into, const std::filesystem::path& previous)>;

/// Writes checkpoint `number` under a temporary name, syncs it, and renames it. Then removes all but the last
/// two. If the disk fails, throws Error or std::filesystem::filesystem_error; the caller must then call
/// discard_unfinished().
/// @param last_number    number of the last complete checkpoint; 0: none
/// @param on_disk_until  files of the folder last written before this time are already synced
void write_checkpoint(const std::filesystem::path& folder, std::int64_t number, std::int64_t last_number,
                      const std::string& stage, const WriteCheckpointFiles& write_files,
                      std::filesystem::file_time_type on_disk_until);
/// Removes the partial files of an interrupted write_checkpoint(); ignores errors.
void discard_unfinished(const std::filesystem::path& folder);

/// Verifies all files of a checkpoint. Throws Error naming the first that is missing or altered.
Checkpoint read_checkpoint(const std::filesystem::path& folder, std::int64_t number);
/// Removes a checkpoint; ignores errors.
void remove_checkpoint(const std::filesystem::path& folder, std::int64_t number);
/// Returns the numbers of the folder's checkpoints, newest first.
std::vector<std::int64_t> checkpoint_numbers(const std::filesystem::path& folder);

/// Writes work.json, unless the folder has one.
void write_identity(const std::filesystem::path& folder, const std::map<std::string, std::string>& identity);
/// Returns the identity in the folder's work.json. Throws Error if the file is missing or damaged.
std::map<std::string, std::string> identity_of(const std::filesystem::path& folder);

/// Returns true if the folder contains only `work.json` and the lock, as after its creation.
bool has_nothing_to_resume(const std::filesystem::path& folder);

/// Returns the name to which the folder is renamed before it is removed. A folder of this name, left by a
/// crash, can be deleted.
std::filesystem::path done_beside(const std::filesystem::path& folder);

/// Throws Error if `folder` exists and is not a folder, or contains anything other than checkpoints and the
/// entry named `beside`. Protects other files from removal.
void require_checkpoints_only(const std::filesystem::path& folder, std::string_view beside);

/// Makes `to` a hard link to `from`, or a copy if linking fails. Returns false if `from` does not exist or
/// cannot be copied.
bool carry_over(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace roomradar
