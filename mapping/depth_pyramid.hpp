// depth_pyramid.hpp: what a depth image proves about whole rectangles of its pixels.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/fusion_config.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Signed distance is kept so far before and behind a surface measured at depth_m.
float half_layer_m(float depth_m, double resolution_m, const FusionConfig& config);

/// Of all pixels in a rectangle: what lies nearer than `front` along the optical axis is seen through by each
/// of them; what lies nearer than `nearest` is seen through by those that have depth, and the others say
/// nothing; what lies farther than -`behind` is hidden from, or unmeasured by, each of them. Between `front`
/// and -`behind` lies a surface. In steps of the pyramid's step_m, rounded to the safe side. `behind` counts
/// downwards so that a rectangle's bounds are the least of its pixels' in every field.
struct DepthBounds {
  std::int16_t front = 0;
  std::int16_t nearest = 0;
  std::int16_t behind = 0;
  std::int16_t unused = 0;
};

struct DepthPyramid {
  float steps_per_m = 0.0F;
  /// levels[i] has cells of 2^i pixels each way; levels[0] is not kept: single pixels are what the image is
  /// for.
  std::vector<Image<DepthBounds>> levels;
  std::vector<float> row_nearest_m, row_farthest_m, row_deepest_m;  // of two rows of the image
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
