// checkerboard.hpp: the dimensions of a checkerboard.
#pragma once
#include <Eigen/Core>

namespace roomradar {

/// A printed checkerboard, described by its inner corners (where four squares meet).
struct Board {
  int columns = 8, rows = 6;  ///< inner corners, 3 to 30 each, not equal
  double square_m = 0.03;
};

/// Returns corner (column, row) in the board's frame: z = 0, x along the columns.
inline Eigen::Vector3d corner_board(const Board& board, int column, int row) {
  return {column * board.square_m, row * board.square_m, 0.0};
}

}  // namespace roomradar
