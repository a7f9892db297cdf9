// board_pose.hpp: pose of a checkerboard from its corners in one image.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "app/calibration/checkerboard.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// Returns T_camera_board, the checkerboard's pose in the camera frame, computed with OpenCV's solvePnP.
/// @param corners_px  all inner corners of the checkerboard, row by row, in the distorted image
Eigen::Isometry3d pose_of_board(const std::vector<Eigen::Vector2d>& corners_px, const Board& board,
                                const Intrinsics& camera, const Lens& lens);

}  // namespace roomradar
