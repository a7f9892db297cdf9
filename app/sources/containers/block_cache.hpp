// block_cache.hpp: keeps the blocks that were decompressed last.
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace roomradar {

/// Up to four blocks, or as many as 64 MB hold. The messages of one frame, and the transforms around its
/// time, are in neighbouring blocks: reading in order decompresses each block once. Not thread safe.
class BlockCache {
 public:
  /// Returns the block `number`, made by make() unless it is cached. The reference is valid until the next
  /// call.
  template <typename Make>
  const std::string& get(std::uint32_t number, const Make& make) {
    constexpr std::size_t kMaxBlocks = 4, kMax_bytes = std::size_t{64} << 20U;
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [number](const auto& block) { return block.first == number; });
    if (found != blocks_.end()) return found->second;
    blocks_.emplace_back(number, make());
    bytes_ += blocks_.back().second.size();
    while (blocks_.size() > kMaxBlocks && bytes_ > kMax_bytes) {
      bytes_ -= blocks_.front().second.size();
      blocks_.pop_front();
    }
    return blocks_.back().second;
  }

 private:
  std::deque<std::pair<std::uint32_t, std::string>> blocks_;
  std::size_t bytes_ = 0;  // of all blocks
};

}  // namespace roomradar
