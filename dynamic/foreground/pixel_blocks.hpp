// pixel_blocks.hpp: grid of blocks of 4 x 4 pixels over an image, and extremes over neighbouring blocks.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace roomradar {

inline constexpr int kBlock_px = 4;

/// Returns the number of blocks that cover this many pixels.
inline int blocks_along(int size_px) { return (size_px + kBlock_px - 1) / kBlock_px; }

/// Grid of columns x rows blocks, row by row. The last block of a row or column may extend beyond the image.
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
  [[nodiscard]] std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * columns + column;
  }
};

/// Expands the values of one row of blocks to one value per pixel of a row of width_px pixels.
template <typename Value>
void stretch(const Value* blocks, int width_px, Value* pixels) {
  const int whole = width_px / kBlock_px;
  for (int block = 0; block < whole; ++block) {
    for (int i = 0; i < kBlock_px; ++i) pixels[block * kBlock_px + i] = blocks[block];
  }
  for (int x = whole * kBlock_px; x < width_px; ++x) pixels[x] = blocks[whole];
}

/// Dilation step: sets each block to the best value of itself and the eight blocks that are `step` away along
/// rows, columns and diagonals. If every block of `from` has the best value within a radius of r blocks, and
/// step <= 2 r + 1, the result is the best value within r + step. `better(a, b)` returns the better of two
/// values. `along_rows` is scratch. `from` and `to` may be one vector.
template <typename Value, typename Better>
void spread(const BlockGrid& grid, const std::vector<Value>& from, int step, const Better& better,
            std::vector<Value>& along_rows, std::vector<Value>& to) {
  along_rows.resize(grid.size());
  to.resize(grid.size());
  const int columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row) {
    const Value* in = from.data() + grid.at(0, row);
    Value* out = along_rows.data() + grid.at(0, row);
    const int head = std::min(step, columns);
    const int tail = std::max(columns - step, head);
    const auto beside = [&](int x) {
      return better(in[x], better(in[std::max(x - step, 0)], in[std::min(x + step, columns - 1)]));
    };
    for (int x = 0; x < head; ++x) out[x] = beside(x);
    for (int x = head; x < tail; ++x) out[x] = better(in[x], better(in[x - step], in[x + step]));
    for (int x = tail; x < columns; ++x) out[x] = beside(x);
  }
  for (int row = 0; row < grid.rows; ++row) {
    const Value* middle = along_rows.data() + grid.at(0, row);
    const Value* above = along_rows.data() + grid.at(0, std::max(row - step, 0));
    const Value* below = along_rows.data() + grid.at(0, std::min(row + step, grid.rows - 1));
    Value* out = to.data() + grid.at(0, row);
    for (int x = 0; x < columns; ++x) out[x] = better(middle[x], better(above[x], below[x]));
  }
}

}  // namespace roomradar
