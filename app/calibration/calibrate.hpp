// calibrate.hpp: both cameras, where they stand to each other, and the depth's errors, from views of a board.
#pragma once
#include <vector>

#include "app/calibration/board_views.hpp"
#include "app/calibration/calibration.hpp"

namespace roomradar {

struct CalibrateConfig {
  Board board;
  int grid_columns = 13, grid_rows = 10;  ///< nodes of the depth correction
  int hold_out = 5;                       ///< every so many views judge the fit instead of making it
};

/// What is left between a camera model and one view.
struct ViewResidual {
  double colour_rms_px = 0.0;
  double depth_bias_m = 0.0;  ///< median of corrected depth less the board's plane
  double depth_rms_m = 0.0;
  double distance_m = 0.0;  ///< of the board
};

/// One standard deviation, from the fit's covariance and what is left of the errors.
struct CalibrationSigmas {
  double colour_focal_px = 0.0, colour_centre_px = 0.0, depth_focal_px = 0.0, depth_centre_px = 0.0;
  double shift_m = 0.0, turn_rad = 0.0;  ///< of T_colour_depth
};

struct CalibrationFit {
  Calibration calibration;
  CalibrationSigmas sigmas;
  std::vector<std::size_t> held_out;  ///< positions among the views of those that did not make the fit
  std::vector<ViewResidual> before;   ///< of every view, with the cameras that the frames say
  std::vector<ViewResidual> after;    ///< of every view, with the calibration
};

/// Fits, jointly over all views: focal lengths, principal point and lens of both cameras, T_colour_depth, the
/// board's pose in each view, and the depth correction. Corners count by 0.15 px, depth by the sensor's noise
/// over the plane that the board is; both robustly. Where nothing was seen the depth correction goes on from
/// its neighbours.
/// Source of the method: Herrera, Kannala, Heikkila, Joint depth and color camera calibration with distortion
/// correction, PAMI 2012; here with the depth error in disparity.
/// Throws Error if there are fewer than 12 views, or 6 that are tilted, if the fit does not converge, if the
/// views leave a focal length unsure by more than 1 %, or the fit is nothing that could be read again.
CalibrationFit calibrate(const BoardViews& views, const CalibrateConfig& config);

/// How well cameras explain one view: the board is posed by its corners, then its plane judges the depth.
ViewResidual residual_of(const BoardView& view, const Board& board, const Calibration& calibration);

}  // namespace roomradar
