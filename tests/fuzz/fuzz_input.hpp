// fuzz_input.hpp: a fuzzer's bytes as files, and the permitted outcomes of a reader.
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "mapping/types/system/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test {

/// Temporary folder of this process, in $TMPDIR, which should be in memory.
inline const std::filesystem::path& fuzz_folder() {
  static const TemporaryFolder folder;
  return folder.path();
}

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
  const std::size_t written = bytes.empty() ? 0 : std::fwrite(bytes.data(), 1, bytes.size(), file);
  if (std::fclose(file) != 0 || written != bytes.size())
    throw std::runtime_error(path.string() + ": cannot be written");
}

/// Writes a file with these bytes; replaces a file of the same name.
inline std::filesystem::path file_with(std::string_view bytes, const std::string& name) {
  std::filesystem::path path = fuzz_folder() / name;
  write_bytes(path, bytes);
  return path;
}

/// Makes a folder of files from one text, in which each file begins with a line "%% NAME". Skips files whose
/// name is 64 or more characters long or has characters other than letters, digits, ".", "-", "_" and one
/// "/".
inline std::filesystem::path folder_with(std::string_view text) {
  constexpr std::size_t kMostFiles = 24;
  constexpr std::string_view kMark = "%% ";
  std::filesystem::path folder = fuzz_folder() / "folder";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  std::size_t at = text.starts_with(kMark) ? 0 : std::string_view::npos;
  for (std::size_t files = 0; at != std::string_view::npos && files < kMostFiles; ++files) {
    const std::size_t line_end = text.find('\n', at);
    if (line_end == std::string_view::npos) break;
    const std::string name(text.substr(at + kMark.size(), line_end - at - kMark.size()));
    const std::size_t next = text.find("\n%% ", line_end);
    const std::size_t end = next == std::string_view::npos ? text.size() : next;
    at = next == std::string_view::npos ? next : next + 1;
    const bool is_plain = !name.empty() && name.size() < 64 && name.front() != '/' && name.back() != '/' &&
                          name.find("..") == std::string::npos && name.find('/') == name.rfind('/') &&
                          name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789.-_/") == std::string::npos;
    if (!is_plain) continue;
    const std::filesystem::path path = folder / name;
    std::error_code ignored;
    std::filesystem::create_directories(path.parent_path(), ignored);
    if (!std::filesystem::is_directory(path, ignored) &&
        std::filesystem::is_directory(path.parent_path(), ignored))
      write_bytes(path, line_end < end ? text.substr(line_end + 1, end - line_end - 1) : std::string_view{});
  }
  return folder;
}

/// Runs `read`, which may reject its input only by throwing Error. Anything else it throws ends the process.
template <typename Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (std::string_view(error.what()).size() < 10) throw std::logic_error("an error without words");
  }
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace roomradar::test

/// libFuzzer's entry point; one per target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
