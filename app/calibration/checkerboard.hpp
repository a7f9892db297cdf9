// checkerboard.hpp: a checkerboard: its dimensions, and its pose from its corners in one image.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

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

/// Returns T_camera_board, the checkerboard's pose in the camera frame, computed with OpenCV's solvePnP.
/// @param corners_px  all inner corners of the checkerboard, row by row, in the distorted image
Eigen::Isometry3d pose_of_board(const std::vector<Eigen::Vector2d>& corners_px, const Board& board,
                                const Intrinsics& camera, const Lens& lens);

}  // namespace roomradar
