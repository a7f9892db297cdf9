// compressed_columns.hpp: arrays of numbers in binary files, compressed with zstd.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
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

/// Returns bytes as one zstd frame, as columns have it.
std::string compress_frame(std::string_view bytes);

struct UnpackedFrame {
  std::string bytes;
  std::size_t frame_bytes = 0;  ///< size of the frame
};
/// Unpacks the zstd frame with which `packed` begins. Returns nullopt if there is none, or it would take more
/// than 64 MB plus 1,000 times its size.
std::optional<UnpackedFrame> unpack_frame(std::string_view packed);

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
/// allocated for them: no map compresses that well. The body must outlive the reader.
class ColumnReader {
 public:
  /// @param where  the file, in messages
  ColumnReader(std::string_view body, std::string where)
      : in_(body, std::move(where), kFileAdvice),
        bytes_left_((std::uint64_t{64} << 20U) + 1000 * std::uint64_t{body.size()}) {}

  /// Returns the reader of the numbers between columns.
  [[nodiscard]] ByteReader& numbers() { return in_; }

  /// A column that is still compressed.
  template <typename Number>
  struct Packed {
    std::size_t count = 0;
    const char* what = "";
    std::string_view frame;
  };

  /// Takes a column as it is, for unpack().
  /// @param what  name of the items in messages; a literal
  /// @param count  required number of items; unset: any
  template <typename Number>
  Packed<Number> take_packed(const char* what, std::optional<std::size_t> count = std::nullopt) {
    static_assert(std::is_arithmetic_v<Number>);
    const std::size_t items = take_count(sizeof(Number), what, count);
    return {items, what, in_.take(in_.number<std::uint64_t>())};
  }
  /// Items of an unpacked column, one after the other. Valid until the reader unpacks another column.
  template <typename Number>
  class Items {
   public:
    Items(const char* planes, std::size_t count) : planes_(planes), count_(count) {}
    /// At most `count` calls.
    Number next() {
      std::array<char, sizeof(Number)> bytes;
      for (std::size_t plane = 0; plane < sizeof(Number); ++plane)
        bytes[plane] = planes_[plane * count_ + at_];
      ++at_;
      return std::bit_cast<Number>(bytes);
    }

   private:
    const char* planes_;
    std::size_t count_, at_ = 0;
  };
  template <typename Number>
  Items<Number> unpack(const Packed<Number>& packed) {
    unpack_planes(packed.frame, packed.count * sizeof(Number), packed.what);
    return {planes_.data(), packed.count};
  }
  /// Takes and unpacks a column.
  template <typename Number>
  std::vector<Number> take(const char* what, std::optional<std::size_t> count = std::nullopt) {
    const Packed<Number> packed = take_packed<Number>(what, count);
    Items<Number> items = unpack(packed);
    std::vector<Number> numbers(packed.count);
    for (Number& number : numbers) number = items.next();
    return numbers;
  }

 private:
  std::size_t take_count(std::size_t item_bytes, const char* what, std::optional<std::size_t> expected);
  void unpack_planes(std::string_view frame, std::size_t bytes, const char* what);

  ByteReader in_;
  std::uint64_t bytes_left_;
  std::string planes_;  ///< of the last column unpacked; reused
};

}  // namespace roomradar
