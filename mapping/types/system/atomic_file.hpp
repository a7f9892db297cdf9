// atomic_file.hpp: atomic file writing.
#pragma once
#include <filesystem>
#include <fstream>

namespace roomradar {

/// Writes to target.partial-PID, and renames this file to `target` once it is complete. Until then, and after
/// any error, `target` is unchanged. A `target` that is not a regular file (a pipe, a device) is written
/// directly. If stdout or stderr is redirected to `target`, the output is appended to `target` directly, in
/// order with that of stdout and stderr.
class AtomicFile {
 public:
  /// Throws Error, with the system's reason, if the file cannot be opened.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Deletes the partial file unless commit() succeeded.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the binary stream to which callers write.
  /// Writes in the classic locale.
  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Renames the partial file to `target` atomically. An existing file is replaced only after the new one is
  /// synced to disk. Throws Error if writing, syncing or renaming fails.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;  ///< equals target_ if written directly
  int stream_of_process_ = -1;     ///< descriptor of stdout or stderr if redirected to the target; else -1
  std::ofstream stream_;
};

}  // namespace roomradar
