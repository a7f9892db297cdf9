// run_sandboxed_test.cpp: work that crashes, hangs or exhausts memory does not affect this process.
#include "mapping/types/system/run_sandboxed.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"

namespace roomradar::run_sandboxed_test {
namespace {

constexpr std::size_t kBytes = std::size_t{256} << 20U;

std::string apart(const std::function<std::string()>& work) {
  return run_sandboxed(work, "file.obj: cannot be read", 1, kBytes);
}

TEST(RunApart, WorkThatWaitsForEverIsEnded) {
  EXPECT_THROW((void)run_sandboxed(
                   [] {
                     pause();  // uses no CPU time
                     return std::string();
                   },
                   "file.obj: cannot be read", 0, kBytes),
               Error);
}

TEST(RunApart, GivesTheAnswerWhateverItsLength) {
  EXPECT_EQ(apart([] { return std::string(); }), "");
  const std::string bytes(5'000'000, '\7');  // more than a pipe holds
  EXPECT_EQ(apart([&] { return bytes; }), bytes);
}

TEST(RunApart, ThrowsWhatTheWorkThrows) {
  EXPECT_EQ(test::error_of([] { apart([]() -> std::string { throw Error("file.obj: has no end"); }); }),
            "file.obj: has no end");
}

TEST(RunApart, ACrashIsASentence) {
  const std::string error = test::error_of([] { apart([]() -> std::string { std::abort(); }); });
  EXPECT_EQ(error, "file.obj: cannot be read (crashed: Aborted)");
}

TEST(RunApart, ALoopWithoutAnEndIsASentence) {
  const std::string error = test::error_of([] {
    apart([]() -> std::string {
      for (std::atomic<int> i = 0;; ++i) {
      }
    });
  });
  EXPECT_EQ(error, "file.obj: cannot be read (it takes more than 1 s, or too much memory)");
}

TEST(RunApart, DoesNotWaitForWhoeverElseHoldsThePipe) {
  // Such as a child that another thread starts at the same time.
  std::array<int, 2> held{};
  ASSERT_EQ(pipe(held.data()), 0);
  EXPECT_EQ(apart([&] {
              if (fork() == 0) {
                close(held[1]);
                char end = 0;
                static_cast<void>(read(held[0], &end, 1) + 1);  // until the test is over
                _exit(0);
              }
              return std::string("done");
            }),
            "done");
  close(held[0]);
  close(held[1]);
}

TEST(RunApart, WorkEndsWithTheProcessThatWaitsForIt) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t waits = fork();
  if (waits == 0) {
    apart([&] {
      static_cast<void>(write(ends[1], "w", 1) + 1);
      pause();
      return std::string();
    });
    _exit(0);
  }
  close(ends[1]);
  char byte = 0;
  ASSERT_EQ(read(ends[0], &byte, 1), 1);  // the work is running
  kill(waits, SIGKILL);
  int status = 0;
  waitpid(waits, &status, 0);
  constexpr int kPatience_ms = 20'000;
  pollfd ended{ends[0], POLLIN, 0};
  ASSERT_EQ(poll(&ended, 1, kPatience_ms), 1) << "it works on for nobody";
  EXPECT_EQ(read(ends[0], &byte, 1), 0);
  close(ends[0]);
}

TEST(RunApart, NothingIsChangedHere) {
  int value = 1;
  apart([&] { return value = 2, std::string(); });
  EXPECT_EQ(value, 1);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(RunApart, AllTheMemoryThereIsIsASentence) {
  const std::string error = test::error_of([] {
    apart([] {
      std::vector<std::string> kept;
      for (;;) kept.emplace_back(std::size_t{1} << 26U, 'x');
      return kept.front();
    });
  });
  EXPECT_NE(error.find("memory"), std::string::npos) << error;
}
#endif

}  // namespace
}  // namespace roomradar::run_sandboxed_test
