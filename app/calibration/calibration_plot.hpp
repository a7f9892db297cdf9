// calibration_plot.hpp: plots the measurements behind a calibration, and its residuals.
#pragma once
#include "app/calibration/calibrate.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Draws four panels: corner positions in the colour image; board pixels in the depth image; each view's
/// depth error over distance, before and after calibration, with held-out views as rings; the depth
/// correction over the image, in mm at 2 m.
ColourImage calibration_plot(const BoardViews& views, const CalibrationFit& fit);

}  // namespace roomradar
