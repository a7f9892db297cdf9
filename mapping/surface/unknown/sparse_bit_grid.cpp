// sparse_bit_grid.cpp: words with set voxels, sorted by their index.
#include "mapping/surface/unknown/sparse_bit_grid.hpp"

#include <algorithm>

namespace roomradar {

SparseBitGrid::SparseBitGrid(const Eigen::Vector3i& size, std::span<const Eigen::Vector3i> set)
    : size_(size), words_a_row_(static_cast<std::size_t>(size.x() + 63) / 64) {
  std::vector<std::uint64_t> bits;  // index of the word times 64, plus the bit
  bits.reserve(set.size());
  for (const Eigen::Vector3i& p : set) {
    if ((p.array() < 0).any() || (p.array() >= size.array()).any()) continue;
    const auto row = static_cast<std::uint64_t>(p.z()) * static_cast<std::uint64_t>(size.y()) +
                     static_cast<std::uint64_t>(p.y());
    bits.push_back(64 * words_a_row_ * row + static_cast<std::uint64_t>(p.x()));
  }
  std::sort(bits.begin(), bits.end());
  for (const std::uint64_t bit : bits) {
    const auto index = static_cast<std::uint32_t>(bit / 64);
    if (indices_.empty() || indices_.back() != index) {
      indices_.push_back(index);
      words_.push_back(0);
    }
    words_.back() |= std::uint64_t{1} << bit % 64;
  }
}

std::size_t SparseBitGrid::memory_bytes() const {
  return indices_.size() * sizeof(indices_[0]) + words_.size() * sizeof(words_[0]);
}

bool SparseBitGrid::at(const Eigen::Vector3i& p) const {
  if ((p.array() < 0).any() || (p.array() >= size_.array()).any()) return false;
  const std::size_t row =
      static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(p.y());
  const auto index = static_cast<std::uint32_t>(words_a_row_ * row + static_cast<std::size_t>(p.x()) / 64);
  const auto found = std::lower_bound(indices_.begin(), indices_.end(), index);
  if (found == indices_.end() || *found != index) return false;
  return (words_[static_cast<std::size_t>(found - indices_.begin())] >> (p.x() % 64) & 1U) != 0;
}

void SparseBitGrid::read_plane(int z, std::vector<std::uint64_t>& words) const {
  const std::size_t plane_words = words_a_row_ * static_cast<std::size_t>(size_.y());
  words.assign(plane_words, 0);
  if (z < 0 || z >= size_.z()) return;
  const std::size_t first = plane_words * static_cast<std::size_t>(z);
  const auto begin = std::lower_bound(indices_.begin(), indices_.end(), first);
  for (auto i = static_cast<std::size_t>(begin - indices_.begin());
       i < indices_.size() && indices_[i] < first + plane_words; ++i)
    words[indices_[i] - first] = words_[i];
}

BlockedRows BlockedPlanes::around(int y, int z) {
  if (z != z_) {
    z_ = z;
    blocked_[0].read_plane(z, x_);
    blocked_[1].read_plane(z, y_);
    blocked_[2].read_plane(z - 1, z_before_);
    blocked_[2].read_plane(z, z_after_);
  }
  const std::size_t words = blocked_[0].words_a_row(), row = words * static_cast<std::size_t>(y);
  return {x_.data() + row, y > 0 ? y_.data() + row - words : nullptr, y_.data() + row,
          z > 0 ? z_before_.data() + row : nullptr, z_after_.data() + row};
}

}  // namespace roomradar
