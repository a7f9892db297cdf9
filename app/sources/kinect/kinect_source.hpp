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
/// The device's own constants convert depth to metres and place the colour camera. Without them (a replay),
/// published values are used. Registered depth is in the colour camera's frame.
///
/// Frames of a live device that are not fetched in time are dropped, oldest first; dropped frames count in
/// Frame::index. options.keep_all queues several seconds of frames. While the device is silent or unplugged,
/// next() returns about every second with ReadResult::waiting; it continues when the device is back. The
/// source cannot rewind; see spooled_source.hpp.
///
/// A replay by fakenect waits for its reader instead, and ends with the recording (FAKENECT_LOOP=0). It
/// delivers the same frames as open_folder() on the same recording.
/// @throws Error from open_kinect() if the program was built without Kinect support, there is no such device,
///         or it cannot be opened. next() throws Error if the device sends no depth for
///         options.device_timeout_s.
std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options = {});

/// Opens the device that `opener` opens, in the same way.
/// @param config  settings of the feed, except for fields that `options` determine
/// @param recording  folder searched for a camera.json, which takes precedence over published values
std::unique_ptr<FrameSource> open_kinect(KinectOpener opener, KinectFeedConfig config,
                                         const SourceOptions& options,
                                         const std::filesystem::path& recording = {});

/// Returns the number of Kinects that libfreenect finds, without opening any. Returns a negative number if
/// the program was built without Kinect support, and 0 if libfreenect cannot start.
int count_kinects();

}  // namespace roomradar
