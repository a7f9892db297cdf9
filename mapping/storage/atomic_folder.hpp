// folder_swap.hpp: atomic replacement of a folder.
#pragma once
#include <exception>
#include <filesystem>
#include <string>

namespace roomradar {

/// Waits until a file's content, or a folder's list of names, is on disk. Throws Error on failure.
void sync_to_disk(const std::filesystem::path& path);

/// New folder beside `target` (target.partial-PID); the destructor removes it unless it was put in place.
class PartialFolder {
 public:
  /// Creates the folder and its parents. Removes partial folders that killed processes left beside `target`,
  /// but restores the folder that set_aside_of() returns as `target`. Throws Error on failure.
  explicit PartialFolder(const std::filesystem::path& target);
  ~PartialFolder();
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }

  /// Waits until all files are on disk, then makes the folder `target` in one step and removes the old
  /// `target`. Throws Error, with `target` unchanged, if the disk or the file system fails.
  void put_in_place();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;
};

/// Returns the old version of `target` (target.before-PID) if a process was killed while replacing it by two
/// renames, on a file system that cannot exchange names. Empty if `target` exists or nothing was set aside.
std::filesystem::path set_aside_of(const std::filesystem::path& target);

/// Returns an identifier that changes when another folder is put in place under this name. Empty if there is
/// no folder.
std::string swap_mark_of(const std::filesystem::path& folder);

/// Throws Error: the folder is replaced faster than it can be read.
[[noreturn]] void fail_as_never_still(const std::filesystem::path& folder);

/// Returns read()'s result from a single version of a folder that another process may replace meanwhile.
/// Retries if the folder was replaced during read(), at most 100 times. Rethrows exceptions of read() only if
/// the folder was not replaced.
template <typename Read>
auto read_of_one(const std::filesystem::path& folder, const Read& read) {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string before = swap_mark_of(folder);
    try {
      auto result = read();
      if (swap_mark_of(folder) == before) return result;
    } catch (const std::exception&) {
      if (swap_mark_of(folder) == before) throw;
    }
  }
  fail_as_never_still(folder);
}

}  // namespace roomradar
