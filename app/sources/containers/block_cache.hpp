// block_cache.hpp: keeps the blocks that were decompressed last.
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

namespace roomradar {

/// Up to four blocks. The messages of one frame are usually in the same block or in neighbours. Not thread
/// safe.
class BlockCache {
 public:
  /// Returns the block `number`, made by make() unless it is cached. The reference is valid until the next
  /// call.
  template <typename Make>
  const std::string& get(std::uint32_t number, const Make& make) {
    constexpr std::size_t kMaxBlocks = 4;
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [number](const auto& block) { return block.first == number; });
    if (found != blocks_.end()) return found->second;
    if (blocks_.size() == kMaxBlocks) blocks_.pop_front();
    blocks_.emplace_back(number, make());
    return blocks_.back().second;
  }

 private:
  std::deque<std::pair<std::uint32_t, std::string>> blocks_;
};

}  // namespace roomradar
