// reduced_depth.hpp: downsamples a frame's depth without averaging across surfaces.
#pragma once
#include "mapping/types/frame.hpp"

namespace roomradar {

/// Returns `stride`, halved until the reduced image has at least 32 rows and columns, but at least 1.
int usable_stride(const Intrinsics& depth_camera, int stride);

/// Replaces each block of stride x stride pixels by one pixel, and scales the camera to match. Chooses the
/// surface that has the most measured pixels in the block or, on a tie, the nearer one. The new depth is the
/// mean over this surface's pixels, in inverse depth. Hence no pixel gets a depth between a near edge and its
/// background, and a fully measured plane keeps its depth. The depth is 0 if the chosen surface has less than
/// half of the block's pixels, as at the border of a gap. Slivers thinner than half a reduced pixel are thus
/// lost.
/// @param stride   1, 2 or 4, from usable_stride()
/// @param reduced  depth_m and depth_camera are overwritten; the other fields are unchanged
void reduce_depth(const Frame& frame, int stride, Frame& reduced);

}  // namespace roomradar
