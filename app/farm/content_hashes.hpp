// content_hashes.hpp: computes hashes of the contents of files and folders.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace roomradar {

/// Hashes contents. Caches each file's hash in memory and in a file. The cached hash is valid while size and
/// modification time are the same.
class ContentHashes {
 public:
  /// @param memory  file with the hashes of earlier runs; need not exist. The file's format is checked, but
  ///                its hashes are trusted
  explicit ContentHashes(std::filesystem::path memory);

  /// Returns the SHA-256 of a file's content, or of the names and contents of all files of a folder, in
  /// hexadecimal digits. Follows links. Throws Error if something cannot be read.
  std::string of(const std::filesystem::path& path);
  /// Returns the total size of the files hashed so far, bytes.
  [[nodiscard]] std::uintmax_t bytes() const { return bytes_; }

  /// Writes the file if hashes were added. Ignores a failure: the next run then computes the hashes again.
  void save() const noexcept;

 private:
  struct Known {
    std::uintmax_t size = 0;
    std::int64_t changed = 0;  ///< modification time, in clock ticks of the file system
    std::string sha256;
  };
  std::filesystem::path memory_;
  std::map<std::string, Known> known_;  ///< by absolute path
  std::uintmax_t bytes_ = 0;
  bool has_news_ = false;

  std::string of_file(const std::filesystem::path& path);
};

}  // namespace roomradar
