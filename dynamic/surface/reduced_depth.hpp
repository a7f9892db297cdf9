// reduced_depth.hpp: a frame's depth with fewer pixels, each of one surface.
#pragma once
#include "mapping/types/frame.hpp"

namespace roomradar {

/// The stride that a depth image of this size is reduced by where `stride` is asked for: half of it, or 1,
/// where fewer than 32 rows or columns would be left.
int usable_stride(const Intrinsics& depth_camera, int stride);

/// One pixel for each stride x stride pixels, and the camera that sees those: scaled(). Its depth is the
/// mean, of inverse depths, of those pixels that lie on the surface that most of the measured ones show, the
/// nearer of two that are equally many: so nothing lies between a near edge and what is behind it, and on a
/// plane it is the depth at the pixel's centre where all are measured. 0 where that surface has less than
/// half of the pixels, as at the rim of a hole; so a sliver thinner than half a pixel is lost.
/// @param stride   1, 2 or 4, usable
/// @param reduced  depth_m and depth_camera are overwritten; its other fields stay
void reduce_depth(const Frame& frame, int stride, Frame& reduced);

}  // namespace roomradar
