// atomic_file_test.cpp: a file keeps its old content until the new content is complete.
#include "mapping/types/system/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::atomic_file_test {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

std::ptrdiff_t entries(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

TEST(AtomicFile, ReplacesAndLeavesNothingBeside) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "r.json";
  write(path, "old");
  write(path, "new");
  EXPECT_EQ(text_of(path), "new");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFile, WhatIsGivenUpChangesNothing) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "r.json";
  write(path, "old");
  {
    AtomicFile file(path);
    file.stream() << "half of the new" << std::flush;
  }
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFile, AFullDiskKeepsTheOldOne) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "r.json";
  write(path, "old");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100, 100};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string error = test::error_of([&] { write(path, std::string(100'000, 'x')); });
    std::_Exit(error.find(path.string()) != std::string::npos ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "no sentence that names the file";
  EXPECT_EQ(text_of(path), "old");
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(AtomicFile, ALinkStaysOneAndADeviceIsWrittenAsItComes) {
  const test::TemporaryFolder folder;
  write(folder.path() / "there", "old");
  fs::create_symlink(folder.path() / "there", folder.path() / "link");
  write(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(text_of(folder.path() / "there"), "new");
  write("/dev/null", "gone");
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
  if (fs::exists("/dev/full")) {
    EXPECT_NE(test::error_of([] { write("/dev/full", "x"); }).find("/dev/full"), std::string::npos);
  }
}

TEST(AtomicFile, APipeByItsNameIsWrittenAsItComes) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  write("/proc/self/fd/" + std::to_string(ends[1]), "through");  // like /dev/stdout: a link without a path
  std::array<char, 16> text{};
  EXPECT_EQ(read(ends[0], text.data(), text.size()), 7);
  EXPECT_STREQ(text.data(), "through");
  close(ends[0]);
  close(ends[1]);
}

TEST(AtomicFile, AFolderThatIsNotThereIsSaid) {
  const test::TemporaryFolder folder;
  const std::string error = test::error_of([&] { write(folder.path() / "no" / "r.json", "x"); });
  EXPECT_NE(error.find("/no does not exist; make it first"), std::string::npos) << error;
}

TEST(AtomicFile, AFileThatStdoutGoesToIsWrittenOn) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "log";
  std::ofstream(path) << "before\n";
  for (const int more : {O_APPEND, 0}) {  // >>, and a descriptor at the end of the file
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const int file = open(path.c_str(), O_WRONLY | more);
      lseek(file, 0, SEEK_END);
      dup2(file, STDOUT_FILENO);
      std::printf("a\n");
      write("/dev/stdout", "report\n");
      std::printf("b\n");
      std::fflush(stdout);
      std::_Exit(0);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(text_of(path), "before\na\nreport\nb\na\nreport\nb\n");
  EXPECT_EQ(entries(folder.path()), 1);
}

}  // namespace
}  // namespace roomradar::atomic_file_test
