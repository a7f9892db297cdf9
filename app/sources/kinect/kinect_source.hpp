// kinect_source.hpp: a live Kinect v1, or its replay by fakenect, as a frame source.
#pragma once
#include <filesystem>
#include <memory>

#include "app/sources/formats/source_options.hpp"
#include "app/sources/kinect/kinect_feed.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens Kinect number `device` (from 0) with libfreenect. Frames have depth, colour, and gravity from the
/// accelerometer.
///
/// The device's factory calibration determines the depth conversion and the colour camera. If it is unknown,
/// as in a replay, published values are used. Registered depth is in the colour camera's frame.
///
/// Frames of a live device that are not fetched in time are dropped, oldest first. Dropped frames are counted
/// in Frame::index. With options.keep_all, several seconds of frames are queued. While the device sends no
/// images or is unplugged, next() returns ReadStatus::kWaiting about every second. The source cannot rewind
/// (see spooled_source.hpp).
///
/// A replay by fakenect drops no frames, and ends with the recording (FAKENECT_LOOP=0). It delivers the same
/// frames as open_folder() for the same recording.
/// @throws Error if the program was built without Kinect support, or if the device does not exist or cannot
///         be opened. next() throws Error if the device sends no depth for options.device_timeout_s.
std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& options = {});

/// Opens a device with `opener` instead of libfreenect.
/// @param config  settings of the feed. `options` replace the fields that they determine
/// @param recording  folder. Its camera.json, if any, takes precedence over published values
std::unique_ptr<FrameSource> open_kinect(KinectOpener opener, KinectFeedConfig config,
                                         const SourceOptions& options,
                                         const std::filesystem::path& recording = {});

/// Returns the number of Kinects that libfreenect finds, without opening one. Returns a negative number if
/// the program was built without Kinect support, and 0 if libfreenect cannot be initialised.
int count_kinects();

}  // namespace roomradar
