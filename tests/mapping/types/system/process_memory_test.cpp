// process_memory_test.cpp: freed memory is returned to the system.
#include "mapping/types/system/process_memory.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace roomradar::process_memory_test {
namespace {

TEST(ProcessMemory, LargeBlocksGoBackAtOnceThoughSmallOnesBetweenThemStay) {
#ifndef __GLIBC__
  GTEST_SKIP() << "only glibc can be asked for that";
#endif
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer keeps what is freed for a while";
#endif
  constexpr std::size_t kBlock = 3 << 20, kBlocks = 20, kSmall = 1000;
  mmap_large_allocations();
  { const std::vector<char> once(2 * kBlock, 1); }  // from now on glibc would keep such blocks in its heap
  std::vector<std::vector<char>> large, small;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    large.emplace_back(kBlock, 1);
    small.emplace_back(kSmall, 1);
  }
  const std::size_t before = resident_bytes();
  ASSERT_GE(before, kBlocks * kBlock);
  large.clear();
  EXPECT_LT(resident_bytes(), before - kBlocks * kBlock * 9 / 10);
}

}  // namespace
}  // namespace roomradar::process_memory_test
