// whole_file.hpp: a file that appears whole or not at all.
#pragma once
#include <filesystem>
#include <fstream>

namespace roomradar {

/// A file that is written beside `target` (target.partial-PID) and takes its place when it is whole; until
/// then, and after any fault, `target` is what it was. What is no plain file (a pipe, a device) is written as
/// it comes; a file that stdout or stderr goes to is written on, in line with what these say.
class WholeFile {
 public:
  /// Throws Error, with the system's reason, if nothing can be written there.
  explicit WholeFile(const std::filesystem::path& target);
  /// Takes away what was not put in place.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// To write to, in binary mode.
  [[nodiscard]] std::ostream& stream() { return stream_; }

  /// Makes it `target` in one step; a file that it replaces goes only when this one is on the disk. Throws
  /// Error if not all that was written could be, or the file system does not do it.
  void put_in_place();

 private:
  std::filesystem::path target_;
  std::filesystem::path partial_;  ///< the target itself, if that is not to be replaced
  int stream_of_process_ = -1;     ///< that goes to the target, too; -1: none
  std::ofstream stream_;
};

}  // namespace roomradar
