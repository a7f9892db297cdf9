// folder_swap.hpp: a folder that appears whole or not at all.
#pragma once
#include <filesystem>

namespace roomradar {

/// Waits until a file, or the list of names in a folder, is on the disk. Throws Error if it does not get
/// there.
void sync_to_disk(const std::filesystem::path& path);

/// A new folder beside `target` (target.partial-PID), removed again unless it is put in place.
class PartialFolder {
 public:
  /// Makes it, and the folders above; those that processes left beside `target` when they were killed go.
  /// Throws Error if that cannot be done.
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

}  // namespace roomradar
