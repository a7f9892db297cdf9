// bit_grid.cpp: set operations, shifts, flood fill and opening, a word at a time.
#include "mapping/surface/bit_grid.hpp"

#include <algorithm>
#include <cassert>

namespace roomradar {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// The voxels whose coordinates are all multiples of `spacing`.
BitGrid lattice_points(const Eigen::Vector3i& size, int spacing) {
  BitGrid points(size, false);
  for (int z = 0; z < size.z(); z += spacing)
    for (int y = 0; y < size.y(); y += spacing)
      for (int x = 0; x < size.x(); x += spacing) points.set({x, y, z}, true);
  return points;
}

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

BitGrid& BitGrid::subtract(const BitGrid& other) {
  assert(size_ == other.size_);
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
  return *this;
}

BitGrid BitGrid::shifted(int axis, int step) const {
  BitGrid out(size_, false);
  if (axis == 0) {
    for (std::size_t start = 0; start < words_.size(); start += words_a_row_)
      for (std::size_t i = 0; i < words_a_row_; ++i) {
        const std::uint64_t own = words_[start + i];
        if (step > 0)
          out.words_[start + i] = own >> 1U | (i + 1 < words_a_row_ ? words_[start + i + 1] << 63U : 0);
        else
          out.words_[start + i] = own << 1U | (i > 0 ? words_[start + i - 1] >> 63U : 0);
      }
    out.clear_row_ends();
    return out;
  }
  const Eigen::Vector3i offset = step * Eigen::Vector3i::Unit(axis);
  for (int z = std::max(0, -offset.z()); z < size_.z() - std::max(0, offset.z()); ++z)
    for (int y = std::max(0, -offset.y()); y < size_.y() - std::max(0, offset.y()); ++y)
      std::copy_n(row(y + offset.y(), z + offset.z()), words_a_row_, out.row(y, z));
  return out;
}

bool BitGrid::spread_to_row(const BitGrid& source, const BitGrid& where,
                            const std::array<BitGrid, 3>& blocked, int y, int z) {
  std::uint64_t* own = row(y, z);
  const std::uint64_t *allowed = where.row(y, z), *beside = source.row(y, z), *bars_x = blocked[0].row(y, z);
  bool any = false;
  const auto add = [&](std::size_t i, std::uint64_t word) {
    word &= allowed[i] & ~own[i];
    any = any || word != 0;
    own[i] |= word;
  };
  const auto add_row = [&](int from_y, int from_z, const std::uint64_t* bars) {
    const std::uint64_t* from = source.row(from_y, from_z);
    for (std::size_t i = 0; i < words_a_row_; ++i) add(i, from[i] & ~bars[i]);
  };
  if (y > 0) add_row(y - 1, z, blocked[1].row(y - 1, z));
  if (y + 1 < size_.y()) add_row(y + 1, z, blocked[1].row(y, z));
  if (z > 0) add_row(y, z - 1, blocked[2].row(y, z - 1));
  if (z + 1 < size_.z()) add_row(y, z + 1, blocked[2].row(y, z));
  for (std::size_t i = 0; i < words_a_row_; ++i) {
    const std::uint64_t up = beside[i] & ~bars_x[i];
    const std::uint64_t carried = i > 0 ? (beside[i - 1] & ~bars_x[i - 1]) >> 63U : 0;
    const std::uint64_t next = i + 1 < words_a_row_ ? beside[i + 1] << 63U : 0;
    add(i, up << 1U | carried | ((beside[i] >> 1U | next) & ~bars_x[i]));
  }
  return any;
}

void BitGrid::spread(const BitGrid& where, const std::array<BitGrid, 3>& blocked) {
  const BitGrid before = *this;
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y) spread_to_row(before, where, blocked, y, z);
}

// In place, alternately upwards and downwards, so a straight path of any length takes one pass.
void BitGrid::flood(const BitGrid& where, const std::array<BitGrid, 3>& blocked) {
  for (bool any = true; any;) {
    any = false;
    const auto flood_row = [&](int y, int z) {
      while (spread_to_row(*this, where, blocked, y, z)) any = true;
    };
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y) flood_row(y, z);
    for (int z = size_.z() - 1; z >= 0; --z)
      for (int y = size_.y() - 1; y >= 0; --y) flood_row(y, z);
  }
}

BitGrid opened(const BitGrid& bits, int edge, int lattice) {
  BitGrid cubes = bits;  // after the loop: the lowest voxels of whole cubes
  for (int axis = 0; axis < 3; ++axis) {
    BitGrid ahead = cubes;
    for (int i = 1; i < edge; ++i) {
      ahead = ahead.shifted(axis, 1);
      cubes &= ahead;
    }
  }
  if (lattice > 1) cubes &= lattice_points(bits.size(), lattice);
  for (int axis = 0; axis < 3; ++axis) {
    BitGrid behind = cubes;
    for (int i = 1; i < edge; ++i) {
      behind = behind.shifted(axis, -1);
      cubes |= behind;
    }
  }
  return cubes;
}

}  // namespace roomradar
