// dynamic_view.hpp: a depth frame divided into dynamic pixels and static model.
#pragma once
#include "mapping/types/image.hpp"
#include "mapping/types/posed_depth.hpp"

namespace roomradar {

/// A depth frame, its dynamic pixels, and the static model's depth in the same view. Refers to the images,
/// which must outlive it and have the size of `measured`.
struct DynamicView {
  PosedDepth measured;
  const MaskImage& dynamic_mask;       ///< not 0: dynamic
  const DepthImage& expected_depth_m;  ///< depth of the static model, m; 0: unknown
};

}  // namespace roomradar
