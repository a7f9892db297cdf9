// surface_policy.hpp: the surfaces of a frame that a virtual object can touch.
#pragma once
#include <string_view>

namespace roomradar {

enum class SurfacePolicy {
  kHoles,   ///< this frame's depth pixels only; open at depth discontinuities and where unmeasured
  kSkirt,   ///< kHoles, plus polygons across depth discontinuities that connect near and far side
  kBorder,  ///< kSkirt, plus the image's border pushed outwards and nearer: a tray around the view
  kMap,     ///< the saved map's static mesh, and this frame's pixels where something is dynamic
};

/// Returns the name used by the command line and reports.
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
