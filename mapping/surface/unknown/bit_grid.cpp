// bit_grid.cpp: set operations, neighbours, flood fill and opening, a word at a time.
#include "mapping/surface/unknown/bit_grid.hpp"

#include <algorithm>
#include <cassert>

namespace roomradar {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

}  // namespace

BitGrid::BitGrid(const Eigen::Vector3i& size, bool value)
    : size_(size),
      words_a_row_(static_cast<std::size_t>(size.x() + 63) / 64),
      words_(words_a_row_ * static_cast<std::size_t>(size.y()) * static_cast<std::size_t>(size.z()),
             value ? kAll : 0) {
  clear_row_ends();
}

void BitGrid::clear_row_ends() {
  const int used = size_.x() % 64;
  if (used == 0) return;
  for (std::size_t i = words_a_row_; i <= words_.size(); i += words_a_row_) words_[i - 1] &= ~(kAll << used);
}

bool BitGrid::at(const Eigen::Vector3i& p) const {
  if ((p.array() < 0).any() || (p.array() >= size_.array()).any()) return false;
  return (row(p.y(), p.z())[p.x() / 64] >> (p.x() % 64) & 1U) != 0;
}

void BitGrid::set_box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, bool value) {
  const Eigen::Vector3i from = low.cwiseMax(0), to = high.cwiseMin(size_);
  if ((from.array() >= to.array()).any()) return;
  const int first = from.x() / 64, last = (to.x() - 1) / 64;
  const std::uint64_t from_first = kAll << (from.x() % 64), to_last = kAll >> (63 - (to.x() - 1) % 64);
  for (int z = from.z(); z < to.z(); ++z)
    for (int y = from.y(); y < to.y(); ++y) {
      std::uint64_t* words = row(y, z);
      for (int i = first; i <= last; ++i) {
        const std::uint64_t mask = (i == first ? from_first : kAll) & (i == last ? to_last : kAll);
        words[i] = value ? words[i] | mask : words[i] & ~mask;
      }
    }
}

BitGrid& BitGrid::operator&=(const BitGrid& other) {
  assert(size_ == other.size_);
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
  return *this;
}

BitGrid& BitGrid::operator|=(const BitGrid& other) {
  assert(size_ == other.size_);
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  return *this;
}

BitGrid& BitGrid::flip() {
  for (std::uint64_t& word : words_) word = ~word;
  clear_row_ends();
  return *this;
}

void BitGrid::BesideRow::read(int y, int z) {
  const std::size_t count = other.words_a_row_;
  const int from_y = axis == 1 ? y + step : y, from_z = axis == 2 ? z + step : z;
  if (y == 0) blocked.read_plane(axis == 2 && step < 0 ? from_z : z, plane);  // of the lower voxels
  words.assign(count, 0);
  if (from_y < 0 || from_y >= other.size_.y() || from_z < 0 || from_z >= other.size_.z()) return;
  const std::uint64_t* const from = other.row(from_y, from_z);
  const std::uint64_t* const bars =
      plane.data() + count * static_cast<std::size_t>(axis == 1 && step < 0 ? from_y : y);
  for (std::size_t i = 0; i < count; ++i)
    if (axis > 0)
      words[i] = from[i] & ~bars[i];
    else if (step > 0)
      words[i] = (from[i] >> 1U | (i + 1 < count ? from[i + 1] << 63U : 0)) & ~bars[i];
    else
      words[i] = (from[i] & ~bars[i]) << 1U | (i > 0 ? (from[i - 1] & ~bars[i - 1]) >> 63U : 0);
}

// In place: a row changes after all rows that need its old value.
BitGrid& BitGrid::erode(int axis, int steps) {
  const int rows = size_.y() * size_.z(), width = axis == 1 ? size_.y() : size_.z();
  for (int i = 0; i < rows; ++i) {
    const int y = i % size_.y(), z = i / size_.y(), at = axis == 1 ? y : z;
    std::uint64_t* const words = row(y, z);
    for (std::size_t w = 0; axis == 0 && w < words_a_row_; ++w) {
      const std::uint64_t own = words[w], next = w + 1 < words_a_row_ ? words[w + 1] : 0;
      for (int step = 1; step <= steps; ++step) words[w] &= own >> step | next << (64 - step);
    }
    for (int step = 1; axis > 0 && step <= steps; ++step) {
      const std::uint64_t* const after =
          at + step < width ? words + static_cast<std::size_t>(step) * stride_words(axis) : nullptr;
      for (std::size_t w = 0; w < words_a_row_; ++w) words[w] &= after ? after[w] : 0;
    }
  }
  return *this;
}

BitGrid& BitGrid::dilate(int axis, int steps) {
  for (int i = size_.y() * size_.z() - 1; i >= 0; --i) {
    const int y = i % size_.y(), z = i / size_.y(), at = axis == 1 ? y : z;
    std::uint64_t* const words = row(y, z);
    for (std::size_t w = words_a_row_; axis == 0 && w-- > 0;) {
      const std::uint64_t own = words[w], before = w > 0 ? words[w - 1] : 0;
      for (int step = 1; step <= steps; ++step) words[w] |= own << step | before >> (64 - step);
    }
    for (int step = 1; axis > 0 && step <= std::min(steps, at); ++step) {
      const std::uint64_t* const before = words - static_cast<std::size_t>(step) * stride_words(axis);
      for (std::size_t w = 0; w < words_a_row_; ++w) words[w] |= before[w];
    }
  }
  clear_row_ends();
  return *this;
}

void BitGrid::keep_multiples_of(int spacing) {
  std::vector<std::uint64_t> kept(words_a_row_, 0);
  for (int x = 0; x < size_.x(); x += spacing)
    kept[static_cast<std::size_t>(x / 64)] |= std::uint64_t{1} << (x % 64);
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y)
      for (std::size_t i = 0; i < words_a_row_; ++i)
        row(y, z)[i] &= z % spacing == 0 && y % spacing == 0 ? kept[i] : 0;
}

/// A row of a grid and its neighbours. A null pointer is a row outside the grid.
struct BitGrid::Rows {
  const std::uint64_t *own, *y_before, *y_after, *z_before, *z_after;
};

/// Sets the voxels of `row` that dilating `source` sets in it. Returns true if a voxel was added.
/// @param where  null: everywhere, also past the row's end
bool BitGrid::spread_to_row(std::uint64_t* row, const Rows& source, const std::uint64_t* where,
                            const BlockedRows& bars, std::size_t words) {
  bool any = false;
  const auto add = [&](std::size_t i, std::uint64_t word) {
    word &= (where ? where[i] : kAll) & ~row[i];
    any = any || word != 0;
    row[i] |= word;
  };
  const auto add_row = [&](const std::uint64_t* from, const std::uint64_t* blocked_row) {
    for (std::size_t i = 0; from && i < words; ++i) add(i, from[i] & ~blocked_row[i]);
  };
  add_row(source.y_before, bars.y_before);
  add_row(source.y_after, bars.y);
  add_row(source.z_before, bars.z_before);
  add_row(source.z_after, bars.z);
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t up = source.own[i] & ~bars.x[i];
    const std::uint64_t carried = i > 0 ? (source.own[i - 1] & ~bars.x[i - 1]) >> 63U : 0;
    const std::uint64_t next = i + 1 < words ? source.own[i + 1] << 63U : 0;
    add(i, up << 1U | carried | ((source.own[i] >> 1U | next) & ~bars.x[i]));
  }
  return any;
}

// Only the previous rows of two planes must be kept.
void BitGrid::spread(const BitGrid* where, const std::array<SparseBitGrid, 3>& blocked) {
  BlockedPlanes bars(blocked);
  const std::size_t plane_words = words_a_row_ * static_cast<std::size_t>(size_.y());
  std::vector<std::uint64_t> below, plane;  // z - 1 and z before the operation
  for (int z = 0; z < size_.z(); ++z) {
    below.swap(plane);
    plane.assign(row(0, z), row(0, z) + plane_words);
    const auto of = [&](const std::vector<std::uint64_t>& rows, int y) {
      return rows.data() + words_a_row_ * static_cast<std::size_t>(y);
    };
    for (int y = 0; y < size_.y(); ++y)
      spread_to_row(
          row(y, z),
          {of(plane, y), y > 0 ? of(plane, y - 1) : nullptr, y + 1 < size_.y() ? of(plane, y + 1) : nullptr,
           z > 0 ? of(below, y) : nullptr, z + 1 < size_.z() ? row(y, z + 1) : nullptr},
          where ? where->row(y, z) : nullptr, bars.around(y, z), words_a_row_);
  }
}

void BitGrid::spread(const BitGrid& where, const std::array<SparseBitGrid, 3>& blocked) {
  spread(&where, blocked);
}

void BitGrid::spread(const std::array<SparseBitGrid, 3>& blocked) {
  spread(nullptr, blocked);
  clear_row_ends();
}

// In place, alternately upwards and downwards, so a straight path of any length takes one pass. A row is
// visited again only after one beside it has changed.
void BitGrid::flood(const BitGrid& where, const std::array<SparseBitGrid, 3>& blocked) {
  BlockedPlanes planes(blocked);
  struct Times {
    std::uint32_t visited = 0, changed = 1;
  };
  std::vector<Times> times(words_a_row_ == 0 ? 0 : words_.size() / words_a_row_);
  std::uint32_t now = 1;  // number of visits
  const auto flood_row = [&](int y, int z) {
    Times& own = times[row_index(y, z)];
    Rows rows{row(y, z), nullptr, nullptr, nullptr, nullptr};
    std::uint32_t newest = own.visited == 0 ? own.changed : 0;
    const auto beside = [&](int at_y, int at_z) -> const std::uint64_t* {
      if (at_y < 0 || at_y >= size_.y() || at_z < 0 || at_z >= size_.z()) return nullptr;
      newest = std::max(newest, times[row_index(at_y, at_z)].changed);
      return row(at_y, at_z);
    };
    rows.y_before = beside(y - 1, z);
    rows.y_after = beside(y + 1, z);
    rows.z_before = beside(y, z - 1);
    rows.z_after = beside(y, z + 1);
    if (newest <= own.visited) return false;
    own.visited = ++now;
    const BlockedRows bars = planes.around(y, z);
    bool any = false;
    while (spread_to_row(row(y, z), rows, where.row(y, z), bars, words_a_row_)) any = true;
    if (any) own.changed = now;
    return any;
  };
  for (bool any = true; any;) {
    any = false;
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y) any |= flood_row(y, z);
    for (int z = size_.z() - 1; z >= 0; --z)
      for (int y = size_.y() - 1; y >= 0; --y) any |= flood_row(y, z);
  }
}

BitGrid opened(BitGrid bits, int edge, int lattice) {
  for (int axis = 0; axis < 3; ++axis) bits.erode(axis, edge - 1);  // the lowest voxels of whole cubes
  if (lattice > 1) bits.keep_multiples_of(lattice);
  for (int axis = 0; axis < 3; ++axis) bits.dilate(axis, edge - 1);
  return bits;
}

}  // namespace roomradar
