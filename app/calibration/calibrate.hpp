// calibrate.hpp: calibration of both cameras, their relative pose and the depth errors from checkerboard
// views.
#pragma once
#include <vector>

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

struct CalibrateConfig {
  Board board;
  int grid_columns = 13, grid_rows = 10;  ///< number of nodes of the depth correction
  int hold_out = 5;                       ///< every n-th view is held out for validation; 0: none
};

/// Standard deviations of the results, from the covariance of the least-squares fit. Each is the largest of
/// its components, such as fx and fy. They are scaled up if the residuals exceed the assumed noise.
struct CalibrationSigmas {
  double colour_focal_px = 0.0, colour_centre_px = 0.0, depth_focal_px = 0.0, depth_centre_px = 0.0;
  double shift_m = 0.0, turn_rad = 0.0;  ///< translation and rotation of T_colour_depth
};

struct CalibrationFit {
  Calibration calibration;
  CalibrationSigmas sigmas;
  std::vector<std::size_t> held_out;  ///< indices of the held-out views, not used by the fit
  std::vector<ViewResidual> before;   ///< residuals with the uncalibrated cameras of the frames, one per view
  std::vector<ViewResidual> after;    ///< residuals with the calibration, one per view
};

/// Fits all parameters jointly to all views that are not held out. Parameters are intrinsics and lens
/// distortion of both cameras (k3 of the depth lens is 0), T_colour_depth, the checkerboard's pose in each
/// view, and the depth correction. Residuals are the reprojection errors of corners (sigma 0.15 px) and the
/// differences of inverse depth from the checkerboard's plane (sigma: twice the sensor's noise). The loss is
/// robust (Huber). Nodes of the depth correction without measurements are extrapolated from their neighbours.
/// Method: Herrera, Kannala, Heikkila, Joint depth and color camera calibration with distortion correction,
/// PAMI 2012, but with the depth error modelled in disparity. Throws Error if there are fewer than 12 views,
/// or fewer than 6 tilted ones in the fit. Throws Error if the fit does not converge, a focal length's sigma
/// exceeds 1 %, or read_calibration() would reject the result.
CalibrationFit calibrate(const BoardViews& views, const CalibrateConfig& config);

}  // namespace roomradar
