// folder_swap.hpp: a folder that appears whole or not at all.
#pragma once
#include <exception>
#include <filesystem>
#include <string>

namespace roomradar {

/// Waits until a file, or the list of names in a folder, is on the disk. Throws Error if it does not get
/// there.
void sync_to_disk(const std::filesystem::path& path);

/// A new folder beside `target` (target.partial-PID), removed again unless it is put in place.
class PartialFolder {
 public:
  /// Makes it, and the folders above. Those that processes left beside `target` when they were killed go, but
  /// what set_aside_of() says is made `target` again. Throws Error if that cannot be done.
  explicit PartialFolder(const std::filesystem::path& target);
  ~PartialFolder();
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return partial_; }

  /// Waits until all its files are on the disk, then makes it `target` in one step; what was there is removed
  /// afterwards. Throws Error, with `target` as it was, if the disk or the file system does not do it.
  void put_in_place();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;
};

/// Where `target` is as it was, if a process was killed while it exchanged it on a file system that can only
/// rename: between two renames neither the old nor the new is there (target.before-PID). Else empty.
std::filesystem::path set_aside_of(const std::filesystem::path& target);

/// Which folder has a name now: another one after it was put in place anew. Empty if there is none.
std::string swap_mark_of(const std::filesystem::path& folder);

/// Throws Error: the folder is put in place anew faster than it can be read.
[[noreturn]] void fail_as_never_still(const std::filesystem::path& folder);

/// What read() gives of a folder that another process may replace meanwhile: all of it of one and the same
/// folder. What read() throws counts only if the folder was not replaced.
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
