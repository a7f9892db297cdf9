// tsdf_smoothing.hpp: smooths signed distances that have few or poor measurements.
#pragma once
#include "mapping/surface/tsdf_levels.hpp"

namespace roomradar {

/// Number of voxels over which one sweep of smooth() carries a change.
inline constexpr int kReachPerSweep_voxels = 8;

/// Smooths each known distance x_i from its measured value d_i towards its axis neighbours, by in-place
/// sweeps:
///   x_i = (w_i d_i + s sum over axes (x_before + x_after) / 2) / (w_i + s count of axes),
/// where w_i is the sample's weight and s is `strength` (> 0, in units of one measurement from 1 m). Samples
/// with w_i > 30 s are left unchanged. Axes with an unknown neighbour are left out, so flat surfaces do not
/// move at any strength. The smoothing radius is sqrt(s / w) voxels. A wall scanned from 1 m keeps its
/// detail. A wall measured once from 4 m is averaged over several voxels. A sweep updates first the cells
/// whose coordinates have an even sum, then the others. Source: weighted diffusion, the red-black
/// Gauss-Seidel steps of a screened Poisson equation. The grid of coarse cells is smoothed with a quarter of
/// the strength. Where the grids meet, each is smoothed with the other's mirrored samples.
void smooth(TsdfLevels& levels, float strength, int sweeps);

}  // namespace roomradar
