// projection.hpp: clip-space matrix of a pinhole camera, projection of boxes to pixels, and conversion of
// depth-buffer values to metres.
#pragma once
#include <Eigen/Geometry>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A rectangle of whole pixels: columns x .. x + width - 1, rows y .. y + height - 1.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

/// Returns the part of `rect` inside an image of this size. Width or height is 0 if there is none.
PixelRect clamped(const PixelRect& rect, int width_px, int height_px);

/// Returns the smallest rectangle that contains both rectangles. Ignores a rectangle without pixels.
PixelRect united(const PixelRect& a, const PixelRect& b);

/// Returns a rectangle of whole pixels that contains the projection of a box into the image. The rectangle
/// exceeds the projection by about a pixel at most. Returns the whole image if a part of the box, but not all
/// of it, is nearer than near_m. Width or height is 0 if the box is empty or out of view.
PixelRect pixels_of(const Eigen::AlignedBox3d& box, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_camera_box, double near_m);

/// Returns the matrix from camera points (x right, y down, z forward) to clip space (x and y in -w..w, z in
/// 0..w). The viewport must have the size of `rect` and shows the pixels of `rect` in the camera's image.
/// Pixel (0, 0) of the image is centred at image coordinates (0, 0). Image row y is framebuffer row y, so
/// images read back need no flip. Triangles that are counter-clockwise seen from outside are clockwise on the
/// framebuffer, so culling needs glFrontFace(GL_CW).
///
/// Depth is reversed and has no far plane: depth_buffer01 = near_m / depth_m, which is 1 at near_m and 0 at
/// infinity. Callers clear the depth buffer to 0 and test with GL_GREATER. One step of a 32 bit float is 6e-8
/// of the depth, which is 0.5 um at 8 m.
Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m, const PixelRect& rect);
/// Returns the matrix for the whole image.
Eigen::Matrix4d clip_from_camera(const Intrinsics& camera, double near_m);

/// Converts a depth-buffer value to metres along the optical axis; returns 0 if nothing was drawn.
inline float depth_from_buffer(float depth_buffer01, float near_m) {
  return depth_buffer01 > 0.0F ? near_m / depth_buffer01 : 0.0F;
}

}  // namespace roomradar
