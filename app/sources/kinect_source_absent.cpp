// kinect_source_absent.cpp: stands in for kinect_source.cpp where the program is built without libfreenect.
#include "app/sources/kinect_source.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {

std::unique_ptr<FrameSource> open_kinect(int device, const SourceOptions& /*options*/) {
  throw Error("kinect:" + std::to_string(device) +
              ": this program was built without Kinect; configure it with -DROOMRADAR_WITH_KINECT=ON and "
              "libfreenect-dev");
}

int count_kinects() { return -1; }

}  // namespace roomradar
