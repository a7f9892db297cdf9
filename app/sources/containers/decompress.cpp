// decompress.cpp: bzip2, LZ4, zstd and zlib behind one loop.
#include "app/sources/containers/decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Result of one step: bytes consumed, bytes produced, and the state of the stream.
struct Step {
  std::size_t consumed = 0, produced = 0;
  bool ended = false, failed = false;
};

/// Calls step(input, output) until the stream ends. The output buffer doubles when it is full.
template <typename StepFunction>
std::string decompress_stream(std::string_view packed, std::uint64_t max_bytes, const std::string& where,
                              const StepFunction& step) {
  constexpr std::uint64_t kFirst_bytes = 1U << 16U;
  std::string bytes(std::min(kFirst_bytes, max_bytes + 1), '\0');
  std::size_t done = 0;
  for (;;) {
    const Step result = step(packed, bytes.data() + done, bytes.size() - done);
    if (result.failed) throw Error(where + ": is damaged: it cannot be decompressed");
    packed.remove_prefix(result.consumed);
    done += result.produced;
    if (done > max_bytes)
      throw Error(where + ": is damaged: it decompresses to more than " + std::to_string(max_bytes) +
                  " bytes");
    if (result.ended) break;
    if (done == bytes.size())
      bytes.resize(std::min<std::uint64_t>(2 * bytes.size(), max_bytes + 1));
    else if (packed.empty() || (result.consumed == 0 && result.produced == 0))
      throw Error(where + ": is cut short or damaged: its compressed data have no end");
  }
  bytes.resize(done);
  return bytes;
}

std::string decompress_bz2(std::string_view packed, std::uint64_t max_bytes, const std::string& where) {
  bz_stream stream = {};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw Error(where + ": cannot be decompressed");
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> owner(&stream, BZ2_bzDecompressEnd);
  return decompress_stream(packed, max_bytes, where, [&](std::string_view in, char* out, std::size_t room) {
    stream.next_in = const_cast<char*>(in.data());
    stream.avail_in = static_cast<unsigned>(in.size());
    stream.next_out = out;
    stream.avail_out = static_cast<unsigned>(room);
    const int result = BZ2_bzDecompress(&stream);
    return Step{in.size() - stream.avail_in, room - stream.avail_out, result == BZ_STREAM_END,
                result != BZ_OK && result != BZ_STREAM_END};
  });
}

std::string decompress_zlib(std::string_view packed, std::uint64_t max_bytes, const std::string& where) {
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) throw Error(where + ": cannot be decompressed");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, inflateEnd);
  return decompress_stream(packed, max_bytes, where, [&](std::string_view in, char* out, std::size_t room) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    stream.avail_in = static_cast<unsigned>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out);
    stream.avail_out = static_cast<unsigned>(room);
    const int result = inflate(&stream, Z_NO_FLUSH);
    return Step{in.size() - stream.avail_in, room - stream.avail_out, result == Z_STREAM_END,
                result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR};
  });
}

std::string decompress_lz4(std::string_view packed, std::uint64_t max_bytes, const std::string& where) {
  LZ4F_dctx* context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)))
    throw Error(where + ": cannot be decompressed");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> owner(context,
                                                                           LZ4F_freeDecompressionContext);
  return decompress_stream(packed, max_bytes, where, [&](std::string_view in, char* out, std::size_t room) {
    std::size_t consumed = in.size(), produced = room;
    const std::size_t hint = LZ4F_decompress(context, out, &produced, in.data(), &consumed, nullptr);
    if (LZ4F_isError(hint)) return Step{0, 0, false, true};
    return Step{consumed, produced, hint == 0, false};
  });
}

std::string decompress_zstd(std::string_view packed, std::uint64_t max_bytes, const std::string& where) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) throw Error(where + ": cannot be decompressed");
  return decompress_stream(packed, max_bytes, where, [&](std::string_view in, char* out, std::size_t room) {
    ZSTD_inBuffer input = {in.data(), in.size(), 0};
    ZSTD_outBuffer output = {out, room, 0};
    const std::size_t hint = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(hint)) return Step{0, 0, false, true};
    return Step{input.pos, output.pos, hint == 0, false};
  });
}

}  // namespace

std::string decompress_up_to(Compression compression, std::string_view packed, std::uint64_t max_bytes,
                             const std::string& where) {
  switch (compression) {
    case Compression::kBz2:
      return decompress_bz2(packed, max_bytes, where);
    case Compression::kLz4:
      return decompress_lz4(packed, max_bytes, where);
    case Compression::kZstd:
      return decompress_zstd(packed, max_bytes, where);
    case Compression::kZlib:
      return decompress_zlib(packed, max_bytes, where);
    case Compression::kNone:
      break;
  }
  if (packed.size() > max_bytes)
    throw Error(where + ": is larger than " + std::to_string(max_bytes) + " bytes");
  return std::string(packed);
}

std::string decompress(Compression compression, std::string_view packed, std::uint64_t size,
                       const std::string& where) {
  if (size > kMaxBlock_bytes)
    throw Error(where + ": its size, " + std::to_string(size) + " bytes, is more than the most, " +
                std::to_string(kMaxBlock_bytes));
  std::string bytes = decompress_up_to(compression, packed, size, where);
  if (bytes.size() != size)
    throw Error(where + ": is damaged: it decompresses to " + std::to_string(bytes.size()) +
                " bytes instead of " + std::to_string(size));
  return bytes;
}

}  // namespace roomradar
