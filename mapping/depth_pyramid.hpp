// depth_pyramid.hpp: what a depth image proves about whole rectangles of its pixels.
#pragma once
#include <vector>

#include "mapping/fusion_config.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Of all pixels in a rectangle: what lies nearer than front_m along the optical axis is seen through by each
/// of them; what lies farther than back_m is hidden from, or unmeasured by, each of them. Between the two
/// lies a surface.
struct DepthBounds {
  float front_m = 0.0F;
  float back_m = 0.0F;
  float nearest_m = 0.0F;  ///< the front of those pixels that have depth; infinity if none has: what lies
                           ///< nearer is seen through by them, and the others say nothing
};

/// The layer round a surface measured at depth_m in which signed distance is kept.
DepthBounds truncation_layer(float depth_m, double resolution_m, const FusionConfig& config);

/// levels[0] has the image's size, each next one half of it, rounded up.
struct DepthPyramid {
  std::vector<Image<DepthBounds>> levels;
};

/// Pixels without depth prove nothing; a hole smaller than 4 x 4 pixels takes the word of its neighbours, so
/// that single dropouts do not keep the space before a wall unknown. Pixels past max_range_m prove free what
/// is nearer than that. Reuses the pyramid's memory.
void build_pyramid(const DepthImage& depth_m, double resolution_m, const FusionConfig& config,
                   DepthPyramid& pyramid);

/// Of a rectangle (borders included) within the image: four lookups, on a level where it spans at most two
/// cells each way.
DepthBounds bounds_within(const DepthPyramid& pyramid, int left, int top, int right, int bottom);

}  // namespace roomradar
