// compressed_columns.hpp: arrays of numbers in binary files, compressed with zstd.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "mapping/storage/binary_file.hpp"

namespace roomradar {

/// Appends `count` items of `item_bytes` bytes each: the count (u64), the number of compressed bytes (u64),
/// and one zstd frame. The frame contains byte planes: the first bytes of all items, then their second bytes,
/// and so on. Bytes of equal significance compress better if they are adjacent.
void put_column(std::string& out, const void* items, std::size_t count, std::size_t item_bytes);
template <typename Number>
void put_column(std::string& out, const std::vector<Number>& numbers) {
  static_assert(std::is_arithmetic_v<Number>);
  put_column(out, numbers.data(), numbers.size(), sizeof(Number));
}

/// Returns a difference, which may have wrapped, with its sign as the lowest bit: small differences have
/// small numbers, so that their high bytes compress well. from_sign_last() is the inverse.
template <typename Number>
Number with_sign_last(Number difference) {
  static_assert(std::is_unsigned_v<Number>);
  const auto d = static_cast<std::make_signed_t<Number>>(difference);
  return static_cast<Number>(d < 0 ? ~(d * 2) : d * 2);
}
template <typename Number>
Number from_sign_last(Number stored) {
  static_assert(std::is_unsigned_v<Number>);
  return static_cast<Number>((stored & 1U) != 0 ? ~(stored >> 1U) : stored >> 1U);
}

/// Takes columns from the body of a file. Throws Error naming the file if the body is cut short or damaged.
/// Rejects columns that together take more than 64 MB plus 1,000 times the body's size before memory is
/// allocated for them: no map compresses that well. Body and path must outlive the reader.
class ColumnReader {
 public:
  ColumnReader(std::string_view body, const std::filesystem::path& path)
      : in_(body, path), bytes_left_((std::uint64_t{64} << 20U) + 1000 * std::uint64_t{body.size()}) {}

  /// Returns the reader of the numbers between columns.
  [[nodiscard]] BinaryReader& numbers() { return in_; }

  /// @param what  name of the items in messages
  /// @param count  required number of items; unset: any
  template <typename Number>
  std::vector<Number> take(const char* what, std::optional<std::size_t> count = std::nullopt) {
    static_assert(std::is_arithmetic_v<Number>);
    std::vector<Number> numbers(take_count(sizeof(Number), what, count));
    take_items(numbers.data(), numbers.size(), sizeof(Number), what);
    return numbers;
  }

 private:
  std::size_t take_count(std::size_t item_bytes, const char* what, std::optional<std::size_t> expected);
  void take_items(void* items, std::size_t count, std::size_t item_bytes, const char* what);

  BinaryReader in_;
  std::uint64_t bytes_left_;
};

}  // namespace roomradar
