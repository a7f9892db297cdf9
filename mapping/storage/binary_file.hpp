// binary_file.hpp: writes numbers to binary files, and reads and validates such files.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>

#include "mapping/types/serialize.hpp"

namespace roomradar {

static_assert(std::endian::native == std::endian::little, "files are written as memory has it");

template <typename Number>
void put(std::string& out, const Number* numbers, std::size_t count) {
  static_assert(std::is_arithmetic_v<Number>);
  out.append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}
template <typename Number>
void put(std::string& out, Number number) {
  put(out, &number, 1);
}

/// Takes numbers from the front of a file's bytes. Throws Error naming the file if bytes are missing. Bytes
/// and path must outlive the reader.
class BinaryReader {
 public:
  BinaryReader(std::string_view bytes, const std::filesystem::path& path) : bytes_(bytes), path_(path) {}

  [[noreturn]] void fail(const std::string& fault) const;
  /// Fails if fewer than `count` items remain. Call it before allocating memory for them.
  void require(std::size_t count, std::size_t item_bytes, const char* what) const {
    if (count > bytes_.size() / item_bytes) fail(std::string("cut short: ") + what + " missing");
  }
  template <typename Number>
  void take(Number* numbers, std::size_t count, const char* what) {
    static_assert(std::is_arithmetic_v<Number>);
    require(count, sizeof(Number), what);
    if (count > 0) std::memcpy(numbers, bytes_.data(), count * sizeof(Number));
    bytes_.remove_prefix(count * sizeof(Number));
  }
  template <typename Number>
  Number take(const char* what) {
    Number number{};
    take(&number, 1, what);
    return number;
  }
  /// Takes the next `count` bytes. Returns a view of them, without a copy.
  std::string_view take_bytes(std::size_t count, const char* what) {
    require(count, 1, what);
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  /// Takes a double. Also throws if the number is not finite.
  double take_finite(const char* what);
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::string_view bytes_;
  const std::filesystem::path& path_;
};

/// End of messages about files that are damaged.
inline constexpr const char* kFileAdvice = "; make the map again or take it from a backup";

/// Writes `magic`, `version`, `body` and a checksum of all three. Throws Error if the file cannot be written.
void write_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                  std::string_view body);

struct BinaryBody {
  std::uint32_t version = 0;
  std::string bytes;
};
/// Whether read_binary() compares the checksum in the file, which takes 1.5 ms per MB.
enum class FileChecksum {
  kCompared,
  kNotNeeded,  ///< the caller has just compared a checksum of the whole file
};
/// Returns the body of a file written by write_binary() with a version from `oldest` to `newest`. Throws
/// Error naming the file and the fault if the file is missing, truncated, altered, or of another kind or
/// version.
BinaryBody read_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t oldest,
                       std::uint32_t newest, FileChecksum checksum = FileChecksum::kCompared);
/// Returns the body of a file of this version.
inline std::string read_binary(const std::filesystem::path& path, std::string_view magic,
                               std::uint32_t version) {
  return read_binary(path, magic, version, version).bytes;
}

/// Writes a file with these fields, each by serialize(). Throws Error if it cannot be written.
template <typename... Fields>
void save_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                 const Fields&... fields) {
  ByteWriter out;
  out(fields...);
  write_binary(path, magic, version, out.bytes);
}
/// Reads the fields of a file written by save_binary(). Throws Error as read_binary() does, and if a field is
/// invalid or bytes are left.
template <typename... Fields>
void load_binary(const std::filesystem::path& path, std::string_view magic, std::uint32_t version,
                 Fields&... fields) {
  const std::string bytes = read_binary(path, magic, version);
  ByteReader in(bytes, path.string(), kFileAdvice);
  in(fields...);
  in.require_end();
}

}  // namespace roomradar
