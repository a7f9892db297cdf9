// pixel_bits.cpp: sums over neighbours, bit by bit, for 64 pixels at once.
#include "dynamic/surface/pixel_bits.hpp"

#include <algorithm>
#include <array>

namespace roomradar {
namespace {

std::uint64_t from_left(const std::uint64_t* word) { return word[0] << 1 | word[-1] >> 63; }
std::uint64_t from_right(const std::uint64_t* word) { return word[0] >> 1 | word[1] << 63; }
std::uint64_t majority(std::uint64_t a, std::uint64_t b, std::uint64_t c) { return (a & b) | (c & (a | b)); }

/// Returns a word with ones where there are pixels.
std::uint64_t inside(const PixelBits& bits, int word) {
  const int left = bits.width - 64 * word;
  return left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
}

}  // namespace

void take_majority(const PixelBits& bits, PixelBits& smooth) {
  smooth.resize(bits.width, bits.height);
  for (int y = 0; y < bits.height; ++y) {
    const std::array<const std::uint64_t*, 3> rows{bits.row(y - 1), bits.row(y), bits.row(y + 1)};
    std::uint64_t* out = smooth.row(y);
    for (int i = 0; i < bits.words; ++i) {
      if ((rows[0][i] | rows[1][i] | rows[2][i]) == 0) continue;
      // Each row's three neighbours as a 2 bit number, then the sum of the three numbers.
      std::array<std::uint64_t, 3> ones, twos;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t left = from_left(rows[k] + i), right = from_right(rows[k] + i);
        ones[k] = left ^ rows[k][i] ^ right;
        twos[k] = majority(left, rows[k][i], right);
      }
      const std::uint64_t odd = ones[0] ^ ones[1] ^ ones[2];
      const std::uint64_t carry = majority(ones[0], ones[1], ones[2]);
      const std::uint64_t both = (twos[0] & twos[1]), either = twos[0] | twos[1];
      const std::uint64_t other_both = twos[2] & carry, other_either = twos[2] | carry;
      const std::uint64_t two_or_more = both | other_both | (either & other_either);
      const std::uint64_t three_or_more = (both & other_either) | (other_both & either);
      out[i] = (three_or_more | (two_or_more & odd)) & inside(bits, i);  // 5 or more of 9
    }
  }
}

void take_far_from(const PixelBits& bits, const PixelBits& near, PixelBits& far) {
  far.resize(bits.width, bits.height);
  for (int y = 0; y < bits.height; ++y) {
    const std::uint64_t* in = bits.row(y);
    std::uint64_t* out = far.row(y);
    for (int i = 0; i < bits.words; ++i) {
      if (in[i] == 0) continue;
      std::uint64_t reached = 0;
      for (int k = -1; k <= 1; ++k) {
        const std::uint64_t* word = near.row(y + k) + i;
        reached |= word[0] | from_left(word) | from_right(word);
      }
      out[i] = in[i] & ~reached;
    }
  }
}

}  // namespace roomradar
