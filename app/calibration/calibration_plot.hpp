// calibration_plot.hpp: a calibration at a glance, to see where it can be trusted.
#pragma once
#include "app/calibration/calibrate.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Four panels: where in the colour image corners were seen; where in the depth image the board was; each
/// view's depth error over its distance, before and after, held-out views as rings; and the depth correction
/// over the image, as mm at 2 m.
ColourImage calibration_plot(const BoardViews& views, const CalibrationFit& fit);

}  // namespace roomradar
