// parallel_for_test.cpp: each piece is worked on once, and faults reach the caller.
#include "mapping/types/system/parallel_for.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "mapping/types/system/worker_thread.hpp"

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

TEST(ParallelFor, CallsWithinCallsEnd) {
  std::atomic<int> worked = 0;
  parallel_for(8, 4,
               [&](std::size_t, unsigned) { parallel_for(50, 4, [&](std::size_t, unsigned) { ++worked; }); });
  EXPECT_EQ(worked, 400);
}

// Whoever waits for its own pieces must not take those of another call, which may need the same lock.
TEST(ParallelFor, TheCallerMayHoldALock) {
  std::mutex mutex;
  std::atomic<int> worked = 0;
  const auto call = [&] {
    for (int i = 0; i < 50; ++i) {
      const std::lock_guard<std::mutex> lock(mutex);
      parallel_for(20, 4, [&](std::size_t, unsigned) { ++worked; });
    }
  };
  std::thread other(call);
  call();
  other.join();
  EXPECT_EQ(worked, 2 * 50 * 20);
}

TEST(ParallelFor, ThreadsOfALowPriorityCallerHaveItsPriority) {
  parallel_for(100, 4, [](std::size_t, unsigned) {});  // the pool has threads of normal priority
  std::atomic<int> others = 0;
  std::thread background([&] {
    lower_priority();
    const int own = getpriority(PRIO_PROCESS, 0);
    parallel_for(100, 4,
                 [&](std::size_t, unsigned) { others += getpriority(PRIO_PROCESS, 0) != own ? 1 : 0; });
  });
  background.join();
  EXPECT_EQ(others, 0);
}

TEST(ParallelFor, AChildOfForkWorksAndEnds) {
  const auto work = [](std::size_t, unsigned) {};
  parallel_for(100, 4, work);  // the pool has threads, which a child has not
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    std::atomic<int> worked = 0;
    parallel_for(100, 4, [&](std::size_t, unsigned) { ++worked; });
    _exit(worked == 100 ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

}  // namespace
}  // namespace roomradar::parallel_for_test
