// surface_policy.hpp: policies that choose the surfaces that a virtual object can touch in a frame.
#pragma once
#include <string_view>

namespace roomradar {

enum class SurfacePolicy {
  kHoles,   ///< only this frame's depth; open at depth discontinuities and unmeasured pixels
  kSkirt,   ///< kHoles, plus polygons that connect both sides of depth discontinuities
  kBorder,  ///< kSkirt, with vertices on the image's border moved outwards and nearer
  kMap,     ///< the saved map's static mesh, and this frame's dynamic pixels
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
