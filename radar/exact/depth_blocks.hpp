// depth_blocks.hpp: finds the triangles of a depth image inside a volume, in blocks of 8 x 8 grid cells.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_gap.hpp"

namespace roomradar {

/// Axis-aligned box in the frame of the motion (z is the direction of motion), m.
struct FrameBox {
  float x0, x1, y0, y1, z0, z1;
};

/// A depth image in the frame of the motion, and the rectangle of its vertex grid that may intersect a
/// volume.
struct DepthView {
  const SceneDepth* scene = nullptr;
  Eigen::Matrix3d R_frame_camera;
  Eigen::Vector3d t_frame_camera;
  /// Back-projection into the frame. A pixel (u, v) measured at `depth` is at depth * rays * (u, v, 1) +
  /// shift.
  Eigen::Matrix3f rays;
  Eigen::Vector3f shift;
  /// Error bound of a point computed in float: slack_m + slack_per_m * depth.
  float slack_m = 0.0F, slack_per_m = 0.0F;
  /// Number of columns of the whole vertex grid.
  int columns = 0;
  /// Columns i0 to i1 and rows j0 to j1 of the vertices that may intersect the volume, both ends included.
  int i0 = 0, i1 = -1, j0 = 0, j1 = -1;
};

/// Finds the rectangle of vertices whose cells can intersect `volume` (in the frame of the motion). The
/// rectangle is the volume's bounding rectangle in the image. The rectangle suffices, since a cell's
/// triangles lie in the pyramid from the camera centre through the cell.
/// @return false if there is no such cell
bool place_depth(const SceneDepth& scene, const Eigen::Matrix3d& R_frame_world,
                 const Eigen::Vector3d& origin_world, const Eigen::AlignedBox3d& volume, DepthView& view);

/// Up to 8 x 8 cells of the vertex grid, and the bounding box of their vertices.
struct DepthBlock {
  FrameBox box;
  std::int32_t i, j;  ///< Column i and row j of the block's top left vertex.
};
/// Appends the view's blocks that have measured vertices. Takes O(vertices in the view). Reads only the
/// pixels of the view's rectangle.
void append_blocks(const DepthView& view, std::vector<float>& scratch, std::vector<DepthBlock>& blocks);

/// A triangle of a cell, and its bounding box.
struct DepthTriangle {
  FrameBox box;
  /// Index of the triangle in its depth image, for depth_triangle().
  std::uint32_t id;
};
/// Appends the triangles of a block. SceneDepth defines which triangles exist.
void append_triangles(const DepthView& view, const DepthBlock& block, std::vector<DepthTriangle>& triangles);

/// Returns the triangle with this id, computed in double from its float vertices.
FrameTriangle depth_triangle(const DepthView& view, std::uint32_t id);

}  // namespace roomradar
