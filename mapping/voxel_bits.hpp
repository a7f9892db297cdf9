// voxel_bits.hpp: a box of voxels with one bit each, 64 of a row in a word, and what is done to all at once.
#pragma once
#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar {

/// Rows run along x. Voxels outside the box are all `outside`, for every function here; so are the bits past
/// a row's end in its last word.
class VoxelBits {
 public:
  VoxelBits() = default;
  /// All in the box are `value`. No coordinate of size may be negative.
  VoxelBits(const Eigen::Vector3i& size, bool value, bool outside);

  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const { return words_.size() * sizeof(std::uint64_t); }
  [[nodiscard]] bool at(const Eigen::Vector3i& p) const;
  /// p must be in the box.
  void set(const Eigen::Vector3i& p, bool value) { set_box(p, p + Eigen::Vector3i::Ones(), value); }
  /// From `low` to before `high`, as far as that lies in the box.
  void set_box(const Eigen::Vector3i& low, const Eigen::Vector3i& high, bool value);

  /// Both must be of one size; what is outside stays what it is.
  VoxelBits& operator&=(const VoxelBits& other);
  VoxelBits& operator|=(const VoxelBits& other);
  VoxelBits& subtract(const VoxelBits& other);
  friend bool operator==(const VoxelBits&, const VoxelBits&) = default;

  /// Each voxel as its neighbour `step` (-1 or 1) along the axis is.
  [[nodiscard]] VoxelBits shifted(int axis, int step) const;

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
  void set_row_ends();

  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  bool outside_ = false;
  std::size_t words_a_row_ = 0;
  std::vector<std::uint64_t> words_;
};

/// Morphological opening by a cube: the voxels that lie in a cube of edge x edge x edge set voxels. What is
/// thinner is gone, the rest is where it was. With lattice > 1 only cubes count whose lowest voxel has
/// multiples of it as coordinates. edge and lattice must be >= 1.
VoxelBits opened(const VoxelBits& bits, int edge, int lattice = 1);

}  // namespace roomradar
