// projection.hpp: the pinhole camera as a clip-space matrix, pixels of boxes, depth-buffer values as metres.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A rectangle of whole pixels: columns x .. x + width - 1, rows y .. y + height - 1.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// The part of `rect` that lies within an image of this size; width or height 0 where nothing does.
PixelRect clamped(const PixelRect& rect, int width_px, int height_px);

/// The smallest rectangle that holds both; one without pixels does not count.
PixelRect united(const PixelRect& a, const PixelRect& b);

/// The smallest rectangle of whole pixels that holds a box as the camera sees it, within its image; the whole
/// image where the box reaches behind near_m; width and height 0 where it is empty or out of sight.
PixelRect pixels_of(const Eigen::AlignedBox3d& box, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_camera_box, double near_m);

/// Clip space (x, y in -w..w, z in 0..w) from camera points (x right, y down, z forward), for a viewport of
/// the size of `rect` that shows those pixels of the camera's image. Pixel (0, 0) of the image is centred at
/// image coordinates (0, 0). Image row y is framebuffer row y, so what is read back needs no flip, and
/// triangles that are counter-clockwise seen from outside are clockwise on the framebuffer:
/// glFrontFace(GL_CW).
///
/// Depth is reversed and has no far end: depth_buffer01 = near_m / depth_m, 1 at near_m, 0 infinitely far;
/// clear to 0 and test GL_GREATER. With 32 bit float one step is 6e-8 of the depth: 0.5 um at 8 m.
Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m, const PixelRect& rect);
/// The same for the whole image.
Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m);

/// Metres along the axis from what GL stores; 0 where nothing was drawn.
inline float depth_from_buffer(float depth_buffer01, float near_m) {
  return depth_buffer01 > 0.0F ? near_m / depth_buffer01 : 0.0F;
}

}  // namespace roomradar
