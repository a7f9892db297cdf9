// freenect_device.hpp: libfreenect, as the one thing behind KinectDevice that is not a test's.
#pragma once
#include <memory>

#include "app/sources/kinect/kinect_device.hpp"

namespace roomradar {

/// A KinectOpener. Throws Error saying what is in the way: no such device, no rights, another program, a
/// program that was built without Kinect.
std::unique_ptr<KinectDevice> open_freenect(const KinectWish& wish);

}  // namespace roomradar
