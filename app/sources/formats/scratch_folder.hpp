// scratch_folder.hpp: a temporary folder that is removed at the end, or by a later process after a kill.
#pragma once
#include <filesystem>

namespace roomradar {

/// A new empty folder, removed with its contents by the destructor. The folder is locked (flock) while the
/// process runs. A process that is killed leaves its folder; the next ScratchFolder in the same parent folder
/// finds it unlocked and removes it.
class ScratchFolder {
 public:
  /// @param parent  where to create the folder; empty: the system's folder for temporary files
  /// @throws Error if the folder cannot be created
  explicit ScratchFolder(std::filesystem::path parent = {});
  ~ScratchFolder();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&& other) noexcept;
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;  ///< empty: moved from
  int locked_ = -1;             ///< descriptor that holds the lock; -1: the file system has no locks
};

}  // namespace roomradar
