// parallel_for_test.cpp: each piece is worked on once, and faults reach the caller.
#include "mapping/types/system/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace roomradar::parallel_for_test {
namespace {

TEST(ParallelFor, EachPieceIsWorkedOnOnceByAThreadWithinTheLimit) {
  for (const std::size_t pieces : {0UL, 1UL, 3UL, 1000UL}) {
    std::vector<std::atomic<int>> worked(pieces);
    std::atomic<bool> is_within = true;
    parallel_for(pieces, 4, [&](std::size_t piece, unsigned thread) {
      ++worked[piece];
      if (thread >= 4) is_within = false;
    });
    for (const std::atomic<int>& count : worked) EXPECT_EQ(count, 1);
    EXPECT_TRUE(is_within);
  }
}

TEST(ParallelFor, OneThreadWorksInOrder) {
  std::vector<std::size_t> order;
  parallel_for(4, 1, [&](std::size_t piece, unsigned thread) {
    EXPECT_EQ(thread, 0U);
    order.push_back(piece);
  });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(ParallelFor, AFaultOnAnyThreadReachesTheCaller) {
  const auto work = [](std::size_t piece, unsigned) {
    if (piece == 57) throw std::runtime_error("piece 57");
  };
  EXPECT_THROW(parallel_for(100, 4, work), std::runtime_error);
  EXPECT_THROW(parallel_for(100, 1, work), std::runtime_error);
}

}  // namespace
}  // namespace roomradar::parallel_for_test
