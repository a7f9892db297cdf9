// block_cache.hpp: cache of a file's most recently decompressed blocks.
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "app/sources/containers/decompress.hpp"
#include "app/sources/containers/random_access_file.hpp"

namespace roomradar {

/// Location of a block in the file, its stored and decompressed sizes, and its compression.
struct PackedBlock {
  std::uint64_t offset = 0, packed_bytes = 0, bytes = 0;
  Compression compression = Compression::kNone;
};

/// Keeps the last four decompressed blocks, and further ones while the cached blocks take at most 64 MiB. The
/// messages of a frame are in neighbouring blocks, so reading frames in order decompresses each block once.
/// Not thread safe.
class BlockCache {
 public:
  /// Returns the decompressed block with index `number`. Decompresses the block unless it is cached. The
  /// reference is valid until the next call. Throws Error naming the file if the block is damaged.
  const std::string& get(std::uint32_t number, const RandomAccessFile& file, const PackedBlock& block) {
    constexpr std::size_t kMaxBlocks = 4, kMax_bytes = std::size_t{64} << 20U;
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [number](const auto& cached) { return cached.first == number; });
    if (found != blocks_.end()) return found->second;
    blocks_.emplace_back(
        number, decompress(block.compression, file.read(block.offset, block.packed_bytes), block.bytes,
                           file.name() + ": the chunk at byte " + std::to_string(block.offset)));
    bytes_ += blocks_.back().second.size();
    while (blocks_.size() > kMaxBlocks && bytes_ > kMax_bytes) {
      bytes_ -= blocks_.front().second.size();
      blocks_.pop_front();
    }
    return blocks_.back().second;
  }

 private:
  std::deque<std::pair<std::uint32_t, std::string>> blocks_;
  std::size_t bytes_ = 0;  // total size of the cached blocks
};

}  // namespace roomradar
