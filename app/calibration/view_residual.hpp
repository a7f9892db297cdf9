// view_residual.hpp: residuals of one checkerboard view with a calibration.
#pragma once
#include "app/calibration/board_views.hpp"
#include "app/calibration/calibration.hpp"

namespace roomradar {

/// See residual_of().
struct ViewResidual {
  double colour_rms_px = 0.0;
  double depth_bias_m = 0.0;  ///< median of corrected depth minus depth of the checkerboard's plane
  double depth_rms_m = 0.0;
  double distance_m = 0.0;  ///< depth of the checkerboard's centre
};

/// Estimates the checkerboard's pose from its corners, then compares the measured depth with the
/// checkerboard's plane.
ViewResidual residual_of(const BoardView& view, const Board& board, const Calibration& calibration);

}  // namespace roomradar
