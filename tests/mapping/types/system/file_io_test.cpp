// file_io_test.cpp: reads all of a file, or throws an error that names it.
#include "mapping/types/system/file_io.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <string>

#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::file_io_test {
namespace {

namespace fs = std::filesystem;

TEST(FileBytes, WhatIsWrittenIsReadToTheByte) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "b";
  for (const std::string& bytes :
       {std::string("a\r\n\0\xff z", 7), std::string(), std::string(100'000, 'x')}) {
    write_bytes(path, bytes);
    EXPECT_EQ(read_bytes(path, "bytes"), bytes);
  }
  fs::create_symlink("b", folder.path() / "link");
  EXPECT_EQ(read_bytes(folder.path() / "link", "bytes").size(), 100'000U);
}

TEST(FileBytes, WhatCannotBeReadIsNamed) {
  const test::TemporaryFolder folder;
  const auto fault_of = [&](const fs::path& path) {
    return test::error_of([&] { static_cast<void>(read_bytes(path, "a poem", 10)); });
  };
  const fs::path long_file = folder.path() / "long", pipe = folder.path() / "pipe",
                 loop = folder.path() / "loop";
  const fs::path none = folder.path() / "none";
  EXPECT_EQ(fault_of(none), none.string() + ": is missing; expected a poem");
  EXPECT_EQ(fault_of(folder.path()), folder.path().string() + ": is not a regular file; expected a poem");
  write_bytes(long_file, "eleven byte");
  EXPECT_EQ(fault_of(long_file), long_file.string() + ": has 11 bytes, too many for a poem");
  EXPECT_EQ(fault_of(long_file / "x"), (long_file / "x").string() + ": is missing; expected a poem");
  write_bytes(long_file, "ten  bytes");
  EXPECT_EQ(read_bytes(long_file, "a poem", 10), "ten  bytes");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);  // opening it would wait for a writer
  EXPECT_EQ(fault_of(pipe), pipe.string() + ": is not a regular file; expected a poem");
  fs::create_symlink("loop", loop);
  EXPECT_TRUE(fault_of(loop).starts_with(loop.string() + ": cannot be read: ")) << fault_of(loop);
}

TEST(FileBytes, WhatCannotBeWrittenIsNamed) {
  const test::TemporaryFolder folder;
  const fs::path nowhere = folder.path() / "none" / "b";
  EXPECT_TRUE(test::error_of([&] {
                write_bytes(nowhere, "b");
              }).starts_with(nowhere.string() + ": cannot be written"));
  const fs::path kept = folder.path() / "kept";
  write_bytes(kept, "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);  // no file can be opened
  const std::string fault = test::error_of([&] { write_bytes(kept, "new"); });
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_TRUE(fault.starts_with(kept.string())) << fault;
  EXPECT_EQ(read_bytes(kept, "a file"), "old");
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_TRUE(
      test::error_of([&] { write_bytes("/dev/full", "b"); }).starts_with("/dev/full: cannot be written"));
}

}  // namespace
}  // namespace roomradar::file_io_test
