// freenect_device_absent.cpp: replaces freenect_device.cpp in builds without libfreenect.
#include "app/sources/kinect/fakenect_replay.hpp"
#include "app/sources/kinect/freenect_device.hpp"
#include "app/sources/kinect/kinect_source.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

std::unique_ptr<KinectDevice> open_freenect(const KinectRequest& request) {
  throw Error("kinect:" + std::to_string(request.number) +
              ": this program was built without Kinect; configure it with -DROOMRADAR_WITH_KINECT=ON and "
              "libfreenect-dev");
}

int count_kinects() { return -1; }

std::optional<std::filesystem::path> replayed_folder() { return std::nullopt; }

}  // namespace roomradar
