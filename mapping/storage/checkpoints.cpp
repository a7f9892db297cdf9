// checkpoints.cpp: the lock, and the forked child that writes a checkpoint.
#include "mapping/storage/checkpoints.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/make_folder.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

/// Returns fork(). With the address sanitizer returns -1: its allocator may be locked by another thread, and
/// would stay locked in the child.
pid_t fork_writer() {
#ifdef __SANITIZE_ADDRESS__
  return -1;
#else
  return ::fork();
#endif
}

[[noreturn]] void fail(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

/// Returns true if the path still names the open file; the lock's last owner may have removed the folder.
bool is_still_there(int file, const fs::path& path) {
  struct stat opened {
  }, named{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

Checkpoints::Checkpoints(fs::path folder, std::map<std::string, std::string> identity, double every_s)
    : folder_(std::move(folder)),
      identity_(std::move(identity)),
      every_s_(every_s),
      last_start_(std::chrono::steady_clock::now()) {
  identity_["roomradar"] = kVersion;
}

Checkpoints::~Checkpoints() {
  reap(/*wait=*/true);
  if (lock_ < 0) return;
  std::error_code ignored;
  if (has_nothing_to_resume(folder_)) fs::remove_all(folder_, ignored);
  ::close(lock_);
}

void Checkpoints::take_lock() {
  if (lock_ >= 0) return;
  const fs::path path = folder_ / kCheckpointLock;
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) fail(path, "cannot be opened: " + system_reason(errno));
  // The writer child of a killed process keeps the lock for a moment longer.
  for (int attempt = 0; attempt < 30; ++attempt) {
    if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) {
      if (is_still_there(lock_, path)) return;
      ::close(std::exchange(lock_, -1));
      fail(folder_, "another roomradar has just ended its work on this scan; start again");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ::close(std::exchange(lock_, -1));
  fail(folder_, "another roomradar is at work on this scan; wait for it, or choose another name for the map");
}

void Checkpoints::ensure_folder() {
  if (lock_ >= 0) return;
  make_folder(folder_);
  take_lock();
  write_identity(folder_, identity_);
}

void Checkpoints::require_same_work() const {
  const std::map<std::string, std::string> found = identity_of(folder_);
  for (const auto& [name, value] : identity_) {
    const auto was = found.find(name);
    if (was != found.end() && was->second == value) continue;
    fail(folder_, "the scan there was begun with " + name + " " +
                      (was == found.end() ? "not set" : "\"" + was->second + "\"") + ", and now it is \"" +
                      value + "\"; resume it with the same, or delete the folder to start again");
  }
}

std::optional<Checkpoint> Checkpoints::resume() {
  if (!fs::exists(folder_)) return std::nullopt;
  ensure_folder();
  require_same_work();
  for (const std::int64_t number : checkpoint_numbers(folder_)) {
    last_number_ = std::max(last_number_, number);
    try {
      Checkpoint checkpoint = read_checkpoint(folder_, number);
      last_number_ = number;
      return checkpoint;
    } catch (const std::exception& fault) {
      faults_.push_back(std::string(fault.what()) + "; the checkpoint is skipped");
      remove_checkpoint(folder_, number);
    }
  }
  last_number_ = 0;
  return std::nullopt;
}

bool Checkpoints::is_due(double intervals) {
  reap(/*wait=*/writes_soon_);
  return writes_soon_ || (writer_ < 0 && since_last_s() >= intervals * every_s_.count());
}

bool Checkpoints::is_due_at_end(double intervals) {
  const bool is_due = writes_soon_ || since_last_s() >= intervals * every_s_.count() / 3.0;
  reap(/*wait=*/is_due);
  return is_due;
}

double Checkpoints::since_last_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_start_).count();
}

void Checkpoints::write(const std::string& stage, const WriteFiles& write_files) {
  reap(/*wait=*/true);
  writes_soon_ = false;
  last_start_ = std::chrono::steady_clock::now();
  being_written_since_ = fs::file_time_type::clock::now();
  try {
    ensure_folder();
  } catch (const Error&) {
    fail_to_write();
    return;
  }
  const pid_t parent = ::getpid();
  writer_ = fork_writer();
  if (writer_ > 0) return;
  if (writer_ < 0) {  // no child, e.g. for want of memory: the work has to wait
    note_written(try_to_write(stage, write_files));
    return;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // the parent decides whether to continue after Ctrl-C
  if (::getppid() != parent) ::_exit(1);
  static_cast<void>(::nice(5) + 1);
  ::_exit(try_to_write(stage, write_files) ? 0 : 1);
}

bool Checkpoints::try_to_write(const std::string& stage, const WriteFiles& write_files) const {
  try {
    write_checkpoint(folder_, last_number_ + 1, last_number_, stage, write_files, on_disk_until_);
    return true;
  } catch (const std::exception&) {
    discard_unfinished(folder_);
    return false;
  }
}

void Checkpoints::reap(bool wait) {
  if (writer_ < 0) return;
  int status = 0;
  pid_t ended = 0;
  do {
    ended = ::waitpid(writer_, &status, wait ? 0 : WNOHANG);
  } while (ended < 0 && errno == EINTR);
  if (ended == 0) return;
  writer_ = -1;
  note_written(ended > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

void Checkpoints::note_written(bool is_written) {
  if (!is_written) return fail_to_write();
  ++last_number_;
  constexpr std::chrono::seconds kClockStep{2};  // coarsest time stamps of file systems
  on_disk_until_ = being_written_since_ - kClockStep;
}

void Checkpoints::fail_to_write() {
  if (++failures_ > 1 || !tell_) return;
  tell_(folder_.string() +
        ": a checkpoint could not be written; is the disk full? The scan continues, and if " +
        "it is cut off " +
        (last_number_ > 0 ? "it resumes from the previous checkpoint" : "it starts again"));
}

bool Checkpoints::has_any() {
  reap(/*wait=*/true);
  return last_number_ > 0;
}

void Checkpoints::forget() {
  reap(/*wait=*/true);
  for (const std::int64_t number : checkpoint_numbers(folder_)) remove_checkpoint(folder_, number);
  last_number_ = 0;
}

void Checkpoints::remove() {
  reap(/*wait=*/true);
  if (lock_ < 0 && !fs::exists(folder_)) return;
  // Rename in one step, so completed work is never mistaken for interrupted work.
  std::error_code ignored;
  fs::remove_all(done_beside(folder_), ignored);
  fs::rename(folder_, done_beside(folder_), ignored);
  fs::remove_all(done_beside(folder_), ignored);
  if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

}  // namespace roomradar
