// atomic_folder.cpp: syncs and renames folders, with Linux system calls, since the standard library cannot
// sync or exchange.
#include "mapping/storage/atomic_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = "partial";
constexpr const char* kBefore = "before";
constexpr const char* kDeleted = "deleted";

[[noreturn]] void fail(const fs::path& path, const std::string& what, int reason) {
  throw Error(path.string() + ": " + what + ": " + system_reason(reason) +
              (reason == ENOSPC || reason == EDQUOT ? "; free some space and save again" : ""));
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path beside(const fs::path& target, const char* word) {
  return parent_of(target) / (target.filename().string() + "." + word + "-" + std::to_string(::getpid()));
}

/// Returns the folders beside the target with this suffix whose processes have ended.
std::vector<fs::path> abandoned(const fs::path& target, const std::string& word) {
  const std::string prefix = target.filename().string() + "." + word + "-";
  std::vector<fs::path> found;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent_of(target), fault)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    pid_t owner = 0;
    const char* const end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + prefix.size(), end, owner);
    const bool named = parsed.ec == std::errc() && parsed.ptr == end && owner > 0;
    if (named && ::kill(owner, 0) != 0 && errno == ESRCH) found.push_back(entry.path());
  }
  return found;
}

/// Restores a folder that was moved aside if nothing replaced it; removes all other abandoned folders.
void clear_abandoned(const fs::path& target) {
  if (const fs::path aside = interrupted_replacement_of(target); !aside.empty()) {
    if (::rename(aside.c_str(), target.c_str()) != 0) fail(target, "cannot be brought back", errno);
  }
  std::error_code ignored;
  for (const char* word : {kPartial, kBefore})
    for (const fs::path& folder : abandoned(target, word)) fs::remove_all(folder, ignored);
}

/// Puts the list of names in the target's parent folder on disk if the file system can. The target is in
/// place already: a power failure could lose the new name, not the folder.
void sync_names_beside(const fs::path& target) {
  try {
    sync_to_disk(parent_of(target));
  } catch (const Error&) {
  }
}

}  // namespace

void sync_to_disk(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot be opened to sync it", errno);
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  if (result != 0) fail(path, "does not reach the disk", reason);
}

void put_in_place(const fs::path& ready, const fs::path& target) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(target))) {
    if (::renameat2(AT_FDCWD, ready.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) != 0 &&
        ((errno != EINVAL && errno != ENOSYS) || ::rename(ready.c_str(), target.c_str()) != 0))
      fail(target, "cannot be moved into place", errno);
  } else if (::renameat2(AT_FDCWD, ready.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
    if (errno != EINVAL && errno != ENOSYS) fail(target, "cannot be moved into place", errno);
    // This file system cannot exchange names: for a moment the target's name is missing, but a complete
    // folder always exists.
    const fs::path aside = beside(target, kBefore);
    if (::rename(target.c_str(), aside.c_str()) != 0) fail(target, "cannot be moved aside", errno);
    if (::rename(ready.c_str(), target.c_str()) != 0) {
      const int reason = errno;
      static_cast<void>(::rename(aside.c_str(), target.c_str()));
      fail(target, "cannot be moved into place", reason);
    }
    fs::remove_all(aside, ignored);
  }
  fs::remove_all(ready, ignored);  // the old target, if names were exchanged
  sync_names_beside(target);
}

bool move_to_free_place(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) != 0) {
    int reason = errno;
    if (reason == EINVAL || reason == ENOSYS) {  // this file system cannot refuse a name that is taken
      if (fs::exists(fs::symlink_status(to)))
        reason = EEXIST;
      else
        reason = ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
    }
    if (reason == EXDEV) return false;
    if (reason == EEXIST || reason == ENOTEMPTY)
      throw Error(to.string() + ": exists already; choose another name");
    if (reason != 0) fail(to, from.string() + " cannot be moved there", reason);
  }
  sync_names_beside(to);
  sync_names_beside(from);
  return true;
}

void remove_whole_folder(const fs::path& folder) {
  const fs::path aside = beside(folder, kDeleted);
  if (::rename(folder.c_str(), aside.c_str()) != 0) fail(folder, "cannot be removed", errno);
  std::error_code fault;
  fs::remove_all(aside, fault);
  if (fault) throw Error(aside.string() + ": is left of the deleted folder: " + system_reason(fault));
  sync_names_beside(folder);
}

bool is_transient(const std::string& name) {
  for (const char* word : {kPartial, kDeleted}) {
    const std::string infix = std::string(".") + word + "-";
    const std::size_t at = name.rfind(infix);
    if (at == std::string::npos || at == 0) continue;
    const std::string owner = name.substr(at + infix.size());
    if (!owner.empty() && owner.find_first_not_of("0123456789") == std::string::npos) return true;
  }
  return false;
}

AtomicFolder::AtomicFolder(const fs::path& target) : target_(target), partial_(beside(target, kPartial)) {
  make_folder(parent_of(target));
  clear_abandoned(target);
  std::error_code fault;
  fs::remove_all(partial_, fault);  // left by an earlier process with the same PID
  make_folder(partial_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;  // no remedy here; the folder's name marks it as partial
  fs::remove_all(partial_, ignored);
}

void AtomicFolder::sync() const {
  for (const fs::directory_entry& entry : fs::directory_iterator(partial_)) sync_to_disk(entry.path());
  sync_to_disk(partial_);
}

void AtomicFolder::commit() {
  sync();
  put_in_place(partial_, target_);
}

void AtomicFolder::commit_as_new() {
  sync();
  if (!move_to_free_place(partial_, target_)) fail(target_, "cannot be moved into place", EXDEV);
}

fs::path interrupted_replacement_of(const fs::path& target) {
  if (fs::exists(fs::symlink_status(target))) return {};
  const std::vector<fs::path> aside = abandoned(target, kBefore);
  return aside.empty() ? fs::path() : aside.front();
}

std::string folder_version(const fs::path& folder) {
  struct stat facts {};
  if (::stat(folder.c_str(), &facts) != 0) return {};
  return std::to_string(facts.st_dev) + " " + std::to_string(facts.st_ino) + " " +
         std::to_string(facts.st_ctim.tv_sec) + " " + std::to_string(facts.st_ctim.tv_nsec);
}

void fail_replaced_too_often(const fs::path& folder) {
  throw Error(folder.string() +
              ": is replaced by another process again and again; read it when that is done");
}

}  // namespace roomradar
