#include "app/run/line_stream.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "mapping/types/system/error.hpp"

namespace roomradar::test {
namespace line_stream_test {
namespace {

namespace fs = std::filesystem;

fs::path path_of(const char* name) {
  const fs::path path =
      fs::path(::testing::TempDir()) / ("roomradar_lines_" + std::to_string(getpid()) + name);
  fs::remove(path);
  return path;
}

std::string read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(LineStream, AFileHasAllLinesInOrder) {
  const fs::path path = path_of("all");
  std::ofstream(path) << "content of before";
  LineStream stream(path);
  std::string expected;
  for (int i = 0; i < 200; ++i) {
    const std::string line(static_cast<std::size_t>(i) * 97, static_cast<char>('a' + i % 26));
    EXPECT_TRUE(stream.offer(line));
    expected += line + '\n';
  }
  stream.close();
  EXPECT_EQ(read_all(path), expected);
  EXPECT_EQ(stream.dropped(), 0);
  EXPECT_FALSE(stream.offer("late"));
  EXPECT_EQ(stream.dropped(), 1);
  fs::remove(path);
}

TEST(LineStream, APipeThatNobodyReadsDropsLines) {
  const fs::path path = path_of("unread");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  LineStream stream(path);
  constexpr int kLines = 2000;  // 2 MB, more than a pipe and the queue hold
  int taken = 0;
  for (int i = 0; i < kLines; ++i) taken += stream.offer(std::string(1000, 'x')) ? 1 : 0;
  EXPECT_LT(taken, kLines);
  EXPECT_NO_THROW(stream.close());
  EXPECT_GE(stream.dropped(), kLines - taken);
  EXPECT_FALSE(stream.is_reader_gone());
  fs::remove(path);
}

TEST(LineStream, ASlowReaderGetsWholeLines) {
  const fs::path path = path_of("slow");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  std::string got;
  {
    LineStream stream(path);
    const std::string line(10'000, 'y');
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(stream.offer(line));  // 1 MB; a pipe holds 64 kB
    std::thread reading([&] {
      char buffer[4096];
      while (got.size() < 100 * (line.size() + 1)) {
        const ssize_t n = read(reader, buffer, sizeof buffer);
        if (n > 0) got.append(buffer, static_cast<std::size_t>(n));
      }
    });
    stream.close();
    reading.join();
    EXPECT_EQ(stream.dropped(), 0);
    std::string expected;
    for (int i = 0; i < 100; ++i) expected += line + '\n';
    EXPECT_EQ(got, expected);
  }
  close(reader);
  fs::remove(path);
}

TEST(LineStream, AFullDiskIsSaidAtTheEnd) {
  LineStream stream("/dev/full");
  stream.offer("a line");
  try {
    stream.close();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: cannot be written"), std::string::npos)
        << error.what();
  }
}

TEST(LineStream, AFileThatCannotBeOpenedIsNamed) { EXPECT_THROW(LineStream("/no/such/folder/lines"), Error); }

}  // namespace
}  // namespace line_stream_test
}  // namespace roomradar::test
