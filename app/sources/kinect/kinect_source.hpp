// kinect_source.hpp: a live Kinect v1, or its replay by fakenect, as a frame source.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "app/sources/kinect/kinect_feed.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens Kinect number `device` (from 0) through libfreenect: depth, colour, and gravity from the
/// accelerometer.
///
/// Depth is converted to metres, and the colour camera is placed, by the device's own constants; without them
/// (a replay) by published values. Registered depth is in the colour camera's frame. Frames of a live device
/// that are not fetched in time are dropped, oldest first, and counted in Frame::index; options.keep_all
/// keeps some seconds of them. While the device is silent or unplugged, next() returns about every second
/// with ReadResult::waiting, and continues when it is back. A replay by fakenect waits for its reader
/// instead, so it delivers the same frames as open_folder() on the same recording, and ends with it
/// (FAKENECT_LOOP=0). The source cannot rewind; see spooled_source.hpp.
/// @throws Error from open_kinect() if the program was built without Kinect support, there is no such device,
/// or it cannot be opened; from next() if it sends no depth for options.device_timeout_s.
std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options = {});

/// Same for the device that `opener` opens. `config` sets up the feed, except for fields that `options`
/// determine.
/// @param recording  folder searched for a camera.json, which takes precedence over published values
std::unique_ptr<FrameSource> open_kinect(KinectOpener opener, KinectFeedConfig config,
                                         const SourceOptions& options,
                                         const std::filesystem::path& recording = {});

/// Returns the number of Kinects that libfreenect finds, without opening any; negative if the program was
/// built without Kinect support, 0 if libfreenect cannot start.
int count_kinects();

}  // namespace roomradar
