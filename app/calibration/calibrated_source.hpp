// calibrated_source.hpp: a source whose frames are as ideal cameras would have taken them.
#pragma once
#include <memory>

#include "app/calibration/calibration.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Takes lens distortion and depth errors out of every frame and gives it the calibrated cameras. Depth
/// pixels move to the nearest place and are not mixed; colour is interpolated; what no pixel saw is 0. Next
/// to nothing is allocated after the first frame. next() throws Error if the images are not of the
/// calibration's size.
std::unique_ptr<FrameSource> calibrated(std::unique_ptr<FrameSource> source, const Calibration& calibration);

}  // namespace roomradar
