// openni_source.hpp: a live Xtion, PrimeSense or other device of OpenNI2 as a frame source.
#pragma once
#include <memory>
#include <string>

#include "app/sources/formats/source_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

/// Opens a device of OpenNI2. Frames have depth, and colour if the device has it. Depth is registered to
/// colour if the device can do so. Intrinsics follow from the fields of view that the device states, else
/// from a PrimeSense's. OpenNI2 buffers the newest images only: frames that are not fetched in time are
/// dropped, and counted in Frame::index. While the device sends no images, next() returns ReadStatus::kWaiting
/// about every second. The source cannot rewind.
/// @param device  index among the connected devices, from 0, or OpenNI2 URI
/// @throws Error if the program was built without OpenNI2, or the device does not exist or cannot be opened.
///         next() throws Error if the device sends no depth for options.device_timeout_s
std::unique_ptr<FrameSource> open_openni(const std::string& device, const SourceOptions& options = {});

}  // namespace roomradar
