// voxel_bits.hpp: a box of voxels with one bit each, 64 of a row in a word, and what is done to all at once.
#pragma once
#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar {

/// Rows run along x. All voxels outside the box are clear, for every function here; so are the bits past a
/// row's end in its last word.
class VoxelBits {
 public:
  VoxelBits() = default;
  /// All in the box are `value`. No coordinate of size may be negative.
  VoxelBits(const Eigen::Vector3i& size, bool value);

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const { return words_.size() * sizeof(std::uint64_t); }
  [[nodiscard]] bool at(const Eigen::Vector3i& p) const;
  /// p must be in the box.
  void set(const Eigen::Vector3i& p, bool value) { set_box(p, p + Eigen::Vector3i::Ones(), value); }
  /// From `low` to before `high`, as far as that lies in the box.
  void set_box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, bool value);

  /// Both must be of one size.
  VoxelBits& operator&=(const VoxelBits& other);
  VoxelBits& operator|=(const VoxelBits& other);
  VoxelBits& subtract(const VoxelBits& other);
  friend bool operator==(const VoxelBits&, const VoxelBits&) = default;

  /// Each voxel as its neighbour `step` (-1 or 1) along the axis is.
  [[nodiscard]] VoxelBits shifted(int axis, int step) const;

  /// Adds the voxels of `where` that are one step along an axis from set ones. A step between a voxel that is
  /// set in `barred` of that axis and the next one is not made. All are of one size.
  void spread(const VoxelBits& where, const std::array<VoxelBits, 3>& barred);
  /// The same for as many steps as add anything.
  void flood(const VoxelBits& where, const std::array<VoxelBits, 3>& barred);

  /// Calls visit(p) for each set voxel of the box, z slowest, x fastest.
  template <typename Visit>
  void for_each_set(const Visit& visit) const {
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y)
        for (std::size_t i = 0; i < words_a_row_; ++i)
          for (std::uint64_t word = row(y, z)[i]; word != 0; word &= word - 1) {
            const int x = static_cast<int>(64 * i) + std::countr_zero(word);
            if (x < size_.x()) visit(Eigen::Vector3i(x, y, z));
          }
  }

 private:
  [[nodiscard]] std::size_t row_index(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y);
  }
  [[nodiscard]] std::uint64_t* row(int y, int z) { return words_.data() + row_index(y, z) * words_a_row_; }
  [[nodiscard]] const std::uint64_t* row(int y, int z) const {
    return words_.data() + row_index(y, z) * words_a_row_;
  }
  void clear_row_ends();
  /// Spreads from voxels of `source`, which may be this, into one row. Says whether that added any.
  bool spread_to_row(const VoxelBits& source, const VoxelBits& where, const std::array<VoxelBits, 3>& barred,
                     int y, int z);

  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::size_t words_a_row_ = 0;
  std::vector<std::uint64_t> words_;
};

/// Morphological opening by a cube: the voxels that lie in a cube of edge x edge x edge set voxels. What is
/// thinner is gone, the rest is where it was. With lattice > 1 only cubes count whose lowest voxel has
/// multiples of it as coordinates. edge and lattice must be >= 1.
VoxelBits opened(const VoxelBits& bits, int edge, int lattice = 1);

}  // namespace roomradar
