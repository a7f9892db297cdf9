// kinect_source.hpp: a live Kinect v1, or its replay by fakenect, as a source of frames.
#pragma once
#include <memory>

#include "app/sources/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens Kinect number `device` (from 0) through libfreenect: raw 11 bit depth made metres here, colour, and
/// the accelerometer's gravity. A thread of its own serves the device.
///
/// A live device's frames that nobody fetches in time are dropped, the oldest first, and counted in
/// Frame::index. A replay by fakenect waits instead, so that it gives what open_folder gives on the same
/// recording, and ends with it (FAKENECT_LOOP=0). The source cannot rewind; see spooled_source.hpp.
/// @throws Error, here or from next(), if the program was built without Kinect, if there is no such device or
/// it cannot be opened, if it stops answering, or if it sends no depth for options.device_timeout_s.
std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options = {});

/// How many Kinects libfreenect sees; negative if the program was built without Kinect, 0 if libfreenect
/// cannot start. Opens none.
int count_kinects();

}  // namespace roomradar
