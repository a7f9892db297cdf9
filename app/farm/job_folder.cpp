// job_folder.cpp: a lock on the folder itself, which ends with the last process that has it open.
#include "app/farm/job_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "mapping/storage/atomic_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJobFile = "job.json";
constexpr const char* kFormat = "roomradar job";
constexpr const char* kFailureFile = "failure.json";
constexpr const char* kFailureFormat = "roomradar failed job";
constexpr std::uintmax_t kLargestJobFile_bytes = 1U << 24U;

fs::path with_ending(const fs::path& folder, const char* ending) { return folder.string() + ending; }

/// Returns the content of a file on the job with this key; nullopt if it is not there or of another form.
std::optional<nlohmann::json> read_of_job(const fs::path& file, const char* format, const std::string& key) {
  try {
    const std::string text = read_bytes(file, "a job's file", kLargestJobFile_bytes);
    nlohmann::json job = nlohmann::json::parse(text);
    if (job.value("format", "") == format && job.value("key", "") == key) return job;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

}  // namespace

bool is_done(const fs::path& folder, const std::string& key) {
  return read_of_job(folder / kJobFile, kFormat, key).has_value();
}

std::optional<std::string> failure_of(const fs::path& folder, const std::string& key) {
  const auto failure = read_of_job(with_ending(folder, ".failed") / kFailureFile, kFailureFormat, key);
  if (!failure || !failure->contains("fault") || !failure->at("fault").is_string()) return std::nullopt;
  return failure->at("fault").get<std::string>();
}

std::optional<RunningFolder> RunningFolder::create(const fs::path& folder) {
  const fs::path running = with_ending(folder, ".running");
  std::error_code fault;
  fs::create_directories(running, fault);
  const int lock = open(running.c_str(), O_RDONLY | O_DIRECTORY);
  if (lock < 0) throw Error(running.string() + ": cannot be created: " + system_reason(errno));
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    close(lock);
    return std::nullopt;
  }
  RunningFolder made(folder, lock);
  for (const auto& entry : fs::directory_iterator(running, fault)) fs::remove_all(entry.path(), fault);
  if (!fs::is_empty(running, fault) || fault) throw Error(running.string() + ": cannot be emptied");
  return made;
}

RunningFolder::RunningFolder(fs::path folder, int lock)
    : folder_(std::move(folder)), running_(with_ending(folder_, ".running")), lock_(lock) {}

RunningFolder::RunningFolder(RunningFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      running_(std::move(other.running_)),
      lock_(std::exchange(other.lock_, -1)) {}

RunningFolder::~RunningFolder() {
  if (lock_ < 0) return;
  try {
    put_in_place(running_, with_ending(folder_, ".failed"));
  } catch (const std::exception&) {  // it is emptied when the job is run once more
  }
  close(lock_);
}

void RunningFolder::note_failure(const std::string& key, const std::string& fault) const noexcept {
  try {
    const nlohmann::json failure = {
        {"format", kFailureFormat}, {"version", 1}, {"key", key}, {"fault", fault}};
    const auto replace = nlohmann::json::error_handler_t::replace;  // a program may print any bytes
    write_bytes(running_ / kFailureFile, failure.dump(2, ' ', false, replace) + "\n");
  } catch (const std::exception&) {
  }
}

void RunningFolder::commit(const std::string& key, const std::vector<std::string>& command) {
  const nlohmann::json job = {{"format", kFormat},   {"version", 1},
                              {"program", kVersion}, {"name", folder_.filename().string()},
                              {"command", command},  {"key", key}};
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(running_, ignored))
    if (entry.is_regular_file()) sync_to_disk(entry.path());
  write_bytes(running_ / kJobFile, job.dump(2) + "\n");
  sync_to_disk(running_ / kJobFile);
  sync_to_disk(running_);
  put_in_place(running_, folder_);
  fs::remove_all(with_ending(folder_, ".failed"), ignored);
  close(std::exchange(lock_, -1));
}

}  // namespace roomradar
