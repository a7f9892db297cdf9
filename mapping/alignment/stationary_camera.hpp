// stillness.hpp: whether two pictures were taken by a camera that did not move between them.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// True if most of the edges of `before` (intensities 0..255) are where they were, within a fifth of a pixel:
/// then the camera stands still, whatever moves in front of it. False for pictures of different sizes, or
/// with fewer than 300 edge pixels, of which nothing can be said. A moving person has no part in the
/// majority; depth has no say, for a Kinect recalibrates while it stands.
bool shows_the_same(const Image<float>& before, const Image<float>& now);

}  // namespace roomradar
