// rtin.cpp: finds the triangles to bisect, from the smallest to the largest.
#include "dynamic/surface/rtin.hpp"

#include <cmath>

namespace roomradar {
namespace {

/// Tests triangles of the grid as linear functions from their right angle.
class Judge {
 public:
  Judge(const Rtin& grid, std::span<const float> values, std::span<const float> tolerances)
      : grid_(grid), values_(values), tolerances_(tolerances) {}

  /// Tests the triangle with its right angle at c and legs of `length` points along x and y, in these
  /// directions.
  [[nodiscard]] bool is_off_by_legs(GridPoint c, int to_x, int to_y, int length) const {
    if (!grid_.is_wanted(c.x - (to_x < 0 ? 1 : 0), c.y - (to_y < 0 ? 1 : 0))) return false;
    const float at_c = value(c.x, c.y);
    const float along_x = (value(c.x + to_x * length, c.y) - at_c) / static_cast<float>(length);
    const float along_y = (value(c.x, c.y + to_y * length) - at_c) / static_cast<float>(length);
    for (int j = 0; j <= length; ++j) {
      for (int i = 0; i <= length - j; ++i) {
        const float flat = at_c + static_cast<float>(i) * along_x + static_cast<float>(j) * along_y;
        if (is_off(c.x + to_x * i, c.y + to_y * j, flat)) return true;
      }
    }
    return false;
  }

  /// Tests the triangle with its right angle at c and the middle of its hypotenuse `height` points away,
  /// along (to_x, to_y).
  [[nodiscard]] bool is_off_by_height(GridPoint c, int to_x, int to_y, int height) const {
    if (!grid_.is_wanted(c.x - (to_x < 0 ? 1 : 0), c.y - (to_y < 0 ? 1 : 0))) return false;
    const GridPoint middle{c.x + to_x * height, c.y + to_y * height};
    const float one = value(middle.x + to_y * height, middle.y + to_x * height);
    const float other = value(middle.x - to_y * height, middle.y - to_x * height);
    const float at_c = value(c.x, c.y);
    const float along = (0.5F * (one + other) - at_c) / static_cast<float>(height);
    const float across = 0.5F * (one - other) / static_cast<float>(height);
    for (int j = 1; j <= height; ++j) {
      for (int i = -j; i <= j; ++i) {
        const float flat = at_c + static_cast<float>(j) * along + static_cast<float>(i) * across;
        if (is_off(c.x + to_x * j + to_y * i, c.y + to_y * j + to_x * i, flat)) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] float value(int x, int y) const { return values_[grid_.point(x, y)]; }
  [[nodiscard]] bool is_off(int x, int y, float flat) const {
    const std::size_t i = grid_.point(x, y);
    return std::abs(values_[i] - flat) > tolerances_[i];
  }
  const Rtin& grid_;
  std::span<const float> values_, tolerances_;
};

}  // namespace

void find_needed(const Rtin& grid, std::span<const float> values, std::span<const float> tolerances,
                 std::span<std::uint8_t> needed) {
  const Judge judge(grid, values, tolerances);
  const int last_x = grid.columns - 1, last_y = grid.rows - 1;
  const auto is_needed = [&](int x, int y) {
    return x >= 0 && y >= 0 && x <= last_x && y <= last_y && needed[grid.point(x, y)] != 0;
  };
  for (int half = 1; half <= 4; half *= 2) {
    const int size = 2 * half, quarter = half / 2;
    // Middles of the sides of squares of this size.
    for (int y = 0; y <= last_y; y += half) {
      const bool is_level = y % size == 0;
      for (int x = is_level ? half : 0; x <= last_x; x += size) {
        std::uint8_t& here = needed[grid.point(x, y)];
        if (here != 0) continue;
        bool is =
            quarter > 0 && (is_needed(x - quarter, y - quarter) || is_needed(x + quarter, y - quarter) ||
                            is_needed(x - quarter, y + quarter) || is_needed(x + quarter, y + quarter));
        if (is_level) {
          is = is || (y > 0 && judge.is_off_by_height({x, y - half}, 0, 1, half)) ||
               (y < last_y && judge.is_off_by_height({x, y + half}, 0, -1, half));
        } else {
          is = is || (x > 0 && judge.is_off_by_height({x - half, y}, 1, 0, half)) ||
               (x < last_x && judge.is_off_by_height({x + half, y}, -1, 0, half));
        }
        here = is ? 1 : 0;
      }
    }
    // Middles of these squares; two triangles share each, across a diagonal.
    for (int y = half; y <= last_y; y += size) {
      for (int x = half; x <= last_x; x += size) {
        std::uint8_t& here = needed[grid.point(x, y)];
        if (here != 0) continue;
        bool is = is_needed(x - half, y) || is_needed(x + half, y) || is_needed(x, y - half) ||
                  is_needed(x, y + half);
        const int down = ((x / size + y / size) & 1) == 0 ? 1 : -1;  // 1: the diagonal runs down to the right
        is = is || judge.is_off_by_legs({x - half, y + down * half}, 1, -down, size) ||
             judge.is_off_by_legs({x + half, y - down * half}, -1, down, size);
        here = is ? 1 : 0;
      }
    }
  }
}

}  // namespace roomradar
