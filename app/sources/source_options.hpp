// source_options.hpp: what a caller may say about a source that the source itself does not say.
#pragma once
#include <optional>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

struct SourceOptions {
  /// Taken instead of what the recording's files or the format's published figures say. Must be of the depth
  /// image's size. Where colour is registered to depth (TUM, numbered folders without camera.json) the colour
  /// camera follows.
  std::optional<Intrinsics> depth_camera;
  /// A live device that sends nothing for as long as this is given up; 30 Hz is normal.
  double device_timeout_s = 5.0;
};

}  // namespace roomradar
