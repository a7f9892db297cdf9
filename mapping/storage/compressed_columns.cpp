// compressed_columns.cpp: splits items into byte planes, and compresses these with zstd.
#include "mapping/storage/compressed_columns.hpp"

#include <zstd.h>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

// At higher levels, planes of noise take ten times as long and are 1 % smaller.
constexpr int kLevel = 3;

}  // namespace

void put_column(std::string& out, const void* items, std::size_t count, std::size_t item_bytes) {
  const auto* const bytes = static_cast<const char*>(items);
  std::string planes(count * item_bytes, '\0');
  for (std::size_t plane = 0; plane < item_bytes; ++plane)
    for (std::size_t i = 0; i < count; ++i) planes[plane * count + i] = bytes[i * item_bytes + plane];
  put(out, std::uint64_t{count});
  const std::size_t size_at = out.size();
  put(out, std::uint64_t{0});
  const std::size_t begin = out.size();
  out.resize(begin + ZSTD_compressBound(planes.size()));
  const std::size_t size =
      ZSTD_compress(out.data() + begin, out.size() - begin, planes.data(), planes.size(), kLevel);
  if (ZSTD_isError(size) != 0)
    throw Error(std::string("zstd cannot compress an array: ") + ZSTD_getErrorName(size));
  out.resize(begin + size);
  const auto stored = std::uint64_t{size};
  std::memcpy(out.data() + size_at, &stored, sizeof(stored));
}

std::size_t ColumnReader::take_count(std::size_t item_bytes, const char* what,
                                     std::optional<std::size_t> expected) {
  const auto count = in_.take<std::uint64_t>(what);
  if (expected && count != *expected)
    in_.fail(std::to_string(count) + " " + what + ", where " + std::to_string(*expected) + " belong");
  if (count > bytes_left_ / item_bytes)
    in_.fail(std::to_string(count) + " " + what + ", more than a file of this size can hold");
  bytes_left_ -= count * item_bytes;
  return count;
}

void ColumnReader::take_items(void* items, std::size_t count, std::size_t item_bytes, const char* what) {
  const std::string_view frame = in_.take_bytes(in_.take<std::uint64_t>(what), what);
  std::string planes(count * item_bytes, '\0');
  const std::size_t size = ZSTD_decompress(planes.data(), planes.size(), frame.data(), frame.size());
  if (ZSTD_isError(size) != 0 || size != planes.size())
    in_.fail(std::string("damaged: its ") + what + " cannot be unpacked");
  auto* const bytes = static_cast<char*>(items);
  for (std::size_t plane = 0; plane < item_bytes; ++plane)
    for (std::size_t i = 0; i < count; ++i) bytes[i * item_bytes + plane] = planes[plane * count + i];
}

}  // namespace roomradar
