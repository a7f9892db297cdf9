// job_folder.hpp: creates a job's folder atomically.
//
// NAME contains job.json and the results of the finished job. NAME.running contains those of a running or
// killed job, NAME.failed those of the last failed one. NAME.log contains the command's output.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roomradar {

/// Returns true if a folder contains the results of a job with this key.
bool is_done(const std::filesystem::path& folder, const std::string& key);

/// Returns the reason of the last failure of the job with this key. Returns nullopt if the job did not fail,
/// was cancelled, or has been done since.
std::optional<std::string> failure_of(const std::filesystem::path& folder, const std::string& key);

/// The folder NAME.running of a job, locked by one process at a time. The destructor renames the folder to
/// NAME.failed unless commit() has succeeded.
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
  /// @param command  the job's words, which are listed in job.json
  void commit(const std::string& key, const std::vector<std::string>& command);
  /// Stores the reason of a failure, for failure_of(). If this fails, the job counts as not run.
  void note_failure(const std::string& key, const std::string& fault) const noexcept;

 private:
  RunningFolder(std::filesystem::path folder, int lock);

  std::filesystem::path folder_, running_;
  int lock_ = -1;  ///< descriptor of NAME.running, locked; the job's process inherits it
};

}  // namespace roomradar
