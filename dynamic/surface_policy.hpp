// surface_policy.hpp: which surfaces a virtual object can touch in a frame.
#pragma once

namespace roomradar {

enum class SurfacePolicy {
  kHoles,  ///< this frame's depth pixels only, nothing across depth jumps: what is hidden is open
  kSkirt,  ///< this frame's depth pixels, and polygons across the depth jumps that join the near side to the
           ///< far side
  kMap,    ///< the static mesh of the saved map, and this frame's pixels where something moved
};

}  // namespace roomradar
