// tsdf_extrapolation.hpp: extrapolates signed distances to voxels next to measured ones.
#pragma once
#include "mapping/octree/tsdf_bricks.hpp"

namespace roomradar {

/// Extrapolates a distance to each unknown voxel that shares a face with a known one, in two rounds, and
/// marks it as guessed. The distance is the mean of the linear extrapolations from the sides with two known
/// voxels in line, or, without such a side, the mean of the known face neighbours. Adds no bricks. All cells
/// around a measured zero crossing then have complete corners, so the surface extends as far as the
/// measurements.
void extrapolate_neighbours(TsdfBricks& bricks);

}  // namespace roomradar
