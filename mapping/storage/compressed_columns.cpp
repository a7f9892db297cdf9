// compressed_columns.cpp: splits items into byte planes, and compresses these with zstd.
#include "mapping/storage/compressed_columns.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

// At higher levels, planes of noise take ten times as long and are 1 % smaller.
constexpr int kLevel = 3;

void require_compressed(std::size_t result) {
  if (ZSTD_isError(result) != 0)
    throw Error(std::string("zstd cannot compress an array: ") + ZSTD_getErrorName(result));
}

/// Appends one zstd frame to a string, from parts of its contents.
class Compressor {
 public:
  /// @param size  bytes of all parts together
  Compressor(std::size_t size, std::string& out) : context_(ZSTD_createCCtx(), &ZSTD_freeCCtx), out_(out) {
    if (!context_) throw std::bad_alloc();
    require_compressed(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel));
    require_compressed(ZSTD_CCtx_setPledgedSrcSize(context_.get(), size));
  }

  void add(std::string_view part) { compress(part, ZSTD_e_continue); }
  void finish() { compress({}, ZSTD_e_end); }

 private:
  void compress(std::string_view part, ZSTD_EndDirective mode) {
    ZSTD_inBuffer in{part.data(), part.size(), 0};
    for (std::size_t left = 1; in.pos < in.size || (mode == ZSTD_e_end && left > 0);) {
      ZSTD_outBuffer packed{packed_.data(), packed_.size(), 0};
      left = ZSTD_compressStream2(context_.get(), &packed, &in, mode);
      require_compressed(left);
      out_.append(packed_.data(), packed.pos);
    }
  }

  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context_;
  std::string& out_;
  std::array<char, 1U << 16U> packed_{};
};

}  // namespace

void put_column(std::string& out, const void* items, std::size_t count, std::size_t item_bytes) {
  std::array<std::uint64_t, 2> sizes{count};
  const std::size_t sizes_at = out.size(), begin = sizes_at + sizeof(sizes);
  out.reserve(begin + ZSTD_compressBound(count * item_bytes));  // growing would copy what is there
  out.resize(begin);
  Compressor compressor(count * item_bytes, out);
  const auto* const bytes = static_cast<const char*>(items);
  std::array<char, 1U << 16U> part;
  for (std::size_t plane = 0; plane < item_bytes; ++plane)
    for (std::size_t first = 0; first < count; first += part.size()) {
      const std::size_t size = std::min(part.size(), count - first);
      for (std::size_t i = 0; i < size; ++i) part[i] = bytes[(first + i) * item_bytes + plane];
      compressor.add({part.data(), size});
    }
  compressor.finish();
  sizes[1] = out.size() - begin;
  std::memcpy(out.data() + sizes_at, sizes.data(), sizeof(sizes));
}

std::string compress_frame(std::string_view bytes) {
  constexpr std::size_t kPart_bytes = 1U << 16U;
  std::string frame;
  Compressor compressor(bytes.size(), frame);
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kPart_bytes)))
    compressor.add(bytes.substr(0, kPart_bytes));
  compressor.finish();
  return frame;
}

std::optional<UnpackedFrame> unpack_frame(std::string_view packed) {
  const std::size_t size = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
  if (ZSTD_isError(size) != 0) return std::nullopt;
  const unsigned long long bytes = ZSTD_getFrameContentSize(packed.data(), size);
  if (bytes == ZSTD_CONTENTSIZE_UNKNOWN || bytes == ZSTD_CONTENTSIZE_ERROR ||
      bytes > (std::uint64_t{64} << 20U) + 1000 * std::uint64_t{size})
    return std::nullopt;
  UnpackedFrame frame{std::string(bytes, '\0'), size};
  const std::size_t unpacked = ZSTD_decompress(frame.bytes.data(), bytes, packed.data(), size);
  if (ZSTD_isError(unpacked) != 0 || unpacked != bytes) return std::nullopt;
  return frame;
}

std::size_t ColumnReader::take_count(std::size_t item_bytes, const char* what,
                                     std::optional<std::size_t> expected) {
  const auto count = in_.number<std::uint64_t>();
  if (expected && count != *expected)
    in_.fail(std::to_string(count) + " " + what + ", where " + std::to_string(*expected) + " belong");
  if (count > bytes_left_ / item_bytes)
    in_.fail(std::to_string(count) + " " + what + ", more than a file of this size can hold");
  bytes_left_ -= count * item_bytes;
  return count;
}

void ColumnReader::unpack_planes(std::string_view frame, std::size_t bytes, const char* what) {
  planes_.resize(std::max(planes_.size(), bytes));
  const std::size_t size = ZSTD_decompress(planes_.data(), bytes, frame.data(), frame.size());
  if (ZSTD_isError(size) != 0 || size != bytes)
    in_.fail(std::string("damaged: its ") + what + " cannot be unpacked");
}

}  // namespace roomradar
