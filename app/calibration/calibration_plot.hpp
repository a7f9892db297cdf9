// calibration_plot.hpp: plots the measurements and residuals of a calibration.
#pragma once
#include "app/calibration/calibrate.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Draws four panels. Panel 1: corner positions in the colour image. Panel 2: checkerboard pixels in the
/// depth image. Panel 3: each view's depth error over distance, before and after calibration, with held-out
/// views as rings. Panel 4: the depth correction over the image, in mm at 2 m.
ColourImage calibration_plot(const BoardViews& views, const CalibrationFit& fit);

}  // namespace roomradar
