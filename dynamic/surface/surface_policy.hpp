// surface_policy.hpp: which surfaces a virtual object can touch in a frame.
#pragma once
#include <string_view>

namespace roomradar {

enum class SurfacePolicy {
  kHoles,   ///< this frame's depth pixels only, nothing across depth jumps: what is hidden is open
  kSkirt,   ///< the same, and polygons across the depth jumps that join the near side to the far side
  kBorder,  ///< the same as kSkirt, and the image's border pushed outwards and nearer: a tray round the view
  kMap,     ///< the static mesh of the saved map, and this frame's pixels where something moved
};

/// As the command line and the reports call it.
constexpr std::string_view to_string(SurfacePolicy policy) {
  switch (policy) {
    case SurfacePolicy::kHoles:
      return "holes";
    case SurfacePolicy::kSkirt:
      return "skirt";
    case SurfacePolicy::kBorder:
      return "border";
    case SurfacePolicy::kMap:
      break;
  }
  return "map";
}

}  // namespace roomradar
