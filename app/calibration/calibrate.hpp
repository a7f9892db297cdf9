// calibrate.hpp: calibration of both cameras, their relative pose and depth errors from checkerboard views.
#pragma once
#include <vector>

#include "app/calibration/board_views.hpp"
#include "app/calibration/calibration.hpp"
#include "app/calibration/view_residual.hpp"

namespace roomradar {

struct CalibrateConfig {
  Board board;
  int grid_columns = 13, grid_rows = 10;  ///< nodes of the depth correction
  int hold_out = 5;                       ///< every n-th view is held out for validation; 0: none
};

/// Standard deviations from the fit's covariance, scaled up if the residuals exceed the assumed noise.
struct CalibrationSigmas {
  double colour_focal_px = 0.0, colour_centre_px = 0.0, depth_focal_px = 0.0, depth_centre_px = 0.0;
  double shift_m = 0.0, turn_rad = 0.0;  ///< of T_colour_depth: translation, rotation
};

struct CalibrationFit {
  Calibration calibration;
  CalibrationSigmas sigmas;
  std::vector<std::size_t> held_out;  ///< indices of the views that the fit does not use
  std::vector<ViewResidual> before;   ///< residuals with the frames' own cameras, one per view
  std::vector<ViewResidual> after;    ///< residuals with the calibration, one per view
};

/// Fits jointly over all views: focal lengths, principal point and lens of both cameras, T_colour_depth, the
/// board's pose in each view, and the depth correction. Residuals are robust: corner positions weighted by a
/// sigma of 0.15 px, depth against the board's plane weighted by the sensor's noise. Nodes of the depth
/// correction without measurements are extrapolated from their neighbours. Method: Herrera, Kannala,
/// Heikkila, Joint depth and color camera calibration with distortion correction, PAMI 2012, except that the
/// depth error is modelled in disparity. Throws Error if there are fewer than 12 views or fewer than 6 tilted
/// views, if the fit does not converge, if a focal length's sigma exceeds 1 %, or if the result would be
/// rejected by read_calibration().
CalibrationFit calibrate(const BoardViews& views, const CalibrateConfig& config);

}  // namespace roomradar
