// pixel_bits.hpp: one bit per pixel, for logic on 64 pixels at a time.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar {

/// Image of bits: height rows of width bits. A margin of zeros may be read: kAbove rows above, kBelow rows
/// below, and 64 bits to each side.
struct PixelBits {
  static constexpr int kAbove = 2, kBelow = 8;
  int width = 0, height = 0, words = 0;  ///< words: 64 bit words per row, without its margin
  std::vector<std::uint64_t> bits;

  /// Sets the size and clears all bits; keeps the allocation if it is large enough.
  void resize(int width_px, int height_px) {
    width = width_px;
    height = height_px;
    words = (width_px + 63) / 64;
    bits.assign(static_cast<std::size_t>(words + 2) * static_cast<std::size_t>(height_px + kAbove + kBelow),
                0);
  }
  /// Returns row y, in -kAbove .. height + kBelow - 1. The indices -1 .. words may be read.
  [[nodiscard]] const std::uint64_t* row(int y) const { return bits.data() + offset(y); }
  [[nodiscard]] std::uint64_t* row(int y) { return bits.data() + offset(y); }
  /// Returns the bit of a pixel. x must be in -64 .. 64 * words + 63.
  [[nodiscard]] bool at(int x, int y) const { return (row(y)[x >> 6] >> (x & 63) & 1U) != 0; }
  /// Returns bits x to x + 4 of row y, lowest first.
  [[nodiscard]] std::uint32_t five(int x, int y) const {
    const std::uint64_t* word = row(y) + (x >> 6);
    const int shift = x & 63;
    std::uint64_t five = word[0] >> shift;
    if (shift > 59) five |= word[1] << (64 - shift);
    return static_cast<std::uint32_t>(five & 31U);
  }
  /// Returns the 5 x 5 pixels whose top left pixel is (x, y): bit 5 * row + column.
  [[nodiscard]] std::uint32_t square(int x, int y) const {
    std::uint32_t square = 0;
    for (int k = 0; k < 5; ++k) square |= five(x, y + k) << (5 * k);
    return square;
  }

 private:
  [[nodiscard]] std::size_t offset(int y) const {
    return static_cast<std::size_t>(y + kAbove) * static_cast<std::size_t>(words + 2) + 1;
  }
};

/// Smooths an outline: sets a pixel of `smooth` if most of the 3 x 3 pixels around it are set in `bits`.
/// Pixels outside the image count as unset. `smooth` is resized.
void take_majority(const PixelBits& bits, PixelBits& smooth);

/// Selects the pixels of `bits` that are not in `near` and have no neighbour in `near`. If `near` is the
/// result of take_majority(), the selected pixels are details that smoothing removed entirely, such as lines
/// one pixel wide.
void take_far_from(const PixelBits& bits, const PixelBits& near, PixelBits& far);

}  // namespace roomradar
