// background_jobs_test.cpp: results arrive in order, on the thread that asks for them.
#include "app/start/background_jobs.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace roomradar::background_jobs_test {
namespace {

void fail(const std::string& what) { ADD_FAILURE() << what; }

void wait_for_all(BackgroundJobs& jobs) {
  while (!jobs.is_idle()) {
    jobs.deliver();
    std::this_thread::yield();
  }
}

TEST(BackgroundJobs, HandResultsOverInOrderOnTheCallersThread) {
  std::atomic<int> woken = 0;
  BackgroundJobs jobs([&] { ++woken; });
  const std::thread::id here = std::this_thread::get_id();
  std::vector<int> results;
  for (int i = 0; i < 20; ++i)
    jobs.add(
        [i, here] {
          EXPECT_NE(std::this_thread::get_id(), here);
          return i;
        },
        [&](int result) {
          EXPECT_EQ(std::this_thread::get_id(), here);
          results.push_back(result);
        },
        fail);
  EXPECT_FALSE(jobs.is_idle());
  wait_for_all(jobs);
  ASSERT_EQ(results.size(), 20U);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(results[static_cast<std::size_t>(i)], i);
  while (woken < 20) std::this_thread::yield();
}

TEST(BackgroundJobs, AFaultOfAJobIsHandedOverAndTheNextOneRuns) {
  BackgroundJobs jobs([] {});
  std::string fault;
  int result = 0;
  jobs.add([]() -> int { throw std::runtime_error("broken"); }, [](int) { FAIL(); },
           [&](const std::string& what) { fault = what; });
  jobs.add([] { return 7; }, [&](int seven) { result = seven; }, fail);
  wait_for_all(jobs);
  EXPECT_EQ(fault, "broken");
  EXPECT_EQ(result, 7);
}

TEST(BackgroundJobs, NothingIsHandedOverAfterTheEnd) {
  std::atomic<bool> may_end = false;
  std::atomic<int> begun = 0;
  {
    BackgroundJobs jobs([] {});
    for (int i = 0; i < 3; ++i)
      jobs.add(
          [&] {
            ++begun;
            while (!may_end) std::this_thread::yield();
            return 0;
          },
          [](int) { FAIL(); }, fail);
    while (begun == 0) std::this_thread::yield();
    may_end = true;
  }
}

}  // namespace
}  // namespace roomradar::background_jobs_test
