// atomic_file.hpp: atomic file writing.
#pragma once
#include <filesystem>
#include <fstream>

namespace roomradar {

/// Writes to target.partial-PID and renames it to `target` once complete; until then, and after any error,
/// `target` is unchanged. A `target` that is not a regular file (a pipe, a device) is written directly. A
/// file that stdout or stderr is redirected to is appended to directly, in order with their output.
class AtomicFile {
 public:
  /// Throws Error, with the system's reason, if the file cannot be opened.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Deletes the partial file unless commit() succeeded.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Binary stream to write to.
  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Renames the partial file to `target` atomically. A file being replaced is dropped only after the new one
  /// is synced to disk. Throws Error if writing, syncing or renaming fails.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;  ///< equals target_ if written directly
  int stream_of_process_ = -1;     ///< descriptor of the stdout or stderr that is redirected to the target;
                                   ///< -1: none
  std::ofstream stream_;
};

}  // namespace roomradar
