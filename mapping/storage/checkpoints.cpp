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
#include <charconv>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>
#include <utility>

#include "mapping/storage/atomic_folder.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kWork = "work.json";
constexpr const char* kWorkWriting = "work.json.writing";
constexpr const char* kWriting = "checkpoint.writing";
constexpr const char* kManifest = "manifest.json";
constexpr std::string_view kPrefix = "checkpoint-";
constexpr std::int64_t kKept = 2;
constexpr std::uintmax_t kMaxJsonBytes = 16U << 20U;

[[noreturn]] void reject(const fs::path& path, const std::string& fault) {
  throw Error(path.string() + ": " + fault);
}

fs::path numbered(const fs::path& folder, std::int64_t number) {
  return folder / (std::string(kPrefix) + std::to_string(number));
}

Json read_json(const fs::path& path) {
  std::error_code fault;
  if (fs::is_symlink(path, fault)) reject(path, "is a link; checkpoints contain no links");
  Json json = Json::parse(read_bytes(path, "a checkpoint's description", kMaxJsonBytes), nullptr,
                          /*allow_exceptions=*/false);
  if (json.is_discarded() || !json.is_object())
    reject(path,
           "is damaged" + std::string(path.filename() == kWork ? "; delete the folder to start again" : ""));
  return json;
}

/// Returns sorted paths relative to the folder, without litter of desktops.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator each(folder); each != fs::end(each); ++each) {
    if (is_litter(each->path().filename().string()))
      each.disable_recursion_pending();
    else if (!each->is_directory())
      files.push_back(each->path().lexically_relative(folder));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Returns a file's size and checksum. For a file linked from the previous checkpoint, reuses the old entry
/// instead of reading it.
Json description_of(const fs::path& into, const fs::path& file, const fs::path& previous,
                    const Json& before) {
  const auto was = before.find(file.generic_string());
  std::error_code fault;
  if (was != before.end() && fs::equivalent(previous / file, into / file, fault)) return *was;
  return {{"bytes", fs::file_size(into / file)}, {"sha256", sha256_of_file(into / file)}};
}

/// Waits until all subfolders, and all files written since `since`, are on disk.
void sync_new_files(const fs::path& folder, fs::file_time_type since) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory() || entry.last_write_time() >= since) sync_to_disk(entry.path());
}

}  // namespace

void write_checkpoint(const fs::path& folder, std::int64_t number, std::int64_t last_number,
                      const std::string& stage, const WriteCheckpointFiles& write_files,
                      fs::file_time_type on_disk_until) {
  const fs::path into = folder / kWriting;
  fs::remove_all(into);
  fs::create_directory(into);
  const fs::path previous = last_number > 0 ? numbered(folder, last_number) : fs::path{};
  const Json before = previous.empty() ? Json::object() : read_json(previous / kManifest).at("files");
  write_files(into, previous);
  Json manifest{{"stage", stage}, {"files", Json::object()}};
  for (const fs::path& file : files_below(into))
    manifest["files"][file.generic_string()] = description_of(into, file, previous, before);
  write_bytes(into / kManifest, manifest.dump(1) + "\n");
  sync_new_files(folder, on_disk_until);
  fs::remove_all(numbered(folder, number));  // damaged, or from an earlier numbering
  fs::rename(into, numbered(folder, number));
  sync_to_disk(folder);
  for (const std::int64_t other : checkpoint_numbers(folder)) {
    if (other <= number - kKept || other > number) fs::remove_all(numbered(folder, other));
  }
}

void discard_unfinished(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder / kWriting, ignored);
}

Checkpoint read_checkpoint(const fs::path& all, std::int64_t number) {
  const fs::path folder = numbered(all, number);
  const Json manifest = read_json(folder / kManifest);
  const auto stage = manifest.find("stage");
  const auto files = manifest.find("files");
  if (stage == manifest.end() || !stage->is_string() || files == manifest.end() || !files->is_object())
    reject(folder / kManifest, "is damaged");
  std::size_t listed = 1;  // the manifest itself
  for (const auto& [name, expected] : files->items()) {
    const fs::path path = folder / name;
    const fs::path inside = fs::path(name).lexically_normal();
    if (inside.is_absolute() || inside.empty() || *inside.begin() == "..")
      reject(folder / kManifest, "is damaged: it names a file outside its folder");
    std::error_code fault;
    if (!fs::is_regular_file(fs::symlink_status(path, fault))) reject(path, "is missing");
    const bool sound = expected.is_object() && expected.value("bytes", Json{}).is_number_unsigned() &&
                       expected.value("sha256", Json{}).is_string() &&
                       fs::file_size(path) == expected["bytes"].get<std::uintmax_t>() &&
                       sha256_of_file(path) == expected["sha256"].get<std::string>();
    if (!sound) reject(path, "is damaged");
    ++listed;
  }
  if (files_below(folder).size() != listed) reject(folder, "holds files that are not its own");
  return {stage->get<std::string>(), folder};
}

void remove_checkpoint(const fs::path& folder, std::int64_t number) {
  std::error_code ignored;
  fs::remove_all(numbered(folder, number), ignored);
}

std::vector<std::int64_t> checkpoint_numbers(const fs::path& folder) {
  std::vector<std::int64_t> numbers;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    std::int64_t number = 0;
    if (!name.starts_with(kPrefix)) continue;
    const char* const end = name.data() + name.size();
    const auto parsed = std::from_chars(name.data() + kPrefix.size(), end, number);
    if (parsed.ec == std::errc() && parsed.ptr == end && number > 0) numbers.push_back(number);
  }
  std::sort(numbers.rbegin(), numbers.rend());
  return numbers;
}

void write_identity(const fs::path& folder, const std::map<std::string, std::string>& identity) {
  if (fs::exists(folder / kWork)) return;
  write_bytes(folder / kWorkWriting, Json{{"work", identity}}.dump(2) + "\n");
  fs::rename(folder / kWorkWriting, folder / kWork);
  sync_to_disk(folder / kWork);
}

bool has_nothing_to_resume(const fs::path& folder) {
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (name != kWork && name != kCheckpointLock && !is_litter(name)) return false;
  }
  return !fault;
}

fs::path done_beside(const fs::path& folder) { return folder.string() + ".done"; }

void require_checkpoints_only(const fs::path& folder, std::string_view beside) {
  std::error_code fault;
  const fs::file_status status = fs::symlink_status(folder, fault);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    reject(folder, "is not a folder, but has the name of the scan's checkpoint folder; move it away");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (name != kWork && name != kWorkWriting && name != kCheckpointLock && name != kWriting &&
        name != beside && !name.starts_with(kPrefix) && !is_litter(name))
      reject(folder, "holds \"" + name + "\", which is not part of an interrupted scan; move it away");
  }
  if (fault) reject(folder, "cannot be listed: " + system_reason(fault));
}

std::map<std::string, std::string> identity_of(const fs::path& folder) {
  const Json json = read_json(folder / kWork);
  const auto work = json.find("work");
  const char* const kDamaged = "is damaged; delete the folder to start again";
  if (work == json.end() || !work->is_object()) reject(folder / kWork, kDamaged);
  std::map<std::string, std::string> identity;
  for (const auto& [name, value] : work->items()) {
    if (!value.is_string()) reject(folder / kWork, kDamaged);
    identity[name] = value.get<std::string>();
  }
  return identity;
}

bool carry_over(const fs::path& from, const fs::path& to) {
  std::error_code fault;
  if (!fs::is_regular_file(from, fault)) return false;
  fs::create_hard_link(from, to, fault);
  if (!fault) return true;
  return fs::copy_file(from, to, fault) && !fault;
}

namespace {

namespace fs = std::filesystem;

/// A checkpoint of a flat of ten minutes takes some seconds.
constexpr unsigned kLongestWrite_s = 300;

/// Returns fork(). What the child may use, and why, is in app/decisions/checkpoints-by-a-forked-child.md. With
/// the address sanitizer returns -1: its allocator may be locked by another thread, and
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
  std::signal(SIGALRM, SIG_DFL);
  ::alarm(kLongestWrite_s);  // a child that hangs is ended, and counts as not written
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
