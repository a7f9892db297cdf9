// decompress.hpp: decompression of blocks whose size is known in advance.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace roomradar {

enum class Compression { kNone, kBz2, kLz4, kZstd, kZlib };

/// Max size of a decompressed block. Recorders write blocks of about 1 MB, or of a few images.
inline constexpr std::uint64_t kMaxBlock_bytes = std::uint64_t{1} << 29;

/// Decompresses a bz2 stream, LZ4 frame, zstd frame or zlib stream that contains exactly `size` bytes. Memory
/// grows as bytes are decompressed: `size`, which may be damaged, is not allocated in advance.
/// @param where  name of the block in error messages
/// @throws Error if the block is damaged, or its size differs from `size` or exceeds kMaxBlock_bytes
[[nodiscard]] std::string decompress(Compression compression, std::string_view packed, std::uint64_t size,
                                     const std::string& where);

/// Decompresses a block of unknown size. Throws Error if the block is damaged or decompresses to more than
/// max_bytes.
[[nodiscard]] std::string decompress_up_to(Compression compression, std::string_view packed,
                                           std::uint64_t max_bytes, const std::string& where);

}  // namespace roomradar
