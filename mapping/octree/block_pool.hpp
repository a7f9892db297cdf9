// block_pool.hpp: pool allocator for equally sized blocks that are addressed by 32-bit numbers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar {

/// Pool of blocks. Blocks never move. References thus stay valid while other blocks are allocated. Number 0
/// is reserved and means "none".
template <typename Block>
class BlockPool {
 public:
  /// @param limit  max number of blocks in use at a time; by default, all numbers below 2^31
  explicit BlockPool(std::uint32_t limit = (1U << 31U) - 1) : limit_(limit) {}

  /// Allocates a block, initialised to Block{}, and returns its number. Throws Error if the limit is reached.
  std::uint32_t take() {
    std::uint32_t number = 0;
    if (free_.empty()) {
      if (next_ > limit_)
        throw Error("the octree has " + std::to_string(limit_) +
                    " blocks of eight voxels, and no numbers for more; take a coarser resolution");
      if (next_ % kChunk == 0 || chunks_.empty()) chunks_.push_back(std::make_unique<Block[]>(kChunk));
      number = next_++;
    } else {
      number = free_.back();
      free_.pop_back();
    }
    (*this)[number] = Block{};
    return number;
  }
  void give_back(std::uint32_t number) { free_.push_back(number); }

  Block& operator[](std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  const Block& operator[](std::uint32_t number) const { return chunks_[number / kChunk][number % kChunk]; }

  [[nodiscard]] std::size_t in_use() const { return next_ - 1 - free_.size(); }
  /// Returns the memory of all blocks ever allocated, since the pool keeps freed blocks for reuse.
  [[nodiscard]] std::size_t memory_bytes() const {
    return chunks_.size() * kChunk * sizeof(Block) + free_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kChunk = 2048;
  std::uint32_t limit_;
  std::uint32_t next_ = 1;
  std::vector<std::unique_ptr<Block[]>> chunks_;
  std::vector<std::uint32_t> free_;
};

}  // namespace roomradar
