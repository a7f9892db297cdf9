// job_folder.hpp: a job's folder, which appears as a whole or not at all.
//
// NAME holds the results of a finished job and job.json, NAME.running those of a running or killed one,
// NAME.failed those of the last failed one, and NAME.log what the command printed.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

/// Returns true if a folder holds the results of a job with this key.
bool is_done(const std::filesystem::path& folder, const std::string& key);

/// Returns the reason why the job with this key failed last; nullopt if it did not fail, was cancelled, or is
/// done since.
std::optional<std::string> failure_of(const std::filesystem::path& folder, const std::string& key);

/// The folder NAME.running of one job. Only one process at a time can have it. The destructor renames it to
/// NAME.failed unless commit() succeeded.
class RunningFolder {
 public:
  /// Creates an empty NAME.running. Returns nullopt if another process runs the job. Throws Error if the
  /// folder cannot be created.
  static std::optional<RunningFolder> create(const std::filesystem::path& folder);
  RunningFolder(RunningFolder&& other) noexcept;
  RunningFolder& operator=(RunningFolder&&) = delete;
  ~RunningFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return running_; }
  /// Writes job.json and renames the folder to NAME, in place of an older one. Throws Error on failure.
  /// @param command  the job's words, as information in job.json
  void commit(const std::string& key, const std::vector<std::string>& command);
  /// Writes the reason of a failure, for failure_of(). Ignores errors: the job then counts as not run.
  void note_failure(const std::string& key, const std::string& fault) const noexcept;

 private:
  RunningFolder(std::filesystem::path folder, int lock);

  std::filesystem::path folder_, running_;
  int lock_ = -1;  ///< descriptor of NAME.running, locked; the job's process inherits it
};

}  // namespace roomradar
