// freenect_device.hpp: KinectDevice implemented with libfreenect.
#pragma once
#include <memory>

#include "app/sources/kinect/kinect_device.hpp"

namespace roomradar {

/// Opens a Kinect with libfreenect. Is a KinectOpener. Throws Error with the cause (no such device, no
/// permission, device in use by another program, or build without Kinect support).
std::unique_ptr<KinectDevice> open_freenect(const KinectRequest& request);

}  // namespace roomradar
