// rvl_depth.cpp: numbers in groups of 3 bits; runs of zeros and of differences.
#include "app/sources/containers/rvl_depth.hpp"

#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr std::uint32_t kMaxSide_px = 16384;

/// Numbers of a stream: groups of 4 bits, of which the first says that another follows; the lowest 3 bits of
/// a number come first. 8 groups make a little-endian word, the first in its highest bits.
class RvlNumbers {
 public:
  RvlNumbers(std::string_view bytes, const std::string& where) : reader_(bytes, where) {}

  std::uint32_t next() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 30; shift += 3) {  // the largest run has 28 bits
      if (groups_left_ == 0) {
        word_ = reader_.number<std::uint32_t>();
        groups_left_ = 8;
      }
      const std::uint32_t group = word_ >> 28U;
      word_ <<= 4U;
      --groups_left_;
      value |= (group & 7U) << shift;
      if ((group & 8U) == 0) return value;
    }
    fail("is damaged: a number has too many bits");
  }

  [[noreturn]] void fail(const char* fault) const { reader_.fail(fault); }

 private:
  ByteReader reader_;
  std::uint32_t word_ = 0;
  int groups_left_ = 0;
};

std::string text_of(RvlSize size) {
  return std::to_string(size.width_px) + " x " + std::to_string(size.height_px);
}

}  // namespace

RvlSize read_rvl_size(std::string_view bytes, const std::string& where) {
  ByteReader reader(bytes, where);
  const auto columns = reader.number<std::uint32_t>(), rows = reader.number<std::uint32_t>();
  constexpr std::uint64_t kAlwaysBelieved_px = 4096 * 4096, kMax_px_per_byte = 1024;
  const std::uint64_t pixels = std::uint64_t{columns} * rows;
  if (columns < 1 || rows < 1 || columns > kMaxSide_px || rows > kMaxSide_px)
    throw Error(where + ": its size of " + std::to_string(columns) + " x " + std::to_string(rows) +
                " is not in 1..16384");
  if (pixels > kAlwaysBelieved_px && pixels > reader.left() * kMax_px_per_byte)
    throw Error(where + ": is damaged: " + std::to_string(reader.left()) + " bytes for an image of " +
                std::to_string(columns) + " x " + std::to_string(rows));
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

void decode_rvl(std::string_view bytes, RvlSize expected, const std::string& where,
                Image<std::uint16_t>& units) {
  const RvlSize size = read_rvl_size(bytes, where);
  if (expected != RvlSize{} && size != expected)
    throw Error(where + ": is " + text_of(size) + "; the recording's other depth images are " +
                text_of(expected));
  RvlNumbers numbers(bytes.substr(kRvlSize_bytes), where);
  units.resize(size.width_px, size.height_px);
  auto pixel = units.pixels.begin();
  const auto run = [&] {
    const std::uint32_t length = numbers.next();
    if (length > units.pixels.end() - pixel) numbers.fail("is damaged: a run passes the end of the image");
    return length;
  };
  std::int32_t previous = 0;
  while (pixel != units.pixels.end()) {
    pixel += run();  // the pixels are 0 already
    for (std::uint32_t left = run(); left > 0; --left) {
      const std::uint32_t zigzag = numbers.next();  // 0, -1, 1, -2, 2 ...
      const std::int32_t difference =
          static_cast<std::int32_t>(zigzag >> 1U) ^ -static_cast<std::int32_t>(zigzag & 1U);
      previous += difference;
      if (previous < 1 || previous > 65535) numbers.fail("is damaged: a pixel is outside 1..65535");
      *pixel++ = static_cast<std::uint16_t>(previous);
    }
  }
}

}  // namespace roomradar
