// worker_thread_test.cpp: both pieces of work are done when the call returns, and no exception is lost.
#include "mapping/types/system/worker_thread.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <future>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace roomradar::worker_thread_test {
namespace {

TEST(WorkerThread, BothPiecesAreDoneWhenTheCallReturns) {
  WorkerThread second;
  std::vector<int> numbers(1000);
  for (int round = 0; round < 2000; ++round) {
    const auto fill = [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) numbers[i] = round;
    };
    second.run([&] { fill(0, 500); }, [&] { fill(500, 1000); });
    ASSERT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0), 1000 * round);
  }
}

TEST(WorkerThread, EachNumberIsWorkedOnOnceAndAFaultIsThrown) {
  WorkerThread second;
  for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
    std::vector<int> worked(count);
    second.run_each(count, [&](std::size_t i) { ++worked[i]; });
    EXPECT_EQ(worked, std::vector<int>(count, 1));
  }
  const auto breaks_at_7 = [](std::size_t i) {
    if (i == 7) throw std::runtime_error("seven");
  };
  EXPECT_THROW(second.run_each(100, breaks_at_7), std::runtime_error);
}

TEST(WorkerThread, WhatEitherThrowsIsThrownAndTheNextCallIsAsEver) {
  WorkerThread second;
  const auto fault_of_run = [&](const auto& here, const auto& beside) -> std::string {
    try {
      second.run(here, beside);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  const auto fine = [] {};
  const auto breaks = [] { throw std::runtime_error("here"); };
  const auto breaks_too = [] { throw std::runtime_error("beside"); };
  EXPECT_EQ(fault_of_run(breaks, fine), "here");
  EXPECT_EQ(fault_of_run(fine, breaks_too), "beside");
  EXPECT_EQ(fault_of_run(breaks, breaks_too), "here");
  EXPECT_EQ(fault_of_run(fine, fine), "none");
}

TEST(LowerPriority, ConcernsOneThread) {
  const auto nice_of = [](pid_t thread) { return getpriority(PRIO_PROCESS, static_cast<id_t>(thread)); };
  const int before = nice_of(gettid());
  std::promise<pid_t> begun;
  std::promise<void> end;
  std::thread other([&] {
    begun.set_value(gettid());
    end.get_future().wait();
  });
  const pid_t thread = begun.get_future().get();
  EXPECT_TRUE(threads_of_process().contains(thread));
  EXPECT_TRUE(threads_of_process().contains(gettid()));
  lower_priority(thread, std::min(before + 1, 19));
  EXPECT_EQ(nice_of(thread), std::min(before + 1, 19));
  EXPECT_EQ(nice_of(gettid()), before);
  end.set_value();
  other.join();
}

TEST(WorkerThread, TheWorkerLeavesTheCallersProcessor) {
  cpu_set_t all;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  if (CPU_COUNT(&all) < 2) GTEST_SKIP() << "this machine has one processor";
  WorkerThread second;
  const int here = sched_getcpu();
  cpu_set_t only_here;
  CPU_ZERO(&only_here);
  CPU_SET(here, &only_here);
  ASSERT_EQ(sched_setaffinity(0, sizeof only_here, &only_here), 0);
  const auto meet = [&] {
    sched_setaffinity(0, sizeof only_here, &only_here);
    sched_setaffinity(0, sizeof all, &all);  // may leave, but is still here
  };
  second.run([] {}, meet);
  int there = here;
  for (int i = 0; i < 3; ++i) second.run([] {}, [&] { there = sched_getcpu(); });
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  EXPECT_NE(there, here);
}

TEST(WorkerThread, OneThatNeverWorkedEndsToo) { const WorkerThread second; }

}  // namespace
}  // namespace roomradar::worker_thread_test
