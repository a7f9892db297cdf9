// view_residual.hpp: errors of one checkerboard view under a calibration.
#pragma once
#include "app/calibration/board_views.hpp"
#include "app/calibration/calibration.hpp"

namespace roomradar {

/// Residuals of one view under a camera model.
struct ViewResidual {
  double colour_rms_px = 0.0;
  double depth_bias_m = 0.0;  ///< median of corrected depth minus depth of the board's plane
  double depth_rms_m = 0.0;
  double distance_m = 0.0;  ///< depth of the board's centre
};

/// Computes a view's residuals: estimates the board's pose from its corners, then compares the depth with the
/// board's plane.
ViewResidual residual_of(const BoardView& view, const Board& board, const Calibration& calibration);

}  // namespace roomradar
