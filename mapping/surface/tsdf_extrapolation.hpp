// tsdf_extrapolation.hpp: extrapolates signed distances to voxels next to measured ones.
#pragma once
#include "mapping/surface/tsdf_levels.hpp"

namespace roomradar {

/// Extrapolates a distance to each unknown voxel that shares a face with a known voxel, in two rounds. Marks
/// the samples as extrapolated. The distance is the mean of linear extrapolations along the axes. One of the
/// six axis directions is used if the next two voxels in it are known. If there is no such direction, the
/// distance is the mean of the known face neighbours. Adds no bricks. Afterwards all eight corners of every
/// cell around a measured zero crossing are known, so the surface extends as far as the measurements. Each
/// grid is extrapolated only where it is not mirrored from the other.
void extrapolate_neighbours(TsdfLevels& levels);

}  // namespace roomradar
