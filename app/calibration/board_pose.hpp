// board_pose.hpp: where a checkerboard stands before a camera, from its corners in one image.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "app/calibration/board_views.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace roomradar {

/// T_camera_board by OpenCV's solvePnP.
/// @param corners_px  in the real image, row by row, all of the board's
Eigen::Isometry3d pose_of_board(const std::vector<Eigen::Vector2d>& corners_px, const Board& board,
                                const Intrinsics& camera, const Lens& lens);

}  // namespace roomradar
