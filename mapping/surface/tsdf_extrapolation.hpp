// sample_guess.hpp: distances for the voxels next to measured ones.
#pragma once
#include "mapping/octree/tsdf_bricks.hpp"

namespace roomradar {

/// Gives each unknown voxel beside a known one (by faces, then once more from those) a distance and marks it
/// as guessed: the mean over the sides with two known voxels of the straight line through them, or if there
/// is no such side, over the voxels beside it. Only within the bricks that there are. So the cells round a
/// measured crossing have all their corners, and the net reaches as far as the measurements.
void guess_neighbours(SampleBricks& bricks);

}  // namespace roomradar
