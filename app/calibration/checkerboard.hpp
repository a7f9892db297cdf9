// checkerboard.hpp: the dimensions of a checkerboard.
#pragma once
#include <Eigen/Core>

namespace roomradar {

/// A printed checkerboard. Its size is counted in inner corners. An inner corner is a common corner of four
/// squares.
struct Board {
  int columns = 8, rows = 6;  ///< number of inner corners, 3 to 30 each, not equal
  double square_m = 0.03;
};

/// Returns inner corner (column, row) in the checkerboard's frame. The checkerboard is the plane z = 0. x
/// points from column to column.
inline Eigen::Vector3d corner_board(const Board& board, int column, int row) {
  return {column * board.square_m, row * board.square_m, 0.0};
}

}  // namespace roomradar
