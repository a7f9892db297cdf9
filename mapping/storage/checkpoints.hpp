// checkpoints.hpp: checkpoints on disk for resuming long work after an interruption.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// Folder of one unfinished piece of work. The folder contains `work.json` (identity of the work), `lock`,
/// and the last two checkpoints. Each checkpoint is a folder that is created atomically. At that time, all
/// files written earlier to the work's folder (such as a live scan's frames) are synced to disk. A forked
/// child writes the checkpoint from a snapshot of the state while the work continues. The child dies with its
/// parent. The work's folder is created with the first checkpoint. Only one process at a time can own it.
class Checkpoints {
 public:
  using WriteFiles = WriteCheckpointFiles;

  /// @param folder    where checkpoints are stored
  /// @param identity  name-value pairs (source, settings). Only work with equal pairs can resume
  /// @param every_s   min time between two checkpoints, s
  Checkpoints(std::filesystem::path folder, std::map<std::string, std::string> identity, double every_s);
  /// Waits for a checkpoint that is being written. Keeps the folder, unless remove() was called or it
  /// contains only `work.json` and `lock`.
  ~Checkpoints();
  Checkpoints(const Checkpoints&) = delete;
  Checkpoints& operator=(const Checkpoints&) = delete;

  /// Returns the newest intact checkpoint, or nullopt if there is none. Deletes damaged checkpoints that are
  /// newer and lists them in faults(). Throws Error if the folder's identity differs (naming the difference)
  /// or another process has the lock.
  std::optional<Checkpoint> resume();

  /// Throws Error naming the difference if the folder belongs to work with another identity.
  void require_same_work() const;

  /// Returns true if the last checkpoint began at least `intervals` times `every_s` ago, and no checkpoint is
  /// being written.
  bool is_due(double intervals = 1.0);
  /// Returns true if the last checkpoint began at least a third of `intervals` times `every_s` ago, and then
  /// waits until it is complete. Call at the end of a stage.
  bool is_due_at_end(double intervals = 1.0);
  /// Makes is_due() and is_due_at_end() wait for the last checkpoint and return true, until write() is
  /// called. For work that is about to be stopped.
  void write_soon() { writes_soon_ = true; }
  /// Waits for a checkpoint that is being written, then starts a child process that writes the next one. The
  /// start takes a few milliseconds. If the child fails (disk full), the previous checkpoint stays and
  /// failures() increases. Only the first failure is reported, through the callback of tell_failure().
  void write(const std::string& stage, const WriteFiles& write_files);
  /// Waits for a checkpoint that is being written. Returns true if there is a checkpoint to resume from.
  [[nodiscard]] bool has_any();
  /// Removes the folder of completed work.
  void remove();
  /// Deletes the checkpoints. The work then restarts from its beginning. Other files in the folder stay.
  void forget();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Creates and locks the folder now, for callers that store their own files in it.
  void ensure_folder();
  /// Returns one sentence per damaged checkpoint that resume() skipped.
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }
  [[nodiscard]] std::int64_t failures() const { return failures_; }
  /// Sets a callback for the first failure to write a checkpoint. There is none by default.
  void tell_failure(std::function<void(const std::string& sentence)> tell) { tell_ = std::move(tell); }

 private:
  void take_lock();
  /// Returns the time since the last checkpoint began, or since construction if there is none.
  [[nodiscard]] double since_last_s() const;
  void note_written(bool is_written);
  void fail_to_write();
  void reap(bool wait);
  bool try_to_write(const std::string& stage, const WriteFiles& write_files) const;

  std::filesystem::path folder_;
  std::map<std::string, std::string> identity_;
  std::chrono::duration<double> every_s_;
  std::chrono::steady_clock::time_point last_start_;
  std::filesystem::file_time_type being_written_since_;
  std::filesystem::file_time_type on_disk_until_ = std::filesystem::file_time_type::min();
  std::int64_t last_number_ = 0;  ///< number of the last complete checkpoint; 0: none
  bool writes_soon_ = false;
  int lock_ = -1;
  pid_t writer_ = -1;
  std::int64_t failures_ = 0;
  std::function<void(const std::string& sentence)> tell_;
  std::vector<std::string> faults_;
};

}  // namespace roomradar
