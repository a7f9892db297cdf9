// kinect_source.hpp: a live Kinect v1, or its replay by fakenect, as a source of frames.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "app/sources/kinect/kinect_feed.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens Kinect number `device` (from 0) through libfreenect: depth, colour, and the accelerometer's gravity.
///
/// Depth is made metres by the device's own constants, and the colour camera stands where they say it does;
/// without them (a replay) by published figures. Registered depth is seen from the colour camera.
/// A live device's frames that nobody fetches in time are dropped, the oldest first, and counted in
/// Frame::index; options.keep_all keeps some seconds of them. While it is silent or unplugged next() returns
/// about every second, ReadResult::waiting, and goes on when it is back. A replay by fakenect waits for its
/// reader instead, so that it gives what open_folder gives on the same recording, and ends with it
/// (FAKENECT_LOOP=0). The source cannot rewind; see spooled_source.hpp.
/// @throws Error, here if the program was built without Kinect, if there is no such device or it cannot be
/// opened; from next() if it sends no depth for options.device_timeout_s.
std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options = {});

/// The same of whatever `opener` opens; a feed as `config` says, but for what the options say.
/// @param recording  where a camera.json may lie that says more of the cameras than is published
std::unique_ptr<FrameSource> open_kinect(KinectOpener opener, KinectFeedConfig config,
                                         const SourceOptions& options,
                                         const std::filesystem::path& recording = {});

/// How many Kinects libfreenect sees; negative if the program was built without Kinect, 0 if libfreenect
/// cannot start. Opens none.
int count_kinects();

}  // namespace roomradar
