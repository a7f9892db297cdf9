// scratch_folder.cpp: mkdtemp, flock, and removal of the folders of killed processes.
#include "app/sources/formats/scratch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScratchPrefix = "roomradar-scratch-";

/// Opens and locks a folder of this user. Returns -1 if that fails; errno is EWOULDBLOCK if a process holds
/// the lock.
int lock_scratch(const fs::path& folder) {
  const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (opened < 0) return -1;
  struct stat facts {};
  if (fstat(opened, &facts) == 0 && facts.st_uid == geteuid() && flock(opened, LOCK_EX | LOCK_NB) == 0)
    return opened;
  close(opened);
  return -1;
}

/// Removes scratch folders that no running process has locked.
void remove_abandoned(const fs::path& parent) {
  std::error_code fault;
  for (fs::directory_iterator entry(parent, fault), end; !fault && entry != end; entry.increment(fault)) {
    if (!entry->path().filename().string().starts_with(kScratchPrefix)) continue;
    const int locked = lock_scratch(entry->path());
    if (locked < 0) continue;
    std::error_code ignored;
    fs::remove_all(entry->path(), ignored);
    close(locked);
  }
}

}  // namespace

ScratchFolder::ScratchFolder(fs::path parent) {
  std::error_code fault;
  if (parent.empty()) parent = fs::temp_directory_path(fault);
  if (fault)
    throw Error("there is no folder for temporary files; set TMPDIR to one: " + system_reason(fault));
  remove_abandoned(parent);
  // Before the new folder is locked, another process may take it for abandoned, lock it and remove it.
  constexpr int kTries = 10;
  for (int i = 0; i < kTries; ++i) {
    std::string pattern = (parent / (std::string(kScratchPrefix) + "XXXXXX")).string();
    if (!mkdtemp(pattern.data()))
      throw Error(parent.string() + ": no temporary folder can be made there: " + system_reason(errno));
    locked_ = lock_scratch(pattern);
    const bool is_taken = locked_ < 0 && errno == EWOULDBLOCK;
    if (!is_taken && fs::exists(pattern, fault)) {
      path_ = pattern;
      return;
    }
    if (locked_ >= 0) close(std::exchange(locked_, -1));
  }
  throw Error(parent.string() +
              ": temporary folders are removed as soon as they are made; set TMPDIR to another");
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (locked_ >= 0) close(locked_);
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), locked_(std::exchange(other.locked_, -1)) {}

ScratchFolder& ScratchFolder::operator=(ScratchFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(locked_, other.locked_);
  return *this;
}

}  // namespace roomradar
