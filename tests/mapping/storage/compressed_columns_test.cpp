// compressed_columns_test.cpp: columns of any size come back; damaged ones are refused with a sentence.
#include "mapping/storage/compressed_columns.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar::compressed_columns_test {
namespace {

constexpr const char* kPath = "columns";

/// Noise in the low bytes, so that a column does not shrink to nothing.
template <typename Number>
std::vector<Number> numbers(std::size_t count) {
  std::mt19937 random(7);
  std::vector<Number> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<Number>(random() % 1000 + i / 100);
  return out;
}

// Columns are compressed 65,536 bytes at a time.
TEST(CompressedColumns, ComeBackWhateverTheirSize) {
  std::string body;
  const std::vector<std::size_t> counts = {0, 1, 65'535, 65'536, 65'537, 300'000};
  for (const std::size_t count : counts) {
    put_column(body, numbers<std::uint8_t>(count));
    put_column(body, numbers<std::uint16_t>(count));
    put_column(body, numbers<std::int32_t>(count));
  }
  ColumnReader in(body, kPath);
  for (const std::size_t count : counts) {
    EXPECT_EQ(in.take<std::uint8_t>("bytes", count), numbers<std::uint8_t>(count));
    EXPECT_EQ(in.take<std::uint16_t>("words", count), numbers<std::uint16_t>(count));
    EXPECT_EQ(in.take<std::int32_t>("numbers"), numbers<std::int32_t>(count));
  }
  EXPECT_EQ(in.numbers().left(), 0U);
}

TEST(CompressedColumns, EqualBytesAreCompressed) {
  std::string body;
  put_column(body, std::vector<std::uint16_t>(1'000'000, 0x1234));
  EXPECT_LT(body.size(), 1000U);
}

TEST(CompressedColumns, DamagedColumnsAreRefused) {
  std::string body;
  put_column(body, numbers<std::uint16_t>(100'000));
  const std::string cut = body.substr(0, body.size() / 2);
  EXPECT_THROW(static_cast<void>(ColumnReader(cut, kPath).take<std::uint16_t>("words")), Error);
  EXPECT_THROW(static_cast<void>(ColumnReader(body, kPath).take<std::uint16_t>("words", 99'999)), Error);
  EXPECT_THROW(static_cast<void>(ColumnReader(body, kPath).take<std::int32_t>("numbers")), Error);
  body[8 + 8] = static_cast<char>(~body[8 + 8]);  // the beginning of the frame
  EXPECT_THROW(static_cast<void>(ColumnReader(body, kPath).take<std::uint16_t>("words")), Error);
}

}  // namespace
}  // namespace roomradar::compressed_columns_test
