// block_pool_test.cpp: blocks are numbered once, reused when given back, and shared by threads.
#include "mapping/types/system/block_pool.hpp"

#include <gtest/gtest.h>

#include <array>
#include <future>
#include <set>
#include <vector>

#include "tests/support/error_of.hpp"

namespace roomradar::block_pool_test {
namespace {

using test::error_of;

struct Eight {
  std::array<std::uint8_t, 8> bytes{};
};

TEST(BlockPool, WithoutNumbersLeftSaysSoAndGoesOnWithThoseGivenBack) {
  BlockPool<Eight> pool(3);
  EXPECT_EQ(pool.take(0), 1U);
  EXPECT_EQ(pool.take(0), 2U);
  pool[2].bytes[5] = 3;
  EXPECT_EQ(pool.take(0), 3U);
  const std::size_t bytes = pool.memory_bytes();
  EXPECT_GE(bytes, 3 * sizeof(Eight));
  EXPECT_NE(error_of([&] { pool.take(0); }).find("take a coarser resolution"), std::string::npos);
  EXPECT_EQ(pool.in_use(), 3U);
  pool.give_back(2, 0);
  EXPECT_EQ(pool.in_use(), 2U);
  EXPECT_EQ(pool.take(0), 2U);
  EXPECT_EQ(pool[2].bytes[5], 0);  // reset
}

TEST(BlockPool, ThreadsOfDifferentLanesGetDifferentBlocks) {
  constexpr unsigned kEach = 5000;
  BlockPool<Eight> pool;
  std::vector<std::future<std::vector<std::uint32_t>>> threads;
  for (unsigned lane = 0; lane < 4; ++lane)
    threads.push_back(std::async(std::launch::async, [&pool, lane] {
      std::vector<std::uint32_t> numbers;
      for (unsigned i = 0; i < 2 * kEach; ++i) {
        numbers.push_back(pool.take(lane));
        pool[numbers.back()].bytes[0] = static_cast<std::uint8_t>(lane);
      }
      for (; numbers.size() > kEach; numbers.pop_back()) pool.give_back(numbers.back(), lane);
      return numbers;
    }));
  std::set<std::uint32_t> all;
  for (unsigned lane = 0; lane < 4; ++lane)
    for (const std::uint32_t number : threads[lane].get()) {
      EXPECT_TRUE(all.insert(number).second);
      EXPECT_EQ(pool[number].bytes[0], lane);
    }
  EXPECT_EQ(pool.in_use(), all.size());
  // What other lanes gave back is used before new memory.
  const std::size_t bytes = pool.memory_bytes();
  pool.gather_free();
  for (unsigned i = 0; i < 4 * kEach; ++i) EXPECT_EQ(all.count(pool.take(0)), 0U);
  EXPECT_EQ(pool.in_use(), all.size() + 4 * kEach);
  EXPECT_LE(pool.memory_bytes(), bytes + 4 * 4 * kEach * sizeof(std::uint32_t));  // only longer lists
}

}  // namespace
}  // namespace roomradar::block_pool_test
