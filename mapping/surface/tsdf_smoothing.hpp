// sample_smoothing.hpp: noise out of signed distances where few or poor measurements stand behind them.
#pragma once
#include "mapping/octree/tsdf_bricks.hpp"

namespace roomradar {

/// Moves each known distance x_i from what was measured, d_i, towards its neighbours along the axes:
///   x_i = (w_i d_i + s sum over axes (x_before + x_after) / 2) / (w_i + s count of axes),
/// sweep after sweep in place, w_i the sample's weight and s `strength` (> 0, in the same unit: 1 is one
/// measurement from 1 m). Axes with an unknown neighbour do not count, so that flat surfaces stay where they
/// are at any strength. It reaches sqrt(s / w) voxels: a wall scanned from 1 m keeps its detail, one glimpsed
/// from 4 m is averaged over several voxels. Source: weighted diffusion, the Gauss-Seidel steps of a screened
/// Poisson equation.
void smooth(SampleBricks& bricks, float strength, int sweeps);

}  // namespace roomradar
