// atomic_folder.hpp: atomic replacement of a folder.
#pragma once
#include <exception>
#include <filesystem>
#include <string>

namespace roomradar {

/// Waits until a file's content, or a folder's list of names, is on disk. Throws Error on failure.
void sync_to_disk(const std::filesystem::path& path);

/// Renames the folder `ready` to `target` atomically, and removes the old `target`. Does not sync the files
/// in `ready`. Throws Error, with both unchanged, if the file system fails.
void put_in_place(const std::filesystem::path& ready, const std::filesystem::path& target);

/// Renames the folder `from` to `to` atomically if nothing has that name. Returns false, with nothing
/// changed, if the two are on different file systems. Throws Error, with nothing changed, if `to` exists or
/// the system refuses.
bool move_to_free_place(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes a folder and its contents. The folder is renamed to folder.deleted-PID first, so that an
/// interruption leaves no part of it under its name. Throws Error if the system refuses.
void remove_whole_folder(const std::filesystem::path& folder);

/// Returns true for the name of a file or folder that is incomplete, or is being removed: NAME.partial-PID,
/// NAME.deleted-PID.
[[nodiscard]] bool is_transient(const std::string& name);

/// New folder target.partial-PID, in the parent folder of `target`. The destructor removes the folder unless
/// commit() succeeded.
class AtomicFolder {
 public:
  /// Creates the folder and its parents. Removes partial folders of `target` that killed processes left. If
  /// interrupted_replacement_of() returns a folder, renames that folder back to `target`. Throws Error on
  /// failure.
  explicit AtomicFolder(const std::filesystem::path& target);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }

  /// Waits until all files directly in the folder are on disk. Then renames the folder to `target` atomically
  /// and removes the old `target`. Throws Error, with `target` unchanged, if the disk or the file system
  /// fails.
  void commit();

  /// Like commit(), but throws Error, with `target` unchanged, if `target` exists.
  void commit_as_new();

 private:
  void sync() const;

  std::filesystem::path target_;
  std::filesystem::path partial_;
};

/// Returns the old version of `target` (target.before-PID) if a process killed during commit() left no
/// `target`. This can happen if the file system cannot exchange two names. commit() then needs two renames.
/// Returns an empty path if `target` exists or there is no old version.
std::filesystem::path interrupted_replacement_of(const std::filesystem::path& target);

/// Returns an identifier that changes when the folder is replaced by another of the same name. Empty if there
/// is no folder.
std::string folder_version(const std::filesystem::path& folder);

/// Throws an Error that says that the folder is replaced faster than it can be read.
[[noreturn]] void fail_replaced_too_often(const std::filesystem::path& folder);

/// Repeats read() until the folder is not replaced during the call, and returns the result of that call. The
/// result is thus from a single version of the folder, even while another process replaces the folder. Throws
/// Error after 100 attempts. Rethrows an exception of read() only if the folder was not replaced during that
/// call.
template <typename Read>
auto read_consistent(const std::filesystem::path& folder, const Read& read) {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string before = folder_version(folder);
    try {
      auto result = read();
      if (folder_version(folder) == before) return result;
    } catch (const std::exception&) {
      if (folder_version(folder) == before) throw;
    }
  }
  fail_replaced_too_often(folder);
}

}  // namespace roomradar
