// calibration_problem.hpp: unknowns and residuals of the joint least-squares fit.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "app/calibration/board_views.hpp"
#include "app/calibration/checkerboard.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/lens.hpp"

namespace ceres {
class Problem;
}

namespace roomradar {

/// T_a_b as rotation vector (rad) and translation (m): x_a = R x_b + t.
struct PoseBlock {
  std::array<double, 6> turn_and_shift{};
};

/// Convert between a pose and its parameters.
PoseBlock pose_of(const Eigen::Isometry3d& T_a_b);
Eigen::Isometry3d isometry_of(const PoseBlock& pose);

/// A camera and its lens: fx, fy, cx, cy (px), k1, k2, p1, p2, k3.
using CameraBlock = std::array<double, 9>;

/// Convert between a camera and its parameters. `sized` provides the image size of the result.
CameraBlock block_of(const Intrinsics& camera, const Lens& lens);
Intrinsics camera_of(const CameraBlock& block, Intrinsics sized);
Lens lens_of(const CameraBlock& block);

/// Parameters of the fit, and its result.
struct CalibrationUnknowns {
  CameraBlock colour, depth;
  PoseBlock T_colour_depth;
  std::vector<PoseBlock> T_colour_board;  ///< the checkerboard's pose in each view
  double inverse_scale = 1.0;
  std::vector<double> nodes;  ///< offsets of the depth correction (1/m), row by row
};

/// Number of nodes of the depth correction, and the size of the depth images that its grid covers.
struct CorrectionGrid {
  int columns = 0, rows = 0;
  int width_px = 0, height_px = 0;
};

/// Adds the residuals of one view. Residuals are the reprojection errors of corners (sigma 0.15 px) and the
/// differences of inverse depth from the checkerboard's plane (sigma: twice the sensor's noise). The loss is
/// Huber's.
/// @param T_colour_board  the checkerboard's pose in this view. Must be an element of unknowns.T_colour_board
/// @param unknowns        must outlive the problem and must not move
void add_view(const BoardView& view, const Board& board, const CorrectionGrid& grid,
              PoseBlock& T_colour_board, CalibrationUnknowns& unknowns, ceres::Problem& problem);

/// Adds two priors on each node of the depth correction. One pulls it towards 0, the other towards its
/// neighbours.
void add_smoothness(const CorrectionGrid& grid, CalibrationUnknowns& unknowns, ceres::Problem& problem);

}  // namespace roomradar
