// random_access_file.hpp: reads byte ranges of a file that is too large for memory.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace roomradar {

/// A regular file, open for reading at any offset. Owns the file descriptor. read() may be called from
/// several threads.
class RandomAccessFile {
 public:
  /// Throws Error naming the file if it is missing, not a regular file or not readable.
  explicit RandomAccessFile(const std::filesystem::path& path);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  /// Returns the file's size when it was opened, bytes.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns true if the file has `count` bytes from `offset` on.
  [[nodiscard]] bool has(std::uint64_t offset, std::uint64_t count) const {
    return offset <= size_ && count <= size_ - offset;
  }
  /// Returns `count` bytes from `offset` on. Throws Error, before memory is allocated, if the file ends
  /// earlier.
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;
  /// Returns at most `count` bytes from `offset` on, fewer at the end of the file.
  [[nodiscard]] std::string read_up_to(std::uint64_t offset, std::uint64_t count) const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Returns true if the path is a regular file that begins with these bytes. Throws Error if it cannot be
/// read.
[[nodiscard]] bool begins_with(const std::filesystem::path& path, std::string_view bytes);

}  // namespace roomradar
