// run_grid.cpp: looks a cell up among the runs of its row.
#include "mapping/surface/unknown/run_grid.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {
namespace {

std::uint64_t index_of(const Eigen::Vector3i& p, const Eigen::Vector3i& size) {
  const auto row = static_cast<std::uint64_t>(p.z()) * static_cast<std::uint64_t>(size.y()) +
                   static_cast<std::uint64_t>(p.y());
  return row * static_cast<std::uint64_t>(size.x()) + static_cast<std::uint64_t>(p.x());
}

}  // namespace

RunGrid::RunGrid(const BitGrid& bits) : size_(bits.size()) {
  bits.for_each_run([&](const Eigen::Vector3i& first, int length) {
    const auto begin = static_cast<std::uint32_t>(index_of(first, size_));
    const std::uint32_t end = begin + static_cast<std::uint32_t>(length);
    if (!ends_.empty() && ends_.back() == begin)
      ends_.back() = end;
    else
      ends_.insert(ends_.end(), {begin, end});
  });
  ends_.shrink_to_fit();
  count_before_rows();
}

RunGrid::RunGrid(const Eigen::Vector3i& size, std::vector<std::uint32_t> ends)
    : size_(size), ends_(std::move(ends)) {
  count_before_rows();
}

void RunGrid::count_before_rows() {
  const auto rows = static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(size_.z());
  before_row_.resize(rows + 1);
  std::size_t count = 0;
  for (std::size_t row = 0; row <= rows; ++row) {
    const std::uint64_t first = row * static_cast<std::uint64_t>(size_.x());
    while (count < ends_.size() && ends_[count] <= first) ++count;
    before_row_[row] = static_cast<std::uint32_t>(count);
  }
}

std::size_t RunGrid::memory_bytes() const {
  return (ends_.size() + before_row_.size()) * sizeof(std::uint32_t);
}

// A cell is set if an odd number of beginnings and ends are at or before it.
bool RunGrid::at(const Eigen::Vector3i& p) const {
  if ((p.array() < 0).any() || (p.array() >= size_.array()).any()) return false;
  const std::size_t row =
      static_cast<std::size_t>(p.z()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(p.y());
  const auto in_row = ends_.begin() + before_row_[row], after_row = ends_.begin() + before_row_[row + 1];
  const auto found = std::upper_bound(in_row, after_row, index_of(p, size_));
  return (found - ends_.begin()) % 2 == 1;
}

}  // namespace roomradar
