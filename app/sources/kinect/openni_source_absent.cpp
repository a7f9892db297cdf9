// openni_source_absent.cpp: replaces openni_source.cpp in builds without OpenNI2.
#include "app/sources/kinect/openni_source.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

std::unique_ptr<FrameSource> open_openni(const std::string& device, const SourceOptions& /*options*/) {
  throw Error("openni:" + device +
              ": this program was built without OpenNI2; configure it with -DROOMRADAR_WITH_OPENNI=ON and "
              "libopenni2-dev");
}

}  // namespace roomradar
