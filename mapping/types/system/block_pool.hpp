// block_pool.hpp: pool allocator of equally sized blocks, addressed by 32-bit numbers, for several threads.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {

/// Max number of threads that may change one pool at a time.
inline constexpr unsigned kMaxLanes = kMaxThreads;

/// Pool of equally sized blocks that are addressed by 32-bit numbers. Blocks never move. References thus stay
/// valid while other blocks are allocated. Number 0 is reserved and means "none". A lane is a free list and a
/// chunk of unused blocks; its number is below kMaxLanes. Threads with different lanes may concurrently
/// allocate, free and access different blocks.
template <typename Block>
class BlockPool {
 public:
  /// @param limit  max number of blocks in use at a time; by default, all numbers below 2^31
  explicit BlockPool(std::uint32_t limit = (1U << 31U) - 1) : limit_(limit) {
    chunks_.reserve(limit / kChunk + 1);  // never grows, so that other threads can read while one adds
  }

  /// Allocates a block, initialised to Block{}, and returns its number. Throws Error if the limit is reached.
  std::uint32_t take(unsigned lane_number) {
    Lane& lane = lanes_[lane_number];
    std::uint32_t number = 0;
    if (lane.free.empty()) {
      if (lane.next % kChunk == 0) lane.next = add_chunk();
      if (lane.next > limit_) throw_full();
      number = lane.next++;
    } else {
      number = lane.free.back();
      lane.free.pop_back();
    }
    ++lane.in_use;
    (*this)[number] = Block{};
    return number;
  }
  void give_back(std::uint32_t number, unsigned lane_number) {
    --lanes_[lane_number].in_use;
    lanes_[lane_number].free.push_back(number);
  }
  /// Moves the free lists of all other lanes to the first lane. No other thread may use the pool during the
  /// call.
  void gather_free() {
    for (Lane& lane : std::span(lanes_).subspan(1)) {
      lanes_[0].free.insert(lanes_[0].free.end(), lane.free.begin(), lane.free.end());
      lane.free.clear();
    }
  }

  Block& operator[](std::uint32_t number) { return chunks_[number / kChunk][number % kChunk]; }
  const Block& operator[](std::uint32_t number) const { return chunks_[number / kChunk][number % kChunk]; }

  [[nodiscard]] std::size_t in_use() const {
    std::ptrdiff_t sum = 0;
    for (const Lane& lane : lanes_) sum += lane.in_use;
    return static_cast<std::size_t>(sum);
  }
  /// Returns the memory of all blocks ever allocated, since the pool keeps freed blocks for reuse.
  [[nodiscard]] std::size_t memory_bytes() const {
    std::size_t bytes = chunks_.size() * kChunk * sizeof(Block);
    for (const Lane& lane : lanes_) bytes += lane.free.capacity() * sizeof(std::uint32_t);
    return bytes;
  }

 private:
  static constexpr std::uint32_t kChunk = 2048;
  struct Lane {
    std::uint32_t next = 0;     // next unused number of the lane's chunk; a multiple of kChunk: none left
    std::ptrdiff_t in_use = 0;  // taken minus given back in this lane
    std::vector<std::uint32_t> free;
  };

  // Returns the number of the first block of a new chunk.
  std::uint32_t add_chunk() {
    const std::scoped_lock lock(adding_chunk_);
    const auto first = static_cast<std::uint32_t>(chunks_.size()) * kChunk;
    if (first > limit_) throw_full();
    chunks_.push_back(std::make_unique<Block[]>(kChunk));
    return std::max(first, 1U);
  }
  [[noreturn]] void throw_full() const {
    throw Error("no more than " + std::to_string(limit_) +
                " blocks can be numbered; take a coarser resolution");
  }

  std::uint32_t limit_;
  std::mutex adding_chunk_;  // guards the size of chunks_
  std::vector<std::unique_ptr<Block[]>> chunks_;
  std::array<Lane, kMaxLanes> lanes_;
};

}  // namespace roomradar
